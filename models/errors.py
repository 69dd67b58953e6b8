"""Errors that a user can cause, and can mend.

Each message says what was asked, what was found and what would work. The command line prints the
message and exits with 2; anything else that escapes is a fault of crankcheck.
"""

from __future__ import annotations

import difflib
import math
from collections.abc import Iterable, Sequence

SHOWN = 20
"""Faults of one file that a message lists; the others are counted."""

LONGEST = 8_000
"""Characters of a message, whatever of a file or of an option stands in it."""


def harmless(text: str) -> str:
    """The text with what is not seen, but acts on a terminal or on other letters, as escapes.

    ``\\x1b`` moves a cursor, ``\\u202e`` turns text round; new lines and tabs stay.
    """
    return "".join(one if one.isprintable() or one in "\n\t" else ascii(one)[1:-1] for one in text)


def nearest(name: str, names: Iterable[str], most: int = 3, cutoff: float = 0.4) -> list[str]:
    """The names that one may have meant, the nearest first; ``cutoff`` is how alike, 0 to 1."""
    return difflib.get_close_matches(name[:200], names, most, cutoff)


def suggestion(
    name: str, names: Iterable[str], otherwise: str, most: int = 3, cutoff: float = 0.4
) -> str:
    """What would work in place of a name: the nearest names, or all of them after ``otherwise``."""
    if near := nearest(name, names, most, cutoff):
        return f"did you mean {' or '.join(near)}?"
    return f"{otherwise} {', '.join(names)}"


def few(names: Iterable[str], most: int) -> str:
    """The first names of a list, and how many more there are."""
    each = list(names)
    return ", ".join(each[:most]) + (f" and {len(each) - most} more" if len(each) > most else "")


def cut(text: str, most: int = 60) -> str:
    """A text short enough for a message."""
    return text if len(text) <= most else f"{text[: most - 3]}..."


def shown(found: object) -> str:
    """What was found in a file, short enough for a message."""
    if isinstance(found, float) and not math.isfinite(found):
        return str(found)
    return cut(repr(found) if isinstance(found, str) else " ".join(repr(found).split()))


def listed(place: str, faults: Sequence[str]) -> str:
    """The message of several faults: the first of them, one a line, and how many more there are."""
    lines = [*faults[:SHOWN]]
    if left := len(faults) - len(lines):
        lines.append(f"and {left} more")
    where = place.replace("\n", "\\n")  # a line of the message is one of ours
    return f"{where}: " + "\n  ".join([""] * (len(lines) > 1) + lines)


class CrankcheckError(Exception):
    """A fault in what the user asked for; its text is the whole message.

    The text may hold what stood in a file: nothing in it acts on the terminal that it is shown on.
    """

    def __str__(self) -> str:
        return harmless(cut(super().__str__(), LONGEST))


class SceneError(CrankcheckError):
    """A scene that is not a mechanism crankcheck can run.

    Parameters
    ----------
    place : str
        The file or scene that holds the faults.
    faults : Sequence[str]
        One line each: key, what was found, what would work.
    """

    def __init__(self, place: str, faults: Sequence[str]) -> None:
        self.place = place
        self.faults = tuple(faults)
        super().__init__(listed(place, faults))

    def __reduce__(self) -> tuple[type[SceneError], tuple[str, tuple[str, ...]]]:
        """Rebuilt from its parts, in another process too."""
        return type(self), (self.place, self.faults)


class StructureError(CrankcheckError):
    """A mechanism whose mobility is not 1, or with a group that has no closed form."""


class ReachError(CrankcheckError):
    """A driver position that the mechanism cannot be assembled in."""


class EngineError(CrankcheckError):
    """An engine that is missing, or cannot hold the scene, or was given a setting it lacks."""
