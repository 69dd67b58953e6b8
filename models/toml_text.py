"""TOML that a user wrote, bounded before it is read and after."""

from __future__ import annotations

import re
import tomllib

from models.parsed import DEEPEST, MOST_KEYS, refuse_extreme
from models.regular import UnreadableError

_DEEP_KEY = re.compile(
    r"""(?<![\w"'\\-])(?:(?:[\w-]++|"(?:[^"\\\n]|\\.)*+"|'[^'\n]*+')[ \t]*+\.[ \t]*+)"""
    rf"{{{DEEPEST}}}"
)
_LONG_NUMBER = re.compile(r"\d[\d_]{3000,}")


def tables(text: str) -> dict[str, object]:
    """The tables of TOML text. Raises UnreadableError, with the line where it is known, for what is
    no TOML, or has too many keys, too deep ones, or numbers of too many digits."""
    if (keys := text.count("=")) > MOST_KEYS:
        raise UnreadableError(f"{keys} keys; at most {MOST_KEYS} are read")
    if deep := _DEEP_KEY.search(text):
        raise UnreadableError(
            f"line {_line(text, deep)}: a key of more than {DEEPEST} parts; the deepest of a "
            "scene has 4"
        )
    try:
        raw = tomllib.loads(text)
    except RecursionError:
        why = f"lists or tables nested too deep, by more than {DEEPEST}; a scene nests them 4 deep"
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
    """The line in which something begins."""
    return text.count("\n", 0, at.start()) + 1
