"""Each version in one row: how many scenes are within tolerance, its worst gap, or why it has no
result."""

from __future__ import annotations

from collections.abc import Sequence

from reports.history.version_result import VersionResult, errors_of
from reports.results.changes.runs import StoredCell

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
