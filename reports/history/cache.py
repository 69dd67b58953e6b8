"""Where environments and results are kept from one call to the next."""

from __future__ import annotations

import os
import sys
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path

from filelock import FileLock, Timeout

from models.errors import CrankcheckError
from reports.output.write import check_folder


def user_cache(
    platform: str = sys.platform, variables: Mapping[str, str] = os.environ
) -> Path | None:
    """The folder of crankcheck among the user's caches, as the system has it; None without a home.

    A variable that names no absolute path counts for nothing, as the XDG specification has it.
    """
    named = variables.get("LOCALAPPDATA" if platform == "win32" else "XDG_CACHE_HOME", "")
    if named and Path(named).is_absolute():
        return Path(named) / "crankcheck"
    try:
        home = Path.home()
    except RuntimeError:
        return None
    usual = {"win32": "AppData/Local", "darwin": "Library/Caches"}
    return home / usual.get(platform, ".cache") / "crankcheck"


def cache_folder(named: Path | None) -> Path:
    """The folder that a user named, or the usual one, absolute and known to be writable.

    Raises
    ------
    CrankcheckError
        No usual place, or no right to write there.
    """
    folder = named or user_cache()
    if folder is None:
        raise CrankcheckError(
            "history: there is no home folder to keep environments in; name one with --cache DIR"
        )
    check_folder(folder, "--cache")
    return folder.resolve() / "history"


@contextmanager
def alone(path: Path, waiting: Callable[[], None]) -> Iterator[None]:
    """The block is done by one process at a time; ``waiting`` is told when another is in it."""
    path.parent.mkdir(parents=True, exist_ok=True)
    lock = FileLock(path)
    try:
        taken = lock.acquire(timeout=0)
    except Timeout:
        waiting()
        taken = lock.acquire()
    with taken:
        yield
