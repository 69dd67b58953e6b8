"""Friction in pins that is always as large: a motor that wants no turning, and can do so much.

Chipmunk's motor of rate 0 brings the turning of one body against the other to rest, by an impulse
of at most ``max_force * dt``: where the mechanism goes on turning it is as large as that, against
the motion, and where it would stop, it holds. A kinematic crank is not braked, nor is the ground:
their friction is added to what the drive gives.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import pymunk

from models.array import Array
from models.errors import EngineError
from models.joints import Slot, block_name, joined_at, joints
from models.loads import ConstantFriction
from models.scene import Scene
from sim.pymunk.pushes import moves_freely

WHOLE = 1.0 - 1e-9
"""The share of its largest couple from which on a motor counts as overcome."""


@dataclass(frozen=True)
class PinFriction:
    """The friction of a pin: ``first`` and ``second`` are its bodies in the space, of which a block
    without mass is one with its guide; ``motor`` is None where neither can be braked."""

    joint: str
    first: str
    second: str
    size: float
    motor: pymunk.SimpleMotor | None

    def couple(self, impulse: Array, before: Array, after: Array, dt_s: float) -> Array:
        """What the first body exerted on the second over each step [N m], (T,).

        Parameters
        ----------
        impulse : Array
            Of the motor; empty where there is none.
        before, after : Array
            The angular velocity of the second body against the first [rad/s] before and after the
            step: a motor that was overcome is against what is left, another one brought the body to
            rest, against what was there.
        """
        if self.motor is None:
            return np.asarray(-self.size * np.sign(after))
        magnitude = impulse / dt_s
        return np.asarray(
            -magnitude * np.sign(np.where(magnitude >= WHOLE * self.size, after, before))
        )


def pin_friction(scene: Scene, made: Mapping[str, pymunk.Body]) -> tuple[PinFriction, ...]:
    """The constant friction of the pins of a scene, for its bodies in the space, by name, the
    ground among them. Raises EngineError for a pin that has not two."""
    guides = {
        block_name(slide.slider): slide.slider.on
        for slide in joints(scene).slides
        if isinstance(slide, Slot)
    }
    rubs = []
    for joint, law in scene.friction.items():
        if isinstance(law, ConstantFriction) and joint not in scene.sliders:
            first, second = _two(scene, joint, guides)
            ends = made[first], made[second]
            motor = None
            if any(map(moves_freely, ends)):
                motor = pymunk.SimpleMotor(*ends, 0.0)
                motor.max_force = law.size
            rubs.append(PinFriction(joint, first, second, law.size, motor))
    return tuple(rubs)


def _two(scene: Scene, joint: str, guides: Mapping[str, str]) -> tuple[str, str]:
    """The bodies in the space that a pin joins."""
    names = joined_at(scene).get(joint, ())
    if len(names) != 2:
        raise EngineError(
            f"{scene.name}: friction.{joint}: {len(names)} bodies meet there, and two rub on one "
            "another; use a pin of two, or a slider"
        )
    return guides.get(names[0], names[0]), guides.get(names[1], names[1])
