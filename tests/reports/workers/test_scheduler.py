"""Many things at a time, each in a process apart."""

from __future__ import annotations

import os
import time
from collections.abc import Generator
from contextlib import closing
from functools import partial

import psutil
import pytest

from models.errors import CrankcheckError
from reports.workers.isolated import Isolated, Limits, Lost
from reports.workers.scheduler import FEW, as_they_end, run_all
from tests.worlds.jobs import refuse, sleepy, unlucky, where
from tests.worlds.programs import ROOT, until
from tests.worlds.tiers import slowly

MANY = list(range(FEW + 2))
MUCH = Limits(3600.0)


def test_results_come_in_order_and_what_is_lost_has_one_too() -> None:
    heard: list[str] = []
    results = run_all(unlucky, MANY, 2, MUCH, lost, heard.append)
    assert results == ["0", "1", "2: the engine ended its process (exit code 3)", "3", "4", "5"]
    assert sorted(heard) == sorted(results)


@pytest.mark.parametrize(
    ("seconds", "jobs", "limit_s"),
    [
        ([3600] * 2, 2, 0.2),
        slowly([0, *[3600] * FEW], 3, 10.0, reason="a child that was ended has another one's turn"),
    ],
)
def test_what_takes_too_long_is_lost(seconds: list[int], jobs: int, limit_s: float) -> None:
    assert run_all(sleepy, seconds, jobs, Limits(limit_s), lost, apart=True) == [
        f"{each}: no end within {limit_s:g} s" if each else "0" for each in seconds
    ]


def test_few_are_done_here() -> None:
    assert run_all(where, MANY[:FEW], 2, MUCH, lost) == [str(os.getpid())] * FEW
    assert run_all(where, MANY, 1, MUCH, lost) == [str(os.getpid())] * len(MANY)
    assert str(os.getpid()) not in run_all(where, MANY[: FEW + 1], 2, MUCH, lost)


@pytest.mark.parametrize("jobs", [1, 2])
def test_what_has_to_be_apart_is_however_few_there_are(jobs: int) -> None:
    results = run_all(unlucky, [1, 2], jobs, MUCH, lost, apart=True)
    assert results == ["1", "2: the engine ended its process (exit code 3)"]


@pytest.mark.parametrize("jobs", [1, 2])
def test_what_the_work_raises_is_raised_here(jobs: int) -> None:
    with pytest.raises(CrankcheckError, match="no 3"):
        run_all(refuse, MANY, jobs, MUCH, lost)


def test_at_the_end_all_children_are_ended_in_the_middle_of_their_work() -> None:
    def drive(child: Isolated[None], seconds: float) -> object:
        return child.call(time.sleep, seconds)

    others = set(psutil.Process().children())  # a browser that other tests have opened
    ends: Generator[tuple[int, object]] = as_they_end(drive, [0.0, 600.0, 600.0], 2, MUCH)
    with closing(ends):
        assert next(ends) == (0, None)
        until(lambda: len({*psutil.Process().children()} - others) == 2)
    assert {*psutil.Process().children()} <= others


def test_nothing_to_do_is_done() -> None:
    assert list(as_they_end(partial(Isolated.call, function=where), [], 0, MUCH)) == []


def lost(number: int, how: Lost) -> str:
    return f"{number}: {how.reason}"


@pytest.fixture(autouse=True)
def importable(monkeypatch: pytest.MonkeyPatch) -> None:
    """The child imports the functions of the tests."""
    monkeypatch.syspath_prepend(ROOT)
    monkeypatch.setenv("PYTHONPATH", str(ROOT))
