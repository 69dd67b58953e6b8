"""CC110, CC125: the error shrinks with the step, of places and of forces."""

from __future__ import annotations

from dataclasses import replace

from reports.judge.rules.rule import Evidence, Finding, Level
from reports.judge.three_steps import Convergence

FINE = ("shrinks", "at rounding", "as solved", "as the truth")
BAD = ("grows", "diverges")
SOFT = 1e-4
"""What MuJoCo's stiffest documented impedance (0.9999) leaves open of a force."""


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
        return _seen(self.id, evidence.convergence, evidence)


class ForcesShrink:
    id = "CC125"
    title = "convergence of forces"
    explanation = (
        "As CC110, of the worst reaction, normal force, moment or torque: forces go with "
        "accelerations, of which a soft constraint leaves a share open at every step."
    )
    cure = (
        "Look at which instant the forces belong to: half a step off is an error of first order. "
        "A floor is what soft constraints leave open (MuJoCo: solref, solimp)."
    )

    def check(self, evidence: Evidence) -> Finding | None:
        """A floor under what a soft constraint leaves open is no news."""
        finding = _seen(self.id, evidence.force_convergence, evidence)
        if finding and finding.level == "advice" and (finding.number or 0.0) <= SOFT:
            return replace(finding, level="pass")
        return finding


def _seen(rule: str, convergence: Convergence | None, evidence: Evidence) -> Finding | None:
    """What is seen of three steps: a floor is worth knowing, and growing a failure."""
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
    return Finding(rule, level, text, convergence.error[-1])
