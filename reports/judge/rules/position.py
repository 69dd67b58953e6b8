"""CC113: the pins are where they should be."""

from __future__ import annotations

from reports.judge.rules.base import Evidence, Finding, within


class PositionWithin:
    id = "CC113"
    title = "position"
    explanation = "The place of every named point against the closed form."
    cure = "Shorten the step (--steps-per-turn)."

    def check(self, evidence: Evidence) -> Finding | None:
        return within(self.id, evidence, "position", "position")
