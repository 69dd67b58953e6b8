"""Springs of a scene in exudyn, and its friction, as forces against the motion."""

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from models.array import Array
from models.errors import EngineError
from models.motion import State
from models.scene import GROUND, Point, Scene
from models.scene.joints import (
    frames,
    joined_at,
    joints,
    line_ends,
    riding_body,
    turned,
    whole_turns,
)
from models.scene.loads import ConstantFriction, LineSpring, PinSpring, SlideSpring
from sim.engine import Drive
from sim.exudyn.loads import Applied, Present, Size
from sim.exudyn.system import Index, PlaneSystem, items

Held = tuple[float, float, float]
"""Rate, damping, and slack length or angle."""


class Springs:
    """Adds the springs of a scene to a system, at the angles of a state, as exudyn's own
    spring-dampers, whose derivatives it knows.

    Between points along their line; in a pin between the angles of two nodes, which count turns;
    along the line of a slider between the guide, whose axis turns with it, and the riding body.
    """

    def __init__(
        self, scene: Scene, state: State, made: PlaneSystem, turning: Callable[[str], str]
    ) -> None:
        self._scene, self._made, self._turning = scene, made, turning
        self._theta = {name: frame.theta for name, frame in frames(scene, state).items()}
        self._index: dict[str, Index] = {}
        self._ahead: dict[str, float] = {}
        for name, spring in scene.springs.items():
            if isinstance(spring, LineSpring):
                item = self._between_points(spring)
            elif isinstance(spring, PinSpring):
                item = self._in_pin(spring)
            else:
                item = self._along_line(spring)
            self._index[name] = made.system.AddObject(item)

    def _between_points(self, spring: LineSpring) -> object:
        return items.ObjectConnectorSpringDamper(
            markerNumbers=[self._made.marker_at(*end) for end in line_ends(self._scene, spring)],
            stiffness=spring.rate,
            damping=spring.damping,
            referenceLength=spring.free,
        )

    def _in_pin(self, spring: PinSpring) -> object:
        """Make a spring between coordinates of nodes, which count from the start."""
        first, second = (self._turning(body) for body in spring.bodies)
        opened = self._theta[second] - self._theta[first]
        ahead = self._ahead[spring.name] = opened + whole_turns(spring, opened)
        return items.ObjectConnectorCoordinateSpringDamper(
            markerNumbers=[self._made.angle_marker(body) for body in (first, second)],
            stiffness=spring.rate,
            damping=spring.damping,
            offset=spring.free - ahead,
        )

    def _along_line(self, spring: SlideSpring) -> object:
        slide = next(s for s in joints(self._scene).slides if s.slider.name == spring.slider)
        slider = slide.slider
        return items.ObjectConnectorLinearSpringDamper(
            markerNumbers=[
                self._made.marker_at(slider.on, slider.through_m),
                self._made.marker(self._scene, riding_body(slide), slider.point),
            ],
            stiffness=spring.rate,
            damping=spring.damping,
            offset=spring.free,
            axisMarker0=[*turned((1.0, 0.0), slider.direction_rad), 0.0],
        )

    def held(self) -> Mapping[str, Held]:
        """Return the springs as exudyn has them."""
        told = {}
        for name, index in self._index.items():
            own = self._made.system.GetObject(index)
            free = own["offset"] if "offset" in own else own["referenceLength"]
            free = float(free) + self._ahead.get(name, 0.0)
            told[name] = (float(own["stiffness"]), float(own["damping"]), free)
        return told


STILL = 1e-9
"""Least speed with friction, over the largest speed of the driver."""


def apply_friction(
    scene: Scene, drive: Drive, made: PlaneSystem, applied: Applied, present: Present
) -> None:
    """Add friction in sliders and pins. Raises EngineError for friction that is not constant, and
    for joints that may come to rest, where a force against the motion is undefined."""
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
    """Add a couple between the two bodies of a pin."""
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
    """Add a force along the line on the sliding body, and the opposite on the guide."""
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
    """Return the least speed with friction; the direction of a lower one is rounding [rad/s]."""
    return STILL * scene.pace_rad_s


def against(size: float, speed: Array | float, still: float) -> Array:
    """Return the size against speeds, 0 at rest."""
    return np.where(np.abs(speed) > still, -np.copysign(size, speed), 0.0)
