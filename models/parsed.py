"""What a text file says, held to bounds that nothing which makes sense comes near to."""

from __future__ import annotations

from collections.abc import Mapping

from models.errors import cut
from models.regular import UnreadableError

DEEPEST = 10
"""Tables and lists in each other, and parts of a key. Readers of TOML take time and memory that
grow with the square of the parts, and all that looks at nested values with their depth."""
MOST_KEYS = 20_000
"""Each part of a key, and of the header of a table, takes as much memory as a key."""
MOST_VALUES = 40_000
"""A fault of each takes a kilobyte, and all are looked for."""
BITS = 64
"""Of a whole number, as TOML has it; one of very many digits can be neither read nor shown."""


def refuse_extreme(value: object) -> None:
    """Raise UnreadableError, with its place, for a value that is nested too deep, or a whole number
    too large, and for too many values."""
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
    """The place of what stands there under a key, in a list under its number."""
    name = cut(key) if isinstance(key, str) else "a number"
    return f"{place}.{key if isinstance(key, int) and abs(key) < 1e9 else name}".removeprefix(".")
