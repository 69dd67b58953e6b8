"""The neighbourhood of the change points that a motion goes through.

The sine of a dyad falls to 0 in a change point, and yet the smooth branch is regular there: inertia
carries an engine through, with the error of place that it has in the regular motion on both sides.
How hard the mechanism is on an engine is therefore read off outside `WINDOW_RAD` of the driver.

Rates are another matter. Within a step of the change point the joints do not hold the dyad in one
direction: a soft constraint leaves all of an acceleration open there. The error of place that piled
up, of second order, is made good in a step or some when they hold again: that is a velocity of
first order, and an acceleration that does not shrink with the step. Rates in the window are rows of
their own, of kind "passage", and held to limits of their own
(`reports.judge.tolerance.in_passage`).

Measured for profile tuned at 180 to 1440 steps a turn on a parallelogram, a kite and an isosceles
slider-crank: rates are those of the regular motion again 0.3 rad after the change point at 180
steps, 0.2 rad at 360 and 0.1 rad at 720.
"""

from __future__ import annotations

import math
from collections.abc import Iterable

import numpy as np

from models.array import Array, Mask
from models.motion import Crossing, Motion

WINDOW_RAD = 0.5
"""Of the driver, on both sides of a change point."""


def near(crossings: Iterable[Crossing], driver_rad: Array, within_rad: float) -> Mask:
    """Whether driver angles (T,) are nearer than this to one of some change points."""
    nearby = np.zeros(driver_rad.shape, dtype=bool)
    for crossing in crossings:
        away = np.remainder(driver_rad - crossing.driver_rad + math.pi, math.tau) - math.pi
        nearby |= np.abs(away) < within_rad
    return nearby


def conditioning(motion: Motion, driver_rad: Array) -> float:
    """The smallest sine of a transmission angle, 1 where there is no dyad.

    Of a dyad in the window of its own change point no sine counts, unless the motion has no other:
    then the largest does, as the one that is farthest from it.
    """
    smallest = 1.0
    for key, sine in motion.conditioning.items():
        own = [crossing for crossing in motion.crossings if crossing.dyad == key]
        outside = sine[~near(own, driver_rad, WINDOW_RAD)]
        smallest = min(smallest, float(np.min(outside) if outside.size else np.max(sine)))
    return smallest
