"""What stands under the tables of free cells."""

from __future__ import annotations

from collections.abc import Sequence

from reports.compare.free.free_facts import FreeFacts
from reports.judge.cell import Checked
from reports.verify.cell_table import MORE_STEPS, MORE_UNITS, span


def words(checked: Sequence[Checked]) -> Sequence[str]:
    """What the numbers are."""
    return [checked[0].cell.way.units]


def steps(free: Sequence[Checked]) -> Sequence[str]:
    """How cells were stepped."""
    dts = sorted({one.cell.dt_s for one in free})
    lasts = sorted({round(one.cell.dt_s * one.cell.steps, 9) for one in free})
    growth = sorted(facts.sensitivity for one in free if (facts := FreeFacts.of(one.errors)))
    return [
        f"dt {span(dts)} s over {span(lasts)} s"
        + (f"; G up to {span(growth)}" if growth else "")
        + "; - not reported.",
    ]


STEPPED = (MORE_STEPS, steps)
FOOTER = ((MORE_UNITS, words), STEPPED)
