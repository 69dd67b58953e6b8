"""Ctrl-C in a real run with worker processes."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest


@pytest.mark.skipif(sys.platform == "win32", reason="signals to a group are POSIX")
def test_ctrl_c_ends_the_workers_with_one_line_and_nothing_written(tmp_path: Path) -> None:
    folder = tmp_path / "out"
    command = [sys.executable, "-m", "reports.cli", "verify", "--turns", "60", "-o", str(folder)]
    running = subprocess.Popen(
        command,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
        env=os.environ | {"PYTHONPATH": str(Path(__file__).parents[2])},
    )
    time.sleep(4.0)  # into the pool, on a slow machine still into the imports of the command
    os.killpg(running.pid, signal.SIGINT)
    output, complaint = running.communicate(timeout=60)
    assert running.returncode == 130, complaint
    assert complaint.splitlines() == ["crankcheck: interrupted, nothing written"]
    assert output == ""
    assert not folder.exists()
