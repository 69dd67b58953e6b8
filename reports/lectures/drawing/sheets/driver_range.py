"""The driver's angles that a sheet shows: those that are reached from where it stands."""

from __future__ import annotations

import math

import numpy as np

from analytic.kinematics import reach, solve_driven
from models.array import Array, Mask
from models.errors import CrankcheckError, ReachError
from models.scene import Scene
from models.scene.laws import Oscillating


def range_about(scene: Scene, theta: float) -> tuple[float, float]:
    """The reachable range [rad] that an angle of the driver is in, near to that angle.

    Raises CrankcheckError where the scene can not be assembled there.
    """
    for low, high in reach(scene):
        shift = 0.0
        if scene.driver.slider is None:
            shift = math.tau * round((theta - 0.5 * (low + high)) / math.tau)
        if low + shift - 1e-9 <= theta <= high + shift + 1e-9:
            return low + shift, high + shift
    slides = scene.driver.slider is not None
    place = f"{theta:g} m" if slides else f"{math.degrees(theta):g} deg"
    raise CrankcheckError(f"{scene.name}: can not be assembled at {place}")


def assembled(scene: Scene, theta: Array) -> Mask:
    """At which driver angles (T,) the scene can be assembled; within a range there may be single
    ones, singular positions, at which it can not."""
    possible = np.ones(theta.shape, dtype=bool)
    parts, one = [np.arange(theta.size)], np.ones(1)
    while parts:
        part = parts.pop()
        try:
            solve_driven(
                scene, theta[part], one, 0.0 * one, links=(), points=(), sliders=(), bound=False
            )
        except ReachError:
            if part.size == 1:
                possible[part] = False
            else:
                parts += np.array_split(part, 2)
    return possible


def sense_of_law(scene: Scene) -> float:
    """1 of a driver that starts counter-clockwise, -1 of one that starts clockwise."""
    return math.copysign(1.0, float(scene.driver.law.at(np.zeros(1))[1][0]))


def range_of_law(scene: Scene) -> tuple[float, float]:
    """What the driver goes through, or reaches from its start [rad or m]; as `range_about`."""
    law = scene.driver.law
    if isinstance(law, Oscillating):
        swing = abs(law.amplitude_rad)
        return law.centre_rad - swing, law.centre_rad + swing
    start = float(law.at(np.zeros(1))[0][0])
    if scene.driver.slider is not None:  # it goes no further than the way of a run
        end = float(law.at(np.array([law.period_s]))[0][0])
        return min(start, end), max(start, end)
    return range_about(scene, start)
