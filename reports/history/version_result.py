"""What the verification of one version found, and the errors that are followed over versions."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
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


GAPS = ("pin gap", "slider gap")


def profiles_of(results: Sequence[VersionResult]) -> list[str]:
    """The profiles that were measured, in order."""
    return list(dict.fromkeys(cell.name.variant for each in results for cell in each.cells))


def overview(results: Sequence[VersionResult]) -> tuple[list[str], list[list[str]]]:
    """Heads, and one row of texts per version."""
    profiles = profiles_of(results)
    heads = ["version"]
    for profile in profiles:
        heads += [f"{profile}:\nwithin", f"{profile}:\nworst gap"]
    return [*heads, "\nresult"], [_row(result, profiles) for result in results]


def _row(result: VersionResult, profiles: Sequence[str]) -> list[str]:
    texts = [result.version]
    for profile in profiles:
        cells = [cell for cell in result.cells if cell.name.variant == profile]
        within = sum(cell.verdict == "within" for cell in cells)
        texts += [f"{within} of {len(cells)}" if cells else "-", _worst(cells)]
    return [*texts, result.reason or _ended(result)]


def _worst(cells: Sequence[StoredCell]) -> str:
    """The largest gap, over the longest link."""
    gaps = [error for cell in cells for name, error in errors_of(cell).items() if name in GAPS]
    return f"{max(gaps):.1e} L" if gaps else "-"


def _ended(result: VersionResult) -> str:
    """Whether the result is new, and the cells that did not run to their end."""
    failed = [cell for cell in result.cells if not cell.ok]
    made = "kept from before" if result.kept else "new"
    if result.misnamed:
        made += f"; calls itself {result.calls_itself}"
    if not failed:
        return made
    first = failed[0]
    return (
        f"{made}; {len(failed)} of {len(result.cells)} cells did not run: {first.name.scene} "
        f"{first.name.variant}: {first.status}: {first.reason[:120]}"
    )
