"""The table of the cells of one profile: names, the largest errors, whose limit they are nearest
to, and what the error does when the step is halved."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

from rich.table import Table

from reports.judge.cell import Checked
from reports.output.console import plain_table
from reports.verify.row_cells import mark, row_cells

Texts = Callable[[Checked], Sequence[str]]


def _none(one: Checked) -> Sequence[str]:
    return ()


@dataclass(frozen=True, eq=False)
class CellTable:
    """The columns of cells of a kind.

    ``numbers`` are quantities by the head of their column. ``rooms`` says for terminals of at least
    so many columns which heads are shown, and which of those that ``before`` fills before the share
    of a limit; ``after`` is filled behind it. From ``apart`` columns on the engine has its own.
    """

    title: str
    numbers: Mapping[str, Sequence[str]]
    rooms: Sequence[tuple[int, Sequence[str], Sequence[str]]]
    before: Texts = _none
    after_heads: Sequence[str] = ()
    after: Texts = _none
    apart: float = math.inf
    names: int = 18
    forces: bool = False

    def shown(self, profile: str, gated: bool, chosen: Sequence[Checked], width: int) -> Table:
        """The cells of one profile, those out of tolerance first."""
        heads, before = next(
            (heads, before) for least, heads, before in self.rooms if width >= least
        )
        apart = width >= self.apart
        role = "gated" if gated else "shown, not gated"
        table = plain_table(f"{self.title}profile {profile} ({role})")
        table.add_column("")
        table.add_column(
            "scene" if apart else "scene\nengine", overflow="fold", min_width=self.names
        )
        if apart:
            table.add_column("engine", no_wrap=True)
        for head in (*heads, *before):
            table.add_column(head, justify="right", no_wrap=True)
        for head in ("most of\na limit", *self.after_heads):
            table.add_column(head, no_wrap=True)
        least, most = (15, None) if apart else (None, 14)
        table.add_column("when dt\nis halved", overflow="fold", min_width=least, max_width=most)
        for one in sorted(chosen, key=lambda one: one.verdict == "within"):
            names = (one.cell.scene.name, one.cell.engine)
            *numbers, share, seen = row_cells(one, heads, self.numbers, forces=self.forces)
            more = self.before(one)[: len(before)]
            table.add_row(
                mark(one),
                *(names if apart else ["\n".join(names)]),
                *(*numbers, *more, share, *self.after(one), seen),
            )
        return table
