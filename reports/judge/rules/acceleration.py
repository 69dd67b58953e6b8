"""CC108, CC114: the accelerations are right, as reported and as differenced."""

from __future__ import annotations

from reports.judge.rules.base import Evidence, Finding, within


class AccelerationReported:
    id = "CC108"
    title = "acceleration, reported"
    explanation = (
        "The accelerations that the engine reports, against the closed form at the "
        "instants that they belong to; an engine that reports none is not judged."
    )
    cure = "Use an integrator of higher order (MuJoCo: RK4), or shorten the step."

    def check(self, evidence: Evidence) -> Finding | None:
        return within(self.id, evidence, "acceleration", "acceleration")


class AccelerationDifferenced:
    id = "CC114"
    title = "acceleration, differenced"
    explanation = (
        "The error of the accelerations that second differences of the logged positions give."
    )
    cure = "Shorten the step; noise grows with 1/dt^2 and is part of the limit."

    def check(self, evidence: Evidence) -> Finding | None:
        return within(self.id, evidence, "acceleration", "acceleration-differenced", "differenced")
