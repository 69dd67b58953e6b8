"""Ctrl-C and SIGTERM in a real run with worker processes, at any time and several times."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from tests.worlds.command import PYTHON

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="signals to a group are POSIX")

SCRIPT = """
import os, signal, sys, threading, time
from crankcheck.__main__ import main

def again():
    for _ in range({times}):
        {kill}
        time.sleep(0.1)

if __name__ == "__main__":
    timer = threading.Timer({after}, again)
    timer.daemon = True
    timer.start()
    sys.argv = ["crankcheck", "verify", "--turns", "60", "-o", {folder!r}]
    main()
"""
GROUP = "os.killpg(os.getpgid(0), signal.SIGINT)"
ALONE = "os.kill(os.getpid(), signal.SIGTERM)"


def ended(folder: Path, kill: str, after: float, times: int) -> tuple[int, str, str]:
    """Exit code, output and complaint of a long run that is told to end ``after`` seconds."""
    script = folder / "run.py"
    script.write_text(
        SCRIPT.format(kill=kill, after=after, times=times, folder=str(folder / "out")),
        encoding="utf-8",
    )
    running = subprocess.Popen(
        [PYTHON, str(script)],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
    )
    # The pipes end when the last process that holds them does: no worker outlives the command.
    output, complaint = running.communicate(timeout=60)
    return running.returncode, output, complaint


# Into the imports of the command, into the start of the workers, and into their work.
@pytest.mark.parametrize("after", [0.01, 0.7, 1.0, 1.4, 4.0])
def test_ctrl_c_ends_the_workers_with_one_line_and_nothing_written(
    tmp_path: Path, after: float
) -> None:
    code, output, complaint = ended(tmp_path, GROUP, after, times=4)
    assert complaint.splitlines() == ["crankcheck: interrupted"]
    assert (code, output) == (130, "")
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize("after", [1.0, 4.0])
def test_sigterm_ends_in_the_same_way(tmp_path: Path, after: float) -> None:
    code, output, complaint = ended(tmp_path, ALONE, after, times=2)
    assert complaint.splitlines() == ["crankcheck: terminated"]
    assert (code, output) == (143, "")
    assert not (tmp_path / "out").exists()
