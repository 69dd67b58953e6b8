"""CC111: the engine's answer is not the reference handed back."""

from __future__ import annotations

from reports.judge.rules.base import Evidence, Finding
from reports.quantities import named

LEAST_SAMPLES = 8
PLACES = named("place")


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
