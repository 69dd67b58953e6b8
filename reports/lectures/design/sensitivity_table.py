"""What tolerances and clearances do to the positions of a mechanism, as a table and in words."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from rich.table import Table

from analytic.lectures.synthesis.sensitivity import Sensitivity, Spread
from reports.lectures.design.proof import in_words, unit_of
from reports.output.console import plain_table


def sensitivity_table(
    found: Sensitivity, limits: Sequence[float], tolerance_m: float, spread: Spread
) -> Table:
    """A row for each thing asked: linear worst case and root of squares, the Monte Carlo's largest,
    what is allowed, and the dimension that it goes with most."""
    table = plain_table(f"Solution 1, every dimension off by up to {tolerance_m:g} m", gap=2)
    for head in ("position", "what", "worst", "root sum sq.", "Monte Carlo", "allowed", "most by"):
        table.add_column(head, overflow="fold")
    worst, usual = found.worst(tolerance_m), found.usual(tolerance_m)
    for k, (number, asked) in enumerate(found.asked):
        unit, most = unit_of(asked), int(np.argmax(np.abs(found.slopes[k])))
        cells = (worst[k], usual[k], spread.largest[k], limits[k])
        table.add_row(
            str(number),
            in_words(asked),
            *(f"{value:.2e} {unit}" for value in cells),
            f"{found.dimensions[most].words} ({found.slopes[k, most]:.3g} {unit}/m)",
        )
    return table


def clearance_in_words(found: Sensitivity, limits: Sequence[float], spread: Spread) -> str:
    """The share of mechanisms that meet the task, and the largest clearance."""
    clearance, row = found.largest_clearance(limits)
    number, asked = found.asked[row]
    lost = f", {spread.lost} could not be assembled" if spread.lost else ""
    return (
        f"{100.0 * spread.share_within:.1f} % of {spread.count} mechanisms meet the task{lost}; "
        f"with a radial clearance of up to {clearance:.3g} m in every joint it is met, set by the "
        f"{in_words(asked)} at position {number}"
    )
