"""Runs in the process of the tests, where it is not tested that they may end or hang another."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Generic, TypeVar

import pytest

from reports.workers.isolated import Limits

Answer = TypeVar("Answer")
STARTED_IN = (
    "advise.advice", "stability.running", "sweep.running", "tune.attempt", "workers.isolated",
)  # fmt: skip
"""The modules that start children."""


class Here(Generic[Answer]):
    """Calls a function where others would start a process for it."""

    closed = False

    def __init__(self, limits: Limits) -> None:
        self.limits = limits

    def call(self, function: Callable[..., Answer], *arguments: object) -> Answer:
        return function(*arguments)

    def close(self) -> None:
        self.closed = True


@contextmanager
def in_this_process() -> Iterator[pytest.MonkeyPatch]:
    """Cells are run and timed here, with one job: no child has to start, and each truth is found
    once; of times, which nobody compares, a few steps are enough. Ends with the block, as other
    tests need children that may die."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("reports.sweep.measured.REPEAT_S", 1e-5)
        patch.setattr("reports.sweep.measured.LEAST_TIMED", 5)
        for name in STARTED_IN:
            patch.setattr(f"reports.{name}.Isolated", Here)
        yield patch
