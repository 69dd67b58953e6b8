"""CC110, CC118, CC125: the error shrinks with the step, and is continuous from sample to sample."""

from dataclasses import replace

from reports.compare.errors import Errors
from reports.judge.rules.rule import Evidence, Finding, Level, measure
from reports.judge.three_steps import Convergence
from reports.quantities import named

FINE = ("shrinks", "at rounding", "as solved", "as the reference")
BAD = ("grows", "diverges")
SOFT = 1e-4
"""Part of a force that MuJoCo's stiffest documented impedance (0.9999) leaves open."""


class ErrorShrinks:
    id = "CC110"
    title = "convergence"
    explanation = (
        "An error that remains when the step is halved twice is no discretisation error: the "
        "model converges to the wrong answer. A gated cell fails if the error grows or exceeds "
        "the limit of the finer step, or if a finer run breaks down."
    )
    cure = (
        "A shorter step does not help; change the model of the engine: stiffness of joints, sweeps "
        "over them (its settings)."
    )

    def check(self, evidence: Evidence) -> Finding | None:
        return _seen(self.id, evidence.convergence, evidence)


class ForcesShrink:
    id = "CC125"
    title = "convergence of forces"
    explanation = (
        "As CC110, for the worst reaction, normal force, moment or torque: forces follow "
        "accelerations, of which a soft constraint leaves a share open at every step."
    )
    cure = (
        "Check the instant of the forces: half a step is an error of first order. A floor comes "
        "from soft constraints: stiffen them."
    )

    def check(self, evidence: Evidence) -> Finding | None:
        """Pass a floor below the part that a soft constraint leaves open."""
        finding = _seen(self.id, evidence.force_convergence, evidence)
        if finding and finding.level == "advice" and (finding.number or 0.0) <= SOFT:
            return replace(finding, level="pass")
        return finding


def _seen(rule: str, convergence: Convergence | None, evidence: Evidence) -> Finding | None:
    """Return the finding on three steps: a floor is advice, growth a failure."""
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


DENSE_RAD = 0.04
"""The longest step, of about 160 a turn, at which an error is followed closely enough."""
CLEAR = 10.0
"""Least pure error above rounding within the engine, over the engine's floor."""
UNSURE = 100.0
"""Least ratio of an error to the uncertainty of the reference."""
MOST = 1.0
"""Largest ratio of the second difference of an error to the error. For independent numbers it is
over 2; for runs that hold, on every shipped scene and 60 random ones, under 0.05."""


class ErrorSmooth:
    id = "CC118"
    title = "smooth"
    explanation = (
        "The error of an engine grows and falls over many steps. One that jumps to and fro between "
        "two samples is rounding or noise in the log."
    )
    cure = (
        "Log every digit; look for noise added to the numbers, and for joints whose solver "
        "stops too soon (use profile tuned)."
    )

    def check(self, evidence: Evidence) -> Finding | None:
        errors = evidence.errors
        if errors is None or evidence.status != "ok" or errors.of_scene.step_rad > DENSE_RAD:
            return None
        if errors.of_scene.facets is not None:  # a follower bounces at each corner
            return None
        found = _roughest(errors)
        if found is None:
            return None
        rough, text = found
        if rough <= MOST:
            return Finding(
                self.id, "pass", "errors change smoothly from sample to sample", rough, MOST
            )
        text = f"{text}, and jumps by {rough:.2g} times that from sample to sample"
        return Finding(self.id, "fail", text, rough, MOST)


def _roughest(errors: Errors) -> tuple[float, str] | None:
    """Return the largest second difference over its error, and that error in words."""
    bent = {
        (row.body_kind, row.body): row.pure * errors.of_scene.step_rad**2
        for row in errors.rows
        if (row.quantity, row.source, row.kind) == ("acceleration", "differenced", "total")
        and row.finite
    }
    ratios = [
        (bent[row.body_kind, row.body] / row.pure, row)
        for row in errors.rows
        if row.quantity in named("place")
        and row.kind == "total"
        and row.pure >= CLEAR * errors.of_scene.floor + UNSURE * row.pure_bound
        and (row.body_kind, row.body) in bent
    ]
    if not ratios:
        return None
    rough, row = max(ratios, key=lambda each: each[0])
    return rough, f"{row.body_kind} {row.body}: {row.quantity} is off by {measure(row)}"
