"""CC103: the links point where they should."""

from __future__ import annotations

from reports.judge.rules.base import Evidence, Finding, within


class AngleWithin:
    id = "CC103"
    title = "angle"
    explanation = (
        "The angle of every link but the driver against the closed form at the commanded time."
    )
    cure = (
        "Shorten the step (--steps-per-turn); where the error at the logged crank angle is "
        "small, mend the drive."
    )

    def check(self, evidence: Evidence) -> Finding | None:
        return within(self.id, evidence, "angle", "angle")
