"""The springs of a scene, as exudyn's own spring-dampers, whose derivatives it knows.

Between points along their line; in a pin between the angles of two nodes, which count turns; along
the line of a slider between the guide, whose axis turns with it, and what rides on the line.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping

from models.joints import joints, line_ends, riding_body, turned, whole_turns
from models.loads import LineSpring, PinSpring, SlideSpring
from models.motion import State
from models.poses import frames
from models.scene import Scene
from sim.exudyn.library import items
from sim.exudyn.plane_system import Index, PlaneSystem

Held = tuple[float, float, float]
"""Rate, damping, and the length or angle at which it is slack."""


class Springs:
    """Adds the springs of a scene to a system, at the angles that a state has."""

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
        """Between coordinates of nodes, which count from the start."""
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
        """The springs as exudyn has them."""
        told = {}
        for name, index in self._index.items():
            own = self._made.system.GetObject(index)
            free = own["offset"] if "offset" in own else own["referenceLength"]
            free = float(free) + self._ahead.get(name, 0.0)
            told[name] = (float(own["stiffness"]), float(own["damping"]), free)
        return told
