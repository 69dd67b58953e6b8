"""Motion of the bodies of a tree from its joint coordinates, vectorised over time."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from models.array import Array
from models.mjcf.tree import Freedom, Limb
from models.scene import GROUND, Point
from sim.engine import BodyPose

Plane = NDArray[np.complex128]


@dataclass
class _MovingFrame:
    """A frame over time while its body's joints are applied; complex numbers for the plane."""

    place: Plane
    theta: Array
    speed: Plane
    omega: Array
    push: Plane
    alpha: Array

    def shifted(self, arm: Plane) -> _MovingFrame:
        """Move the frame to a point at ``arm``, an arm that turns with the body."""
        turn = 1j * self.omega
        return _MovingFrame(
            self.place + arm,
            self.theta,
            self.speed + turn * arm,
            self.omega,
            self.push + (1j * self.alpha - self.omega**2) * arm,
            self.alpha,
        )


@np.errstate(over="ignore", invalid="ignore")  # for a run with open joints
def body_poses(
    limbs: Sequence[Limb], q: Array, rate: Array, acceleration: Array, lag_s: float = 0.0
) -> Mapping[str, BodyPose]:
    """Return the poses of all bodies.

    Where the rates belong to ``lag_s`` after the coordinates, each level is computed at its own
    instant: velocities at the coordinates of then, accelerations with the rates of now.

    Parameters
    ----------
    limbs : Sequence[Limb]
        Parents before children; the columns of ``q`` follow their freedoms in this order.
    q, rate, acceleration : Array
        Joint coordinates, rates and accelerations [rad or m, per s, per s^2], shape (T, n).
    """
    if lag_s == 0.0:
        moving = _bodies(limbs, q, rate, acceleration)
        return {name: _pose(body, body) for name, body in moving.items()}
    now = _bodies(limbs, q, rate - lag_s * acceleration, acceleration)
    then = _bodies(limbs, q + lag_s * rate, rate, acceleration)
    return {name: _pose(now[name], then[name]) for name in now}


def _bodies(
    limbs: Sequence[Limb], q: Array, rate: Array, acceleration: Array
) -> dict[str, _MovingFrame]:
    """Return all bodies, every level at one instant."""
    still = np.zeros(len(q))
    ground = still.astype(np.complex128)
    moving = {GROUND: _MovingFrame(ground, still, ground, still, ground, still)}
    column = 0
    for limb in limbs:
        base = moving[limb.parent]
        body = base.shifted(_arm(base.theta, limb.offset))
        body.theta = body.theta + limb.angle_rad
        for freedom in limb.freedoms:
            shift = q[:, column] - freedom.ref
            body = _moved(body, freedom, shift, rate[:, column], acceleration[:, column])
            column += 1
        moving[limb.body] = body
    return {limb.body: moving[limb.body] for limb in limbs}


def _moved(
    body: _MovingFrame, freedom: Freedom, shift: Array, rate: Array, push: Array
) -> _MovingFrame:
    """Return the frame after one more joint coordinate."""
    if freedom.kind == "hinge":
        pivot = body.shifted(_arm(body.theta, freedom.anchor))
        pivot.theta = pivot.theta + shift
        pivot.omega = pivot.omega + rate
        pivot.alpha = pivot.alpha + push
        return pivot.shifted(-_arm(pivot.theta, freedom.anchor))
    axis = _arm(body.theta, freedom.axis)
    slid = body.shifted(axis * shift)
    slid.speed = slid.speed + axis * rate
    slid.push = slid.push + axis * push + 2j * body.omega * axis * rate
    return slid


def _arm(theta: Array, local: Point) -> Plane:
    return np.asarray(np.exp(1j * theta) * complex(*local))


def _pose(now: _MovingFrame, then: _MovingFrame) -> BodyPose:
    """Return the frame as real arrays: velocities from ``then``, the rest from ``now``."""

    def pair(number: Plane) -> Array:
        return np.stack([number.real, number.imag], axis=-1)

    return BodyPose(
        pair(now.place), now.theta, pair(then.speed), then.omega, pair(now.push), now.alpha
    )
