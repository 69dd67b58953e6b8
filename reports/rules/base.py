"""What a rule is, what it sees, and what it says."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal, Protocol

from reports.convergence import Convergence
from reports.errors import Error, Errors, Quantity, Source
from reports.tolerance import Limit

Level = Literal["pass", "advice", "fail"]


@dataclass(frozen=True)
class Evidence:
    """All that is known of one cell: how the run ended, its errors, the limits in force.

    ``errors`` is None where nothing was logged, ``convergence`` where it was not asked for.
    """

    status: str
    reason: str
    stopped_at_s: float
    errors: Errors | None
    limits: Mapping[str, Limit]
    convergence: Convergence | None = None


@dataclass(frozen=True)
class Finding:
    """What one rule says of one cell: in words, and as a number against its limit."""

    rule: str
    level: Level
    text: str
    number: float | None = None
    limit: float | None = None


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
    """Hold the largest error of a quantity to its limit; an error that is not finite fails."""
    worst = evidence.errors.worst(quantity, source) if evidence.errors else None
    if worst is None:
        return None
    limit = evidence.limits[tolerance]
    level: Level = "pass" if worst.pure <= limit.number else "fail"
    same = evidence.errors.worst(quantity, source, "geometric") if evidence.errors else None
    crank = f"; at the logged crank angle {same.maximum:.3g} {same.unit}" if same else ""
    text = f"{place(worst)}{crank}; limit {limit.number:.2g} ({limit.origin})"
    return Finding(rule, level, text, worst.pure, limit.number)


def place(error: Error) -> str:
    """An error in words: body, size in its unit and as a pure number, where it is largest."""
    degrees = error.driver_at_maximum_rad * 57.29577951308232
    size = f"{error.maximum:.3g} {error.unit}"
    if error.unit != "rad":
        size += f" ({error.pure:.3g})"
    return (
        f"{error.body_kind} {error.body}: {size} at t = {error.time_of_maximum_s:.4g} s, "
        f"driver {degrees:.1f} deg"
    )
