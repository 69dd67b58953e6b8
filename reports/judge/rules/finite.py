"""CC109: every logged number is a number."""

from __future__ import annotations

from reports.judge.rules.base import Evidence, Finding


class ValuesFinite:
    id = "CC109"
    title = "finite values"
    explanation = (
        "A NaN or an infinity in a log is a failure, even at one sample, even at the end; so is a "
        "link, point, slider or pin of the scene that the log says nothing about."
    )
    cure = (
        "Shorten the step; look at the engine's warnings for the first bad step; where something "
        "is missing, look at what the adapter reads."
    )

    def check(self, evidence: Evidence) -> Finding | None:
        if evidence.errors is None:
            return None
        broken = [row for row in evidence.errors.rows if not row.finite]
        if evidence.errors.missing:
            text = f"missing from the log: {', '.join(evidence.errors.missing)}"
            return Finding(self.id, "fail", text, float(len(broken)), 0.0)
        if not broken:
            return Finding(self.id, "pass", "every logged number is finite")
        first = min(broken, key=lambda row: row.time_of_maximum_s)
        bodies = ", ".join(dict.fromkeys(f"{row.quantity} of {row.body}" for row in broken[:4]))
        text = f"not finite from t = {first.time_of_maximum_s:.4g} s on: {bodies}"
        return Finding(self.id, "fail", text, float(len(broken)), 0.0)
