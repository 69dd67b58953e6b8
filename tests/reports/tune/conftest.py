"""Searches in the process of the tests, with made-up clocks, that run each cell once."""

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import ClassVar, cast

import pytest

from reports.judge.cell import Cell
from reports.workers.isolated import Lost
from tests.worlds.in_process import Answer, Here

TOO_SHORT_S = 1e-3
"""A limit that no run keeps."""


class Remembering(Here[Answer]):
    """Answers once for all tests: that an engine does the same twice is tested elsewhere."""

    answers: ClassVar[dict[str, object]] = {}

    def call(self, function: Callable[..., Answer], *arguments: object) -> Answer:
        if self.limits.time_s < TOO_SHORT_S:
            return cast(Answer, Lost("timeout", f"no end within {self.limits.time_s:g} s"))
        key = f"{function.__name__} {arguments}"
        if key not in self.answers:
            self.answers[key] = function(*arguments)
        return cast(Answer, self.answers[key])


def timed(_: object, cells: Sequence[tuple[Cell, float]], rounds: int) -> list[object]:
    """In place of a clock: a cell takes as many microseconds as there are cells up to it."""
    assert rounds > 1
    return [((n + 9.0, float(n)), (1.1 * n, 2.0 * n)) for n, _ in enumerate(cells, 1)]


@pytest.fixture
def path(tmp_path: Path) -> Path:
    return tmp_path / "kept.db"


@pytest.fixture(autouse=True, scope="module")
def _in_this_process() -> object:
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("reports.tune.attempt.Isolated", Remembering)
        patch.setattr("reports.tune.attempt.timed_in_turns", timed)
        yield
