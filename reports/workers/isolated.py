"""Run cells in a process of their own, which is ended when it fails or takes too long."""

import contextlib
import os
import pickle
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Generator, Sequence
from concurrent.futures import ThreadPoolExecutor, as_completed
from contextlib import closing
from dataclasses import dataclass, field
from functools import partial
from queue import SimpleQueue
from typing import IO, Generic, Self, TypeVar, cast

from models.errors import CrankcheckError
from reports.workers import one_thread
from reports.workers.child import COMPILING, main, receive, send
from reports.workers.child import Answer as ChildAnswer
from sim.own_engine.known import spellings

Result = TypeVar("Result")
LIMIT_S = 60.0
MEMORY_GB = 2.0
MOST_S, MOST_GB = 1e6, 1e4
COMPILING_S = 1800.0
"""Longest time for an engine's compiling in a job [s], which is no part of the job's."""
START_S = 60.0
"""Longest time for the imports of a child [s]."""
START = (
    f"import sys; sys.path[:] = sys.argv[2:]; from {main.__module__} import main; "
    "main(int(sys.argv[1]))"
)


@dataclass(frozen=True)
class Limits:
    """Limits of a cell: wall time [s] and memory [GB] beyond that of a child at its start."""

    time_s: float = LIMIT_S
    memory_gb: float = MEMORY_GB


def checked_limits(time_s: float, memory_gb: float) -> Limits:
    """Return the limits that a user sets. Raises CrankcheckError for numbers that are no limits."""
    for option, value, most, unit in (
        ("--limit-s", time_s, MOST_S, "seconds"),
        ("--memory-gb", memory_gb, MOST_GB, "GB"),
    ):
        if not 0.0 < value <= most:
            raise CrankcheckError(f"{option} {value:g}: give a number above 0 to {most:g} {unit}")
    return Limits(time_s, memory_gb)


@dataclass(frozen=True)
class Lost:
    """A cell that came to no end of its own: status (``crashed``, ``timeout``) and reason; its
    exception, if that is the cause."""

    status: str
    reason: str
    error: Exception | None = field(default=None, compare=False)


class Isolated(Generic[Result]):
    """A child process that runs one job at a time; a new one replaces one that died.

    Not to be shared by threads. `close` ends the child at once.
    """

    def __init__(self, limits: Limits) -> None:
        self.limits = limits
        self._child: subprocess.Popen[bytes] | None = None
        self.closed = False
        self._at_work = threading.Lock()

    def call(self, function: Callable[..., Result], *arguments: object) -> Result | Lost:
        """Return the result of ``function``, or how it was lost.

        The function has to be importable by name, and the arguments to be pickled.
        """
        with self._at_work:
            return self._called(function, arguments)

    def _called(
        self, function: Callable[..., Result], arguments: tuple[object, ...]
    ) -> Result | Lost:
        child = None if self.closed else self._child or self._started(function)
        if child is None or self.closed:  # maybe while it started
            return Lost("crashed", "the sweep was ended")
        if isinstance(child, Lost):
            return child
        jobs, answers = _pipes(child)
        limit_s = self.limits.time_s
        answer: ChildAnswer | None = None
        with _Clock(child, limit_s) as clock, contextlib.suppress(OSError):
            send(jobs, (function, arguments))
            answer = _answer(answers, clock)
        if answer is None:
            return self._lost(child, f"no end within {limit_s:g} s" if clock.late.is_set() else "")
        how, value, raised, worn = answer
        if worn or clock.late.is_set():  # an answer in the last moment stands; the child is gone
            self._end(child)
        return cast(Result, value) if how == "done" else Lost(how, str(value), _unpacked(raised))

    def close(self) -> None:
        """End the child, also in the middle of a job that another thread waits for."""
        self.closed = True
        if (child := self._child) is not None:
            child.kill()
        with self._at_work:
            if self._child is not None:
                self._end(self._child)

    def _started(self, function: Callable[..., Result]) -> subprocess.Popen[bytes] | Lost:
        """Start a child with the imports of ``function``, in a session of its own: Ctrl-C at the
        terminal is not for it. Return Lost where it did not come so far."""
        variables = dict(os.environ)
        one_thread(variables)
        child = self._child = subprocess.Popen(
            # The packages of this process, for any contents of its working folder.
            [sys.executable, "-P", "-c", START, str(int(1e9 * self.limits.memory_gb)), *sys.path],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            env=variables,
            start_new_session=True,
        )
        if self.closed:  # meanwhile
            child.kill()
        jobs, answers = _pipes(child)
        ready = b""
        with _Clock(child, START_S) as clock, contextlib.suppress(OSError):
            send(jobs, (function, spellings()))
            ready = receive(answers)
        if ready and not clock.late.is_set():
            return child
        return self._lost(child, f"no start within {START_S:g} s" if clock.late.is_set() else "")

    def _lost(self, child: subprocess.Popen[bytes], late: str) -> Lost:
        """Return why a child gave no answer; ``late`` is the exceeded time limit, in words."""
        with contextlib.suppress(subprocess.TimeoutExpired):
            child.wait(5.0)  # it is about to end by itself, which shows more than being killed
        code = self._end(child)
        if late:
            return Lost("timeout", late)
        return Lost("crashed", f"the engine ended its process ({_ending(code)})")

    def _end(self, child: subprocess.Popen[bytes]) -> int:
        """End a child, and return its exit code; the next job gets another."""
        self._child = None
        child.kill()
        code = child.wait()
        for pipe in _pipes(child):
            with contextlib.suppress(OSError):
                pipe.close()
        return code


class _Clock:
    """The time of a job: when it is over, the child is killed, and the job ``late``. While an
    engine compiles, `COMPILING_S` alone is the limit, and its time is left out of the job's."""

    def __init__(self, child: subprocess.Popen[bytes], limit_s: float) -> None:
        self.child, self.left_s, self.late = child, limit_s, threading.Event()

    def __enter__(self) -> Self:
        self._start(self.left_s)
        return self

    def __exit__(self, *raised: object) -> None:
        self._stop()

    def compiles(self, begins: bool) -> None:
        """Change from the time of the job to that of compiling, or back."""
        self._stop()
        if begins:
            self.left_s -= time.monotonic() - self.began
        self._start(COMPILING_S if begins else max(self.left_s, 0.0))

    def _start(self, limit_s: float) -> None:
        self.began = time.monotonic()
        self.timer = threading.Timer(limit_s, self._end)
        self.timer.daemon = True
        self.timer.start()

    def _stop(self) -> None:
        self.timer.cancel()
        self.timer.join()  # it may be at it, and must not kill the next job

    def _end(self) -> None:
        self.late.set()
        self.child.kill()


def _answer(stream: IO[bytes], clock: _Clock) -> ChildAnswer | None:
    """Return the answer to a job; None where the child ended without one."""
    while raw := receive(stream):
        answer: ChildAnswer = pickle.loads(raw)
        if answer[0] != COMPILING:
            return answer
        clock.compiles(bool(answer[1]))
    return None


def _unpacked(raised: bytes) -> Exception | None:
    """Return the exception of a job; None where that could not travel, or is not known here."""
    with contextlib.suppress(Exception):
        return cast(Exception, pickle.loads(raised))
    return None


def _pipes(child: subprocess.Popen[bytes]) -> tuple[IO[bytes], IO[bytes]]:
    """Return the streams of jobs and of answers."""
    assert child.stdin is not None
    assert child.stdout is not None
    return child.stdin, child.stdout


def _ending(code: int) -> str:
    if code >= 0:
        return f"exit code {code}"
    try:
        return f"signal {signal.Signals(-code).name}"
    except ValueError:
        return f"signal {-code}"


FEW = 4
"""Most items that are done in this process: a second process takes longer to start."""
Item = TypeVar("Item")
Answer = TypeVar("Answer")


def run_all(
    work: Callable[[Item], Result],
    items: Sequence[Item],
    jobs: int,
    limits: Limits,
    lost: Callable[[Item, Lost], Result],
    done: Callable[[Result], None] = lambda _: None,
    apart: bool = False,
) -> list[Result]:
    """Return ``work`` on all items, in their order; ``done`` is called with each of them.

    One job has no limits. Few items, or one job, are done in this process, unless they have to be
    ``apart``: other people's code may end the process without a word. ``lost`` gives the result of
    an item that ends the process which works on it, or takes too much; exceptions of ``work``,
    which another process can import, are raised here. 0 ``jobs``: one per processor.
    """
    if apart and jobs == 1:
        limits = Limits(MOST_S, MOST_GB)
    if not apart and ((jobs or processors()) == 1 or len(items) <= FEW):
        ends = ((index, work(item)) for index, item in enumerate(items))
    else:
        ends = as_they_end(partial(_one, work, lost), items, jobs, limits)
    return in_order(ends, done)


def in_order(
    ends: Generator[tuple[int, Result]], done: Callable[[Result], None] = lambda _: None
) -> list[Result]:
    """Return the results of `as_they_end` in the order of its items; ``done`` is called with each,
    as it ends, in this thread."""
    results: dict[int, Result] = {}
    with closing(ends):
        for index, result in ends:
            results[index] = result
            done(result)
    return [results[index] for index in sorted(results)]


def as_they_end(
    work: Callable[[Isolated[Answer], Item], Result],
    items: Sequence[Item],
    jobs: int,
    limits: Limits,
) -> Generator[tuple[int, Result]]:
    """Work on all items, begun in their order; yield index and result of each as it ends.

    ``work`` is called in a thread, with a child process that is that item's alone until it returns.
    When this is closed, or ``work`` raises, all children are ended at once.
    """
    number = min(jobs or processors(), len(items))
    children = [Isolated[Answer](limits) for _ in range(number)]
    free: SimpleQueue[Isolated[Answer]] = SimpleQueue()
    for child in children:
        free.put(child)

    def with_child(item: Item) -> Result:
        child = free.get()
        try:
            return work(child, item)
        finally:
            free.put(child)

    threads = ThreadPoolExecutor(max(number, 1))
    try:
        waiting = {threads.submit(with_child, item): index for index, item in enumerate(items)}
        for future in as_completed(waiting):
            yield waiting.pop(future), future.result()
    finally:
        threads.shutdown(wait=False, cancel_futures=True)
        for child in children:
            child.close()


def processors() -> int:
    """Return how many processors this process may use."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


def _one(
    work: Callable[[Item], Result],
    lost: Callable[[Item, Lost], Result],
    child: Isolated[Result],
    item: Item,
) -> Result:
    answer = child.call(work, item)
    if not isinstance(answer, Lost):
        return answer
    if answer.error is not None:
        raise answer.error
    return lost(item, answer)
