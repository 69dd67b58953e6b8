"""Springs of a scene in exudyn, and its friction, as forces against the motion."""

from functools import partial
from typing import Any

import numpy as np

from models.array import Array
from models.errors import EngineError
from models.scene import GROUND, Point, Scene, joints
from models.scene.loads import ConstantFriction, LineSpring, PinSpring, Spring
from sim.engine import Drive, ties
from sim.exudyn.loads import Applied
from sim.exudyn.system import Index, items


class Springs:
    """Adds the springs of a scene to a system, as exudyn's own spring-dampers, whose derivatives it
    knows.

    Between points along their line; in a pin between the angles of two nodes, which count turns;
    along the line of a slider between the guide, whose axis turns with it, and the riding body.
    """

    def __init__(self, applied: Applied) -> None:
        self._applied, self._made = applied, applied.made
        self._ahead: dict[str, float] = {}
        self._index: dict[str, Index] = {
            name: self._made.system.AddObject(self._item(spring))
            for name, spring in applied.scene.springs.items()
        }

    def _item(self, spring: Spring) -> object:
        """Make a spring; angles of nodes count from the start."""
        made = self._made
        own: dict[str, Any] = {"stiffness": spring.rate, "damping": spring.damping}
        if isinstance(spring, PinSpring):
            first, second = map(self._applied.turning, spring.bodies)
            opened = made.start_rad[second] - made.start_rad[first]
            ahead = self._ahead[spring.name] = opened + joints.whole_turns(spring, opened)
            own["markerNumbers"] = [made.coordinate_marker(body) for body in (first, second)]
            return items.ObjectConnectorCoordinateSpringDamper(offset=spring.free - ahead, **own)
        own["markerNumbers"] = [made.marker_at(*e) for e in ties.spring_ends(made.scene, spring)]
        if isinstance(spring, LineSpring):
            return items.ObjectConnectorSpringDamper(referenceLength=spring.free, **own)
        axis = joints.turned((1.0, 0.0), made.scene.sliders[spring.slider].direction_rad)
        own["axisMarker0"] = [*axis, 0.0]
        return items.ObjectConnectorLinearSpringDamper(offset=spring.free, **own)

    def held(self) -> dict[str, tuple[float, float, float]]:
        """Return rate, damping and slack length or angle of the springs, as exudyn has them."""
        told = {}
        for name, index in self._index.items():
            own = self._made.system.GetObject(index)
            free = float(own["offset"] if "offset" in own else own["referenceLength"])
            free += self._ahead.get(name, 0.0)
            told[name] = (float(own["stiffness"]), float(own["damping"]), free)
        return told


STILL = 1e-9
"""Least speed with friction, over the largest speed of the driver."""


def apply_friction(applied: Applied, drive: Drive) -> None:
    """Add friction in sliders and pins. Raises EngineError for friction that is not constant, and
    for joints that may come to rest, where a force against the motion is undefined."""
    scene = applied.scene
    if scene.friction and drive == "free":
        raise EngineError(
            f"friction ({', '.join(scene.friction)}): exudyn is given it as forces against the "
            "motion, and joints that nothing drives come to rest and stick; take it out, or use "
            "drive prescribed"
        )
    for name, friction in scene.friction.items():
        if not isinstance(friction, ConstantFriction):
            raise EngineError(f"friction.{name}: exudyn is given none that follows the reactions")
        rub = _rub_line if friction.joint in scene.sliders else _rub_pin
        rub(applied, friction, still_rad_s(scene))


def _rub_pin(applied: Applied, friction: ConstantFriction, still: float) -> None:
    def torque(own: str, other: str, system: Any, _: float) -> float:
        rate = applied.present.angle(system, own)[1] - applied.present.angle(system, other)[1]
        return float(against(friction.size, rate, still))

    first, second = map(applied.turning, joints.joined_at(applied.scene)[friction.joint][:2])
    applied.torque(first, partial(torque, first, second))
    applied.torque(second, partial(torque, second, first))


def _rub_line(applied: Applied, friction: ConstantFriction, still: float) -> None:
    """Add a force along the line on the sliding body, and the opposite on the guide."""
    slider, present = applied.scene.sliders[friction.joint], applied.present
    least = still * applied.scene.longest_m

    def force(sign: float, system: Any, _: float) -> Point:
        _, speed = present.slider(system, slider.name)
        size = sign * float(against(friction.size, speed, least))
        c, s = present.line(system, slider.name)
        return size * c, size * s

    applied.force(applied.tip(slider), partial(force, 1.0))
    if slider.on != GROUND:
        guide = applied.made.marker_at(slider.on, slider.through_m)
        applied.force(guide, partial(force, -1.0))


def still_rad_s(scene: Scene) -> float:
    """Return the least speed with friction; the direction of a lower one is rounding [rad/s]."""
    return STILL * scene.pace_rad_s


def against(size: float, speed: Array | float, still: float) -> Array:
    """Return the size against speeds, 0 at rest."""
    return np.where(np.abs(speed) > still, -np.copysign(size, speed), 0.0)
