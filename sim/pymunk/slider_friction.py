"""Friction of sliders that is always as large, given like a load, against the motion.

The speed of a slider is that at the end of the step. What stands still is not held: a mechanism
that is driven stands still at the ends of strokes alone.
"""

from __future__ import annotations

import math
from collections.abc import Mapping

from models.errors import EngineError
from models.joints import Slot, joints, riding_body, turned
from models.loads import ConstantFriction
from models.scene import Scene
from sim.engine import Drive
from sim.pymunk.pushes import Pushes
from sim.pymunk.space import SpaceModel
from sim.pymunk.step_end import Frames, SliderCourse, anchor_of


class SliderFriction:
    """The constant friction of the sliders of a scene, in a space."""

    def __init__(
        self, scene: Scene, model: SpaceModel, tracks: Mapping[str, SliderCourse], drive: Drive
    ) -> None:
        slides = {slide.slider.name: slide for slide in joints(scene).slides}
        self._scene, self._model, self._tracks = scene, model, tracks
        self._rubbing = [
            (slides[one.joint], one.size)
            for one in scene.friction.values()
            if isinstance(one, ConstantFriction) and one.joint in slides
        ]
        if drive == "free" and self._rubbing:
            names = ", ".join(f"friction.{slide.slider.name}" for slide, _ in self._rubbing)
            raise EngineError(
                f"{scene.name}: {names}: pymunk has no friction that holds a slider at rest, and "
                "free motion may bring it there; drive the mechanism, or take the friction out"
            )

    def __bool__(self) -> bool:
        return bool(self._rubbing)

    def push(self, frames: Frames, pushes: Pushes) -> dict[str, float]:
        """Have it act on what slides, and the opposite on the guide: its size by slider [N]."""
        rubbed = {}
        for slide, size in self._rubbing:
            slider, rider = slide.slider, riding_body(slide)
            speed = self._tracks[slider.name].course.rate
            against = -math.copysign(size, speed) if speed else 0.0
            rubbed[slider.name] = against
            fx, fy = turned((against, 0.0), frames[slider.on].theta + slider.direction_rad)
            if isinstance(slide, Slot):
                pushes.note(slider.name, (fx, fy, 0.0))
            place = frames[rider].at(anchor_of(self._scene, self._model, rider, slider.point))
            pushes.force(rider, frames[rider], place, (fx, fy))
            pushes.force(slider.on, frames[slider.on], place, (-fx, -fy))
        return rubbed
