"""How far an engine holds a case: the grid of values, then a bisection between good and bad."""

from __future__ import annotations

import math
from collections.abc import Callable, Generator, Sequence

from reports.stability.case import Case
from reports.stability.matrix import Critical, Graded, label

LOOKS = 7
"""Runs of a bisection at most: a factor of 10 is then known to 2 %."""
NEAR = 0.05
"""Good and bad this near to each other, relatively, are near enough."""
Grader = Callable[[float, bool], Graded]


def line(case: Case, grade: Grader) -> Generator[Graded]:
    """All runs of one engine with one profile: the case's values, then what a bisection looks at.

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
    """The hardest run that holds, with all that are easier, and the easiest that does not."""

    def hardness(run: Graded) -> float:
        return harder(case) * run.value

    fails = min((r for r in runs if r.outcome not in case.good), key=hardness, default=None)
    easier = [run for run in runs if fails is None or hardness(run) < hardness(fails)]
    return max(easier, key=hardness, default=None), fails


def between(case: Case, holds: float, fails: float) -> float | None:
    """The value to look at next; None where the two are near enough, or nothing lies between."""
    if case.scale == "linear":
        width = max(case.values) - min(case.values)
        return None if abs(fails - holds) <= NEAR * width else _short(0.5 * (holds + fails))
    if holds <= 0.0 or fails <= 0.0 or abs(fails / holds - 1.0) <= NEAR:
        return None
    middle = math.sqrt(holds * fails)
    middle = float(round(middle)) if case.scale == "whole" else _short(middle)
    return None if middle in (holds, fails) else middle


def _short(value: float) -> float:
    """A value that is what its label says, so that the command that is told repeats it."""
    return float(label(value))


def critical(case: Case, runs: list[Graded]) -> Critical:
    """How far the runs of one line hold; they are in the order in which `line` gave them."""
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
    """The command that repeats a run alone."""
    return (
        f"crankcheck stability {run.case} --engine {run.engine} --profile {run.profile} "
        f"--at {run.label}"
    )


def _words(case: Case, holds: Graded | None, fails: Graded | None, good: list[Graded]) -> str:
    """The critical value in a line; ``good`` are all runs that held."""
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


def harder(case: Case) -> float:
    """The sign by which the values of a case grow harder."""
    return -1.0 if case.values[-1] < case.values[0] else 1.0
