"""The third opinion on forces: power balances at every instant.

What the drive puts in is what energy gains, less what loads, springs and friction put in::

    torque omega = d/dt (T + V) - sum (F v + M omega),   dT/dt = sum (m a_S v_S + J alpha omega)

Reactions do no work, so none is in it.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from itertools import chain

import numpy as np

from models.array import Array
from models.errors import CrankcheckError
from models.motion import Motion
from models.scene import Scene
from models.scene.driver import driver_course
from tests.second_opinions.body_samples import (
    body_samples,
    springs_on_bodies,
    weights_and_loads,
)
from tests.second_opinions.friction import rubbing_samples


@dataclass(frozen=True)
class PowerBalance:
    """Power of the drive [W], and what becomes of it, (T,); ``scale`` is the sum of its parts."""

    put_in: Array
    used: Array
    scale: Array


def power_balance(
    scene: Scene, motion: Motion, torque: Array, friction: Mapping[str, Array] | None = None
) -> PowerBalance:
    """The power of a driving torque [N m] beside what the motion, the loads, the springs and the
    friction, by joint as in `models.motion.Forces`, take up."""
    used, scale = np.zeros(len(motion.time_s)), np.zeros(len(motion.time_s))
    bodies = body_samples(scene, motion)
    parts = []
    for body in bodies.values():
        push = body.mass * body.acceleration_at(body.centre)
        parts.append(np.sum(push * body.velocity_at(body.centre), axis=1))
        parts.append(body.inertia * body.alpha * body.omega)
    outside = (weights_and_loads(scene, motion), springs_on_bodies(scene, motion))
    for name, place, force, moment in chain(*outside):
        body = bodies[name]
        parts.append(-np.sum(force * body.velocity_at(place), axis=1) - moment * body.omega)
    for joint, rubbing in rubbing_samples(scene, motion, bodies).items():
        if friction is None:
            raise CrankcheckError(
                f"{scene.name}: friction.{joint} is not given; give Forces.friction"
            )
        parts.append(-friction[joint] * rubbing.rate)
    for part in parts:
        used += part
        scale += np.abs(part)
    put_in = torque * driver_course(scene, motion)[1]
    return PowerBalance(put_in, used, scale + np.abs(put_in))
