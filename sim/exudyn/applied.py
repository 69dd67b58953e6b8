"""Forces and torques that exudyn applies to bodies: numbers of its own, or what it calls back for.

It calls with the time and in the state that its Newton's method is at, so that a load belongs to
the end of the step, as all forces of an implicit step do. A block without mass is no body here: a
force on it is one on the body whose point rides on the line, a torque on it one on the guide, which
it turns with.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from models.errors import CrankcheckError
from models.joints import block_name, joints, riding_body
from models.scene import GROUND, Point, Scene
from sim.exudyn.library import items
from sim.exudyn.plane_system import Index, PlaneSystem

Size = Callable[[Any, float], float]
"""A size [N or N m], of the system and of the time on exudyn's clock."""
Vector = Callable[[Any, float], Point]
"""A force [N], of the same."""


def massless_blocks(scene: Scene) -> dict[str, str]:
    """The sliders whose block is no body in exudyn, by the name of the block."""
    return {block_name(slot.slider): slot.slider.name for slot in joints(scene).slots}


class Applied:
    """Adds forces and torques to a system. ``fault`` is why one of them has no size any more."""

    def __init__(self, scene: Scene, made: PlaneSystem) -> None:
        self._scene, self._made = scene, made
        self._massless = massless_blocks(scene)
        self.fault = ""
        self._rider = {slide.slider.name: riding_body(slide) for slide in joints(scene).slides}

    def turning(self, body: str) -> str:
        """The body that a body turns as: of a block without mass, its guide."""
        slider = self._massless.get(body)
        return body if slider is None else self._scene.sliders[slider].on

    def on(self, body: str, point: str) -> Index:
        """A marker at a point of a body, or of what rides for a block without mass."""
        slider = self._massless.get(body)
        return self._made.marker(self._scene, body, point) if slider is None else self.tip(slider)

    def tip(self, slider: str) -> Index:
        """A marker at the point that slides."""
        point = self._scene.sliders[slider].point
        return self._made.marker(self._scene, self._rider[slider], point)

    def force(self, marker: Index, force: Vector | Point, *, in_body: bool = False) -> None:
        """Add a force, in the frame of the ground or of the body."""
        told = (
            self._called(lambda *now: (*force(*now), 0.0))
            if callable(force)
            else _fixed(*force, 0.0)
        )
        self._made.system.AddLoad(
            items.LoadForceVector(markerNumber=marker, bodyFixed=in_body, **told)
        )

    def torque(self, body: str, torque: Size | float) -> None:
        """Add a torque on a body or a block; the ground feels none."""
        turning = self.turning(body)
        if turning == GROUND:
            return
        told = (
            self._called(lambda *now: (0.0, 0.0, torque(*now)))
            if callable(torque)
            else _fixed(0.0, 0.0, torque)
        )
        marker = self._made.marker_at(turning, (0.0, 0.0))
        self._made.system.AddLoad(items.LoadTorqueVector(markerNumber=marker, **told))

    def _called(self, vector: Callable[[Any, float], tuple[float, float, float]]) -> dict[str, Any]:
        """A load as what exudyn calls."""

        def called(system: Any, time_s: float, _: object) -> list[float]:
            try:
                return list(vector(system, time_s))
            except CrankcheckError as error:
                self.fault = str(error)  # exudyn would tell it with a traceback
                raise

        return {"loadVectorUserFunction": called}


def _fixed(*vector: float) -> dict[str, Any]:
    """A load as numbers."""
    return {"loadVector": list(vector)}
