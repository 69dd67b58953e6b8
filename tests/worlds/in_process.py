"""Sweeps in the process of the tests, where nothing that is tested ends or slows another one."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Generic, TypeVar

import pytest

from reports.workers.isolated import Limits

Answer = TypeVar("Answer")


class Here(Generic[Answer]):
    """Calls a function where others would start a process for it."""

    closed = False

    def __init__(self, limits: Limits) -> None:
        self.limits = limits

    def call(self, function: Callable[..., Answer], *arguments: object) -> Answer:
        return function(*arguments)

    def close(self) -> None:
        """There is nothing to end."""


@contextmanager
def in_this_process() -> Iterator[pytest.MonkeyPatch]:
    """Cells of sweeps are run and timed here, with ``jobs=1``; ends with the block, as other tests
    need children that may die."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("reports.workers.scheduler.Isolated", Here)
        patch.setattr("reports.sweep.running.Isolated", Here)
        yield patch
