"""The table of beads: with a column of its own."""

from reports.judge.cell import Checked
from reports.quantities import QUANTITIES
from reports.verify.table import CellTable
from tests.worlds.bead.columns import columns

NUMBERS = {QUANTITIES["phase"].head: ["phase"], "place\n/ L": ["angle", "position"]}


def _period(one: Checked) -> list[str]:
    off = columns(one)["period_off"]
    return [f"{off:+.1e}" if isinstance(off, float) else "-"]


TABLE = CellTable(
    "beads, ",
    NUMBERS,
    ((76, tuple(NUMBERS), ()), (0, (QUANTITIES["phase"].head,), ())),
    after_heads=("period\noff by",),
    after=_period,
)
