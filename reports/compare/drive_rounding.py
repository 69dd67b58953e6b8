"""What rounding makes of a driver's angle that an engine adds up step by step.

At constant speed an engine adds ``speed * dt`` to the angle at every step (MuJoCo ``qpos += dt *
qvel``, pymunk ``angle += omega * dt``). Each sum is rounded by at most eps/2 of the angle, and as
the same amount is added each time, all are rounded to the same side while the angle stays between
two powers of two: the worst case, steps * eps/2 * largest angle, is nearly reached, and the square
root of the number of steps that chance would give is exceeded (measured, 10^3 to 10^6 steps: 0.1 to
0.18 of the worst case, whatever the step and the engine).

Any other law comes to MuJoCo as accelerations, worked out beforehand, and is added up twice. Some
roundings of the speed remain at every step, and a law that repeats itself repeats them: the angle
is off by their sum, which grows with the square of the number of steps as well (measured: 2.3
times the above for 10^4 and 10^5 steps).
"""

from __future__ import annotations

import sys

from models.laws import ConstantSpeed, Law

TWICE = 4.0
"""How much more is granted where the angle is added up twice."""


def summed(law: Law, dt_s: float, steps: int) -> float:
    """The most that rounding makes of the driver's angle in so many steps of ``dt_s`` [rad]."""
    lasts_s = steps * dt_s
    farthest = law.offset_rad + lasts_s * law.fastest_until(lasts_s)
    once = steps * sys.float_info.epsilon / 2.0 * farthest
    return once if isinstance(law, ConstantSpeed) else TWICE * once
