"""CC112: the reference knows the answer well enough to judge by it."""

from __future__ import annotations

import math

from reports.rules.base import Evidence, Finding

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
        for row in evidence.errors.rows:
            if row.kind != "total":
                continue  # shown, held to no limit
            key = row.tolerance
            share = row.pure_bound / evidence.limits[key].number
            share = math.inf if math.isnan(share) else share
            if share > worst:
                worst, name, limit = share, f"{key} of {row.body}", evidence.limits[key].number
        if worst <= SHARE:
            return Finding(
                self.id, "pass", f"reference within {worst:.1e} of the limits", worst, SHARE
            )
        text = f"reference not certain: {name} is known to {worst * limit:.2g}, limit {limit:.2g}"
        return Finding(self.id, "fail", text, worst, SHARE)
