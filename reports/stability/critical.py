"""How far an engine holds a case: the grid of values, then a bisection between good and bad."""

from __future__ import annotations

import math
from collections.abc import Callable, Generator

from reports.stability.case import Case
from reports.stability.matrix import Critical, Graded, label

LOOKS = 7
"""Runs of a bisection at most: a factor of 10 is then known to 2 %."""
NEAR = 0.05
"""Good and bad this near to each other, relatively, are near enough."""
Grade = Callable[[float, bool], Graded]


def line(case: Case, grade: Grade) -> Generator[Graded]:
    """All runs of one engine with one profile: the case's values, then what a bisection looks at.

    Parameters
    ----------
    grade : Callable
        The run at a value; True for a value of the grid.
    """
    held: float | None = None
    failed: float | None = None
    for value in case.values:
        found = grade(value, True)
        yield found
        if failed is None and found.outcome in case.good:
            held = value
        elif failed is None:
            failed = value
    if held is None or failed is None:
        return
    for _ in range(LOOKS):
        middle = between(case, held, failed)
        if middle is None:
            return
        found = grade(middle, False)
        yield found
        if found.outcome in case.good:
            held = middle
        else:
            failed = middle


def between(case: Case, held: float, failed: float) -> float | None:
    """The value to look at next; None where the two are near enough, or nothing lies between."""
    if case.scale == "linear":
        width = max(case.values) - min(case.values)
        return None if abs(failed - held) <= NEAR * width else _short(0.5 * (held + failed))
    if held <= 0.0 or failed <= 0.0 or abs(failed / held - 1.0) <= NEAR:
        return None
    middle = math.sqrt(held * failed)
    middle = float(round(middle)) if case.scale == "whole" else _short(middle)
    return None if middle in (held, failed) else middle


def _short(value: float) -> float:
    """A value that is what its label says, so that the command that is told repeats it."""
    return float(label(value))


def critical(case: Case, runs: list[Graded]) -> Critical:
    """How far the runs of one line hold; they are in the order in which `line` gave them."""
    first, sign = runs[0], harder(case)
    bad = [run for run in runs if run.outcome not in case.good]
    good = [run for run in runs if run.outcome in case.good]
    fails = min(bad, key=lambda run: sign * run.value, default=None)
    held = [run for run in good if fails is None or sign * (fails.value - run.value) > 0.0]
    holds = max(held, key=lambda run: sign * run.value, default=None)
    shown = fails or holds or first
    return Critical(
        case=case.name,
        engine=first.engine,
        profile=first.profile,
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
        return f"holds all, error up to {worst:.0e}" if len(good) > 1 else "holds"
    if holds is None:
        if good:
            held = sum(run.grid for run in good)
            return f"{fails.outcome} at {label(fails.value)}, holds {held} of {len(case.values)}"
        return f"{fails.outcome} at once" if len(case.values) > 1 else fails.outcome
    way = "down to" if harder(case) < 0.0 else "up to"
    value = f"{label(holds.value)} {case.unit}".strip()
    return f"holds {way} {value}, then {fails.outcome}"


def harder(case: Case) -> float:
    """The sign by which the values of a case grow harder."""
    return -1.0 if case.values[-1] < case.values[0] else 1.0
