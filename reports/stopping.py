"""Ctrl-C and SIGTERM: the workers die, further signals are ignored, the command unwinds once."""

from __future__ import annotations

import os
import signal
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType

SIGNALS = (signal.SIGINT, signal.SIGTERM)
WORDS = {signal.SIGINT: "interrupted", signal.SIGTERM: "terminated"}
PATIENCE_S = 5.0
"""How long unwinding may take before the process ends without it."""


class Stopped(BaseException):
    """The user, or the system, wants the command to end; no ``except Exception`` may keep it."""

    def __init__(self, number: int) -> None:
        self.code = 128 + number
        self.word = WORDS[signal.Signals(number)]
        super().__init__(self.word)


def install() -> None:
    """Turn the first signal into `Stopped`; one that is ignored already stays ignored (nohup)."""
    for number in SIGNALS:
        if signal.getsignal(number) is not signal.SIG_IGN:
            signal.signal(number, _stop)


def _stop(number: int, _frame: FrameType | None) -> None:
    for each in SIGNALS:
        signal.signal(each, signal.SIG_IGN)
    end = threading.Timer(PATIENCE_S, os._exit, [128 + number])  # a lock may never be released
    end.daemon = True
    end.start()
    if "multiprocessing" in sys.modules:
        for worker in sys.modules["multiprocessing"].active_children():
            worker.kill()
    raise Stopped(number)


@contextmanager
def held_back() -> Iterator[None]:
    """Signals wait until the end of the block; processes that are started in it are born deaf to
    them, until `leave_to_parent`."""
    if not hasattr(signal, "pthread_sigmask"):  # Windows
        yield
        return
    before = signal.pthread_sigmask(signal.SIG_BLOCK, SIGNALS)
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


def leave_to_parent() -> None:
    """In a worker: Ctrl-C is the parent's to handle, SIGTERM ends the worker at once."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    if hasattr(signal, "pthread_sigmask"):
        signal.pthread_sigmask(signal.SIG_UNBLOCK, SIGNALS)
