"""The table of what was let go."""

from __future__ import annotations

from collections.abc import Sequence

from rich.table import Table

from reports.judge.cell import Checked
from reports.judge.precision import precision
from reports.output.columns import plain_table
from reports.quantities import QUANTITIES, named
from reports.verify.row_cells import mark, row_cells

FREE_NUMBERS = {
    QUANTITIES["phase"].head: ["phase"],
    "place\n/ G": list(named("place")),
    QUANTITIES["geometry"].head: ["geometry"],
    QUANTITIES["gap"].head: ["gap"],
    "veloc.\n/ w G": ["velocity"],
    QUANTITIES["energy"].head: ["energy"],
}
"""Those of the table of what was let go."""
WIDE, STACKED = 110, 76
"""Columns of a terminal that show every number, and below which it shows one."""


def free_table(profile: str, gated: bool, chosen: Sequence[Checked], width: int) -> Table:
    """The cells of one profile that were let go, those out of tolerance first."""
    heads, stacked = tuple(FREE_NUMBERS), width < STACKED
    heads = heads if width >= WIDE else (heads[0], heads[2], heads[5])[: 1 if stacked else 3]
    role = "gated" if gated else "shown, not gated"
    table = plain_table(f"free motion, profile {profile} ({role})")
    table.add_column("")
    table.add_column("scene\nengine", overflow="fold", min_width=18)
    for head in heads:
        table.add_column(head, justify="right", no_wrap=True)
    table.add_column("most of\na limit", no_wrap=True)
    table.add_column("class\nto 1e-3", no_wrap=True)
    table.add_column("when dt\nis halved", overflow="fold", max_width=14)
    for one in sorted(chosen, key=lambda one: one.verdict == "within"):
        names = f"{one.cell.scene.name}\n{one.cell.engine}"
        *numbers, seen = row_cells(one, heads, FREE_NUMBERS)
        table.add_row(mark(one), names, *numbers, _precision(one), seen)
    return table


def _precision(one: Checked) -> str:
    """The classes that are reached, and the time to which the high one of IFToMM's is."""
    facts = one.errors.free if one.errors else None
    return f"{precision(one)}\n{facts.horizon_s(1e-3):.3g} s" if facts else "-"
