"""CC124: the forces in a pin add up to nothing."""

from __future__ import annotations

from reports.judge.rules.rule import Evidence, Finding, Level

ROUNDING = 1e-9
"""A share of the largest reaction that sums of a few forces are never rounded by."""


class PinsBalance:
    id = "CC124"
    title = "balance of pins"
    explanation = (
        "A pin has no mass: what it exerts on its bodies adds up to nothing, however the engine "
        "steps. Where it does not, one of the forces is not the pin's."
    )
    cure = (
        "Look at which bodies the adapter adds up; what one body exerts on the other is the "
        "opposite of what it bears."
    )

    def check(self, evidence: Evidence) -> Finding | None:
        found = evidence.errors.of_forces.unbalanced if evidence.errors else None
        if found is None:
            return None
        level: Level = "pass" if found.share <= ROUNDING else "fail"
        text = (
            f"forces in pin {found.point} add up to {found.share:.2g} of the largest reaction; "
            f"limit {ROUNDING:.2g}"
        )
        return Finding(self.id, level, text, found.share, ROUNDING)
