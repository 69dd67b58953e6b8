"""CC111, CC112: the reference is another computation than the engine's, and sure enough."""

from __future__ import annotations

import math
from collections.abc import Iterator

from reports.compare.errors import Errors
from reports.judge.rules.rule import Evidence, Finding, measure
from reports.judge.too_good import highest_order, too_good
from reports.quantities import named

LEAST_SAMPLES = 8
PLACES = named("place")
SHARE = 0.1
"""The reference may be wrong by this share of the limit it is used for."""


class TwoComputations:
    id = "CC111"
    title = "two computations"
    explanation = (
        "Two independent computations never agree over a whole run: an engine that integrates is "
        "off by what its step leaves out, one that solves its joints rounds its rates in another "
        "way. Where a body agrees better, the reference has been compared with itself."
    )
    cure = (
        "Look where the adapter takes its numbers from; it must read the engine. One that solves "
        "its joints in each step declares placing solved."
    )

    def check(self, evidence: Evidence) -> Finding | None:
        errors = evidence.errors
        if errors is None:
            return None
        placing, order = evidence.placing, evidence.order
        found = too_good(errors, placing, order)
        rows = [
            row
            for row in errors.rows
            if row.quantity in PLACES and row.kind == "total" and row.samples >= LEAST_SAMPLES
        ]
        if not found and not rows:
            return None
        if rows and max(row.pure for row in rows) == 0.0:
            text = "every position equals the reference to the last bit"
            return Finding(self.id, "fail", text, 0.0, 0.0)
        if not found:
            text = "engine and reference differ by what tells them apart"
            return Finding(self.id, "pass", text, max(row.pure for row in rows))
        first = found[0]
        bodies = ", ".join(dict.fromkeys(f"{row.body_kind} {row.body}" for row in found))
        why = (
            f"what is integrated is off by step^{highest_order(errors, order)}"
            if placing == "integrated"
            else "rates are rounded in another way where they are worked out apart"
        )
        text = (
            f"{bodies}: {first.quantity} is off by {measure(first)} at most"
            f"{' at the logged crank angle' if first.kind == 'geometric' else ''}; {why}"
        )
        return Finding(self.id, "fail", text, first.pure)


class ReferenceCertain:
    id = "CC112"
    title = "reference certain"
    explanation = (
        "The reference carries a bound of its own error; near a singular position that grows, "
        "and a limit below it can not be judged."
    )
    cure = (
        "Keep away from the toggle position, take friction out of a joint that never turns, or "
        "widen the tolerance that is named."
    )

    def check(self, evidence: Evidence) -> Finding | None:
        if evidence.errors is None:
            return None
        worst, name, limit = 0.0, "", 0.0
        for key, body, bound in _bounds(evidence.errors):
            if key not in evidence.limits:
                continue
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
