"""The process that cells run in: it may crash, hang or run out of memory without harm to others.

It reads pickled jobs from its standard input, before them the function of the first and the places
of engines that are not ours, and writes pickled answers to its standard output; it ends as soon as
its input does, whatever it is doing. The printed output of engines goes nowhere.
"""

import contextlib
import os
import pickle
import queue
import sys
import threading
import traceback
from collections.abc import Callable
from pathlib import Path
from typing import IO

from sim.compiling import listen

Ending = tuple[str, object, bytes]
"""Ending of a job (``done``, ``crashed``), its result or reason, and its exception, pickled: a
reader of the ending need not know it. An engine that compiles is no ending (``compiling``), with
True at its begin and False at its end."""
Answer = tuple[*Ending, bool]
"""An ending, and whether another child should do the next job, as this one has much memory that it
did not give back."""
COMPILING = "compiling"
WORN = 0.5
"""Share of its memory that a child may have kept from job to job."""


def main(memory_bytes: int) -> None:
    """Serve jobs until the input ends."""
    answers = os.fdopen(os.dup(1), "wb")
    nowhere = os.open(os.devnull, os.O_WRONLY)
    os.dup2(nowhere, 1)
    os.dup2(nowhere, 2)
    jobs: queue.SimpleQueue[bytes] = queue.SimpleQueue()
    threading.Thread(target=_listen, args=(sys.stdin.buffer, jobs), daemon=True).start()
    # Imports of the first function are no part of any cell's time or memory.
    _, own_engines = pickle.loads(jobs.get())
    if own_engines:
        from sim.own_engine.known import told  # most of a child's start, where its job needs less

        told(own_engines)
    listen(lambda begins: send(answers, (COMPILING, begins, b"", False)))
    at_first = _taken()
    _limit(at_first + memory_bytes)
    send(answers, ("ready", None, b"", False))
    while True:
        function, arguments = pickle.loads(jobs.get())
        ending = _done(function, arguments, memory_bytes)
        answer: Answer = (*ending, _taken() - at_first > WORN * memory_bytes)
        send(answers, answer)


def _listen(source: IO[bytes], jobs: queue.SimpleQueue[bytes]) -> None:
    """Hand on the input; end the process when the input ends."""
    while raw := receive(source):
        jobs.put(raw)
    os._exit(0)


def _done(
    function: Callable[..., object], arguments: tuple[object, ...], memory_bytes: int
) -> Ending:
    try:
        return "done", function(*arguments), b""
    except MemoryError:
        return "crashed", f"out of memory: a cell has {memory_bytes / 1e9:.3g} GB", b""
    except Exception as error:  # whatever an engine throws costs its own cell alone
        return "crashed", f"{type(error).__name__}: {error}", _portable(error)


def _portable(error: Exception) -> bytes:
    """Return the pickled error, with its traceback; empty where it cannot be packed."""
    error.add_note("".join(traceback.format_exception(error)))
    with contextlib.suppress(Exception):
        return pickle.dumps(error)
    return b""


def _taken() -> int:
    """Return the memory that this process has requested [bytes]; 0 if the system does not say."""
    try:
        pages = Path("/proc/self/statm").read_text(encoding="ascii").split()[0]
    except OSError:
        return 0
    return int(pages) * os.sysconf("SC_PAGE_SIZE")


def _limit(most_bytes: int) -> None:
    """Limit the memory of the process, where the system can enforce it."""
    with contextlib.suppress(ImportError, OSError, ValueError, AttributeError):
        import resource

        resource.setrlimit(resource.RLIMIT_AS, (most_bytes, most_bytes))


def send(stream: IO[bytes], value: object) -> None:
    """Write one pickled value with its length before it."""
    raw = pickle.dumps(value, protocol=pickle.HIGHEST_PROTOCOL)
    stream.write(len(raw).to_bytes(8, "little"))
    stream.write(raw)
    stream.flush()


def receive(stream: IO[bytes]) -> bytes:
    """Return the next pickled value as bytes; empty at the end of the stream."""
    head = stream.read(8)
    if len(head) < 8:
        return b""
    size = int.from_bytes(head, "little")
    raw = stream.read(size)
    return raw if len(raw) == size else b""
