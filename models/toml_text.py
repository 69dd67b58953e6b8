"""TOML that a user wrote, bounded before it is read and after."""

from __future__ import annotations

import re
import tomllib

from models.parsed import DEEPEST, MOST_KEYS, refuse_extreme
from models.regular import UnreadableError

_PART = re.compile(r"""(?:[\w-]++|"(?:[^"\\\n]|\\.)*+"|'[^'\n]*+')""")
_DOT = r"[ \t]*+\.[ \t]*+"
_DEEP_KEY = re.compile(rf"(?:^|[\[{{,])[ \t]*+(?:{_PART.pattern}{_DOT}){{{DEEPEST}}}", re.MULTILINE)
_PARTS = rf"({_PART.pattern}(?:{_DOT}{_PART.pattern})*+)[ \t]*+"
_KEY = re.compile(rf"(?:^|[{{,])[ \t]*+{_PARTS}=|^[ \t]*+\[\[?+[ \t]*+{_PARTS}\]", re.MULTILINE)
"""A key with its value, or the header of a table."""
_LONG_NUMBER = re.compile(r"\d[\d_]{3000,}")


def tables(text: str) -> dict[str, object]:
    """The tables of TOML text. Raises UnreadableError, with the line where it is known, for what is
    no TOML, or has too many keys, too deep ones, or numbers of too many digits."""
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
    """The line in which something begins."""
    return text.count("\n", 0, at.start()) + 1
