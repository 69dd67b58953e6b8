"""Programs that tests start: they hear signals, and end with the test."""

import contextlib
import os
import signal
import subprocess
import time
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path

ROOT = Path(__file__).parents[2]
Start = Callable[..., "subprocess.Popen[str]"]


def hear_signals() -> None:
    """Let what this process starts hear Ctrl-C also where its own parent ignores it (`nohup`, a
    job in the background of a script): what is ignored is so in each program that is started, what
    is handled is not."""
    for number in (signal.SIGINT, signal.SIGTERM):
        if signal.getsignal(number) is signal.SIG_IGN:
            signal.signal(number, lambda *_: None)


@contextlib.contextmanager
def programs() -> Iterator[Start]:
    """Gives what starts a program, in a session of its own, whose output is to be read from it; at
    the end of the block whatever is left of it is killed."""
    running: list[subprocess.Popen[str]] = []

    def start(
        *command: object,
        more: Mapping[str, str] | None = None,
        cwd: Path | None = None,
        output: int = subprocess.PIPE,
    ) -> subprocess.Popen[str]:
        program = subprocess.Popen(
            [*map(str, command)],
            stdout=output,
            stderr=output,
            text=True,
            cwd=cwd,
            start_new_session=True,
            env={**os.environ, **(more or {})},
        )
        running.append(program)
        return program

    try:
        yield start
    finally:
        for program in running:
            _end(program)


def _end(program: subprocess.Popen[str]) -> None:
    with contextlib.suppress(ProcessLookupError, PermissionError, AttributeError):
        os.killpg(program.pid, signal.SIGKILL)  # AttributeError: not on Windows
    program.kill()
    program.wait()
    for pipe in (program.stdout, program.stderr):
        if pipe is not None:
            pipe.close()


def until(condition: Callable[[], bool]) -> None:
    """Wait for it, five minutes at most: the machine may have much else to do."""
    end = time.monotonic() + 300.0
    while not condition():
        assert time.monotonic() < end, "waited in vain"
        time.sleep(0.02)
