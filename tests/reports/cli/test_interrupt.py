"""Ctrl-C and SIGTERM in a real run with worker processes, at any time and several times."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

from tests.worlds.command import PYTHON
from tests.worlds.programs import Start

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="signals to a group are POSIX")

SCRIPT = """
import os, signal, sys, threading, time
from crankcheck.__main__ import main

event, name, number = {moment!r}
left = [None] * number

def again():
    for _ in range({times}):
        {kill}
        time.sleep(0.1)

def hear(what, arguments):
    if what == event and name in str(arguments[0]) and left:
        left.pop()
        if not left:
            threading.Thread(target=again, daemon=True).start()

if __name__ == "__main__":
    sys.addaudithook(hear)
    sys.argv = ["crankcheck", "verify", *{arguments!r}]
    main()
"""
GROUP = "os.killpg(os.getpgid(0), signal.SIGINT)"
ALONE = "os.kill(os.getpid(), signal.SIGTERM)"
Moment = tuple[str, str, int]
"""An event that Python tells of, part of its first argument, and the how manieth it is."""
IMPORTS: Moment = ("import", "numpy", 1)
FIRST_STARTS: Moment = ("subprocess.Popen", "python", 1)
SECOND_STARTS: Moment = ("subprocess.Popen", "python", 2)
FIRST_ANSWER: Moment = ("pickle.find_class", "reports.judge.cell", 1)
LONG = ("--turns", "4")
"""Some ten seconds of work, which ends in its first moments."""
DEAF = ("sh", "-c", 'trap "" INT; exec "$@"', "sh")
"""Starts a program that ignores Ctrl-C, as `nohup` and a script's background do."""


def ended(
    start: Start, folder: Path, kill: str, moment: Moment, times: int, *, deaf: bool = False
) -> tuple[int, str, str]:
    """Exit code, output and complaint of a run that is told to end at a moment, so many times."""
    arguments = [*(("fourbar-lecture-1",) if deaf else LONG), "-o", str(folder / "out")]
    script = folder / "run.py"
    script.write_text(
        SCRIPT.format(kill=kill, moment=moment, times=times, arguments=arguments),
        encoding="utf-8",
    )
    running = start(*(DEAF if deaf else ()), PYTHON, script)
    # The pipes end when the last process that holds them does: no worker outlives the command.
    output, complaint = running.communicate(timeout=300)
    return running.returncode, output, complaint


@pytest.mark.parametrize("moment", [IMPORTS, FIRST_STARTS, SECOND_STARTS, FIRST_ANSWER])
def test_ctrl_c_ends_the_workers_with_one_line_and_nothing_written(
    programs: Start, tmp_path: Path, moment: Moment
) -> None:
    code, output, complaint = ended(programs, tmp_path, GROUP, moment, times=4)
    assert complaint.splitlines() == ["crankcheck: interrupted"]
    assert (code, output) == (130, "")
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize("moment", [FIRST_STARTS, FIRST_ANSWER])
def test_sigterm_ends_in_the_same_way(programs: Start, tmp_path: Path, moment: Moment) -> None:
    code, output, complaint = ended(programs, tmp_path, ALONE, moment, times=2)
    assert complaint.splitlines() == ["crankcheck: terminated"]
    assert (code, output) == (143, "")
    assert not (tmp_path / "out").exists()


def test_ctrl_c_stays_ignored_where_the_parent_ignores_it(programs: Start, tmp_path: Path) -> None:
    code, _, complaint = ended(programs, tmp_path, GROUP, IMPORTS, times=2, deaf=True)
    assert (code, complaint) == (0, "")
    assert (tmp_path / "out" / "verify.csv").exists()
