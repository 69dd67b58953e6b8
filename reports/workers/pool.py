"""Do many things, several at a time; one that kills its process costs that one alone."""

from __future__ import annotations

import multiprocessing
import os
from collections.abc import Callable, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from concurrent.futures.process import BrokenProcessPool
from typing import TypeVar

from reports.workers.signals import Stopped, held_back, leave_to_parent

FEW = 4
"""Up to so many items are done in this process: a second one takes longer to start."""
Item = TypeVar("Item")
Result = TypeVar("Result")


def do_all(
    work: Callable[[Item], Result],
    items: Sequence[Item],
    jobs: int,
    lost: Callable[[Item], Result],
    done: Callable[[Result], None] = lambda _: None,
) -> list[Result]:
    """``work`` on all items, in their order; ``done`` hears of each result as it comes.

    Parameters
    ----------
    work : Callable
        A function of a module, that another process can import.
    jobs : int
        Processes; 0 for one per processor.
    lost : Callable
        The result of an item that ends the process which works on it.
    """
    jobs = jobs or processors()
    if jobs == 1 or len(items) <= FEW:
        return [_tell(work(item), done) for item in items]
    found = _parallel(work, items, jobs, done)
    for index, item in enumerate(items):
        if index not in found:  # lost when a neighbour broke the pool; alone it shows who it was
            found[index] = _tell(_alone(work, item, lost), done)
    return [found[index] for index in range(len(items))]


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
    work: Callable[[Item], Result],
    items: Sequence[Item],
    jobs: int,
    done: Callable[[Result], None],
) -> dict[int, Result]:
    """What the pool finished, by index; less than all where a process died."""
    found: dict[int, Result] = {}
    pool = _pool(min(jobs, len(items)))
    wait = True
    try:
        with held_back():  # submitting starts the workers
            waiting = {pool.submit(work, item): index for index, item in enumerate(items)}
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


def _alone(work: Callable[[Item], Result], item: Item, lost: Callable[[Item], Result]) -> Result:
    """One item in a process of its own."""
    with _pool(1) as pool:
        try:
            with held_back():
                future = pool.submit(work, item)
            return future.result()
        except BrokenProcessPool:
            return lost(item)


def _tell(result: Result, done: Callable[[Result], None]) -> Result:
    done(result)
    return result
