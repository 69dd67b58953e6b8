"""The table of cells whose driver follows a law, and its footer."""

from collections.abc import Sequence

from reports.compare.errors import largest
from reports.judge.cell import Checked
from reports.quantities import MOVES, QUANTITIES
from reports.verify.table import STEPS, UNITS, CellTable, span

ANGLE, GAP = QUANTITIES["angle"].head, QUANTITIES["gap"].head
NUMBERS = {
    entry.head: [name for name, each in QUANTITIES.items() if each.head == entry.head]
    for entry in QUANTITIES.values()
    if entry.head and entry.role in MOVES
}
"""The columns of numbers: head, and the quantities whose worst error it shows."""
TABLE = CellTable(
    "", NUMBERS, ((100, tuple(NUMBERS), ()), (76, (ANGLE, GAP), ()), (0, (ANGLE,), ())),
    apart=76, names=22,
)  # fmt: skip


def words(checked: Sequence[Checked]) -> Sequence[str]:
    """The meaning of the numbers, and how cams are held."""
    scenes = {one.cell.scene.name: one.cell.scene for one in checked}
    cams = [
        f"{name}, cam {pair.name}: "
        + (f"by contact, {pair.facets} facets." if pair.facets else "as a relation.")
        for name, scene in scenes.items()
        for pair in scene.cams.values()
    ]
    return [checked[0].cell.way.units, *cams]


def steps(driven: Sequence[Checked]) -> Sequence[str]:
    """The steps of the cells."""
    counts = sorted({round(one.cell.steps_per_turn, 3) for one in driven})
    turns = sorted({round(one.cell.turns, 3) for one in driven})
    dts = sorted({one.cell.dt_s for one in driven})
    drive = largest(e for one in driven if one.errors and (e := one.errors.worst("drive")))
    turned = f"{span(turns)} turn" + ("" if turns == [1.0] else "s")
    return [
        f"dt {span(dts)} s, {span(counts)} steps a turn, {turned}; "
        + (f"largest drive error {drive.maximum:.1e} rad; " if drive else "")
        + "- not reported."
    ]


STEPPED = (STEPS, steps)
FOOTER = ((UNITS, words), STEPPED)
