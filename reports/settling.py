"""What an engine may be off by in its first samples, while it takes up its pins.

An impulse engine starts with velocities that belong half a step away from where its joints want
them. The first solution makes up for that at once: velocities jump by half a step's acceleration,
``step * curvature / 2``, which a dyad passes on enlarged by 1/conditioning, and the jump rings off
within the samples that are of kind "start". Differenced over one step it is an acceleration of
``curvature / 2``, whatever the step. Both come on top of the limit that holds for the rest of the
run.

Measured for profile tuned at 90 to 1440 steps a turn on every shipped scene, as multiples of
``step * curvature / conditioning`` and of ``curvature / conditioning``: pymunk velocities 0.29
reported and 0.14 differenced, accelerations 0.30 differenced; MuJoCo under 1e-4 throughout. As
reported, accelerations are worked out at each sample by itself: they do not jump, and get nothing.
The caps are twice the worst excess over the ordinary limit in the same runs (0.025 w and 1.7 w^2 at
90 steps a turn): near a singular position the theory grants more than anyone would call a start.
"""

from __future__ import annotations

from reports.errors import Errors

JUMP = 0.5
"""Steps by which the first velocities may be early or late."""
STEP_POWER = {"velocity": 1, "velocity-differenced": 1, "acceleration-differenced": 0}
"""Power of the step in the allowance, by the name of the tolerance; nothing for other names."""
CAP = {"velocity": 5e-2, "velocity-differenced": 5e-2, "acceleration-differenced": 3.5}
"""The most that is allowed, as a pure number."""


def allowance(tolerance: str, errors: Errors) -> float:
    """What the first samples may be off by on top of the limit ``tolerance``, as a pure number."""
    if tolerance not in STEP_POWER:
        return 0.0
    step = float(errors.step_rad ** STEP_POWER[tolerance])
    grown = JUMP * step * errors.curvature / max(errors.conditioning, 1e-12)
    return min(grown, CAP[tolerance])
