"""The second opinion on forces: Lagrange multipliers of all constraints at once.

Nothing here knows of dyads, groups or an order of solving. With the positions and velocities of a
motion, accelerations and multipliers are the unknowns of one linear system for each sample::

    | M      Phi_q^T |  | q''    |     | Q     |
    | Phi_q  0       |  | lambda |  =  | gamma |

Q holds weights, loads, springs and what of inertia goes with the squares of rates. As the driver's
equation is among the constraints Phi_q is square, and the lower half gives q'' without the upper
one: solved as a whole the system would have the square of its condition. Source: E. J. Haug,
Computer Aided Kinematics and Dynamics of Mechanical Systems, chapter 6.

Friction, which hangs on the multipliers, is put in Q, and both are worked out again and again.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import chain

import numpy as np

from analytic.multibody.dynamics import joint_forces
from models.array import Array
from models.errors import CrankcheckError
from models.motion import Forces, Motion
from models.scene import Scene
from models.scene.driver import driver_course
from tests.second_opinions.body_samples import (
    BodySamples,
    body_samples,
    cross,
    springs_on_bodies,
    weights_and_loads,
)
from tests.second_opinions.constraints import Constraints
from tests.second_opinions.friction import rubbing_samples

REFINEMENTS = 2
MOST = 400
"""Substitutions of friction: those of a contraction by 0.9."""
SETTLED = 1e-14
"""What the last of them changes, over the largest friction of all joints."""


def forces(scene: Scene, motion: Motion) -> Forces:
    """Driving torque and reactions of a mechanism of mobility 1 without redundant links, without
    bounds; of the accelerations of its motion the driver's alone is looked at.

    Raises CrankcheckError for constraints that are singular at a sample, or are not as many as the
    coordinates; for friction that does not settle.
    """
    system = equations(scene, motion)
    try:
        return _settled(scene, system, motion)
    except np.linalg.LinAlgError:
        raise CrankcheckError(
            f"{scene.name}: the constraints are singular at a sample, where the multipliers are "
            "not determined; leave it out"
        ) from None


def _settled(scene: Scene, system: Equations, motion: Motion) -> Forces:
    """The reactions, with what rubs put on the right side again until it stays."""
    bodies = body_samples(scene, motion)
    joints = rubbing_samples(scene, motion, bodies)
    friction = {joint: np.zeros(len(system.applied)) for joint in joints}
    for _ in range(MOST):
        pushed = system.applied.copy()
        for joint, own in joints.items():
            for name, force, torque in own.pushes(friction[joint]):
                at = system.constraints.at[name]
                pushed[:, at : at + 2] += force
                pushed[:, at + 2] += torque + cross(own.place - bodies[name].origin, force)
        multipliers = replace(system, applied=pushed).multipliers()
        found = reactions(system.constraints, motion.time_s, -multipliers)
        before = friction
        friction = {joint: own.friction(scene, joint, found) for joint, own in joints.items()}
        change = [np.abs(friction[joint] - before[joint]) for joint in joints]
        largest = max((np.max(np.abs(each)) for each in friction.values()), default=0.0)
        if not change or np.max(change) <= SETTLED * largest:
            return replace(found, friction=friction)
    raise CrankcheckError(
        f"{scene.name}: friction does not settle in {MOST} repeated substitutions, which it does "
        "where it contracts; leave out what is locked, and near it"
    )


@dataclass(frozen=True)
class Equations:
    """The equations of a scene at T samples: Phi_q and M (T, n, n), gamma and Q (T, n)."""

    constraints: Constraints
    jacobian: Array
    gamma: Array
    mass: Array
    applied: Array

    def accelerations(self) -> Array:
        return refined(self.jacobian, self.gamma)

    def multipliers(self) -> Array:
        inertia = (self.mass @ self.accelerations()[:, :, None])[:, :, 0]
        return refined(np.swapaxes(self.jacobian, 1, 2), self.applied - inertia)


def refined(matrix: Array, right: Array) -> Array:
    """The solutions (T, n) of linear systems, as exact as their entries are.

    Elimination alone errs by the condition of the whole system, in which a far dyad near a dead
    point counts. Steps of refinement leave an error of the size of Skeel's bound, eps |A^-1|
    (|A| |x| + |b|), component by component (R. D. Skeel, Iterative refinement implies numerical
    stability for Gaussian elimination, Math. Comp. 35, 1980).
    """
    x = np.linalg.solve(matrix, right[:, :, None])
    for _ in range(REFINEMENTS):
        x = x + np.linalg.solve(matrix, right[:, :, None] - matrix @ x)
    return np.asarray(x[:, :, 0], np.float64)


def equations(scene: Scene, motion: Motion) -> Equations:
    """The equations at the samples of a motion. Raises CrankcheckError as `forces`."""
    system = Constraints(scene)
    bodies = body_samples(scene, motion)
    own = [bodies[name] for name in system.bodies]
    q = np.column_stack([each for b in own for each in (b.origin, b.theta)])
    rates = np.column_stack([each for b in own for each in (b.velocity, b.omega)])
    alpha = driver_course(scene, motion)[2]
    mass, applied = np.zeros((*q.shape, system.size)), np.zeros_like(q)
    for name, body in bodies.items():
        _inertia(body, system.at[name], mass, applied)
    outside = (weights_and_loads(scene, motion), springs_on_bodies(scene, motion))
    for name, place, force, torque in chain(*outside):
        at = system.at[name]
        applied[:, at : at + 2] += force
        applied[:, at + 2] += torque + cross(bodies[name].arm(place), force)
    return Equations(
        system,
        np.array([system.jacobian(each) for each in q]),
        np.array([system.gamma(*each) for each in zip(q, rates, alpha.tolist(), strict=True)]),
        mass,
        applied,
    )


def _inertia(body: BodySamples, at: int, mass_matrix: Array, right: Array) -> None:
    """The mass matrix of a body about its frame's origin, and its centrifugal force."""
    mass, arm = body.mass, body.arm(body.centre)
    mass_matrix[:, at, at] = mass_matrix[:, at + 1, at + 1] = mass
    mass_matrix[:, at, at + 2] = mass_matrix[:, at + 2, at] = -mass * arm[:, 1]
    mass_matrix[:, at + 1, at + 2] = mass_matrix[:, at + 2, at + 1] = mass * arm[:, 0]
    mass_matrix[:, at + 2, at + 2] = body.inertia + mass * np.sum(arm**2, axis=1)
    right[:, at : at + 2] += mass * body.omega[:, None] ** 2 * arm


def reactions(system: Constraints, time_s: Array, pushes: Array) -> Forces:
    """What the multipliers mean: pushes along the gradients of the equations, in their order, the
    driver's last."""
    return joint_forces(system.assembly, time_s, pushes[:, :-1], pushes[:, -1])
