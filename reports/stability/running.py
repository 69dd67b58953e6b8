"""Run the catalogue: every case in every engine and profile, each run in a process apart."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import closing
from dataclasses import dataclass, replace

from models.errors import CrankcheckError
from reports.stability.case import Case
from reports.stability.critical import critical, line
from reports.stability.grading import CATALOGUE, GradedPicture, graded
from reports.stability.matrix import Critical, Graded, Picture, label
from reports.workers.isolated import Isolated, Limits, Lost, as_they_end

LIMIT_S = 120.0
MEMORY_GB = 4.0


@dataclass(frozen=True)
class CaseLine:
    """A case in one engine with one profile, with its ``forces`` or without."""

    case: str
    engine: str
    profile: str
    forces: bool = False


@dataclass(frozen=True)
class Held:
    """What came of a line: its runs, how far it holds, and pictures of what failed."""

    line: CaseLine
    runs: tuple[Graded, ...]
    critical: Critical
    pictures: tuple[Picture, ...]


def run_lines(
    lines: Sequence[CaseLine], jobs: int, limits: Limits, done: Callable[[Held], None]
) -> list[Held]:
    """Run the lines, several at a time, the longest first; gives them in the order of ``lines``.

    ``done`` hears of each as it ends, in this thread.
    """
    order = sorted(range(len(lines)), key=lambda index: -_work(CATALOGUE[lines[index].case]))
    results: dict[int, Held] = {}
    with closing(as_they_end(_line, [lines[index] for index in order], jobs, limits)) as ends:
        for place, held in ends:
            results[order[place]] = held
            done(held)
    return [results[index] for index in range(len(lines))]


def run_one(given: CaseLine, value: float, limits: Limits) -> Graded:
    """One run in a process apart. Raises CrankcheckError where it cannot be asked for."""
    with closing(Isolated[GradedPicture](limits)) as child:
        return _graded(given, value, child, grid=False)[0]


def _work(case: Case) -> int:
    """The steps of a line, roughly."""
    return sum(case.trial(value).steps for value in case.values)


def _line(child: Isolated[GradedPicture], given: CaseLine) -> Held:
    """One line, run by run in a child process."""
    case = CATALOGUE[given.case]
    pictures: list[Picture] = []

    def grade(value: float, grid: bool) -> Graded:
        found, drawn = _graded(given, value, child, grid=grid)
        if drawn is not None:
            pictures.append(drawn)
        return found

    runs = list(line(case, grade))
    return Held(given, tuple(runs), critical(case, runs), tuple(pictures))


def _graded(
    given: CaseLine, value: float, child: Isolated[GradedPicture], *, grid: bool
) -> GradedPicture:
    """A run in the child process, with its picture where it is of the grid.

    What has no reference, or cannot be asked of the engine, is no fault of the engine: it raises
    CrankcheckError.
    """
    answer = child.call(graded_by_name, given, value, grid)
    if not isinstance(answer, Lost):
        found, drawn = answer
        return replace(found, grid=grid), drawn
    if isinstance(answer.error, CrankcheckError):
        raise CrankcheckError(f"case {given.case} at {label(value)}: {answer.error}")
    return _lost(given, value, answer, grid), None


def graded_by_name(given: CaseLine, value: float, draw: bool) -> GradedPicture:
    """As `grading.graded`, for a case by its name: what travels to the child process is small."""
    case = CATALOGUE[given.case]
    return graded(case, given.engine, given.profile, value, draw=draw, forces=given.forces)


def _lost(given: CaseLine, value: float, lost: Lost, grid: bool) -> Graded:
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
