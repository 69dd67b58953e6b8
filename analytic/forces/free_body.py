"""The free-body diagram of each body: what acts on it but for its joints.

By d'Alembert's principle that is its weight, its loads, and its inertia::

    P = m (g - a_S) in the centre of mass S        M = -J alpha
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from analytic.dyads.chunk import Chunk
from analytic.dyads.plane import (
    EPS,
    STEADY,
    UNTURNED,
    ZERO,
    BodyKinematics,
    PointKinematics,
    Vec,
)
from analytic.forces.bounded import NOUGHT, NOWHERE, Bounded, BoundedVec
from models.joints import block_name
from models.scene import GROUND, Point, Scene

ROUGH = 4 * EPS
"""What turning a vector of a body rounds off, over its length."""


class FreeBody:
    """A body cut free, over a chunk: the force on it [N] and the moment about its centre [N m]."""

    def __init__(self, body: BodyKinematics, centre: Point) -> None:
        self.body, self.centre = body, centre
        self.force: BoundedVec = NOWHERE
        self.moment: Bounded = NOUGHT

    def vector(self, start: Point, end: Point) -> BoundedVec:
        """From one place of the body to another [m]."""
        x, y = end[0] - start[0], end[1] - start[1]
        if x == 0.0 and y == 0.0:
            return NOWHERE
        turn, length = self.body.turn, self.body.length
        if turn is UNTURNED:
            v = Vec(x, y)
        elif y == 0.0:
            v = turn if x == length else turn * (x / length)
        else:
            v = turn.turned(Vec(x / length, y / length))
        if self.body.error is None:
            return BoundedVec(v, 0.0, None)
        size = math.hypot(x, y)
        apart = EPS * (math.hypot(*start) + math.hypot(*end))
        return BoundedVec(v, size, (size + apart) * (self.body.error.theta + ROUGH) + apart)

    def unit(self, angle_rad: float, rounding: float) -> BoundedVec:
        """The unit vector at a constant angle, known but for ``rounding``, to the body's frame."""
        v = self.body.unit(angle_rad)
        if self.body.error is None:
            return BoundedVec(v, 0.0, None)
        return BoundedVec(v, 1.0 + ROUGH, self.body.error.theta + rounding + ROUGH)

    def push(self, arm: BoundedVec, force: BoundedVec) -> None:
        """A force at the end of an arm from the centre."""
        self.force = self.force + force
        self.moment = self.moment + arm.cross(force)

    def moment_about(self, arm: BoundedVec) -> Bounded:
        """The moment of all that acts, about the end of an arm from the centre."""
        return self.moment - arm.cross(self.force)


def free_bodies(scene: Scene, chunk: Chunk) -> dict[str, FreeBody]:
    """All bodies, and the ground, under their weight and inertia."""
    free = {GROUND: FreeBody(chunk.bodies[GROUND], (0.0, 0.0))}
    for link in scene.links.values():
        body = FreeBody(chunk.bodies[link.name], link.centre_m)
        if link.mass_kg or link.inertia_kg_m2:
            near = _nearest(scene, link.points, link.centre_m)
            anchor = chunk.point(link.name, near)
            about = replace(body.body, local=link.points[near], anchor=anchor)
            _weigh(scene, body, about.point(link.centre_m), (link.mass_kg, link.inertia_kg_m2))
        free[link.name] = body
    for slider in scene.sliders.values():
        if slider.link is None:
            name = block_name(slider)
            body = FreeBody(chunk.bodies[name], (0.0, 0.0))
            if slider.mass_kg or slider.inertia_kg_m2:
                masses = (slider.mass_kg, slider.inertia_kg_m2)
                _weigh(scene, body, chunk.point(name, slider.point), masses)
            free[name] = body
    return free


def _nearest(scene: Scene, points: Mapping[str, Point], centre: Point) -> str:
    """The point that the motion of the centre is taken from: one at rest, or the nearest."""
    return min(points, key=lambda p: (p not in scene.ground, math.dist(points[p], centre)))


def _weigh(
    scene: Scene, body: FreeBody, centre: PointKinematics, masses: tuple[float, float]
) -> None:
    """Put its weight and inertia on a body whose centre moves so."""
    mass, inertia = masses
    g = Vec(*scene.gravity_m_s2) if any(scene.gravity_m_s2) else ZERO
    force = centre.a * -mass if g is ZERO else (g - centre.a) * mass
    if centre.error is None:
        body.force = BoundedVec(force, 0.0, None)
    else:
        size = mass * (centre.a.norm() + math.hypot(*scene.gravity_m_s2))
        body.force = BoundedVec(force, size, mass * centre.error.acceleration + 2 * EPS * size)
    alpha = body.body.alpha
    if alpha is STEADY or inertia == 0.0:
        return
    error = body.body.error
    lost = None if error is None else inertia * (error.alpha + EPS * np.abs(alpha))
    body.moment = Bounded(alpha * -inertia, lost)
