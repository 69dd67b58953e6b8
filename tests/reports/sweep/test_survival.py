"""A sweep that is killed, stopped, or run again: what is done is kept, what is missing is run."""

import re
import signal
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import pandas as pd
import psutil
import pytest
from filelock import FileLock

from reports.store.reader import read_store, stored_keys
from reports.sweep import measured as measuring
from reports.sweep.measured import MeasuredCell
from reports.workers.signals import Stopped
from tests.reports.store.test_damage import same
from tests.worlds.command import PYTHON, script
from tests.worlds.command_line import crank, refused
from tests.worlds.in_process import in_this_process
from tests.worlds.programs import Start, until

GRID = ("slider-crank-offset", "--profile", "tuned", "--turns", "2", "--jobs", "1")
STEPS = ("--steps-per-turn", "90,100,108,120")
NUMBER = 2 * 4
PROGRAM = script("""
import os, signal, sys
from pathlib import Path
import psutil
from reports.store import writer
from crankcheck.__main__ import main

number, *arguments = sys.argv[1:]
left = [None] * int(number)

def hear(what, details):
    if what == "os.rename" and "/cells/cells-" in str(details):
        left.pop()
        if not left:
            children = psutil.Process().children(recursive=True)
            Path("children").write_text(" ".join(str(each.pid) for each in children))
            os.kill(os.getpid(), signal.SIGKILL)

if __name__ == "__main__":
    writer.EVERY_S = 0.0
    sys.addaudithook(hear)
    sys.argv = ["crankcheck", *arguments]
    main()
""")
"""The command, which writes each cell at once and kills itself where a part with one cell, the how
manieth, is about to be there."""
KEPT = ["finished cells are kept; the same command continues from there", "crankcheck: interrupted"]
pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="SIGKILL is POSIX")


def counted(folder: Path, *options: str) -> tuple[int, ...]:
    """Cells in all, run now, and there before, and cells timed now of a sweep that is not
    disturbed."""
    with in_this_process() as patch:
        patch.setattr("reports.sweep.measured.timed_in_turns", times)
        done = crank("sweep", *GRID, *STEPS, "-o", folder, *options)
    assert done.exit_code == 0, done.output
    found = re.search(r"(\d+) cells: (\d+) run now, (\d+) were there; (\d+) timed", done.output)
    assert found, done.output
    return tuple(map(int, found.groups()))


def times(_: object, cells: Sequence[object], *__: object) -> list[object]:
    return [((3.0, 2.0), (2.5, 2.25))] * len(cells)


def test_a_killed_sweep_goes_on(programs: Start, tmp_path: Path) -> None:
    folder, there = tmp_path / "store", 2
    (tmp_path / "run.py").write_text(PROGRAM)
    options = (*GRID, *STEPS, "--no-timing", "-o", "store")
    killed = programs(PYTHON, "run.py", there + 1, "sweep", *options, cwd=tmp_path)
    killed.communicate()
    assert killed.returncode == -signal.SIGKILL
    assert len(stored_keys(folder, "cells")) == there
    assert list(folder.glob("cells/.*.tmp"))
    assert counted(folder, "--no-timing") == (NUMBER, NUMBER - there, there, 0)
    assert counted(tmp_path / "whole", "--no-timing") == (NUMBER, NUMBER, 0, 0)
    same(read_store(folder), read_store(tmp_path / "whole"), "run_on")
    assert not list(folder.glob("cells/.*.tmp"))
    pids = [int(pid) for pid in (tmp_path / "children").read_text().split()]
    assert pids
    until(lambda: not any(psutil.pid_exists(pid) for pid in pids))
    parts = {path: path.stat().st_mtime_ns for path in folder.glob("*/*.parquet")}
    assert counted(folder, "--no-timing") == (NUMBER, 0, NUMBER, 0), "all is there"
    assert {path: path.stat().st_mtime_ns for path in folder.glob("*/*.parquet")} == parts


def test_ctrl_c_keeps_cells_and_timings(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    real, cells, blocks = measuring.measured, [], []
    monkeypatch.setattr("reports.sweep.running.BLOCK", 3)

    def third_stops(*arguments: Any) -> MeasuredCell:
        cells.append(arguments)
        if len(cells) == 3:
            raise Stopped(signal.SIGINT)
        return real(*arguments)

    def second_stops(isolated: object, block: Sequence[object], rounds: int, _: object) -> object:
        assert rounds == 6
        blocks.append(len(block))
        if len(blocks) == 2:
            raise Stopped(signal.SIGINT)
        return times(isolated, block)

    def stopped() -> pd.DataFrame:
        with in_this_process() as patch:
            patch.setattr("reports.sweep.measured.measured", third_stops)
            patch.setattr("reports.sweep.measured.timed_in_turns", second_stops)
            done = crank("sweep", *GRID, *STEPS, "-o", tmp_path / "store")
        assert (done.exit_code, done.stderr.splitlines()[-2:]) == (130, KEPT)
        return read_store(tmp_path / "store").cells

    assert (len(stopped()), blocks) == (2, [])
    count = len(cells)
    timed = stopped().dropna(subset="us_per_step")
    assert (len(cells) - count, blocks) == (NUMBER - 2, [3, 3])
    us = timed[["us_per_step", "us_per_step_a", "us_per_step_b", "us_per_step_median"]]
    assert us.to_numpy().tolist() == [[2.0, 2.0, 2.25, 2.375]] * 3
    assert list(timed.s_per_turn) == pytest.approx(list(2e-6 * timed.steps_per_turn))
    assert counted(tmp_path / "store") == (NUMBER, 0, NUMBER, NUMBER - 3)
    assert not read_store(tmp_path / "store").cells.key.duplicated().any()


def test_a_folder_that_another_sweep_writes_to_is_refused(tmp_path: Path) -> None:
    with FileLock(tmp_path / ".lock"):
        refused(crank("sweep", *GRID, *STEPS, "-o", tmp_path), "another sweep writes there now")
