"""What stands in a row of a verification: the verdict, the largest errors, the limit that they take
most of."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

from rich.text import Text

from reports.compare.errors import Error, Errors, largest
from reports.judge.cell import Checked
from reports.judge.rules import FORCES
from reports.judge.rules.rule import Finding
from reports.quantities import QUANTITIES

MARKS = {
    "within": Text("ok", "green"),
    "out": Text("OUT", "bold red"),
    "unsupported": Text("NONE", "bold red"),
}
SHORT = {each.id: each.short for entry in QUANTITIES.values() for each in entry.criteria}
"""The rules that hold an error to a limit, short; a dash marks differenced rates."""


def mark(one: Checked) -> Text:
    """The verdict; red only where it counts."""
    shown = MARKS[one.verdict]
    return shown if one.cell.gated or one.verdict == "within" else Text(shown.plain, "yellow")


def row_cells(
    one: Checked,
    heads: Sequence[str],
    numbers: Mapping[str, Sequence[str]],
    *,
    forces: bool = False,
) -> list[Text | str]:
    """One row, from its numbers on; ``numbers`` are the quantities by head."""
    errors = one.errors
    if errors is None:
        return [*["-"] * len(heads), "", Text(f"{one.status}: {one.reason}", "red")]
    shown = [_largest(errors, numbers[head]) for head in heads]
    convergence = one.force_convergence if forces else one.convergence
    seen = convergence.words.replace(": ", "\n") if convergence else ""
    if one.status != "ok":
        early = one.status != "branch-changed"  # such a run goes on to its end
        seen = one.status + (f" at t = {one.stopped_at_s:.3g} s" if early else "")
    own = [finding for finding in one.findings if (finding.rule in FORCES) == forces]
    return [*(_number(error) for error in shown), _share(own), seen]


def _largest(errors: Errors, quantities: Sequence[str]) -> Error | None:
    """The worst of some quantities, as reported."""
    return largest(worst for name in quantities if (worst := errors.worst(name)))


def _number(error: Error | None) -> str:
    """A pure number, or a dash where nothing of the kind was reported."""
    return "-" if error is None else f"{error.pure:.1e}" if error.finite else "nan"


def _share(findings: Sequence[Finding]) -> Text:
    """The largest share of a limit that an error takes, and whose it is."""
    shares = [
        (finding.number / finding.limit, SHORT[finding.rule])
        for finding in findings
        if finding.rule in SHORT and finding.number is not None and finding.limit
    ]
    if not shares:
        return Text("")
    share, name = max(shares, key=lambda pair: math.inf if math.isnan(pair[0]) else pair[0])
    if math.isnan(share):
        return Text("nan", "red")
    size = f"{share:.0%}" if share < 10 else f"x{share:.0f}" if share < 1e4 else f"x{share:.0e}"
    style = "red" if share > 1 else "yellow" if share > 0.5 else ""
    return Text(f"{size} {name}", style)
