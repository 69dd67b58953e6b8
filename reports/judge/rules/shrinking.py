"""CC110: the error shrinks with the step."""

from __future__ import annotations

from reports.judge.rules.base import Evidence, Finding, Level

FINE = ("shrinks", "at rounding")
BAD = ("grows", "diverges")


class ErrorShrinks:
    id = "CC110"
    title = "convergence"
    explanation = (
        "An error that stays when the step is halved twice is no discretisation error: "
        "the model converges to the wrong answer. Where the cell is gated an error that grows, or "
        "that is over the limit of the finer step, fails, as does a finer run that breaks down."
    )
    cure = (
        "A shorter step does not help; change what the engine models "
        "(MuJoCo: solref, solimp; pymunk: error_bias, iterations)."
    )

    def check(self, evidence: Evidence) -> Finding | None:
        seen = evidence.convergence
        if seen is None:
            return None
        steps = ", ".join(
            f"{error:.2g} {seen.unit} at dt {dt:.3g} s"
            for dt, error in zip(seen.dt_s, seen.error, strict=True)
        )
        words = seen.words + (f" {seen.unit}" if "floor" in seen.words else "")
        faults = [*seen.faults, *seen.over]
        level: Level = "pass" if seen.trend in FINE and not faults else "advice"
        if evidence.gated and (faults or seen.trend in BAD):
            level = "fail"
        text = "; ".join([f"{words} ({steps})", *faults])
        return Finding(self.id, level, text, seen.error[-1])
