"""A process apart: what it may take, what ends it, and what is told of that."""

from __future__ import annotations

import os
import threading
import time
from collections.abc import Callable
from contextlib import closing
from pathlib import Path
from typing import ClassVar

import pytest

from models.errors import SceneError
from reports.workers import isolated as isolation
from reports.workers.isolated import Isolated, Limits, Lost
from tests.worlds.jobs import be_odd, be_strange, fail, hold, refuse_scene
from tests.worlds.programs import ROOT

LIMIT_S = 900.0
"""That of a job, which no job here takes."""


def test_a_child_that_keeps_memory_is_replaced() -> None:
    with closing(Isolated[int](Limits(LIMIT_S, 0.4))) as isolated:
        pids = {isolated.call(hold, 120_000_000) for _ in range(3)}
    assert not any(isinstance(pid, Lost) for pid in pids)
    assert len(pids) > 1


def test_the_time_limit_is_for_each_job(monkeypatch: pytest.MonkeyPatch) -> None:
    with closing(Isolated[None](Limits(0.3))) as isolated:
        assert isolated.call(time.sleep, 3600.0) == Lost("timeout", "no end within 0.3 s")
        monkeypatch.setattr(isolation.threading, "Timer", Noted)
        isolated.limits = Limits(LIMIT_S)
        for jobs in (1, 2):
            assert isolated.call(time.sleep, 0.0) is None
            assert Noted.limits_s.count(LIMIT_S) == jobs
            assert Noted.running == 0


class Noted(threading.Timer):
    """A timer that notes its limit, and how many of them run."""

    limits_s: ClassVar[list[float]] = []
    running: ClassVar[int] = 0

    def __init__(self, interval_s: float, function: Callable[[], None]) -> None:
        super().__init__(interval_s, function)
        Noted.limits_s.append(interval_s)

    def start(self) -> None:
        Noted.running += 1
        super().start()

    def cancel(self) -> None:
        Noted.running -= 1
        super().cancel()


class LastMoment(threading.Timer):
    """A timer that goes off when it is stopped, a little late, if it is that of a job."""

    def __init__(self, interval_s: float, function: Callable[[], None]) -> None:
        of_job = interval_s == LIMIT_S
        super().__init__(0.1 if of_job else interval_s, function)
        self.of_job = of_job

    def start(self) -> None:
        if not self.of_job:
            super().start()

    def cancel(self) -> None:
        if self.of_job:
            super().start()
        else:
            super().cancel()


def test_a_limit_that_ends_with_the_job_does_not_end_the_next(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(isolation.threading, "Timer", LastMoment)
    with closing(Isolated[int](Limits(LIMIT_S))) as isolated:
        pids = [isolated.call(os.getpid) for _ in range(2)]
    assert not any(isinstance(pid, Lost) for pid in pids)
    assert len(set(pids)) == 2


def test_a_closed_one_starts_nothing() -> None:
    isolated: Isolated[None] = Isolated(Limits())
    isolated.close()
    assert isolated.call(time.sleep, 0.0) == Lost("crashed", "the sweep was ended")


def test_what_the_function_imports_is_not_of_the_memory_of_a_job(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "large.py").write_text(
        "held = bytearray(300_000_000)\ndef size():\n    return len(held)\n"
    )
    monkeypatch.syspath_prepend(tmp_path)
    from large import size  # type: ignore[import-not-found]  # made just now

    with closing(Isolated[int](Limits(LIMIT_S, 0.2))) as isolated:
        assert isolated.call(size) == 300_000_000
        assert "out of memory" in str(isolated.call(bytearray, 300_000_000))


def test_what_was_raised_comes_with_the_place_where_it_was() -> None:
    with closing(Isolated[object](Limits(LIMIT_S))) as isolated:
        lost = isolated.call(fail)
        refused = isolated.call(refuse_scene, "scene.toml", ["one", "two"])
        odd = isolated.call(be_odd)
        strange = isolated.call(be_strange)
    assert isinstance(lost, Lost)
    assert isinstance(lost.error, ZeroDivisionError)
    assert "in fail" in lost.error.__notes__[0]
    assert isinstance(refused, Lost)
    assert isinstance(refused.error, SceneError)
    assert refused.error.faults == ("one", "two")
    assert odd == Lost("crashed", "OddError: 1 and 2")
    assert isinstance(odd, Lost)
    assert odd.error is None, "it cannot travel"
    assert strange == Lost("crashed", "StrangeError: of a module that is there alone")
    assert isinstance(strange, Lost)
    assert strange.error is None


def test_a_child_that_does_not_start_in_time_says_so(monkeypatch: pytest.MonkeyPatch) -> None:
    with closing(Isolated[int](Limits())) as isolated:
        with monkeypatch.context() as patch:
            patch.setattr(isolation.threading, "Timer", AtOnce)
            assert isolated.call(os.getpid) == Lost("timeout", "no start within 60 s")
        assert isinstance(isolated.call(os.getpid), int)


class AtOnce(threading.Timer):
    """A timer that goes off where it is started."""

    def start(self) -> None:
        self.function()

    def join(self, timeout: float | None = None) -> None:
        """No thread was started."""


@pytest.fixture(autouse=True)
def importable(monkeypatch: pytest.MonkeyPatch) -> None:
    """The child imports the functions of the tests."""
    monkeypatch.syspath_prepend(ROOT)
    monkeypatch.setenv("PYTHONPATH", str(ROOT))
