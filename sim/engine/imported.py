"""Imports of engines' packages that write a line on the standard error of the process."""

import os
from collections.abc import Iterator
from contextlib import contextmanager
from importlib import import_module
from pathlib import Path
from typing import Any


@contextmanager
def muted() -> Iterator[None]:
    """Drop what native code writes on the standard error meanwhile."""
    kept = os.dup(2)
    try:
        with Path(os.devnull).open("w") as nowhere:
            os.dup2(nowhere.fileno(), 2)
        yield
    finally:
        os.dup2(kept, 2)
        os.close(kept)


def imported(name: str) -> Any:
    """Import a package in silence."""
    with muted():
        return import_module(name)


def imported_warp() -> Any:
    """Import Warp, whose first use says that there is no accelerator; it compiles without a word
    for each kernel."""
    with muted():
        warp = import_module("warp")
        warp.config.log_level = warp.LOG_ERROR
        warp.init()
    return warp
