"""The table of cells in free motion, and its footer."""

from collections.abc import Sequence

from reports.compare.free_facts import FreeFacts
from reports.judge.cell import Checked
from reports.quantities import QUANTITIES, named
from reports.verify.table import MORE_STEPS, MORE_UNITS, CellTable, span
from reports.ways.driven.table import words
from reports.ways.free.columns import precision

FREE_NUMBERS = {
    QUANTITIES["phase"].head: ["phase"],
    "place\n/ G": list(named("place")),
    QUANTITIES["geometry"].head: ["geometry"],
    QUANTITIES["gap"].head: ["gap"],
    "veloc.\n/ w G": ["velocity"],
    QUANTITIES["energy"].head: ["energy"],
}


def _precision(one: Checked) -> list[str]:
    """The classes reached, and the time for which IFToMM's high class holds."""
    facts = FreeFacts.of(one.errors)
    return [f"{precision(one)}\n{facts.horizon_s(1e-3):.3g} s" if facts else "-"]


HEADS = tuple(FREE_NUMBERS)
TABLE = CellTable(
    "free motion, ",
    FREE_NUMBERS,
    ((110, HEADS, ()), (76, (HEADS[0], HEADS[2], HEADS[5]), ()), (0, HEADS[:1], ())),
    after_heads=("class\nto 1e-3",),
    after=_precision,
)


def steps(free: Sequence[Checked]) -> Sequence[str]:
    """The steps of the cells."""
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
