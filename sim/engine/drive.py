"""Drive signals: the input of each step that keeps the crank on its law at the samples.

All rules are open loop: they follow from the law alone, and the engine's own arithmetic is exact
for them up to rounding, because a heavy or kinematic crank does not feel the mechanism. A free
crank has no input.
"""

import math

import numpy as np

from models.array import Array
from models.motion import State
from models.scene import Scene
from models.scene.laws import ConstantSpeed, Law
from sim.engine import Drive


def angles(law: Law, start_s: float, dt_s: float, first: int, last: int) -> Array:
    """Return the crank angle [rad] at the steps ``first`` to ``last``, both included."""
    return law.at(start_s + dt_s * np.arange(first, last + 1, dtype=np.float64))[0]


def chords(law: Law, start_s: float, dt_s: float, first: int, last: int) -> Array:
    """Return the mean angular velocity [rad/s] over each step, for steps ``first`` to ``last``."""
    if isinstance(law, ConstantSpeed):
        return np.full(last - first + 1, law.speed_rad_s)
    return np.diff(angles(law, start_s, dt_s, first, last + 1)) / dt_s


def start_speed(law: Law, start_s: float, dt_s: float, velocity_shift: float) -> float:
    """Return the angular velocity [rad/s] of the crank at the start.

    Half a step before or after the start (``velocity_shift`` -0.5 or 0.5) it is the chord. With
    velocities at the samples (0) and a constant torque within a step, the speed for exact angles
    alternates about the law unless it starts theta''' dt^2 / 12 below it.
    """
    if isinstance(law, ConstantSpeed):
        return law.speed_rad_s
    if velocity_shift != 0.0:
        first = 0 if velocity_shift > 0.0 else -1
        return float(chords(law, start_s, dt_s, first, first)[0])
    times = start_s + dt_s * np.array([-1.0, 0.0, 1.0])
    _, omega, alpha = law.at(times)
    return float(omega[1] - (alpha[2] - alpha[0]) / 2.0 * dt_s / 12.0)


def pushes(law: Law, start_s: float, dt_s: float, steps: int, velocity_shift: float) -> Array:
    """Return the angular acceleration [rad/s^2] of each of the ``steps`` from the start on.

    Velocity before position (``velocity_shift`` -0.5): second differences of the angle. Constant
    acceleration within the step (0): from theta' = theta + v dt + a dt^2 / 2, v' = v + a dt.
    """
    theta = angles(law, start_s, dt_s, -1, steps)
    if velocity_shift != 0.0:
        return np.diff(theta, 2) / dt_s**2
    chord = np.diff(theta[1:]) / dt_s
    sign = (-1.0) ** np.arange(steps)
    start = start_speed(law, start_s, dt_s, velocity_shift)
    before = np.concatenate([[0.0], np.cumsum(2.0 * sign * chord)[:-1]])
    speed = sign * (start - before)
    return 2.0 * (chord - speed) / dt_s


def pace(scene: Scene, state: State, drive: Drive) -> float:
    """Return the speed scale of a run [rad/s]: the law's largest angular velocity.

    For free motion it is the largest of the state, or of a fall through the longest link by
    gravity; 0 only where nothing moves and nothing will.
    """
    if drive != "free":
        return scene.pace_rad_s
    speeds = [abs(omega) for omega in state.omega.values()]
    gains = [abs(alpha) for alpha in state.alpha.values()]
    gains.append(math.hypot(*scene.gravity_m_s2) / scene.longest_m)
    return max(*speeds, *map(math.sqrt, gains))


def period(scene: Scene, state: State, drive: Drive) -> float:
    """Return the time scale [s], far longer than a good step; infinite where nothing moves."""
    if drive != "free":
        return scene.driver.law.period_s
    speed = pace(scene, state, drive)
    return math.tau / speed if speed else math.inf
