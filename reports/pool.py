"""Check many cells, several at a time; a cell that kills its process costs that cell alone."""

from __future__ import annotations

import multiprocessing
import os
from collections.abc import Callable, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from concurrent.futures.process import BrokenProcessPool

from reports.cell import Cell, Checked, check, unfinished
from reports.stopping import Stopped, held_back, leave_to_parent

FEW = 4
"""Up to so many cells are done in this process: a second one takes longer to start."""


def check_all(
    cells: Sequence[Cell], jobs: int, done: Callable[[Checked], None] = lambda _: None
) -> list[Checked]:
    """Check all cells, in the order of ``cells``; ``done`` hears of each as it ends.

    Parameters
    ----------
    jobs : int
        Processes; 0 for one per processor.
    """
    jobs = jobs or processors()
    if jobs == 1 or len(cells) <= FEW:
        return [_tell(check(cell), done) for cell in cells]
    found = _parallel(cells, jobs, done)
    for index, cell in enumerate(cells):
        if index not in found:  # lost when a neighbour broke the pool; alone it shows who it was
            found[index] = _tell(_alone(cell), done)
    return [found[index] for index in range(len(cells))]


def processors() -> int:
    """How many processors this process may use."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


def _pool(jobs: int) -> ProcessPoolExecutor:
    # "spawn" on every system: a fork of a process with threads may hang.
    context = multiprocessing.get_context("spawn")
    return ProcessPoolExecutor(jobs, mp_context=context, initializer=leave_to_parent)


def _parallel(
    cells: Sequence[Cell], jobs: int, done: Callable[[Checked], None]
) -> dict[int, Checked]:
    """What the pool finished, by index; less than all where a process died."""
    found: dict[int, Checked] = {}
    pool = _pool(min(jobs, len(cells)))
    wait = True
    try:
        with held_back():  # submitting starts the workers
            waiting = {pool.submit(check, cell): index for index, cell in enumerate(cells)}
        for future in as_completed(waiting):
            found[waiting[future]] = _tell(future.result(), done)
    except BrokenProcessPool:
        pass  # the caller does the rest one by one
    except Stopped:
        wait = False  # the workers are dead, and may have left a lock behind
        raise
    finally:
        pool.shutdown(wait=wait, cancel_futures=True)
    return found


def _alone(cell: Cell) -> Checked:
    """One cell in a process of its own."""
    with _pool(1) as pool:
        try:
            with held_back():
                future = pool.submit(check, cell)
            return future.result()
        except BrokenProcessPool:
            return unfinished(cell, "crashed", "the engine ended its process")


def _tell(checked: Checked, done: Callable[[Checked], None]) -> Checked:
    done(checked)
    return checked
