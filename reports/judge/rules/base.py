"""What a rule is, what it sees, and what it says."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal, Protocol

from reports.compare.errors import Error, Errors, Quantity, Source
from reports.judge.three_steps import Convergence
from reports.judge.tolerance import Limit, in_passage

Level = Literal["pass", "advice", "fail"]


@dataclass(frozen=True)
class Evidence:
    """All that is known of one cell: how the run ended, its errors, the limits in force.

    ``errors`` is None where nothing was logged, ``convergence`` where it was not asked for; a
    cell that is not ``gated`` is shown only. ``mass_ratio`` is the heaviest body over the lightest.
    """

    status: str
    reason: str
    stopped_at_s: float
    errors: Errors | None
    limits: Mapping[str, Limit]
    convergence: Convergence | None = None
    gated: bool = True
    profile: str = ""
    mass_ratio: float = 1.0


@dataclass(frozen=True)
class Finding:
    """What one rule says of one cell: in words, and as a number against its limit.

    ``cure`` is what would help this cell, "" where nothing has to.
    """

    rule: str
    level: Level
    text: str
    number: float | None = None
    limit: float | None = None
    cure: str = ""


class Rule(Protocol):
    """One check with an ID, a title, why it matters, and what to do when it fails."""

    id: str
    title: str
    explanation: str
    cure: str

    def check(self, evidence: Evidence) -> Finding | None:
        """The finding, or None where the rule has nothing to look at."""
        ...


def within(
    rule: str, evidence: Evidence, quantity: Quantity, tolerance: str, source: Source = "reported"
) -> Finding | None:
    """Hold the largest error of a quantity to its limit; an error that is not finite fails.

    Rates near a change point are held to theirs, and what takes the larger share is told.
    """
    if evidence.errors is None:
        return None
    limit = evidence.limits[tolerance]
    worst = evidence.errors.worst(quantity, source)
    passing = evidence.errors.worst(quantity, source, "passage")
    if passing is not None:
        wide = in_passage(tolerance, limit, evidence.errors)
        if worst is None or _share(passing, wide) > _share(worst, limit):
            worst, limit = passing, wide
    if worst is None:
        return None
    level: Level = "pass" if worst.pure <= limit.number else "fail"
    at_crank = evidence.errors.worst(quantity, source, "geometric")
    geometric = f"; {measure(at_crank)} at the logged crank angle" if at_crank else ""
    number = f"{limit.number:.2g} {SCALES[worst.unit]} ({limit.origin})"
    text = f"{place(worst)}{geometric}; limit {number}"
    return Finding(rule, level, text, worst.pure, limit.number)


def _share(error: Error, limit: Limit) -> float:
    """What an error takes of a limit; infinite for one that is not finite."""
    return error.pure / limit.number if error.finite else math.inf


SCALES = {
    "rad": "rad",
    "m": "L",
    "rad/s": "w",
    "m/s": "w L",
    "rad/s^2": "w^2",
    "m/s^2": "w^2 L",
}
"""What a pure number of a unit is a multiple of: L the longest link, w the driver's peak speed."""


def measure(error: Error) -> str:
    """The size of an error in its unit, and over its scale where that is another number."""
    size = f"{error.maximum:.3g} {error.unit}"
    return size if error.unit == "rad" else f"{size} = {error.pure:.3g} {SCALES[error.unit]}"


def place(error: Error) -> str:
    """An error in words: body, size, and where it is largest."""
    degrees = math.degrees(error.driver_at_maximum_rad)
    return (
        f"{error.body_kind} {error.body}: {measure(error)} at t = {error.time_of_maximum_s:.4g} s, "
        f"driver {degrees:.1f} deg"
    )
