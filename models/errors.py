"""Errors that a user can cause, and can mend.

Each message says what was asked, what was found and what would work. The command line prints the
message and exits with 2; anything else that escapes is a fault of crankcheck.
"""

from __future__ import annotations

from collections.abc import Sequence


class CrankcheckError(Exception):
    """A fault in what the user asked for; its text is the whole message."""


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
        super().__init__(f"{place}: " + "\n  ".join(("",) * (len(faults) > 1) + self.faults))

    def __reduce__(self) -> tuple[type[SceneError], tuple[str, tuple[str, ...]]]:
        """Rebuilt from its parts, in another process too."""
        return type(self), (self.place, self.faults)


class StructureError(CrankcheckError):
    """A mechanism whose mobility is not 1, or with a group that has no closed form."""


class ReachError(CrankcheckError):
    """A driver position that the mechanism cannot be assembled in."""


class EngineError(CrankcheckError):
    """An engine that is missing, or cannot hold the scene, or was given a setting it lacks."""
