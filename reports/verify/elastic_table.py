"""The table of elastic links: what they are off by, and whose that is."""

from __future__ import annotations

from collections.abc import Sequence

from rich.table import Table

from reports.judge.cell import Checked
from reports.output.columns import plain_table
from reports.quantities import QUANTITIES
from reports.verify.row_cells import mark, row_cells

ELASTIC_NUMBERS = {
    QUANTITIES["segments"].head: ["segments"],
    QUANTITIES["deflection"].head: ["deflection"],
    QUANTITIES["angle"].head: ["angle", "phase"],
    QUANTITIES["gap"].head: ["gap"],
}
"""What of an engine's errors is shown: beside the exact chain, beside the beam, and of places; of
what is let go the driver's angle as well."""
THEORIES = ("chain\n/ D", "doubt\n/ D", "linear\n/ D")
WIDE, STACKED = 98, 76
"""Columns of a terminal that show every number, and below which it shows one."""


def elastic_table(profile: str, gated: bool, chosen: Sequence[Checked], width: int) -> Table:
    """The cells of one profile whose links bend, those out of tolerance first."""
    heads = tuple(ELASTIC_NUMBERS)
    heads = heads if width >= WIDE else heads[:2] if width >= STACKED else heads[:1]
    role = "gated" if gated else "shown, not gated"
    table = plain_table(f"elastic links, profile {profile} ({role})")
    table.add_column("")
    table.add_column("scene\nengine", overflow="fold", min_width=18)
    for head in heads:
        table.add_column(head, justify="right", no_wrap=True)
    theories = THEORIES if width >= WIDE else THEORIES[:1]
    for head in theories:
        table.add_column(head, justify="right", no_wrap=True)
    table.add_column("most of\na limit", no_wrap=True)
    table.add_column("when dt\nis halved", overflow="fold", max_width=14)
    for one in sorted(chosen, key=lambda one: one.verdict == "within"):
        names = f"{one.cell.scene.name}\n{one.cell.engine}"
        *numbers, share, seen = row_cells(one, heads, ELASTIC_NUMBERS)
        table.add_row(mark(one), names, *numbers, *_theories(one)[: len(theories)], share, seen)
    return table


def _theories(one: Checked) -> tuple[str, ...]:
    """What the segments leave of the beam, what the beam may be off by, and what the linear theory
    is off it by."""
    facts = one.errors.elastic if one.errors else None
    if facts is None:
        return ("-", "-", "-")
    about = "~" * facts.estimated
    return (f"{about}{facts.chain:.1e}", f"{facts.doubt:.1e}", f"{facts.linear:.1e}")
