"""Run another program to its end; a signal that ends this process ends the other first."""

from __future__ import annotations

import contextlib
import os
import signal
import subprocess
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from reports.workers.signals import held_back

CAN_NOT_RUN = 126
"""The exit code that shells give a program that is there and can not be run."""


@dataclass(frozen=True)
class Ended:
    """How a program ended: exit code (negative: the signal that killed it), and what it wrote."""

    code: int
    output: str
    complaint: str


Runner = Callable[[Sequence[str], Mapping[str, str], Path | None], Ended]
"""Command, environment variables, folder to run in."""


def run_child(
    command: Sequence[str],
    variables: Mapping[str, str],
    folder: Path | None = None,
    patience_s: float = 0.0,
) -> Ended:
    """Run a command and wait for it.

    The child is born deaf to Ctrl-C and SIGTERM, which are this process's to handle: it tells the
    child to end and, ``patience_s`` later, kills it. A child that wants the time to unwind calls
    `reports.workers.signals.leave_to_parent`.
    """
    child: subprocess.Popen[str] | None = None
    try:
        with held_back():
            child = subprocess.Popen(
                command,
                env=dict(variables),
                cwd=folder,
                stdin=subprocess.DEVNULL,
                stdout=subprocess.PIPE,
                stderr=subprocess.PIPE,
                encoding="utf-8",
                errors="replace",
                start_new_session=True,  # so that all that it starts can be ended with it
            )
        output, complaint = child.communicate()
    except OSError as error:
        if child is not None:
            _end(child, patience_s)
        return Ended(CAN_NOT_RUN, "", f"{Path(command[0]).name}: {error.strerror or error}")
    except BaseException:
        if child is not None:
            _end(child, patience_s)
        raise
    return Ended(child.returncode, output, complaint)


def _end(child: subprocess.Popen[str], patience_s: float) -> None:
    """Tell a child to end, and see that it does, with all that it has started."""
    if patience_s:
        child.terminate()
        with contextlib.suppress(subprocess.TimeoutExpired):
            child.wait(patience_s)
    if hasattr(os, "killpg"):
        with contextlib.suppress(ProcessLookupError, PermissionError):
            os.killpg(child.pid, signal.SIGKILL)
    child.kill()
    child.wait()
