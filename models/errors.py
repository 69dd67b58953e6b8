"""Errors that a user can cause, and can correct.

Each message states the request, the fault and the remedy. The command line prints the message and
exits with 2; anything else that escapes is a fault of crankcheck.
"""

from __future__ import annotations

import difflib
import math
from collections.abc import Iterable, Sequence

SHOWN = 20
"""Faults of one file that a message lists; the rest is counted."""

LONGEST = 8_000
"""Largest number of characters in a message, also where it quotes a file or an option."""


def harmless(text: str) -> str:
    """Return the text with invisible characters that act on a terminal or on other letters escaped.

    ``\\x1b`` moves a cursor, ``\\u202e`` turns text round; new lines and tabs stay.
    """
    return "".join(one if one.isprintable() or one in "\n\t" else ascii(one)[1:-1] for one in text)


def nearest(name: str, names: Iterable[str], most: int = 3, cutoff: float = 0.4) -> list[str]:
    """Return the most similar names, the nearest first; ``cutoff`` is the likeness, 0 to 1."""
    return difflib.get_close_matches(name[:200], names, most, cutoff)


def suggestion(
    name: str, names: Iterable[str], otherwise: str, most: int = 3, cutoff: float = 0.4
) -> str:
    """Suggest names in place of a wrong one: the nearest, or all of them after ``otherwise``."""
    if near := nearest(name, names, most, cutoff):
        return f"did you mean {' or '.join(near)}?"
    return f"{otherwise} {', '.join(names)}"


def few(names: Iterable[str], most: int) -> str:
    """Return the first names of a list, and the number of further ones."""
    each = list(names)
    return ", ".join(each[:most]) + (f" and {len(each) - most} more" if len(each) > most else "")


def cut(text: str, most: int = 60) -> str:
    """Shorten a text for a message."""
    return text if len(text) <= most else f"{text[: most - 3]}..."


def shown(found: object) -> str:
    """Return a value found in a file as text short enough for a message."""
    if isinstance(found, float) and not math.isfinite(found):
        return str(found)
    return cut(repr(found) if isinstance(found, str) else " ".join(repr(found).split()))


def listed(place: str, faults: Sequence[str]) -> str:
    """Return the message of several faults: the first, one a line, and the number of the rest."""
    lines = [*faults[:SHOWN]]
    if left := len(faults) - len(lines):
        lines.append(f"and {left} more")
    where = place.replace("\n", "\\n")  # a line of the message is one of ours
    return f"{where}: " + "\n  ".join([""] * (len(lines) > 1) + lines)


class CrankcheckError(Exception):
    """An error of the user's request; its text is the whole message. The text may quote a file:
    nothing in it acts on the terminal."""

    def __str__(self) -> str:
        return harmless(cut(super().__str__(), LONGEST))


class SceneError(CrankcheckError):
    """A scene that is not a mechanism crankcheck can run.

    Parameters
    ----------
    place : str
        The file or scene that holds the faults.
    faults : Sequence[str]
        One line each: key, value found, remedy.
    """

    def __init__(self, place: str, faults: Sequence[str]) -> None:
        self.place = place
        self.faults = tuple(faults)
        super().__init__(listed(place, faults))

    def __reduce__(self) -> tuple[type[SceneError], tuple[str, tuple[str, ...]]]:
        """Rebuild the error from its parts, in another process too."""
        return type(self), (self.place, self.faults)


class StructureError(CrankcheckError):
    """A mechanism whose mobility is not 1, or with a group that has no closed form."""


class ReachError(CrankcheckError):
    """A driver position in which the mechanism cannot be assembled."""


class EngineError(CrankcheckError):
    """An engine that is missing, cannot represent the scene, or lacks a given setting."""
