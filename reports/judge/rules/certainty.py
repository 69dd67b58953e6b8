"""CC112: the reference knows the answer well enough to judge by it."""

from __future__ import annotations

import math
from collections.abc import Iterator

from reports.compare.errors import Errors
from reports.judge.rules.base import Evidence, Finding

SHARE = 0.1
"""The reference may be wrong by this share of the limit it is used for."""


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
