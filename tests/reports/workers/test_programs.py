"""Another program: what it is told when this process has to end."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from reports.workers.programs import run_child
from reports.workers.signals import Stopped
from tests.worlds.programs import ROOT, until

CHILD = """
import subprocess, sys
from pathlib import Path
from reports.workers.signals import leave_to_parent
if sys.argv[2] == "hears":
    leave_to_parent()
own = subprocess.Popen([sys.executable, "-c", "import time; time.sleep(3600.0)"])
Path(sys.argv[1]).write_text(str(own.pid))
own.wait()
"""


@pytest.mark.skipif(sys.platform == "win32", reason="signals to a group are POSIX")
@pytest.mark.parametrize(
    ("patience_s", "hears", "how"),
    [
        (600.0, "hears", signal.SIGTERM),
        (0.0, "hears", signal.SIGKILL),
        (0.01, "is deaf", signal.SIGKILL),
    ],
)
def test_a_signal_ends_it_with_all_that_it_started(
    patience_s: float, hears: str, how: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A program that is told to end may take its time to do so, which here it does not need."""
    sign = tmp_path / "sign"
    children: list[subprocess.Popen[str]] = []

    def interrupted(child: subprocess.Popen[str]) -> tuple[str, str]:
        children.append(child)
        until(lambda: sign.exists() and sign.read_text() != "")
        raise Stopped(signal.SIGINT)

    monkeypatch.setattr(subprocess.Popen, "communicate", interrupted)
    command = [sys.executable, "-c", CHILD, str(sign), hears]
    with pytest.raises(Stopped):
        run_child(command, os.environ | {"PYTHONPATH": str(ROOT)}, patience_s=patience_s)
    (child,) = children
    assert child.returncode == -how
    for pipe in filter(None, (child.stdout, child.stderr)):
        pipe.close()
    until(lambda: ended(int(sign.read_text())))


def ended(process: int) -> bool:
    """Whether a process is gone, or is there in name only, as nobody has asked how it ended."""
    try:
        state = Path(f"/proc/{process}/stat").read_text(encoding="ascii").rpartition(")")[2]
    except (FileNotFoundError, ProcessLookupError):
        return True
    return state.split()[0] == "Z"
