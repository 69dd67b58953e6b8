"""Check all cells of a request, several at a time."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from reports.judge.cell import Cell, Checked, unfinished
from reports.verify.advised import advised
from reports.workers.isolated import Limits, Lost
from reports.workers.scheduler import run_all
from sim.registry import ENGINES

LIMITS = Limits(3600.0, 16.0)
"""Far beyond what any sound cell takes: one that hangs, or fills the memory, is a row all the
same. Longer runs are asked for with one job, which has no limits."""


def check_all(
    cells: Sequence[Cell], jobs: int, done: Callable[[Checked], None] = lambda _: None
) -> list[Checked]:
    """Check all cells, in the order of ``cells``; ``done`` hears of each as it ends.

    Parameters
    ----------
    jobs : int
        Processes; 0 for one per processor.
    """
    apart = any(cell.engine not in ENGINES for cell in cells)
    return run_all(advised, cells, jobs, LIMITS, _lost, done, apart)


def _lost(cell: Cell, lost: Lost) -> Checked:
    return unfinished(cell, lost.status, lost.reason)
