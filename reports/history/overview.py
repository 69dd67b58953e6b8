"""Each version in one row: how many scenes are within tolerance, its worst gap, or why it has no
result."""

from __future__ import annotations

from collections.abc import Sequence

from reports.history.measured import Found, Outcome

GAPS = ("pin gap", "slider gap")


def overview(outcomes: Sequence[Outcome]) -> tuple[list[str], list[list[str]]]:
    """Heads, and one row of texts per version."""
    profiles = list(dict.fromkeys(cell.profile for one in outcomes for cell in one.cells))
    heads = ["version"]
    for profile in profiles:
        heads += [f"{profile}:\nwithin", f"{profile}:\nworst gap"]
    return [*heads, "\nresult"], [_row(outcome, profiles) for outcome in outcomes]


def _row(outcome: Outcome, profiles: Sequence[str]) -> list[str]:
    texts = [outcome.version]
    for profile in profiles:
        cells = [cell for cell in outcome.cells if cell.profile == profile]
        within = sum(cell.verdict == "within" for cell in cells)
        texts += [f"{within} of {len(cells)}" if cells else "-", _worst(cells)]
    return [*texts, outcome.reason or _ended(outcome)]


def _worst(cells: Sequence[Found]) -> str:
    """The largest gap, over the longest link."""
    gaps = [cell.errors[name] for cell in cells for name in GAPS if name in cell.errors]
    return f"{max(gaps):.1e} L" if gaps else "-"


def _ended(outcome: Outcome) -> str:
    """Whether the result is new, and the cells that did not run to their end."""
    failed = [cell for cell in outcome.cells if cell.status != "ok"]
    made = "kept from before" if outcome.kept else "new"
    if outcome.misnamed:
        made += f"; calls itself {outcome.calls_itself}"
    if not failed:
        return made
    first = failed[0]
    return (
        f"{made}; {len(failed)} of {len(outcome.cells)} cells did not run: {first.scene} "
        f"{first.profile}: {first.status}: {first.reason[:120]}"
    )
