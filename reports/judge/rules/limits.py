"""The rules that hold a quantity to its limit: one for each criterion of the quantities."""

from __future__ import annotations

import math
from dataclasses import dataclass

from reports.compare.errors import Error
from reports.judge.rules.rule import Evidence, Finding, Level, measure, place, share
from reports.judge.tolerance import Limit, in_passage
from reports.quantities import QUANTITIES
from reports.quantities.quantity import Criterion, tolerance_name


@dataclass(frozen=True, kw_only=True)
class Within(Criterion):
    """The largest error of a quantity is within its limit; one that is not finite fails."""

    quantity: str

    def check(self, evidence: Evidence) -> Finding | None:
        """Rates near a change point are held to theirs, and what takes the larger share is told."""
        errors, tolerance = evidence.errors, tolerance_name(self.quantity, self.source)
        limit = evidence.limits.get(tolerance)
        if errors is None or limit is None:
            return None
        worst = errors.worst(self.quantity, self.source)
        passing = errors.worst(self.quantity, self.source, "passage")
        if passing is not None:
            wide = in_passage(tolerance, limit, errors)
            if worst is None or _part(passing, wide) > _part(worst, limit):
                worst, limit = passing, wide
        if worst is None:
            return None
        level: Level = "pass" if worst.pure <= limit.number else "fail"
        at_crank = errors.worst(self.quantity, self.source, "geometric")
        geometric = f"; {measure(at_crank)} at the logged crank angle" if at_crank else ""
        raw = errors.worst(self.quantity, self.source, "raw")
        before = f" over the sensitivity; {measure(raw)} as it is" if raw else ""
        number = f"{limit.number:.2g} {share(worst)} ({limit.origin})"
        text = f"{place(worst)}{before}{geometric}; limit {number}"
        return Finding(self.id, level, text, worst.pure, limit.number)


def _part(error: Error, limit: Limit) -> float:
    """What an error takes of a limit; infinite for one that is not finite."""
    return error.pure / limit.number if error.finite else math.inf


LIMITS = tuple(
    Within(quantity=name, **vars(each))
    for name, entry in QUANTITIES.items()
    for each in entry.criteria
)
