"""CC115: the log is whole: every commanded sample, at its time."""

from __future__ import annotations

from reports.judge.rules.base import Evidence, Finding


class LogComplete:
    id = "CC115"
    title = "complete log"
    explanation = (
        "A run that claims to have ended well has logged every commanded sample, stamped with "
        "the whole number of steps that it was taken after; what was not logged was not judged."
    )
    cure = "Look at how the adapter logs; the time stamps are start + k dt, not a summed clock."

    def check(self, evidence: Evidence) -> Finding | None:
        if evidence.status != "ok":
            return None  # short by its nature: the status fails already
        fault = "nothing was logged" if evidence.errors is None else evidence.errors.incomplete
        if fault:
            return Finding(self.id, "fail", fault)
        return Finding(self.id, "pass", "every commanded sample was logged at its time")
