"""Ctrl-C and SIGTERM: the workers die, further signals are ignored, the command unwinds once."""

from __future__ import annotations

import contextlib
import os
import signal
import subprocess
import sys
import threading
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path
from types import FrameType

SIGNALS = (signal.SIGINT, signal.SIGTERM)
WORDS = {signal.SIGINT: "interrupted", signal.SIGTERM: "terminated"}
PATIENCE_S = 5.0
"""Time for unwinding [s], after which the process ends without it."""


class Stopped(BaseException):
    """A request of the user, or the system, to end; no ``except Exception`` may keep it."""

    def __init__(self, number: int) -> None:
        self.code = 128 + number
        self.word = WORDS[signal.Signals(number)]
        super().__init__(self.word)


_seen: list[Stopped] = []
_printed = threading.Lock()
"""Taken by whoever prints the one line of a signal: the unwound command, or the end without it."""
_waiting: list[int] | None = None
"""Signals that came while they were held back; None while they are not."""


def seen() -> Stopped | None:
    """Return the signal that came, also where the interrupted code made another error of it (an
    import that is cut short is an ImportError)."""
    return _seen[0] if _seen else None


def may_print() -> bool:
    """Return True once: the one line of a signal is printed by who gets this."""
    return _printed.acquire(blocking=False)


def install() -> None:
    """Turn the first signal into `Stopped`; one that is ignored already stays ignored (nohup)."""
    sys.unraisablehook = _unraisable
    for number in SIGNALS:
        if signal.getsignal(number) is not signal.SIG_IGN:
            signal.signal(number, _stop)


def finish() -> None:
    """Ignore signals from now on: all is done and printed, and Python takes itself down."""
    for number in SIGNALS:
        signal.signal(number, signal.SIG_IGN)


def _stop(number: int, _frame: FrameType | None) -> None:
    if _waiting is not None:
        _waiting.append(number)
        return
    finish()
    stopped = Stopped(number)
    _seen.append(stopped)
    end = threading.Timer(PATIENCE_S, _end_at_once, [stopped])  # a lock may never be released
    end.daemon = True
    end.start()
    raise stopped


def _unraisable(lost: sys.UnraisableHookArgs) -> None:
    """Report an error that nobody can catch, as in an object's end; end the process at a signal."""
    if isinstance(lost.exc_value, Stopped):
        _end_at_once(lost.exc_value)
    sys.__unraisablehook__(lost)


def _end_at_once(stopped: Stopped) -> None:
    """Print the one line, and end the process, without unwinding: its children end with its pipes,
    its locks are free, and files are written whole or not at all."""
    if may_print():
        with suppress(OSError):
            os.write(2, f"crankcheck: {stopped.word}\n".encode())
    os._exit(stopped.code)


def broken_pipe_ends(at_once: bool) -> None:
    """Choose if a pipe that nobody reads ends the process by itself (141), as it should while only
    help is printed; with workers to talk to it is an error to be handled."""
    if hasattr(signal, "SIGPIPE"):
        signal.signal(signal.SIGPIPE, signal.SIG_DFL if at_once else signal.SIG_IGN)


@contextmanager
def held_back() -> Iterator[None]:
    """Hold signals until the end of the block; processes that are started in it are born deaf to
    them, until `leave_to_parent`."""
    global _waiting  # noqa: PLW0603 - a signal handler has nothing else to look at
    # The mask is for the processes; here another thread may take the signal all the same.
    masks = hasattr(signal, "pthread_sigmask")  # not on Windows
    before = signal.pthread_sigmask(signal.SIG_BLOCK, SIGNALS) if masks else set()
    _waiting = []
    try:
        yield
    finally:
        came, _waiting = _waiting, None
        if masks:
            signal.pthread_sigmask(signal.SIG_SETMASK, before)
        if came:
            _stop(came[0], None)


def leave_to_parent() -> None:
    """Leave Ctrl-C to the parent, in a worker; SIGTERM ends the worker at once."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    if hasattr(signal, "pthread_sigmask"):
        signal.pthread_sigmask(signal.SIG_UNBLOCK, SIGNALS)


CAN_NOT_RUN = 126
"""Exit code that shells give a program that is there and can not be run."""


@dataclass(frozen=True)
class Ended:
    """Ending of a program: exit code (negative: the signal that killed it), and its output."""

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

    The child ignores Ctrl-C and SIGTERM from its start, as this process handles them: it asks the
    child to end and kills it ``patience_s`` later. A child that wants the time to unwind calls
    `leave_to_parent`.
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
    """End a child, and see that it ends, with all that it has started."""
    if patience_s:
        child.terminate()
        with contextlib.suppress(subprocess.TimeoutExpired):
            child.wait(patience_s)
    if hasattr(os, "killpg"):
        with contextlib.suppress(ProcessLookupError, PermissionError):
            os.killpg(child.pid, signal.SIGKILL)
    child.kill()
    child.wait()
