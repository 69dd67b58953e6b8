"""Friction that is constant, as forces and torques against the motion that exudyn is in."""

from __future__ import annotations

from typing import Any

import numpy as np

from models.array import Array
from models.errors import EngineError
from models.joints import joined_at
from models.loads import ConstantFriction
from models.scene import GROUND, Point, Scene
from sim.engine import Drive
from sim.exudyn.applied import Applied, Size
from sim.exudyn.plane_system import PlaneSystem
from sim.exudyn.present import Present

STILL = 1e-9
"""Over the largest speed of the driver."""


def apply_friction(
    scene: Scene, drive: Drive, made: PlaneSystem, applied: Applied, present: Present
) -> None:
    """Add friction in sliders and pins. Raises EngineError for what is not constant, and for
    joints that may come to rest, where no force against the motion says what holds them."""
    if scene.friction and drive == "free":
        raise EngineError(
            f"friction ({', '.join(scene.friction)}): exudyn is given it as forces against the "
            "motion, and joints that nothing drives come to rest and stick; take it out, or use "
            "drive prescribed"
        )
    for name, friction in scene.friction.items():
        if not isinstance(friction, ConstantFriction):
            raise EngineError(f"friction.{name}: exudyn is given none that follows the reactions")
        if friction.joint in scene.sliders:
            _rub_line(scene, friction, made, applied, present)
        else:
            _rub_pin(scene, friction, applied, present)


def _rub_pin(scene: Scene, friction: ConstantFriction, applied: Applied, present: Present) -> None:
    """A couple of the two bodies of a pin on one another."""
    first, second = joined_at(scene)[friction.joint]
    turning = applied.turning(first), applied.turning(second)
    still = still_rad_s(scene)

    def on(side: int) -> Size:
        def torque(system: Any, _: float) -> float:
            own, other = (present.angle(system, turning[k])[1] for k in (side, 1 - side))
            return float(against(friction.size, own - other, still))

        return torque

    applied.torque(first, on(0))
    applied.torque(second, on(1))


def _rub_line(
    scene: Scene, friction: ConstantFriction, made: PlaneSystem, applied: Applied, present: Present
) -> None:
    """A force along the line on what slides, and the opposite on the guide, on the same line."""
    slider = scene.sliders[friction.joint]
    still = still_rad_s(scene) * scene.longest_m

    def along(sign: float) -> Any:
        def force(system: Any, _: float) -> Point:
            _, speed = present.slider(system, slider.name)
            size = sign * float(against(friction.size, speed, still))
            c, s = present.line(system, slider.name)
            return size * c, size * s

        return force

    applied.force(applied.tip(slider.name), along(1.0))
    if slider.on != GROUND:
        applied.force(made.marker_at(slider.on, slider.through_m), along(-1.0))


def still_rad_s(scene: Scene) -> float:
    """What turns no faster does not rub, as its direction is rounding [rad/s]."""
    return STILL * scene.pace_rad_s


def against(size: float, speed: Array | float, still: float) -> Array:
    """The size against speeds, 0 where these are none."""
    return np.where(np.abs(speed) > still, -np.copysign(size, speed), 0.0)
