"""Where bodies rub on one another: the joints of a chunk that have friction, and what it acts on.

::

    pin      second body turns at w = omega2 - omega1   the first exerts a couple c on it, c w <= 0
    slider   what slides moves at v along e             the guide exerts f e on it, f v <= 0

Friction in a slider acts at its point, along the line. Of a block or link that its guide holds by
two edges, with a moment, that is the classical friction of the resultant normal force alone.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass

import numpy as np

from analytic.dyads.chunk import Chunk
from analytic.dyads.plane import Real
from analytic.forces.bounded import Bounded, BoundedVec
from analytic.forces.free_body import Balance, Displaced, FreeBody, PrismaticPair
from analytic.structure.mobility import Structure
from models.errors import CrankcheckError, few
from models.loads import ConstantFriction, Friction
from models.scene import GROUND, Scene

STILL = 1e-12
"""Below this share of the driver's rate (and of the longest link) a joint does not move: what is
left is rounding, and its friction, anywhere within its limits, is taken as 0."""


@dataclass(frozen=True)
class Rubbing:
    """A joint with friction: ``pair`` where it is a slider, the bodies ``first`` and ``second``.

    ``against`` is the direction of friction, -1, 0 or 1, against that of the motion; its error is
    up to 2 where rounding does not tell the way of the motion.
    """

    law: Friction
    first: str
    second: str
    against: Bounded
    pair: PrismaticPair | None

    def put(self, free: Mapping[str, FreeBody], friction: Bounded) -> None:
        """The friction, with its sign, on both bodies."""
        if self.pair is None:
            free[self.second].moment = free[self.second].moment + friction
            if self.first != GROUND:
                free[self.first].moment = free[self.first].moment - friction
            return
        force = self.pair.along * friction
        free[self.second].push(self.pair.arms[self.second], force)
        if self.first != GROUND:
            free[self.first].push(self.pair.arms[self.first], -force)

    def reaction(self, balance: Balance) -> BoundedVec | Bounded:
        """What the friction grows with: the force in the pin, or the slider's normal force."""
        if self.pair is None:
            return balance.pins[self.law.joint][self.second]
        return balance.sliders[self.pair.name][0]


def rubbing_joints(
    scene: Scene,
    structure: Structure,
    chunk: Chunk,
    free: Mapping[str, FreeBody],
    displaced: Displaced,
) -> Iterator[Rubbing]:
    """The joints of a chunk that have friction. Raises CrankcheckError for a joint that is not
    there, or in which more than two bodies meet."""
    for joint, law in scene.friction.items():
        if joint in scene.sliders:
            slider, sliding = scene.sliders[joint], chunk.sliders[joint]
            pair = PrismaticPair(slider, scene, free, displaced[joint])
            error = None if sliding.error is None else sliding.error.speed
            against = _against(chunk, sliding.speed, error, scene.longest_m)
            yield Rubbing(law, slider.on, pair.body, against, pair)
            continue
        first, second = _bodies_of_pin(scene, structure, joint)
        one, other = chunk.bodies[first], chunk.bodies[second]
        error = None
        if one.error is not None and other.error is not None:
            error = one.error.omega + other.error.omega
        yield Rubbing(
            law, first, second, _against(chunk, other.omega - one.omega, error, 1.0), None
        )


def put_constant_friction(
    joints: Iterable[Rubbing], free: Mapping[str, FreeBody]
) -> dict[str, Bounded]:
    """Put what rubs the same whatever a joint bears on the bodies; that friction, by joint."""
    friction = {}
    for rubbing in joints:
        if isinstance(rubbing.law, ConstantFriction):
            size = rubbing.against * Bounded(rubbing.law.size)
            rubbing.put(free, size)
            friction[rubbing.law.joint] = size
    return friction


def _bodies_of_pin(scene: Scene, structure: Structure, joint: str) -> tuple[str, str]:
    """Files are checked when they are read; a scene may be made otherwise."""
    bodies = structure.pins.get(joint, ())
    if len(bodies) != 2:
        names = [n for n, held in structure.pins.items() if len(held) == 2] + list(scene.sliders)
        raise CrankcheckError(
            f"{scene.name}: friction.{joint}: {len(bodies)} bodies meet there, and two rub on one "
            f"another; use one of {few(names, 12)}"
        )
    return bodies[0], bodies[1]


def _against(chunk: Chunk, rate: Real, error: Real | None, length_m: float) -> Bounded:
    """The opposite direction of a rate; of one that is 0 but for rounding none."""
    least = STILL * length_m * np.abs(chunk.driver.omega)
    rate = np.broadcast_to(np.asarray(rate, dtype=np.float64), chunk.theta.shape)
    sign = np.where(np.abs(rate) > least, -np.sign(rate), 0.0)
    if error is None:
        return Bounded(sign, None)
    open_ = np.abs(rate) <= np.maximum(least, error)
    return Bounded(sign, np.where(open_, 1.0 + np.abs(sign), 0.0))
