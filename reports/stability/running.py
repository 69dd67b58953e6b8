"""Run the catalogue: every case in every engine and profile, each run in a process apart."""

from __future__ import annotations

import queue
from collections.abc import Callable, Sequence
from concurrent.futures import Future, ThreadPoolExecutor, as_completed
from dataclasses import dataclass, replace

from models.errors import CrankcheckError
from reports.stability.case import Case, label
from reports.stability.catalogue import CATALOGUE
from reports.stability.critical import critical, line
from reports.stability.grading import GradedPicture, graded
from reports.stability.matrix import Critical, Graded, Picture
from reports.workers.isolated import Isolated, Limits, Lost

LIMIT_S = 120.0
MEMORY_GB = 4.0


@dataclass(frozen=True)
class Line:
    """A case in one engine with one profile."""

    case: str
    engine: str
    profile: str


@dataclass(frozen=True)
class Held:
    """What came of a line: its runs, how far it holds, and pictures of what failed."""

    line: Line
    runs: tuple[Graded, ...]
    critical: Critical
    pictures: tuple[Picture, ...]


def run_lines(
    lines: Sequence[Line], jobs: int, limits: Limits, done: Callable[[Held], None]
) -> list[Held]:
    """Run the lines, several at a time, the longest first; gives them in the order of ``lines``.

    ``done`` hears of each as it ends, in this thread.
    """
    apart = [Isolated[GradedPicture | str](limits) for _ in range(max(min(jobs, len(lines)), 1))]
    free: queue.SimpleQueue[Isolated[GradedPicture | str]] = queue.SimpleQueue()
    for one in apart:
        free.put(one)
    pool = ThreadPoolExecutor(len(apart))
    waiting: dict[Future[Held], int] = {}
    found: dict[int, Held] = {}
    try:
        for index in sorted(range(len(lines)), key=lambda i: -_work(CATALOGUE[lines[i].case])):
            waiting[pool.submit(_line, lines[index], free)] = index
        for future in as_completed(waiting):
            held = future.result()
            found[waiting[future]] = held
            done(held)
    finally:
        for future in waiting:
            future.cancel()
        for one in apart:
            one.close()
        pool.shutdown()
    return [found[index] for index in range(len(lines))]


def run_one(given: Line, value: float, limits: Limits) -> Graded:
    """One run in a process apart. Raises CrankcheckError where it cannot be asked for."""
    isolated = Isolated[GradedPicture | str](limits)
    try:
        return _graded(given, value, isolated, grid=False)[0]
    finally:
        isolated.close()


def _work(case: Case) -> int:
    """The steps of a line, roughly."""
    return sum(case.trial(value).steps for value in case.values)


def _line(given: Line, free: queue.SimpleQueue[Isolated[GradedPicture | str]]) -> Held:
    """One line, in a child process that is free."""
    case, isolated = CATALOGUE[given.case], free.get()
    pictures: list[Picture] = []

    def grade(value: float, grid: bool) -> Graded:
        found, drawn = _graded(given, value, isolated, grid=grid)
        if drawn is not None:
            pictures.append(drawn)
        return found

    try:
        runs = list(line(case, grade))
    finally:
        free.put(isolated)
    return Held(given, tuple(runs), critical(case, runs), tuple(pictures))


def _graded(
    given: Line, value: float, isolated: Isolated[GradedPicture | str], *, grid: bool
) -> GradedPicture:
    """A run in the child process, with its picture where it is of the grid."""
    answer = isolated.call(graded_by_name, given.case, given.engine, given.profile, value, grid)
    if isinstance(answer, Lost):
        return _lost(given, value, answer, grid), None
    if isinstance(answer, str):
        raise CrankcheckError(f"case {given.case} at {label(value)}: {answer}")
    found, drawn = answer
    return replace(found, grid=grid), drawn


def graded_by_name(
    case: str, engine: str, profile: str, value: float, draw: bool
) -> GradedPicture | str:
    """As `grading.graded`, for a case by its name: what travels to the child process is small.

    What has no reference, or cannot be asked of the engine, is no fault of the engine: its message.
    """
    try:
        return graded(CATALOGUE[case], engine, profile, value, draw=draw)
    except CrankcheckError as error:
        return str(error)


def _lost(given: Line, value: float, lost: Lost, grid: bool) -> Graded:
    """A run that its process did not survive."""
    trial = CATALOGUE[given.case].trial(value)
    return Graded(
        case=given.case,
        engine=given.engine,
        profile=given.profile,
        value=value,
        label=label(value),
        outcome="crashed",
        reason=lost.reason,
        steps=trial.steps,
        dt_s=trial.dt_s,
        grid=grid,
    )
