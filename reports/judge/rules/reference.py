"""CC111, CC112: the reference is another computation than the engine's, and sure enough."""

from __future__ import annotations

import math
from collections.abc import Iterator

from reports.compare.errors import Errors
from reports.judge.rules.rule import Evidence, Finding
from reports.quantities import named

LEAST_SAMPLES = 8
PLACES = named("place")
SHARE = 0.1
"""The reference may be wrong by this share of the limit it is used for."""


class TwoComputations:
    id = "CC111"
    title = "two computations"
    explanation = (
        "Two independent computations never agree to the last bit over a whole run; "
        "where they do, the reference has been compared with itself."
    )
    cure = "Look where the adapter takes its numbers from; it must read the engine."

    def check(self, evidence: Evidence) -> Finding | None:
        if evidence.errors is None:
            return None
        rows = [
            row
            for row in evidence.errors.rows
            if row.quantity in PLACES and row.kind == "total" and row.samples >= LEAST_SAMPLES
        ]
        if not rows:
            return None
        largest = max(row.pure for row in rows)
        if largest == 0.0:
            text = "every position equals the reference to the last bit"
            return Finding(self.id, "fail", text, 0.0, 0.0)
        return Finding(self.id, "pass", "engine and reference differ in rounding at least", largest)


class ReferenceCertain:
    id = "CC112"
    title = "reference certain"
    explanation = (
        "The reference carries a bound of its own error; near a singular position that grows, "
        "and a limit below it can not be judged."
    )
    cure = "Keep away from the toggle position, or widen the tolerance that is named."

    def check(self, evidence: Evidence) -> Finding | None:
        if evidence.errors is None:
            return None
        worst, name, limit = 0.0, "", 0.0
        for key, body, bound in _bounds(evidence.errors):
            share = bound / evidence.limits[key].number
            share = math.inf if math.isnan(share) else share
            if share > worst:
                worst, name, limit = share, f"{key} of {body}", evidence.limits[key].number
        if worst <= SHARE:
            return Finding(
                self.id, "pass", f"reference within {worst:.1e} of the limits", worst, SHARE
            )
        text = f"reference not certain: {name} is known to {worst * limit:.2g}, limit {limit:.2g}"
        return Finding(self.id, "fail", text, worst, SHARE)


def _bounds(errors: Errors) -> Iterator[tuple[str, str, float]]:
    """Tolerance, body and pure bound: of the reference at every sample, whatever the engine
    reports, and of what the errors were worked out from."""
    for (quantity, body), bound in errors.uncertain.items():
        yield quantity, body, bound
    for row in errors.rows:
        if row.kind == "total":  # the others are shown, or held to limits of their own
            yield row.tolerance, row.body, row.pure_bound
