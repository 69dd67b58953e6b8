"""CC102: the crank is where it was told to be."""

from __future__ import annotations

from reports.judge.rules.base import Evidence, Finding, within


class DriveWithin:
    id = "CC102"
    title = "drive"
    explanation = (
        "Everything is compared at the commanded time: a crank that lags or leads spoils "
        "every other number."
    )
    cure = "Drive with --drive prescribed; a servo needs a higher gain, or a shorter step."

    def check(self, evidence: Evidence) -> Finding | None:
        return within(self.id, evidence, "drive", "drive")
