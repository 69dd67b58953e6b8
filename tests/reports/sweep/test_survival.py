"""A sweep that is killed, stopped, or run again: what is done is kept, what is missing is run."""

from __future__ import annotations

import random
import re
import signal
import sys
import time
from pathlib import Path

import pandas as pd
import psutil
import pytest

from reports.store.reader import Stored, read_store, stored_keys
from tests.worlds.command import COMMAND
from tests.worlds.programs import Start, programs, until

SEED = 20261121
STEPS = "90,100,108,120,144,150,160,360,720,1440"
"""Most cells take a moment, as what is tested is the store; the last take long enough to be killed
in."""
GRID = ("slider-crank-offset", "--steps-per-turn", STEPS, "--turns", "2")
NUMBER = 8 * 10
FEW = 4 * 5
LONG = ("--turns", "30", "--no-timing")
"""Cells that take longer than the writer waits until it keeps some."""
BY_CHANCE = {"wall_s", "logged_us_per_step", "run_on", "us_per_step"}
SLOW_KILLS = [pytest.param(kill, marks=pytest.mark.slow) for kill in range(1, 5)]
pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="SIGKILL is POSIX")


@pytest.fixture(scope="module")
def whole(tmp_path_factory: pytest.TempPathFactory) -> Stored:
    """The same sweep, never disturbed."""
    folder = tmp_path_factory.mktemp("whole") / "store"
    with programs() as start:
        done = start(COMMAND, "sweep", *GRID, "-o", folder, "--no-timing")
        _, err = done.communicate(timeout=300)
    assert done.returncode == 0, err
    return read_store(folder)


def counts(text: str) -> tuple[int, ...]:
    """Cells in all, run now, and there before; cells timed now."""
    found = re.search(r"(\d+) cells: (\d+) run now, (\d+) were there; (\d+) timed now", text)
    assert found, text
    return tuple(map(int, found.groups()))


def parts(folder: Path, table: str) -> int:
    return len(list((folder / table).glob(f"{table}-*.parquet")))


def children(of: int) -> list[psutil.Process]:
    """The processes that a sweep has started."""
    return psutil.Process(of).children(recursive=True)


def same(one: Stored, other: Stored) -> None:
    """The same cells, each once, bit by bit but for what chance decides."""
    columns = [name for name in one.cells.columns if name not in BY_CHANCE]
    left, right = (s.cells.set_index("key").sort_index() for s in (one, other))
    names = [name for name in columns if name != "key"]
    pd.testing.assert_frame_equal(left[names], right[names], check_exact=True)
    order = ["key", "quantity", "body_kind", "body", "source", "kind"]
    long = (s.errors.sort_values(order).reset_index(drop=True) for s in (one, other))
    pd.testing.assert_frame_equal(*long, check_exact=True)
    for key in left.index:
        assert set(one.trace(key)) == set(other.trace(key))


@pytest.mark.parametrize("kill", [0, *SLOW_KILLS])
def test_a_killed_sweep_goes_on_where_it_was(
    start: Start, whole: Stored, tmp_path: Path, kill: int
) -> None:
    folder = tmp_path / "store"
    arguments = ("sweep", *GRID, "-o", folder, "--no-timing", "--jobs", "1")
    running = start(*arguments)
    until(lambda: parts(folder, "cells") > 0)
    time.sleep(random.Random(SEED + kill).uniform(0.0, 0.3))
    started = children(running.pid)
    running.send_signal(signal.SIGKILL)
    running.communicate()
    there = len(read_store(folder).cells)
    assert 0 < there < NUMBER
    done = start(*arguments)
    out, err = done.communicate(timeout=300)
    assert done.returncode == 0, err
    assert counts(out) == (NUMBER, NUMBER - there, there, 0)
    same(read_store(folder), whole)
    until(lambda: not any(child.is_running() for child in started))


def test_a_third_run_finds_everything_there(start: Start, whole: Stored) -> None:
    before = sorted(path.stat().st_mtime_ns for path in whole.folder.glob("*/*.parquet"))
    out, _ = start("sweep", *GRID, "-o", whole.folder, "--no-timing").communicate(timeout=300)
    assert counts(out) == (NUMBER, 0, NUMBER, 0)
    assert before
    assert sorted(path.stat().st_mtime_ns for path in whole.folder.glob("*/*.parquet")) == before


@pytest.mark.parametrize("timing", [False, True], ids=["finding errors", "timing"])
def test_ctrl_c_keeps_what_is_done(start: Start, tmp_path: Path, timing: bool) -> None:
    folder = tmp_path / "store"
    steps = ",".join(STEPS.split(",")[-FEW // 4 :])
    options = ("--engine", "pymunk", *(("--turns", "2") if timing else LONG))
    arguments = ("sweep", GRID[0], "-o", folder, "--steps-per-turn", steps, *options)
    running = start(*arguments)
    until(lambda: len(stored_keys(folder, "cells")) >= (FEW if timing else 1))
    time.sleep(0.1)
    started = children(running.pid)
    running.send_signal(signal.SIGINT)
    _, err = running.communicate(timeout=300)
    assert running.returncode == 130
    assert err.splitlines()[-2:] == [
        "what is done is kept; the same command goes on from there",
        "crankcheck: interrupted",
    ]
    assert "Traceback" not in err
    until(lambda: not any(child.is_running() for child in started))
    kept = read_store(folder)
    missing = FEW - len(kept.cells)
    untimed = missing + int(kept.cells.us_per_step.isna().sum()) if timing else 0
    assert (missing > 0) != timing
    assert (untimed > 0) == timing
    out, _ = start(*arguments).communicate(timeout=300)
    assert counts(out) == (FEW, missing, len(kept.cells), untimed)
    assert not read_store(folder).cells.key.duplicated().any()


def test_two_sweeps_into_one_folder_do_not_mix(start: Start, tmp_path: Path) -> None:
    folder = tmp_path / "store"
    first = start("sweep", *GRID, "-o", folder, "--jobs", "1")
    until(lambda: parts(folder, "cells") > 0)
    second = start("sweep", *GRID, "-o", folder)
    _, err = second.communicate(timeout=300)
    first.send_signal(signal.SIGTERM)
    first.communicate(timeout=300)
    assert second.returncode == 2
    assert "another sweep writes there now" in err
    assert first.returncode == 143
