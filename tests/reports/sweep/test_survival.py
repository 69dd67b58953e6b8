"""A sweep that is killed, stopped, or run again: what is done is kept, what is missing is run."""

import re
import signal
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import psutil
import pytest
from filelock import FileLock

from reports.store.reader import Stored, read_store, stored_keys
from reports.sweep import measured as measuring
from reports.sweep.measured import MeasuredCell
from reports.workers.signals import Stopped
from tests.reports.store.test_damage import same
from tests.worlds.command import PYTHON, script
from tests.worlds.command_line import crank, crank_alone, refused
from tests.worlds.in_process import in_this_process
from tests.worlds.programs import Start, until
from tests.worlds.tiers import few, slow

GRID = ("slider-crank-offset", "--profile", "tuned", "--turns", "2", "--jobs", "1")
STEPS = ("--steps-per-turn", "90,100,108,120")
NUMBER = 2 * 4
PROGRAM = script("""
import os, sys
from pathlib import Path
import psutil
from reports.store import writer
from crankcheck.__main__ import main

event, name, number, sign, *arguments = sys.argv[1:]
left = [None] * int(number)

def hear(what, details):
    if what == event and name in str(details) and left:
        left.pop()
        if not left:
            children = psutil.Process().children(recursive=True)
            Path("children").write_text(" ".join(str(each.pid) for each in children))
            os.kill(os.getpid(), int(sign))

if __name__ == "__main__":
    writer.EVERY_S = 0.0
    sys.addaudithook(hear)
    sys.argv = ["crankcheck", *arguments]
    main()
""")
"""The command, which writes each cell at once and sends itself a signal at a moment: an event that
Python tells of, part of its arguments, and the how manieth it is."""
CELLS = ("os.rename", "/cells/cells-")
"""A part with one cell is about to be there."""
STARTS = ("subprocess.Popen", "python")
KEPT = ["what is done is kept; the same command goes on from there", "crankcheck: interrupted"]
pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="SIGKILL is POSIX")


def begun(
    start: Start, folder: Path, moment: Sequence[object], sign: signal.Signals, *more: str
) -> subprocess.Popen[str]:
    """A sweep into a store of the folder that sends itself the signal at that moment."""
    (folder / "run.py").write_text(PROGRAM)
    options = (*GRID, *STEPS, "-o", "store", *more)
    return start(PYTHON, "run.py", *moment, int(sign), "sweep", *options, cwd=folder)


def children_end(folder: Path) -> None:
    """Wait for the end of what that sweep had started at the moment, which was something."""
    pids = [int(pid) for pid in (folder / "children").read_text().split()]
    assert pids
    until(lambda: not any(psutil.pid_exists(pid) for pid in pids))


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
    """In place of a clock."""
    return [((3.0, 2.0), (2.5, 2.25))] * len(cells)


@pytest.fixture(scope="module")
def whole(tmp_path_factory: pytest.TempPathFactory) -> Stored:
    """The same sweep, never disturbed."""
    folder = tmp_path_factory.mktemp("whole") / "store"
    assert counted(folder, "--no-timing") == (NUMBER, NUMBER, 0, 0)
    return read_store(folder)


@pytest.mark.parametrize("part", few((1, 3, 4, 8), {3}, "one moment shows it; the ends may differ"))
def test_a_killed_sweep_goes_on(programs: Start, whole: Stored, tmp_path: Path, part: int) -> None:
    folder = tmp_path / "store"
    killed = begun(programs, tmp_path, (*CELLS, part), signal.SIGKILL, "--no-timing")
    killed.communicate()
    assert killed.returncode == -signal.SIGKILL
    there = part - 1
    assert len(stored_keys(folder, "cells")) == there
    assert list(folder.glob("cells/.*.tmp"))
    assert counted(folder, "--no-timing") == (NUMBER, NUMBER - there, there, 0)
    same(read_store(folder), whole, "run_on")
    assert not list(folder.glob("cells/.*.tmp"))
    children_end(tmp_path)
    parts = {path: path.stat().st_mtime_ns for path in folder.glob("*/*.parquet")}
    assert counted(folder, "--no-timing") == (NUMBER, 0, NUMBER, 0), "all is there"
    assert {path: path.stat().st_mtime_ns for path in folder.glob("*/*.parquet")} == parts


@slow("a signal to a process with children: `make test` stops a sweep in its own")
@pytest.mark.parametrize(
    ("moment", "kept"), [((*CELLS, 3), 3), ((*STARTS, 2), NUMBER)], ids=["finding errors", "timing"]
)
def test_ctrl_c_keeps_what_is_done(
    programs: Start, tmp_path: Path, moment: tuple[str, str, int], kept: int
) -> None:
    """The cell that was about to be kept, too; where its timing starts there is no child."""
    stopped = begun(programs, tmp_path, moment, signal.SIGINT)
    _, err = stopped.communicate()
    assert (stopped.returncode, err.splitlines()[-2:]) == (130, KEPT)
    assert "Traceback" not in err
    if kept < NUMBER:
        children_end(tmp_path)
    folder = tmp_path / "store"
    assert len(read_store(folder).cells) == kept
    assert counted(folder) == (NUMBER, NUMBER - kept, kept, NUMBER)
    assert not read_store(folder).cells.key.duplicated().any()


def test_ctrl_c_keeps_the_timings_before(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    blocks: list[int] = []

    def second_stops(isolated: object, cells: Sequence[object], rounds: int, _: object) -> object:
        assert rounds == 6
        blocks.append(len(cells))
        if len(blocks) == 2:
            raise Stopped(signal.SIGINT)
        return times(isolated, cells)

    monkeypatch.setattr("reports.sweep.running.BLOCK", 3)
    with in_this_process() as patch:
        patch.setattr("reports.sweep.measured.timed_in_turns", second_stops)
        done = crank("sweep", *GRID, *STEPS, "-o", tmp_path / "store")
    assert (done.exit_code, done.stderr.splitlines()[-2:]) == (130, KEPT)
    assert blocks == [3, 3]
    timed = read_store(tmp_path / "store").cells.dropna(subset="us_per_step")
    us = timed[["us_per_step", "us_per_step_a", "us_per_step_b", "us_per_step_median"]]
    assert us.to_numpy().tolist() == [[2.0, 2.0, 2.25, 2.375]] * 3
    assert list(timed.s_per_turn) == pytest.approx(list(2e-6 * timed.steps_per_turn))
    assert counted(tmp_path / "store") == (NUMBER, 0, NUMBER, NUMBER - 3)


def test_ctrl_c_keeps_the_cells_before(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    real, calls = measuring.measured, []

    def third_stops(*arguments: Any) -> MeasuredCell:
        calls.append(arguments)
        if len(calls) == 3:
            raise Stopped(signal.SIGINT)
        return real(*arguments)

    monkeypatch.setattr(measuring, "measured", third_stops)
    done = crank_alone("sweep", *GRID, *STEPS, "-o", tmp_path / "store")
    assert (done.exit_code, done.stderr.splitlines()[-2:]) == (130, KEPT)
    assert len(read_store(tmp_path / "store").cells) == 2
    monkeypatch.setattr(measuring, "measured", real)
    assert counted(tmp_path / "store") == (NUMBER, NUMBER - 2, 2, NUMBER)
    assert not read_store(tmp_path / "store").cells.key.duplicated().any()


def test_a_folder_that_another_sweep_writes_to_is_refused(tmp_path: Path) -> None:
    with FileLock(tmp_path / ".lock"):
        refused(crank("sweep", *GRID, *STEPS, "-o", tmp_path), "another sweep writes there now")
