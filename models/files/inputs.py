"""Bounds on names and files from a user: plain files, TOML."""

import os
import re
import stat
import tomllib
from collections.abc import Iterable, Mapping
from pathlib import Path

from models.errors import CrankcheckError, cut, shown

MOST_TEXT = 200_000
"""Largest size of a file that a user writes [byte]: a thousand links take about half of it."""
_KINDS = {
    stat.S_IFDIR: "a folder",
    stat.S_IFIFO: "a pipe, not a plain file",
    stat.S_IFCHR: "a device, not a plain file",
    stat.S_IFBLK: "a device, not a plain file",
    stat.S_IFSOCK: "a socket, not a plain file",
}
# A file that has become a pipe since the check is opened without waiting for its other end.
_FLAGS = os.O_RDONLY | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_BINARY", 0)


class UnreadableError(Exception):
    """Unreadable or meaningless input; its text gives the reason, and not the file."""


def regular_bytes(path: Path, most: int) -> bytes:
    """Read a plain file. Raises UnreadableError for anything else, for more than ``most`` bytes,
    for a file that grows meanwhile, and for one that may not be read.

    Nothing else is read: a pipe keeps its reader waiting, and a device may never end.
    """
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
    """Read a text file of a user. Raises UnreadableError as `regular_bytes`, and if not UTF-8."""
    try:
        return regular_bytes(path, MOST_TEXT).decode("utf-8-sig")  # some editors put a mark first
    except UnicodeDecodeError:
        raise UnreadableError("not UTF-8 text; save the file as UTF-8") from None
    except UnreadableError as error:
        raise UnreadableError(
            f"{error}; name a plain text file of at most {MOST_TEXT} bytes that you may read"
        ) from None


def _size(found: os.stat_result, most: int) -> int:
    """Return the size of a plain file [byte]. Raises UnreadableError for another, or a larger."""
    kind = stat.S_IFMT(found.st_mode)
    if kind != stat.S_IFREG:
        raise UnreadableError(_KINDS.get(kind, "no plain file"))
    if found.st_size > most:
        raise UnreadableError(f"{found.st_size} bytes; at most {most} are read")
    return found.st_size


DEEPEST = 10
"""Largest depth of nested tables and lists, and parts of a key. TOML readers take time and memory
that grow with the square of the parts, and all checks of nested values grow with their depth."""
MOST_KEYS = 20_000
"""Largest number of keys; each part of a key and of a table's header takes a key's memory."""
MOST_VALUES = 40_000
"""Largest number of values: each fault takes a kilobyte, and all are found."""
BITS = 64
"""Bits of a whole number in TOML; one of very many digits can be neither read nor shown."""


def refuse_extreme(value: object) -> None:
    """Refuse values nested too deep, too many values, and whole numbers too large. Raises
    UnreadableError with their place."""
    waiting: list[tuple[str, int, object]] = [("", 0, value)]
    looked = 0
    while waiting:
        place, depth, found = waiting.pop()
        looked += 1
        if looked > MOST_VALUES:
            raise UnreadableError(
                f"more than {MOST_VALUES} values, such as {place}; leave some out"
            )
        if depth > DEEPEST:
            raise UnreadableError(
                f"{cut(place)}: tables and lists nested too deep, by more than {DEEPEST}; scenes "
                "and studies nest them 4 deep"
            )
        if isinstance(found, int) and found.bit_length() >= BITS:
            raise UnreadableError(
                f"{place or 'the whole'}: a whole number of {found.bit_length()} bits; use less "
                f"than {BITS}, or write it as a float, such as 1e15"
            )
        if isinstance(found, Mapping):
            waiting += [(place, depth, key) for key in found if not isinstance(key, str)]
            waiting += [(_below(place, key), depth + 1, each) for key, each in found.items()]
        elif isinstance(found, list):
            waiting += [(_below(place, at), depth + 1, each) for at, each in enumerate(found)]


def _below(place: str, key: object) -> str:
    """Return the place of a value under a key, or in a list under its number."""
    name = cut(key) if isinstance(key, str) else "a number"
    return f"{place}.{key if isinstance(key, int) and abs(key) < 1e9 else name}".removeprefix(".")


_PART = re.compile(r"""(?:[\w-]++|"(?:[^"\\\n]|\\.)*+"|'[^'\n]*+')""")
_DOT = r"[ \t]*+\.[ \t]*+"
_DEEP_KEY = re.compile(rf"(?:^|[\[{{,])[ \t]*+(?:{_PART.pattern}{_DOT}){{{DEEPEST}}}", re.MULTILINE)
_PARTS = rf"({_PART.pattern}(?:{_DOT}{_PART.pattern})*+)[ \t]*+"
_KEY = re.compile(rf"(?:^|[{{,])[ \t]*+{_PARTS}=|^[ \t]*+\[\[?+[ \t]*+{_PARTS}\]", re.MULTILINE)
"""A key with its value, or the header of a table."""
_LONG_NUMBER = re.compile(r"\d[\d_]{3000,}")


def tables(text: str) -> dict[str, object]:
    """Parse TOML text to tables. Raises UnreadableError, with the line if it is known, for text
    that is no TOML, or has too many keys, too deep ones, or numbers of too many digits."""
    if deep := _DEEP_KEY.search(text):
        raise UnreadableError(
            f"line {_line(text, deep)}: a key of more than {DEEPEST} parts; the deepest of scenes "
            "and studies has 4"
        )
    if (keys := sum(len(_PART.findall(key[0])) for key in _KEY.finditer(text))) > MOST_KEYS:
        raise UnreadableError(
            f"{keys} keys, those of headers and the parts between dots counted; at most "
            f"{MOST_KEYS} are read"
        )
    try:
        raw = tomllib.loads(text)
    except RecursionError:
        why = (
            f"lists or tables nested too deep, by more than {DEEPEST}; scenes and studies nest "
            "them 4 deep"
        )
    except tomllib.TOMLDecodeError as error:
        why = str(error)[:300]
    except ValueError:  # of `int`, which reads only so many digits
        where = f"line {_line(text, long)}: " if (long := _LONG_NUMBER.search(text)) else ""
        why = f"{where}a number of more digits than can be read; write it as a float, such as 1e15"
    else:
        refuse_extreme(raw)
        return raw
    raise UnreadableError(f"not valid TOML: {why}")


def _line(text: str, at: re.Match[str]) -> int:
    return text.count("\n", 0, at.start()) + 1


def names_in(chosen: str | Iterable[str], what: str) -> tuple[str, ...]:
    """Return the chosen names, in order. Raises CrankcheckError for other values."""
    if isinstance(chosen, str):
        return (chosen,)
    names: tuple[str, ...] | None
    try:
        names = tuple(chosen)
    except TypeError:  # also of an array of no dimension, which is called iterable
        names = None
    if names is None or not all(isinstance(name, str) for name in names):
        raise CrankcheckError(f"{what}: found {shown(chosen)}; give a name, or a list of names")
    return names
