"""CC105: the pins hold."""

from __future__ import annotations

from reports.judge.rules.base import Evidence, Finding, within


class GapWithin:
    id = "CC105"
    title = "pin gap"
    explanation = (
        "Two bodies that share a pin or a slider must not come apart: an open loop is "
        "another mechanism, however well the crank turns."
    )
    cure = (
        "Stiffen the joint (MuJoCo: solref, solimp; pymunk: iterations, error_bias), or "
        "shorten the step."
    )

    def check(self, evidence: Evidence) -> Finding | None:
        return within(self.id, evidence, "gap", "gap")
