"""CC106, CC107: the rates are right, as reported and as differenced."""

from __future__ import annotations

from reports.judge.rules.base import Evidence, Finding, within


class VelocityReported:
    id = "CC106"
    title = "velocity, reported"
    explanation = (
        "The velocities that the engine reports, against the closed form at the instants "
        "that they belong to (some engines log them half a step away from the positions)."
    )
    cure = "Use the differenced velocities, or shorten the step."

    def check(self, evidence: Evidence) -> Finding | None:
        return within(self.id, evidence, "velocity", "velocity")


class VelocityDifferenced:
    id = "CC107"
    title = "velocity, differenced"
    explanation = (
        "The error of the velocities that central differences of the logged positions give."
    )
    cure = (
        "Shorten the step; an error of the position that jumps from step to step shows here first."
    )

    def check(self, evidence: Evidence) -> Finding | None:
        return within(self.id, evidence, "velocity", "velocity-differenced", "differenced")
