"""How the crank and the sliders stand and move at present, in the middle of a step as well."""

from __future__ import annotations

import math
from typing import Any

from models.joints import Prism, Slot, joints, riding_body
from models.motion import State
from models.poses import frames
from models.scene import GROUND, Point, Scene
from sim.exudyn.library import exu
from sim.exudyn.plane_system import ANGLE, Index, PlaneSystem

KIND = exu.OutputVariableType


class Present:
    """The present of a system, for what acts on it by its state."""

    def __init__(self, scene: Scene, state: State, made: PlaneSystem) -> None:
        self._scene, self._made = scene, made
        self._start_rad = {name: frame.theta for name, frame in frames(scene, state).items()}
        self._ends = {slide.slider.name: self._ends_of(slide) for slide in joints(scene).slides}

    def _ends_of(self, slide: Prism | Slot) -> tuple[Index, Index]:
        """Markers of the point that slides and of that which the line passes through."""
        slider = slide.slider
        return (
            self._made.marker(self._scene, riding_body(slide), slider.point),
            self._made.marker_at(slider.on, slider.through_m),
        )

    def angle(self, system: Any, body: str) -> tuple[float, float]:
        """Of a body or the ground: angle [rad] and rate [rad/s]."""
        if body == GROUND:
            return 0.0, 0.0
        node = self._made.node[body]
        turned = float(system.GetNodeOutput(node, KIND.Coordinates)[ANGLE])
        rate = float(system.GetNodeOutput(node, KIND.Coordinates_t)[ANGLE])
        return self._start_rad[body] + turned, rate

    def line(self, system: Any, name: str, turned_rad: float = 0.0) -> Point:
        """The direction of the line of a slider in the plane, or one turned against it."""
        slider = self._scene.sliders[name]
        angle = self.angle(system, slider.on)[0] + slider.direction_rad + turned_rad
        return math.cos(angle), math.sin(angle)

    def slider(self, system: Any, name: str) -> tuple[float, float]:
        """Of a slider: displacement [m] and speed [m/s] as seen from its guide."""
        tip, start = self._ends[name]
        x, y = self._apart(system, tip, start, KIND.Position)
        u, v = self._apart(system, tip, start, KIND.Velocity)
        c, s = self.line(system, name)
        _, omega = self.angle(system, self._scene.sliders[name].on)
        return c * x + s * y, c * (u + omega * y) + s * (v - omega * x)

    def _apart(self, system: Any, tip: Index, start: Index, what: Any) -> Point:
        x, y, _ = system.GetMarkerOutput(tip, what) - system.GetMarkerOutput(start, what)
        return float(x), float(y)
