"""The table of cells whose driver follows a law."""

from __future__ import annotations

from reports.quantities import QUANTITIES
from reports.verify.cell_table import CellTable

ANGLE, GAP = QUANTITIES["angle"].head, QUANTITIES["gap"].head
NUMBERS = {
    entry.head: [name for name, each in QUANTITIES.items() if each.head == entry.head]
    for entry in QUANTITIES.values()
    if entry.head and entry.role not in ("force", "free", "elastic")
}
"""The columns of numbers: head, and the quantities that it shows the worst of."""
TABLE = CellTable(
    "", NUMBERS, ((100, tuple(NUMBERS), ()), (76, (ANGLE, GAP), ()), (0, (ANGLE,), ())),
    apart=76, names=22,
)  # fmt: skip
