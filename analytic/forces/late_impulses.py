"""Energy errors of a mechanism from impulses that come a step late.

An engine that moves its bodies along tangents and closes the joints by impulses leaves these open
by the arc of a step, dt^2/2 times the acceleration that the joints require. The forces of the
joints have worked over that arc: the energy is off by twice the energy of accelerations times dt^2
at most, from the first steps on, in which the arc opens. As the arc of a step is closed in the next
one, the forces are late by it, a loss at every step: dt^2 times the energy of accelerations of the
differences of accelerations from step to step.

Source: the energy of accelerations is Gauss' and Appell's, S = sum (m a^2 + I alpha^2) / 2;
measured against engines in `reports.judge.tolerance`.
"""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from functools import reduce

import numpy as np

from analytic.forces.given_motion import chunks_of
from models.array import Array
from models.motion import Motion
from models.scene import GROUND, Scene, Slider
from models.scene.joints import bodies, centre_of, mass_of


@dataclass(frozen=True)
class LateImpulses:
    """Energy errors over the largest kinetic energy: ``start`` at the start of the motion;
    ``offset`` comes and goes with it, and is the mean over its first or its last while, the larger;
    ``loss`` has added up over it."""

    start: float = 0.0
    offset: float = 0.0
    loss: float = 0.0


ON_TIME = LateImpulses()


def late_impulses(scene: Scene, motion: Motion, dt_s: float, while_s: float) -> LateImpulses:
    """Return the energy errors by steps of ``dt_s`` [s] in a motion, given at instants (T,), with
    means over ``while_s`` [s]; none at rest, or for an unknown step (0).

    Instants that are further apart than a step count as so many average steps, and have to resolve
    the motion. Raises CrankcheckError as `analytic.forces.kinetostatics.forces`.
    """
    samples = len(motion.time_s)
    kinetic, stirred, changed = np.zeros(samples), np.zeros(samples), np.zeros(max(samples - 1, 0))
    for name in bodies(scene):
        mass, inertia = mass_of(scene, name)
        speed, push = _rates(scene, motion, name)
        weights = 0.5 * np.array([mass, mass, inertia])
        kinetic += speed**2 @ weights
        stirred += push**2 @ weights
        changed += np.diff(push, axis=0) ** 2 @ weights
    largest = float(np.max(kinetic))
    if not largest > 0.0 or samples < 2 or not dt_s:
        return ON_TIME
    # Differences over a longer time than a step belong to so many steps.
    steps = float(motion.time_s[-1] - motion.time_s[0]) / ((samples - 1) * dt_s)
    time_s = motion.time_s
    first, last = time_s <= time_s[0] + while_s, time_s >= time_s[-1] - while_s
    offset = max(np.mean(stirred[first]), np.mean(stirred[last]))
    parts = stirred[0], offset, np.sum(changed) / steps
    return LateImpulses(*(2.0 * dt_s**2 * float(part) / largest for part in parts))


def _rates(scene: Scene, motion: Motion, body: str) -> tuple[Array, Array]:
    """Return the velocity of a body's centre with its angular velocity, and their rates, (T, 3)
    each; 0 in a singular position."""
    speeds, pushes = [], []
    for _, chunk in chunks_of(scene, motion, bound=False):
        at = chunk.bodies[body].point(centre_of(scene, body))
        still = np.zeros_like(at.a.x)
        speeds.append([at.v.x, at.v.y, still + chunk.bodies[body].omega])
        pushes.append([at.a.x, at.a.y, still + chunk.bodies[body].alpha])
    speed, push = (np.concatenate(parts, axis=1).T for parts in (speeds, pushes))
    return np.nan_to_num(speed, posinf=0.0, neginf=0.0), np.nan_to_num(push, posinf=0.0, neginf=0.0)


BodyPlace = tuple[float | Array, float | Array]
"""Place in the frame of a body [m], the same or another at every sample."""


def jolts(scene: Scene, motion: Motion) -> Array:
    """Return half the largest acceleration that joints make up for in a step, at every sample (T,).

    A pure number: angles over the square of the driver's peak speed, places over the longest link
    too. Samples at which it is not finite (singular ones) are 0.

    A motion whose velocities belong half a step away from its joints is corrected by impulses in
    these. They change the velocity of the centre of each body by half a step's acceleration, and
    its angular velocity by half a step's angular acceleration, as bodies without other forces
    accelerate by the least change that the joints require. A point of a body at the distance r from
    its centre keeps half of a + omega^2 r, as the part of its acceleration that points to the
    centre comes from rotation, and does not jump; a slider moves by the difference of two bodies.

    Source: Gauss's principle of least constraint (J. reine angew. Math. 4, 1829), for the step of
    an impulse solver; measured against two engines in `reports.judge.rules.limits`.
    """
    largest = reduce(np.maximum, _pushes(scene, motion))
    half = 0.5 * largest / scene.driver.law.peak_speed_rad_s**2
    return np.where(np.isfinite(half), half, 0.0)


def _pushes(scene: Scene, motion: Motion) -> Iterator[Array]:
    """Yield those of links [rad/s^2], points and sliders [m/s^2 over the longest link], (T,)."""
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
    """Yield the guide, and the link that slides or carries the block, with the place on each."""
    s = motion.sliders[slider.name].displacement
    x, y = slider.through_m
    turn = slider.direction_rad
    yield slider.on, (x + s * math.cos(turn), y + s * math.sin(turn))
    carried = [n for n, link in scene.links.items() if slider.point in link.points]
    for name in [slider.link] if slider.link else carried[:1]:
        yield name, scene.links[name].points[slider.point]


def _turning(scene: Scene, motion: Motion, body: str, place: BodyPlace) -> Array:
    """Return the acceleration of a body's place towards its centre of mass [m/s^2], (T,)."""
    if body == GROUND:
        return np.zeros_like(motion.time_s)
    x, y = scene.links[body].centre_m
    arm = np.hypot(place[0] - x, place[1] - y)
    return np.asarray(motion.links[body].omega ** 2 * arm)
