"""Check all cells of a request, several at a time."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from reports.judge.cell import Cell, Checked, check, unfinished
from reports.workers.pool import do_all


def check_all(
    cells: Sequence[Cell], jobs: int, done: Callable[[Checked], None] = lambda _: None
) -> list[Checked]:
    """Check all cells, in the order of ``cells``; ``done`` hears of each as it ends.

    Parameters
    ----------
    jobs : int
        Processes; 0 for one per processor.
    """
    return do_all(check, cells, jobs, _lost, done)


def _lost(cell: Cell) -> Checked:
    return unfinished(cell, "crashed", "the engine ended its process")
