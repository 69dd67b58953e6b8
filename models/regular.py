"""Read what a user names: a plain file of bounded size, or words that say why not.

Nothing else is read: a pipe keeps its reader waiting, and a device may never end.
"""

from __future__ import annotations

import os
import stat
from pathlib import Path

MOST_TEXT = 200_000
"""Bytes of a file that a user writes: a thousand links take about half of it."""
_KINDS = {
    stat.S_IFDIR: "a folder",
    stat.S_IFIFO: "a pipe, no plain file",
    stat.S_IFCHR: "a device, no plain file",
    stat.S_IFBLK: "a device, no plain file",
    stat.S_IFSOCK: "a socket, no plain file",
}
# What has become a pipe since it was looked at is opened without waiting for its other end.
_FLAGS = os.O_RDONLY | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_BINARY", 0)


class UnreadableError(Exception):
    """What can not be read, or makes no sense; its text says why, and not of which file."""


def regular_bytes(path: Path, most: int) -> bytes:
    """What stands in a plain file. Raises UnreadableError for anything else, for more than ``most``
    bytes, for a file that grows meanwhile, and for one that may not be read."""
    try:
        _size(path.stat(), most)
        with os.fdopen(os.open(path, _FLAGS), "rb") as file:
            size = _size(os.fstat(file.fileno()), most)
            raw = file.read(size + 1)
    except FileNotFoundError:
        raise UnreadableError("not there") from None
    except OSError as error:
        raise UnreadableError(f"can not be read: {error.strerror or error}") from None
    if len(raw) > size:
        raise UnreadableError(f"grows while it is read, above {size} bytes")
    return raw


def regular_text(path: Path) -> str:
    """What stands in a text file that a user wrote. Raises UnreadableError as `regular_bytes`, and
    for what is not UTF-8."""
    try:
        return regular_bytes(path, MOST_TEXT).decode("utf-8-sig")  # some editors put a mark first
    except UnicodeDecodeError:
        raise UnreadableError("not UTF-8 text; save the file as UTF-8") from None
    except UnreadableError as error:
        raise UnreadableError(
            f"{error}; name a plain text file of at most {MOST_TEXT} bytes that you may read"
        ) from None


def _size(found: os.stat_result, most: int) -> int:
    """The size of a plain file [byte]. Raises UnreadableError for no such file, or a larger one."""
    kind = stat.S_IFMT(found.st_mode)
    if kind != stat.S_IFREG:
        raise UnreadableError(_KINDS.get(kind, "no plain file"))
    if found.st_size > most:
        raise UnreadableError(f"{found.st_size} bytes; at most {most} are read")
    return found.st_size
