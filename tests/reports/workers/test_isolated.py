"""A process apart: what it may take, what ends it, and what is told of that."""

from __future__ import annotations

import os
import sys
import threading
import time
from collections.abc import Callable
from contextlib import closing
from pathlib import Path
from types import ModuleType

import pytest

from models.errors import SceneError
from reports.workers import isolated as isolation
from reports.workers.isolated import Isolated, Limits, Lost
from tests.worlds.programs import ROOT

LIMIT_S = 0.7


def test_a_child_that_keeps_memory_is_replaced() -> None:
    with closing(Isolated[int](Limits(20.0, 0.4))) as isolated:
        pids = {isolated.call(hold, 120_000_000) for _ in range(4)}
    assert not any(isinstance(pid, Lost) for pid in pids)
    assert len(pids) > 1


def test_the_time_limit_is_for_each_job() -> None:
    with closing(Isolated[None](Limits(1.2))) as isolated:
        assert isolated.call(time.sleep, 60.0) == Lost("timeout", "no end within 1.2 s")
        assert isolated.call(time.sleep, 0.7) is None
        assert isolated.call(time.sleep, 0.7) is None


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
        pids = [isolated.call(os.getpid) for _ in range(3)]
    assert not any(isinstance(pid, Lost) for pid in pids)
    assert len(set(pids)) == 3


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

    with closing(Isolated[int](Limits(memory_gb=0.2))) as isolated:
        assert isolated.call(size) == 300_000_000
        assert "out of memory" in str(isolated.call(bytearray, 300_000_000))


def test_what_was_raised_comes_with_the_place_where_it_was() -> None:
    with closing(Isolated[object](Limits())) as isolated:
        lost = isolated.call(fail)
        refused = isolated.call(refuse, "scene.toml", ["one", "two"])
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
        monkeypatch.setattr("reports.workers.isolated.START_S", 0.01)
        assert isolated.call(os.getpid) == Lost("timeout", "no start within 0.01 s")
        monkeypatch.setattr("reports.workers.isolated.START_S", 60.0)
        assert isinstance(isolated.call(os.getpid), int)


_held: list[bytearray] = []


def hold(size: int) -> int:
    """Keep some memory, and tell in which process."""
    _held.append(bytearray(size))
    return os.getpid()


def fail() -> float:
    return 1 / 0


def refuse(place: str, faults: list[str]) -> None:
    raise SceneError(place, faults)


class OddError(Exception):
    """One that cannot be made anew from what it holds."""

    def __init__(self, one: int, two: int) -> None:
        super().__init__(f"{one} and {two}")


def be_odd() -> None:
    raise OddError(1, 2)


def be_strange() -> None:
    module = ModuleType("there_alone")
    exec("class StrangeError(Exception):\n    pass", vars(module))
    sys.modules[module.__name__] = module
    raise module.StrangeError("of a module that is there alone")


@pytest.fixture(autouse=True)
def importable(monkeypatch: pytest.MonkeyPatch) -> None:
    """The child imports this file's functions by the name that pytest gave it."""
    monkeypatch.syspath_prepend(ROOT)
    monkeypatch.setenv("PYTHONPATH", str(ROOT))
