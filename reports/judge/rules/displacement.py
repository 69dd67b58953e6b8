"""CC104: the sliders are where they should be."""

from __future__ import annotations

from reports.judge.rules.base import Evidence, Finding, within


class DisplacementWithin:
    id = "CC104"
    title = "displacement"
    explanation = "The displacement of every slider along its line against the closed form."
    cure = "Shorten the step (--steps-per-turn)."

    def check(self, evidence: Evidence) -> Finding | None:
        return within(self.id, evidence, "displacement", "displacement")
