"""CC118: the error of a place goes on from sample to sample, as an engine's does."""

from __future__ import annotations

from reports.compare.errors import Errors
from reports.judge.rules.rule import Evidence, Finding, measure
from reports.judge.three_steps import AT_ROUNDING
from reports.quantities import named

DENSE_RAD = 0.04
"""The longest step, of about 160 a turn, at which an error is followed closely enough."""
CLEAR = 10.0 * AT_ROUNDING
"""A pure error that is not made of rounding within the engine."""
UNSURE = 100.0
"""How far over what the reference may be wrong by an error has to be as well."""
MOST = 1.0
"""The most that the second difference of an error may be of the error itself. Of independent
numbers it is over 2; of runs that hold, on every shipped scene and 60 random ones, under 0.05."""


class ErrorSmooth:
    id = "CC118"
    title = "smooth"
    explanation = (
        "The error of an engine grows and falls over many steps. One that jumps to and fro between "
        "two samples is rounding or noise in the log, whatever is below it."
    )
    cure = (
        "Log every digit; look for what is added to the numbers, and for joints that the solver "
        "does not come to an end with."
    )

    def check(self, evidence: Evidence) -> Finding | None:
        errors = evidence.errors
        if errors is None or evidence.status != "ok" or errors.of_scene.step_rad > DENSE_RAD:
            return None
        found = _roughest(errors)
        if found is None:
            return None
        rough, text = found
        if rough <= MOST:
            return Finding(self.id, "pass", "errors go on from sample to sample", rough, MOST)
        text = f"{text}, and jumps by {rough:.2g} times that from sample to sample"
        return Finding(self.id, "fail", text, rough, MOST)


def _roughest(errors: Errors) -> tuple[float, str] | None:
    """The largest second difference over the error that it is of, and that error in words."""
    bent = {
        (row.body_kind, row.body): row.pure * errors.of_scene.step_rad**2
        for row in errors.rows
        if (row.quantity, row.source, row.kind) == ("acceleration", "differenced", "total")
        and row.finite
    }
    ratios = [
        (bent[row.body_kind, row.body] / row.pure, row)
        for row in errors.rows
        if row.quantity in named("place")
        and row.kind == "total"
        and row.pure >= CLEAR + UNSURE * row.pure_bound
        and (row.body_kind, row.body) in bent
    ]
    if not ratios:
        return None
    rough, row = max(ratios, key=lambda each: each[0])
    return rough, f"{row.body_kind} {row.body}: {row.quantity} is off by {measure(row)}"
