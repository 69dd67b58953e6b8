"""What an engine may be off by in its first samples, while it takes up its pins.

An impulse engine starts with velocities that belong half a step away from where its joints want
them. The first solution makes up for that at once. It changes the velocity of the centre of each
body by half a step's acceleration, and its angular velocity by half a step's angular acceleration,
as the acceleration of bodies that only their joints push is the least change that the joints ask
for. A point of a body at the distance r from its centre is left with half of a + omega^2 r, as the
part of its acceleration that points to the centre comes from turning, and does not jump; a slider
moves by the difference of two bodies. The largest of these is the jolt of the start (`jolts`); from
step to step it goes on as an error of place of jolt * step^2 (`reports.tolerance`). The jump is
over with the next sample, or rings off where iterations leave a part of it. Differenced over two
steps it is half as large; differenced twice, it is an acceleration of the jolt itself, at every
step.

Measured for profile tuned at 90 to 1440 steps a turn on every shipped scene, and on a thousand
random ones (tests/reports/test_random.py), as multiples of ``step * jolt``, ``step * jolt / 2`` and
``jolt``: pymunk up to 1.1 where its iterations come to an end, and up to 1.6 where they leave a
fifth of an error from one step to the next, which rings. MuJoCo under 0.05.

A soft constraint starts with its spring at rest: until that has given way, the accelerations are
off by the part that the impedance leaves open, (1 - 0.9999) of the acceleration with which the
bodies would part if the loop were open. That is about the curvature where their masses are alike;
a light body that holds a heavy one would part with it by the ratio of their masses faster.

The caps are what anyone would call wrong, whatever the theory grants: a tenth of the driver's speed
within a step.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from models.motion import Motion
from models.scene import GROUND, Scene, Slider
from reports.errors import Errors
from reports.series import Array, length

Place = tuple[float | Array, float | Array]
"""A place in the frame of a body [m], the same or another at every sample."""

ROOM = 2.0
"""What ringing may add: 1.6 of the jolt was seen where iterations left a fifth of an error from
step to step, and 1.1 where they left next to none."""
OPEN = 1e-4
"""What MuJoCo's stiffest documented impedance (0.9999) leaves of an acceleration."""
CAP = 0.1
"""The most that the velocities may jump by, over the driver's speed."""


def allowance(tolerance: str, errors: Errors) -> float:
    """What the first samples may be off by on top of the limit ``tolerance``, as a pure number."""
    jump = min(ROOM * errors.jolt * errors.step_rad, CAP)
    if tolerance == "velocity":
        return jump
    if tolerance == "velocity-differenced":
        return jump / 2.0
    if tolerance == "acceleration-differenced":
        return jump / errors.step_rad
    if tolerance == "acceleration":
        parting = errors.curvature * errors.mass_ratio / max(errors.conditioning, 1e-12)
        return min(OPEN * parting, CAP)
    return 0.0


def jolts(scene: Scene, reference: Motion) -> Array:
    """Half the largest pure acceleration that joints make up for in a step, at every sample (T,).

    Samples at which it is not finite (singular ones) are 0.
    """
    found = np.maximum.reduce(list(_pushes(scene, reference)))
    half = 0.5 * found / scene.driver.law.peak_speed_rad_s**2
    return np.where(np.isfinite(half), half, 0.0)


def mass_ratio(scene: Scene) -> float:
    """The mass of the heaviest body over that of the lightest that has one."""
    masses = [link.mass_kg for link in scene.links.values()]
    masses += [slider.mass_kg for slider in scene.sliders.values()]
    given = [mass for mass in masses if mass > 0.0]
    return max(given, default=1.0) / min(given, default=1.0)


def _pushes(scene: Scene, reference: Motion) -> Iterator[Array]:
    """For links [rad/s^2], their points and sliders [m/s^2 over the longest link], each (T,)."""
    for name, link in scene.links.items():
        yield np.abs(reference.links[name].alpha)
        for point, place in link.points.items():
            push = length(reference.points[point].acceleration)
            yield (push + _turning(scene, reference, name, place)) / scene.longest_m
    for slider in scene.sliders.values():
        push = np.abs(reference.sliders[slider.name].acceleration)
        for body, at in _sides(scene, reference, slider):
            push = push + _turning(scene, reference, body, at)
        yield push / scene.longest_m


def _sides(scene: Scene, reference: Motion, slider: Slider) -> Iterator[tuple[str, Place]]:
    """The guide, and the link that slides or carries the block, with the place on each."""
    s = reference.sliders[slider.name].displacement
    x, y = slider.through_m
    turn = slider.direction_rad
    yield slider.on, (x + s * math.cos(turn), y + s * math.sin(turn))
    carried = [n for n, link in scene.links.items() if slider.point in link.points]
    for name in [slider.link] if slider.link else carried[:1]:
        yield name, scene.links[name].points[slider.point]


def _turning(scene: Scene, reference: Motion, body: str, place: Place) -> Array:
    """The acceleration of a place of a body towards its centre of mass [m/s^2], (T,)."""
    if body == GROUND:
        return np.zeros_like(reference.time_s)
    x, y = scene.links[body].centre_m
    arm = np.hypot(place[0] - x, place[1] - y)
    return np.asarray(reference.links[body].omega ** 2 * arm)
