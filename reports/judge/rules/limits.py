"""CC116 and the rules that compare a quantity with its limit, one for each criterion."""

import math
from dataclasses import dataclass

from reports.compare.errors import Error, Errors
from reports.judge.rules.rule import Evidence, Finding, Level, measure, place, share
from reports.judge.tolerance import Limit, in_passage
from reports.quantities import QUANTITIES
from reports.quantities.quantity import Criterion, tolerance_name
from sim.engine import Placing


@dataclass(frozen=True, kw_only=True)
class Within(Criterion):
    """The largest error of a quantity is within its limit; one that is not finite fails."""

    quantity: str

    def check(self, evidence: Evidence) -> Finding | None:
        """Compare with the limits, separate near a change point; report the larger share."""
        errors, tolerance = evidence.errors, tolerance_name(self.quantity, self.source)
        limit = evidence.limits.get(tolerance)
        if errors is None or limit is None:
            return None
        worst = errors.worst(self.quantity, self.source)
        passing = errors.worst(self.quantity, self.source, "passage")
        if passing is not None:
            wide = in_passage(tolerance, limit, errors)
            if worst is None or _part(passing, wide) > _part(worst, limit):
                worst, limit = passing, wide
        if worst is None:
            return None
        level: Level = "pass" if worst.pure <= limit.number else "fail"
        at_crank = errors.worst(self.quantity, self.source, "geometric")
        geometric = f"; {measure(at_crank)} at the logged crank angle" if at_crank else ""
        raw = errors.worst(self.quantity, self.source, "raw")
        before = f" over the sensitivity; {measure(raw)} as it is" if raw else ""
        number = f"{limit.number:.2g} {share(worst)} ({limit.origin})"
        text = f"{place(worst)}{before}{geometric}; limit {number}"
        return Finding(self.id, level, text, worst.pure, limit.number)


def _part(error: Error, limit: Limit) -> float:
    """Return an error as a part of a limit; infinite for one that is not finite."""
    return error.pure / limit.number if error.finite else math.inf


LIMITS = tuple(
    Within(quantity=name, **vars(each))
    for name, entry in QUANTITIES.items()
    for each in entry.criteria
)


class StartWithin:
    id = "CC116"
    title = "start"
    explanation = (
        "An engine may need some samples to settle its pins; its rates may jump meanwhile by "
        "half a step's acceleration, not more. If it solves its joints in each step, its "
        "accelerations may be wrong by their change within a step."
    )
    cure = "Start the engine with velocities of its own instant, or shorten the step."

    def check(self, evidence: Evidence) -> Finding | None:
        errors = evidence.errors
        every = errors.rows if errors else ()
        rows = [row for row in every if row.kind == "start" and row.tolerance in evidence.limits]
        if errors is None or not rows:
            return None
        limits = {row.tolerance: start_limit(row.tolerance, evidence, errors) for row in rows}

        def part(row: Error) -> float:
            taken = row.pure / limits[row.tolerance]
            return math.inf if math.isnan(taken) else taken

        worst = max(rows, key=part)
        limit = limits[worst.tolerance]
        level: Level = "pass" if worst.pure <= limit else "fail"
        text = f"{worst.tolerance}, {place(worst)}; limit {limit:.2g} {share(worst)}"
        return Finding(self.id, level, text, worst.pure, limit)


def start_limit(tolerance: str, evidence: Evidence, errors: Errors) -> float:
    """Return the limit of a rate of the first samples, as a pure number."""
    return _settled(tolerance, evidence, errors) + allowance(tolerance, errors, evidence.placing)


def _settled(tolerance: str, evidence: Evidence, errors: Errors) -> float:
    """Return the limit of later samples, near a change point if the start is."""
    limit = evidence.limits[tolerance]
    return (
        in_passage(tolerance, limit, errors) if errors.of_scene.starts_in_passage else limit
    ).number


ROOM = 2.0
"""Factor for ringing: 1.6 of the jolt was seen where iterations left a fifth of an error from step
to step, and 1.1 where they left next to none."""
OPEN = 1e-4
"""Part of an acceleration that MuJoCo's stiffest documented impedance (0.9999) leaves."""
CHANGE = 1.4
"""Part of the change of the accelerations in a step that may remain after a start with joints
closed in their places: twice the observed one."""
ARM = 2.0
"""Ratio of force errors to acceleration errors at a start, by arms and masses: 1.6 was seen."""
ELEMENTS = 4.0
"""Factor on the error of the elements' acceleration at the start: twice the observed one."""
CAP = 0.1
"""Largest jump of the velocities, over the driver's speed."""


def allowance(tolerance: str, errors: Errors, placing: Placing = "integrated") -> float:
    """Return the additional error allowed in the first samples, on top of the limit ``tolerance``,
    as a pure number, for an engine of this ``placing``.

    An impulse engine starts with velocities that are half a step away from those that its joints
    need. The first solution corrects that at once, by the jolt times the step
    (`analytic.forces.late_impulses`); from step to step it continues as a position error of jolt *
    step^2 (`reports.judge.tolerance`). The jump is over with the next sample, or rings off where
    iterations leave a part of it. Differenced over two steps it is half as large; differenced
    twice, it is an acceleration of the jolt itself, at every step.

    Measured for profile tuned at 90 to 1440 steps a turn on every shipped scene, and on a thousand
    random ones (tests/reports/judge/test_random.py), as multiples of ``step * jolt``, ``step * jolt
    / 2`` and ``jolt``: pymunk up to 1.1 where its iterations converge, and up to 1.6 where they
    leave a fifth of an error from one step to the next, which rings. MuJoCo under 0.05.

    A soft constraint starts with its spring at rest: until that has given way, the accelerations
    are off by the part that the impedance leaves open, (1 - 0.9999) of the acceleration with which
    the bodies would part if the loop were open. That is about the curvature where their masses are
    alike; a light body that holds a heavy one would part with it faster by the ratio of their
    masses.

    An implicit engine that closes its joints in their places at the end of each step starts with
    accelerations for the rates at its start, and needs in its first step those for the places at
    its end: they are off by a part of their change in a step, which its damping removes. The change
    over a step is about ``step * curvature^1.5``, the curvature and its frequency; exudyn was seen
    to be off by up to 0.69 of that with profile tuned, at 90 to 720 steps a turn on every shipped
    scene, and by up to 3.8 as shipped, where it rings for sixty steps.

    The correction of an impulse solver at its start is half a step's change of momentum: the forces
    of its first step are off by half of themselves, at every step, and those of the second by as
    much to the other side. Where iterations leave half of it, it rings off within a dozen steps,
    and these alone are the start (`reports.compare.whole_errors.OF_STEPS`). Observed for pymunk, as
    multiples of half the largest force at the start: up to 1.26, at 90 and 720 steps a turn on
    every shipped scene.

    Elements of a beam placed on the true line are stretched, as a cubic cannot bend without
    stretching somewhere, and start with the acceleration of that push on their ends
    (`models.scene.elastic.Beam.pushed`): for fourbar-elastic 0.13 of the driver's speed squared
    with 2 of them and 0.009 with 4, at every step, until that is damped.

    The caps are plainly wrong results, whatever the theory grants: a tenth of the driver's speed
    within a step.
    """
    numbers = errors.limits[tolerance]
    scene, pushed = errors.of_scene, ELEMENTS * errors.of_links.pushed
    if numbers.parts:
        parting = scene.curvature * scene.mass_ratio / max(scene.conditioning, 1e-12)
        changing = CHANGE * scene.step_rad * scene.curvature**1.5 if placing == "solved" else 0.0
        changing += scene.jumping(2)
        loaded = OPEN * scene.parting
        if not numbers.makes_up:
            return min(OPEN * parting + changing + loaded, CAP) + pushed
        own = min(ARM * (OPEN * parting + changing), CAP) + ROOM * 0.5 * errors.of_forces.start_load
        own += min(ARM * loaded * errors.of_forces.inertia_share, CAP)
        return own + ARM * pushed
    if numbers.jump:
        jump = min(ROOM * scene.jolt * scene.step_rad, CAP)
        return numbers.jump * jump / scene.step_rad ** (numbers.rate - 1)
    return 0.0
