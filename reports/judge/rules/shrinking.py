"""CC110: the error shrinks with the step."""

from __future__ import annotations

from reports.judge.rules.rule import Evidence, Finding, Level

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
        convergence = evidence.convergence
        if convergence is None:
            return None
        steps = ", ".join(
            f"{error:.2g} {convergence.unit} at dt {dt:.3g} s"
            for dt, error in zip(convergence.dt_s, convergence.error, strict=True)
        )
        words = convergence.words + (f" {convergence.unit}" if "floor" in convergence.words else "")
        faults = [*convergence.faults, *convergence.over]
        level: Level = "pass" if convergence.trend in FINE and not faults else "advice"
        if evidence.gated and (faults or convergence.trend in BAD):
            level = "fail"
        text = "; ".join([f"{words} ({steps})", *faults])
        return Finding(self.id, level, text, convergence.error[-1])
