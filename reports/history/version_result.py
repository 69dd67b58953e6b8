"""What the verification of one version found, and the errors that are followed over versions."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from packaging.version import InvalidVersion, Version

from models.errors import CrankcheckError
from reports.history.environments import EngineVersion
from reports.quantities import QUANTITIES, named
from reports.results.changes.reading import read_run
from reports.results.changes.runs import StoredCell, StoredRun

NO_RUN = StoredRun("no result", {})


@dataclass(frozen=True)
class FollowedError:
    """An error that is followed over versions: the largest of some stored ones, as a pure number.

    ``tolerance`` is the one that says what rounding makes of it. ``rate`` marks those that come of
    the others: where places are wrong, rates are too.
    """

    unit: str
    stored: tuple[str, ...]
    tolerance: str
    rate: bool = False


FOLLOWED: Mapping[str, FollowedError] = {
    "angle": FollowedError("rad", ("angle",), "angle"),
    "place": FollowedError("of L", ("displacement", "position"), "position"),
    "pin gap": FollowedError("of L", ("pin gap",), "gap"),
    "slider gap": FollowedError("of L", ("slider gap",), "gap"),
} | {
    name: FollowedError(f"of {QUANTITIES[name].share}", (name,), name, rate=True)
    for name in named("derived")
}


def errors_of(cell: StoredCell) -> dict[str, float]:
    """The errors of a cell that are followed, where it has a number for them."""
    numbers = {
        name: [
            cell.errors[each]
            for each in error.stored
            if math.isfinite(cell.errors.get(each, math.inf))
        ]
        for name, error in FOLLOWED.items()
    }
    return {name: max(each) for name, each in numbers.items() if each}


@dataclass(frozen=True)
class VersionResult:
    """A version with its verification, or with the reason why there is none.

    ``folder`` holds the files of the verification; ``kept`` says that an earlier call made them.
    """

    asked: EngineVersion
    run: StoredRun = NO_RUN
    reason: str = ""
    folder: Path | None = None
    kept: bool = False

    @property
    def version(self) -> str:
        return str(self.asked.version)

    @property
    def cells(self) -> tuple[StoredCell, ...]:
        return tuple(self.run.cells.values())

    @property
    def calls_itself(self) -> str:
        """The version that the engine told, which need not be that of its package."""
        return self.run.facts.get(self.asked.engine, "")

    @property
    def misnamed(self) -> bool:
        """Whether the engine gives itself another number than its package has."""
        try:
            told_version = Version(self.calls_itself)
        except InvalidVersion:
            return bool(self.calls_itself)
        # Post and local parts belong to the package; the engine does not know them.
        return Version(told_version.base_version) != Version(self.asked.version.base_version)


def read_version(folder: Path) -> StoredRun:
    """The verification in a folder of the cache. Raises CrankcheckError if it is damaged there."""
    try:
        return read_run(folder)
    except CrankcheckError as error:
        raise CrankcheckError(
            f"not the result of a verification ({error}); run again with --again"
        ) from None
