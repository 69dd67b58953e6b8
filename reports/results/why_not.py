"""Why settings are not recommended, or only with caution, in words."""

from __future__ import annotations

import math
from collections.abc import Sequence

from models.errors import few
from reports.output.numbers import short
from reports.results.candidates import NOT_RUN, Candidate
from reports.results.lines import called

SHOWN = 3
"""Scenes that a sentence names; of more it gives the number."""


def nearest(choice: Sequence[Candidate], target: float) -> Candidate:
    """What reaches the target on most scenes, of those with the least error."""
    return max(choice, key=lambda c: (c.reaching(target), -c.worst_error, -_worst(c), -_cost(c)))


def nothing(best: Candidate, good: Sequence[Candidate], target: float) -> str:
    """Why nothing is recommended, where ``best`` comes nearest; ``good`` lack their times."""
    if good:
        names = ", ".join(dict.fromkeys(called(one.variant, one.drive) for one in good))
        return (
            f"{names} would do, but no cost is known of every scene: sweep again without "
            "--no-timing"
        )
    return f"nearest is {best.name}: {_shortfall(best, target)}"


def broken(one: Candidate, choice: Sequence[Candidate], target: float) -> str:
    """Where the same settings miss the target at a finer step; empty where they keep it.

    What was not run at a finer step says nothing.
    """
    finer = [
        c
        for c in choice
        if c.same_settings(one) and c.steps_per_turn > one.steps_per_turn and _missed(c, target)
    ]
    if not finer:
        return ""
    first = min(finer, key=lambda c: c.steps_per_turn)
    return f"not at {first.steps_told}: {few(_missed(first, target), SHOWN)}"


def _shortfall(one: Candidate, target: float) -> str:
    """On how many scenes, and what hinders the others; the nearest where it is on none."""
    if not one.reaching(target) and one.errors:
        scene = min(one.errors, key=lambda name: one.errors[name])
        return f"on no scene, {short(one.errors[scene])} on {scene} at best"
    missing = [f"{scene} {why}" for scene, why in one.faults.items() if why == NOT_RUN]
    rest = few([*_missed(one, target), *missing], SHOWN)
    return f"on {one.reaching(target)} of {one.scenes} scenes; {rest}"


def _missed(one: Candidate, target: float) -> list[str]:
    """The scenes that were run and miss the target, worst first, each with its error or fault."""
    failed = [f"{scene} {why}" for scene, why in one.faults.items() if why != NOT_RUN]
    over = sorted(((e, s) for s, e in one.errors.items() if e > target), reverse=True)
    return failed + [f"{scene} {short(error)}" for error, scene in over]


def _worst(one: Candidate) -> float:
    return max(one.errors.values(), default=math.inf)


def _cost(one: Candidate) -> float:
    """Time, infinite where it is not known."""
    return one.s_per_turn if math.isfinite(one.s_per_turn) else math.inf
