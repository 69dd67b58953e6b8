"""CC110: the error shrinks with the step."""

from __future__ import annotations

from reports.rules.base import Evidence, Finding, Level

FINE = ("shrinks", "at rounding")


class ErrorShrinks:
    id = "CC110"
    title = "convergence"
    explanation = (
        "An error that stays when the step is halved twice is no discretisation error: "
        "the model converges to the wrong answer."
    )
    cure = (
        "A shorter step does not help; change what the engine models "
        "(MuJoCo: solref, solimp; pymunk: error_bias, iterations); profile tuned does it."
    )

    def check(self, evidence: Evidence) -> Finding | None:
        seen = evidence.convergence
        if seen is None:
            return None
        steps = ", ".join(
            f"{error:.2g} {seen.unit} at dt {dt:.3g} s"
            for dt, error in zip(seen.dt_s, seen.error, strict=True)
        )
        level: Level = "pass" if seen.trend in FINE else "advice"
        words = seen.words + (f" {seen.unit}" if "floor" in seen.words else "")
        return Finding(self.id, level, f"{words} ({steps})", seen.error[-1])
