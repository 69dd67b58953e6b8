"""The jolt: how fast bodies must change their velocities for what half a step has left undone.

A motion whose velocities belong half a step away from its joints is put right by impulses in these.
They change the velocity of the centre of each body by half a step's acceleration, and its angular
velocity by half a step's angular acceleration, as the acceleration of bodies that only their joints
push is the least change that the joints ask for. A point of a body at the distance r from its
centre is left with half of a + omega^2 r, as the part of its acceleration that points to the centre
comes from turning, and does not jump; a slider moves by the difference of two bodies.

Source: Gauss's principle of least constraint (J. reine angew. Math. 4, 1829), for the step of an
impulse solver; measured against two engines in `reports.judge.start_allowance`.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from functools import reduce

import numpy as np

from models.array import Array
from models.motion import Motion
from models.scene import GROUND, Scene, Slider

BodyPlace = tuple[float | Array, float | Array]
"""A place in the frame of a body [m], the same or another at every sample."""


def jolts(scene: Scene, motion: Motion) -> Array:
    """Half the largest acceleration that joints make up for in a step, at every sample (T,).

    A pure number: angles over the square of the driver's peak speed, places over the longest link
    too. Samples at which it is not finite (singular ones) are 0.
    """
    largest = reduce(np.maximum, _pushes(scene, motion))
    half = 0.5 * largest / scene.driver.law.peak_speed_rad_s**2
    return np.where(np.isfinite(half), half, 0.0)


def _pushes(scene: Scene, motion: Motion) -> Iterator[Array]:
    """For links [rad/s^2], their points and sliders [m/s^2 over the longest link], each (T,)."""
    for name, link in scene.links.items():
        yield np.abs(motion.links[name].alpha)
        for point, place in link.points.items():
            turning = _turning(scene, motion, name, place)
            if point not in scene.ground:
                turning += np.hypot(*motion.points[point].acceleration.T)
            yield turning / scene.longest_m
    for slider in scene.sliders.values():
        push = np.abs(motion.sliders[slider.name].acceleration)
        for body, at in _sides(scene, motion, slider):
            push = push + _turning(scene, motion, body, at)
        yield push / scene.longest_m


def _sides(scene: Scene, motion: Motion, slider: Slider) -> Iterator[tuple[str, BodyPlace]]:
    """The guide, and the link that slides or carries the block, with the place on each."""
    s = motion.sliders[slider.name].displacement
    x, y = slider.through_m
    turn = slider.direction_rad
    yield slider.on, (x + s * math.cos(turn), y + s * math.sin(turn))
    carried = [n for n, link in scene.links.items() if slider.point in link.points]
    for name in [slider.link] if slider.link else carried[:1]:
        yield name, scene.links[name].points[slider.point]


def _turning(scene: Scene, motion: Motion, body: str, place: BodyPlace) -> Array:
    """The acceleration of a place of a body towards its centre of mass [m/s^2], (T,)."""
    if body == GROUND:
        return np.zeros_like(motion.time_s)
    x, y = scene.links[body].centre_m
    arm = np.hypot(place[0] - x, place[1] - y)
    return np.asarray(motion.links[body].omega ** 2 * arm)
