"""Driving torque by virtual power: that of all forces along the motion that the driver allows.

With the velocity v' of each centre and the rate theta' of each body per unit of the driver's rate,
and the force E and moment M that act on it, inertia among them::

    torque + sum (E v' + M theta') = 0

No reaction is in it, so it holds for redundant links too, and at rest.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from analytic.dyads.chunk import Chunk, driver_scale
from analytic.dyads.plane import EPS, BodyKinematics, PointKinematics, Real, Vec
from analytic.forces.bounded import NOUGHT, Bounded, BoundedVec
from analytic.forces.force_elements import apply_springs
from analytic.forces.free_body import FreeBody, apply_loads
from analytic.kinematics import chunks, unit_chunk
from models.array import Array, samples
from models.scene import GROUND, Point, Scene
from models.scene.joints import block_name


def torque_by_power(free: Mapping[str, FreeBody], unit: Chunk, chunk: Chunk) -> Bounded:
    """Return the torque on the driver [N m], or the force along its line [N], of a chunk with
    loaded bodies.

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
    """Return the rate of a body [1]."""
    if body.error is None:
        return Bounded(body.omega, None)
    change = np.abs(body.alpha) + body.error.alpha
    return Bounded(body.omega, body.error.omega + off * change + EPS * np.abs(body.omega))


def _velocity(point: PointKinematics, off: Real) -> BoundedVec:
    """Return the velocity of a point [m]."""
    if point.error is None:
        return BoundedVec(point.v, 0.0, None)
    change = point.a.norm() + point.error.acceleration
    return BoundedVec(point.v, point.v.norm(), point.error.velocity + off * change)


@dataclass(frozen=True)
class ReducedMachine:
    """Machine reduced to the driver's angle ``theta`` [rad]: ``inertia`` I [kg m^2], its ``slope``
    I' [kg m^2] by the angle, ``torque`` M of weights, loads and springs [N m]; (T,) each."""

    theta: Array
    inertia: Array
    slope: Array
    torque: Array


def reduced_machine(scene: Scene, time_s: ArrayLike) -> ReducedMachine:
    """Reduce the machine to its driver, at the given times under its driver's law.

    Raises as `analytic.forces.kinetostatics.forces`, except at dead points, where it is not finite.

    With rates v' and theta' per unit of the driver's rate, its reduced moment of inertia and the
    reduced torque of weights, loads and springs are::

        I = sum (m v'^2 + J theta'^2)         M = sum (F v' + M theta')
        torque = I alpha + I' omega^2 / 2 - M          (I' = dI/dphi)

    Friction is left out, as it depends on the reactions. Source: I. I. Artobolevskii, Theory of
    Mechanisms, on reduced masses.
    """
    instants = samples(time_s, "time_s")
    parts = []
    for span, chunk in chunks(scene, instants, bound=False):
        unit = unit_chunk(scene, chunk.theta, bound=False)
        with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
            free = loaded_bodies(scene, chunk, instants[span])
            apply_springs(scene, chunk, free)
            torque = -torque_by_power(free, unit, chunk)
            rows = (chunk.theta, *inertia_and_slope(scene, unit), torque.value)
        parts.append([np.broadcast_to(row, chunk.theta.shape) for row in rows])
    return ReducedMachine(*(np.concatenate(rows) for rows in zip(*parts, strict=True)))


def loaded_bodies(scene: Scene, chunk: Chunk, time_s: Array) -> dict[str, FreeBody]:
    """Return all bodies of a chunk at times [s] under their weights and loads, without inertia.
    Raises CrankcheckError as `analytic.forces.free_body.apply_loads`."""
    free = {GROUND: FreeBody(chunk.bodies[GROUND], (0.0, 0.0))}
    for name, (mass, _, centre) in _masses(scene).items():
        free[name] = body = FreeBody(chunk.bodies[name], centre)
        if mass > 0.0 and any(scene.gravity_m_s2):
            x, y = (mass * g for g in scene.gravity_m_s2)
            body.force = BoundedVec(Vec(x, y), math.hypot(x, y), None)
    apply_loads(scene, chunk, time_s, free)
    return free


def _masses(scene: Scene) -> dict[str, tuple[float, float, Point]]:
    """Return mass [kg], moment of inertia [kg m^2] and centre of each body."""
    own = {n: (k.mass_kg, k.inertia_kg_m2, k.centre_m) for n, k in scene.links.items()}
    for slider in scene.sliders.values():
        if slider.link is None:
            own[block_name(slider)] = (slider.mass_kg, slider.inertia_kg_m2, (0.0, 0.0))
    return own


@np.errstate(divide="ignore", invalid="ignore", over="ignore")  # accelerations at change points
def inertia_and_slope(scene: Scene, unit: Chunk) -> tuple[Array, Array]:
    """Return the reduced moment of inertia and its derivative [kg m^2], (T,), of a chunk with the
    driver at 1 rad/s, steady: there accelerations are the derivatives of rates by its angle."""
    inertia, slope = np.zeros_like(unit.theta), np.zeros_like(unit.theta)
    for name, (mass, moment, centre) in _masses(scene).items():
        body = unit.bodies[name]
        at = body.point(centre)
        inertia += mass * at.v.square() + moment * body.omega**2
        slope += 2.0 * (mass * at.v.dot(at.a) + moment * body.omega * body.alpha)
    return inertia, slope
