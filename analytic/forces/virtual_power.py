"""The driving torque by virtual power: what all forces do along the motion that the driver allows.

With the velocity v' of each centre and the rate theta' of each body per unit of the driver's rate,
and the force E and moment M that act on it, inertia among them::

    torque + sum (E v' + M theta') = 0

No reaction is in it, so it holds for redundant links too, and at rest.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from analytic.dyads.chunk import Chunk
from analytic.dyads.driven import driver_scale
from analytic.dyads.plane import EPS, BodyKinematics, PointKinematics, Real
from analytic.forces.bounded import NOUGHT, Bounded, BoundedVec
from analytic.forces.free_body import FreeBody
from models.scene import GROUND


def torque_by_power(free: Mapping[str, FreeBody], unit: Chunk, chunk: Chunk) -> Bounded:
    """The torque on the driver [N m], or the force along its line [N], of a chunk whose bodies are
    loaded.

    ``unit`` is the same positions with the driver at 1 rad/s, steady. Its angle is taken as exact:
    that of ``chunk`` may be wrong by its own bound, which moves every rate by its derivative.
    """
    off = 0.0 if chunk.driver.error is None else 2.0 * chunk.driver.error.theta
    total = NOUGHT
    for name, body in free.items():
        if name == GROUND:
            continue
        moving = unit.bodies[name]
        rate = _rate(moving, off)
        velocity = _velocity(moving.point(body.centre), off)
        total = total + body.force.dot(velocity) + body.moment * rate
    scale = driver_scale(chunk.scene)
    return -total if scale == 1.0 else -total * Bounded(1.0 / scale)


def _rate(body: BodyKinematics, off: Real) -> Bounded:
    """The rate of a body [1]."""
    if body.error is None:
        return Bounded(body.omega, None)
    change = np.abs(body.alpha) + body.error.alpha
    return Bounded(body.omega, body.error.omega + off * change + EPS * np.abs(body.omega))


def _velocity(point: PointKinematics, off: Real) -> BoundedVec:
    """The velocity of a point [m]."""
    if point.error is None:
        return BoundedVec(point.v, 0.0, None)
    change = point.a.norm() + point.error.acceleration
    return BoundedVec(point.v, point.v.norm(), point.error.velocity + off * change)
