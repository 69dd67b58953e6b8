"""exudyn itself, and what it says.

Its type stubs leave out ``self`` and its items are untyped, so all of it is `Any` here.
"""

from __future__ import annotations

import contextlib
import io
import re
from collections.abc import Iterator
from importlib import import_module
from typing import Any

SAID = re.compile(r"Python WARNING|Python ERROR")
"""What begins each of the things that exudyn says of a run."""
PLACE = re.compile(r"\[(?:Python )?file .*?\]:?")
"""Where in a Python program a call of exudyn stands, which it adds to all that it says."""


@contextlib.contextmanager
def quiet(heard: list[str]) -> Iterator[None]:
    """Add to ``heard`` what exudyn prints meanwhile, which it does by way of ``sys.stdout``."""
    said = io.StringIO()
    try:
        with contextlib.redirect_stdout(said):
            yield
    finally:
        heard += [text for part in SAID.split(said.getvalue()) if (text := plain(part))]


def plain(text: str) -> str:
    """What exudyn says in one line, without its rules of asterisks."""
    return " ".join(PLACE.sub("", text).replace("*", "").split())


with quiet([]):  # it announces what its environment variables ask of it
    exu: Any = import_module("exudyn")
    items: Any = import_module("exudyn.itemInterface")
VERSION = str(exu.config.Version())
