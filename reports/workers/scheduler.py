"""Do many things, several at a time; one that ends its process costs that one alone."""

from __future__ import annotations

import os
from collections.abc import Callable, Generator, Sequence
from concurrent.futures import ThreadPoolExecutor, as_completed
from contextlib import closing
from functools import partial
from queue import SimpleQueue
from typing import TypeVar

from reports.workers.isolated import MOST_GB, MOST_S, Isolated, Limits, Lost

FEW = 4
"""Up to so many items are done in this process: a second one takes longer to start."""
Item = TypeVar("Item")
Result = TypeVar("Result")
Answer = TypeVar("Answer")
BOUNDLESS = Limits(MOST_S, MOST_GB)


def run_all(
    work: Callable[[Item], Result],
    items: Sequence[Item],
    jobs: int,
    limits: Limits,
    lost: Callable[[Item, Lost], Result],
    done: Callable[[Result], None] = lambda _: None,
    apart: bool = False,
) -> list[Result]:
    """``work`` on all items, in their order; ``done`` hears of each result as it comes.

    One job has no limits. What is few, or asked for with one job, is done in this process, unless
    it has to be ``apart``: what somebody else wrote may end the process without a word. ``lost``
    gives the result of an item that ends the process which works on it, or takes too much; what
    ``work``, which another process can import, raises itself is raised here. 0 ``jobs``: one per
    processor.
    """
    if apart and jobs == 1:
        limits = BOUNDLESS
    if not apart and ((jobs or processors()) == 1 or len(items) <= FEW):
        ends = ((index, work(item)) for index, item in enumerate(items))
    else:
        ends = as_they_end(partial(_one, work, lost), items, jobs, limits)
    results: dict[int, Result] = {}
    with closing(ends):
        for index, result in ends:
            results[index] = result
            done(result)
    return [results[index] for index in range(len(items))]


def as_they_end(
    work: Callable[[Isolated[Answer], Item], Result],
    items: Sequence[Item],
    jobs: int,
    limits: Limits,
) -> Generator[tuple[int, Result]]:
    """Work on all items, begun in their order; yields index and result of each as it ends.

    ``work`` is called in a thread, with a child process that is that item's alone until it returns.
    When this is closed, or ``work`` raises, all children are ended at once.
    """
    number = min(jobs or processors(), len(items))
    children = [Isolated[Answer](limits) for _ in range(number)]
    free: SimpleQueue[Isolated[Answer]] = SimpleQueue()
    for child in children:
        free.put(child)

    def with_child(item: Item) -> Result:
        child = free.get()
        try:
            return work(child, item)
        finally:
            free.put(child)

    threads = ThreadPoolExecutor(max(number, 1))
    try:
        waiting = {threads.submit(with_child, item): index for index, item in enumerate(items)}
        for future in as_completed(waiting):
            yield waiting.pop(future), future.result()
    finally:
        threads.shutdown(wait=False, cancel_futures=True)
        for child in children:
            child.close()


def processors() -> int:
    """How many processors this process may use."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


def _one(
    work: Callable[[Item], Result],
    lost: Callable[[Item, Lost], Result],
    child: Isolated[Result],
    item: Item,
) -> Result:
    """One item in a child process."""
    answer = child.call(work, item)
    if not isinstance(answer, Lost):
        return answer
    if answer.error is not None:
        raise answer.error
    return lost(item, answer)
