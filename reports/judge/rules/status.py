"""CC101: the run came to its end."""

from __future__ import annotations

from reports.judge.rules.base import Evidence, Finding


class StatusOk:
    id = "CC101"
    title = "status"
    explanation = "A run that stopped early, or never started, says nothing about the rest."
    cure = (
        "What is unsupported says itself what to change; a run that came apart needs a shorter "
        "step (--steps-per-turn); one that left its branch needs lengths, or a range of the "
        "driver, away from the singular position that it passes."
    )

    def check(self, evidence: Evidence) -> Finding | None:
        if evidence.status == "ok":
            return Finding(self.id, "pass", "the run came to its end")
        reason = f": {evidence.reason}" if evidence.reason else ""
        early = evidence.stopped_at_s > 0.0 and evidence.status != "branch-changed"
        at = f" at t = {evidence.stopped_at_s:.4g} s" if early else ""
        return Finding(self.id, "fail", f"{evidence.status}{at}{reason}")
