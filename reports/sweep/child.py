"""The process that cells run in: it may crash, hang or run out of memory without harm to others.

It reads pickled jobs from its standard input and writes pickled answers to its standard output; it
ends as soon as its input does, whatever it is doing. What engines print goes nowhere.
"""

from __future__ import annotations

import contextlib
import importlib
import os
import pickle
import queue
import sys
import threading
from collections.abc import Callable
from pathlib import Path
from typing import IO

Job = tuple[Callable[..., object], tuple[object, ...]]
Answer = tuple[str, object]


def main(memory_bytes: int) -> None:
    """Serve jobs until the input ends."""
    answers = os.fdopen(os.dup(1), "wb")
    nowhere = os.open(os.devnull, os.O_WRONLY)
    os.dup2(nowhere, 1)
    os.dup2(nowhere, 2)
    jobs: queue.SimpleQueue[bytes] = queue.SimpleQueue()
    threading.Thread(target=_listen, args=(sys.stdin.buffer, jobs), daemon=True).start()
    importlib.import_module("reports.sweep.outcome")  # no part of any cell's time or memory
    _limit(memory_bytes)
    send(answers, ("ready", None))
    while True:
        function, arguments = pickle.loads(jobs.get())
        send(answers, _done(function, arguments, memory_bytes))


def _listen(source: IO[bytes], jobs: queue.SimpleQueue[bytes]) -> None:
    """Hand on what comes in; end the process with the one that sends it."""
    while raw := receive(source):
        jobs.put(raw)
    os._exit(0)


def _done(
    function: Callable[..., object], arguments: tuple[object, ...], memory_bytes: int
) -> Answer:
    """The answer to one job."""
    try:
        return "done", function(*arguments)
    except MemoryError:
        return "crashed", f"out of memory: a cell has {memory_bytes / 1e9:.3g} GB"
    except Exception as error:  # whatever an engine throws costs its own cell alone
        return "crashed", f"{type(error).__name__}: {error}"


def _limit(memory_bytes: int) -> None:
    """Let the process take ``memory_bytes`` beyond what it has, where the system can limit it."""
    with contextlib.suppress(ImportError, OSError, ValueError, AttributeError):
        import resource

        pages = int(Path("/proc/self/statm").read_text(encoding="ascii").split()[0])
        most = pages * os.sysconf("SC_PAGE_SIZE") + memory_bytes
        resource.setrlimit(resource.RLIMIT_AS, (most, most))


def send(stream: IO[bytes], value: object) -> None:
    """Write one pickled value with its length before it."""
    raw = pickle.dumps(value, protocol=pickle.HIGHEST_PROTOCOL)
    stream.write(len(raw).to_bytes(8, "little"))
    stream.write(raw)
    stream.flush()


def receive(stream: IO[bytes]) -> bytes:
    """The next pickled value as bytes; empty at the end of the stream."""
    head = stream.read(8)
    if len(head) < 8:
        return b""
    size = int.from_bytes(head, "little")
    raw = stream.read(size)
    return raw if len(raw) == size else b""


if __name__ == "__main__":
    main(int(sys.argv[1]))
