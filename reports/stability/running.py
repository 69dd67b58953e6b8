"""Run the catalogue: every case in every engine and profile, each run in a process apart; and
search the value up to which each holds a case.
"""

import math
from collections.abc import Callable, Generator, Sequence
from contextlib import closing
from dataclasses import dataclass, replace

from models.errors import CrankcheckError
from reports.stability.case import Case
from reports.stability.grading import CATALOGUE, GradedPicture, graded
from reports.stability.matrix import CaseFacts, Critical, Graded, OfLine, Picture, label
from reports.workers.isolated import Isolated, Limits, Lost, as_they_end, in_order

LOOKS = 7
"""Most runs of a bisection: a factor of 10 is then known to 2 %."""
NEAR = 0.05
"""Relative distance of good and bad values at which the search ends."""
Grader = Callable[[float, bool], Graded]


def line(case: Case, grade: Grader) -> Generator[Graded]:
    """Yield all runs of one engine with one profile: the case's values, then the bisection.

    Parameters
    ----------
    grade : Callable
        The run at a value; True for a value of the grid.
    """
    runs = []
    for value in case.values:
        runs.append(grade(value, True))
        yield runs[-1]
    for _ in range(LOOKS):
        holds, fails = _bracket(case, runs)
        middle = between(case, holds.value, fails.value) if holds and fails else None
        if middle is None:
            return
        runs.append(grade(middle, False))
        yield runs[-1]


def _bracket(case: Case, runs: Sequence[Graded]) -> tuple[Graded | None, Graded | None]:
    """Return the hardest run that holds, with all easier ones, and the easiest that does not."""

    def hardness(run: Graded) -> float:
        return harder(case) * run.value

    fails = min((r for r in runs if r.outcome not in case.good), key=hardness, default=None)
    easier = [run for run in runs if fails is None or hardness(run) < hardness(fails)]
    return max(easier, key=hardness, default=None), fails


def between(case: Case, holds: float, fails: float) -> float | None:
    """Return the next value to run; None where the two are near enough, or nothing lies between."""
    if case.scale == "linear":
        width = max(case.values) - min(case.values)
        return None if abs(fails - holds) <= NEAR * width else _short(0.5 * (holds + fails))
    if holds <= 0.0 or fails <= 0.0 or abs(fails / holds - 1.0) <= NEAR:
        return None
    middle = math.sqrt(holds * fails)
    middle = float(round(middle)) if case.scale == "whole" else _short(middle)
    return None if middle in (holds, fails) else middle


def _short(value: float) -> float:
    """Round a value to its label, so that the shown command repeats it."""
    return float(label(value))


def critical(case: Case, runs: list[Graded]) -> Critical:
    """Return how far the runs of one line hold, in the order in which `line` gave them."""
    holds, fails = _bracket(case, runs)
    shown = fails or holds or runs[0]
    good = [run for run in runs if run.outcome in case.good]
    return Critical(
        case=case.name,
        engine=shown.engine,
        profile=shown.profile,
        holds=math.nan if holds is None else holds.value,
        fails=math.nan if fails is None else fails.value,
        outcome=shown.outcome,
        words=_words(case, holds, fails, good),
        command=command(shown),
    )


def command(run: Graded) -> str:
    """Return the command that repeats a run alone."""
    return (
        f"crankcheck stability {run.case} --engine {run.engine} --profile {run.profile} "
        f"--at {run.label}"
    )


def _words(case: Case, holds: Graded | None, fails: Graded | None, good: list[Graded]) -> str:
    """Return the critical value in a line; ``good`` are all runs that held."""
    if fails is None:
        assert holds is not None
        if holds.outcome not in ("ok", "locked"):
            return holds.outcome
        worst = max(run.error for run in good)
        if len(good) == 1:
            return "holds"
        return f"holds all, error up to {worst:.0e}" if worst else "holds all"
    if holds is None:
        if good:
            number = sum(run.grid for run in good)
            return f"{fails.outcome} at {label(fails.value)}, holds {number} of {len(case.values)}"
        return f"{fails.outcome} at once" if len(case.values) > 1 else fails.outcome
    way = "down to" if harder(case) < 0.0 else "up to"
    value = f"{label(holds.value)} {case.unit}".strip()
    return f"holds {way} {value}, then {fails.outcome}"


def harder(case: Case | CaseFacts) -> float:
    """Return the sign by which the values of a case grow harder."""
    return -1.0 if case.values[-1] < case.values[0] else 1.0


LIMIT_S = 120.0
MEMORY_GB = 4.0


@dataclass(frozen=True)
class CaseLine(OfLine):
    """A line with its ``forces`` or without."""

    forces: bool = False


@dataclass(frozen=True)
class Held:
    """Result of a line: its runs, how far it holds, and pictures of failed runs."""

    line: CaseLine
    runs: tuple[Graded, ...]
    critical: Critical
    pictures: tuple[Picture, ...]


def run_lines(
    lines: Sequence[CaseLine], jobs: int, limits: Limits, done: Callable[[Held], None]
) -> list[Held]:
    """Run the lines, several at a time, the longest first; return them in the order of ``lines``.

    ``done`` is called with each as it ends, in this thread.
    """
    longest = sorted(lines, key=lambda line: -_work(CATALOGUE[line.case]))
    every = in_order(as_they_end(_line, longest, jobs, limits), done)
    return sorted(every, key=lambda held: lines.index(held.line))


def run_one(given: CaseLine, value: float, limits: Limits) -> Graded:
    """Return one run in a process apart. Raises CrankcheckError where it cannot be run."""
    with closing(Isolated[GradedPicture](limits)) as child:
        return _graded(given, value, child, grid=False)[0]


def _work(case: Case) -> int:
    """Return the steps of a line, roughly."""
    return sum(case.trial(value).steps for value in case.values)


def _line(child: Isolated[GradedPicture], given: CaseLine) -> Held:
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
    """Return a run of the child process, with its picture if it belongs to the grid; one that its
    process did not survive has crashed.

    Raises CrankcheckError for a run without a reference, or a request that the engine can not take:
    these are no faults of the engine.
    """
    answer = child.call(graded_by_name, given, value, grid)
    if not isinstance(answer, Lost):
        found, drawn = answer
        return replace(found, grid=grid), drawn
    if isinstance(answer.error, CrankcheckError):
        raise CrankcheckError(f"case {given.case} at {label(value)}: {answer.error}")
    trial = CATALOGUE[given.case].trial(value)
    lost = Graded(*given.line, value, label(value), "crashed", answer.reason, grid=grid)
    return replace(lost, steps=trial.steps, dt_s=trial.dt_s), None


def graded_by_name(given: CaseLine, value: float, draw: bool) -> GradedPicture:
    """Grade as `grading.graded`, by the name of the case: little travels to the child process."""
    case = CATALOGUE[given.case]
    return graded(case, given.engine, given.profile, value, draw=draw, forces=given.forces)
