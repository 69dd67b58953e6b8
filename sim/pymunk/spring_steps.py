"""The springs and dampers of a scene, given like loads: with the lengths and rates of the end of
the step.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping

from models.joints import Prism, Slot, joints, less, line_ends, riding_body, turned, whole_turns
from models.loads import LineSpring, PinSpring, SlideSpring, Spring
from models.scene import Point, Scene
from sim.pymunk.pushes import Pushes
from sim.pymunk.space import SpaceModel
from sim.pymunk.step_end import Course, Frames, SliderCourse, anchor_of, frames_at_end


class SpringSteps:
    """The springs of a scene that its space has not of its own, ``but`` those of a chain."""

    def __init__(
        self,
        scene: Scene,
        model: SpaceModel,
        tracks: Mapping[str, SliderCourse],
        dt_s: float,
        but: Collection[Spring] = (),
    ) -> None:
        start = frames_at_end(model, 0.0)
        self._steps: list[_OnLine | _InPin | _OnSlide] = []
        slides = {slide.slider.name: slide for slide in joints(scene).slides}
        for name, spring in scene.springs.items():
            if name in model.springs or spring in but:
                continue
            if isinstance(spring, LineSpring):
                self._steps.append(_OnLine(scene, model, spring, start, dt_s))
            elif isinstance(spring, PinSpring):
                self._steps.append(_InPin(spring, start, dt_s))
            else:
                slide, track = slides[spring.slider], tracks[spring.slider]
                self._steps.append(_OnSlide(scene, model, spring, slide, track))

    def __bool__(self) -> bool:
        return bool(self._steps)

    @property
    def numbers(self) -> dict[str, tuple[float, float, float]]:
        """Rate, damping and the length at which it is slack, of each by name."""
        springs = (step.spring for step in self._steps)
        return {one.name: (one.rate, one.damping, one.free) for one in springs}

    def push(self, frames: Frames, pushes: Pushes) -> None:
        """Have them act."""
        for step in self._steps:
            step.push(frames, pushes)


class _OnLine:
    """A spring between two points."""

    def __init__(
        self, scene: Scene, model: SpaceModel, spring: LineSpring, start: Frames, dt_s: float
    ) -> None:
        self.spring = spring
        self._ends = tuple(
            (body, less(place, model.centre[body])) for body, place in line_ends(scene, spring)
        )
        self._course = Course(math.dist(*self._places(start)), dt_s)

    def _places(self, frames: Frames) -> tuple[Point, Point]:
        first, second = (frames[body].at(anchor) for body, anchor in self._ends)
        return first, second

    def push(self, frames: Frames, pushes: Pushes) -> None:
        """At the end of the step; of a length of 0 it is open where it would pull."""
        first, second = self._places(frames)
        length = math.dist(first, second)
        self._course.go_on(length)
        if length == 0.0:
            return
        pull = self.spring.pull(length, self._course.rate) / length
        fx, fy = pull * (second[0] - first[0]), pull * (second[1] - first[1])
        (one, _), (other, _) = self._ends
        pushes.force(one, frames[one], first, (fx, fy))
        pushes.force(other, frames[other], second, (-fx, -fy))


class _InPin:
    """A spring between two bodies that meet in a pin."""

    def __init__(self, spring: PinSpring, start: Frames, dt_s: float) -> None:
        self.spring = spring
        opened = self._opened(start)
        self._whole = whole_turns(spring, opened)
        self._course = Course(opened + self._whole, dt_s)

    def _opened(self, frames: Frames) -> float:
        first, second = self.spring.bodies
        return frames[second].theta - frames[first].theta

    def push(self, frames: Frames, pushes: Pushes) -> None:
        q = self._opened(frames) + self._whole
        self._course.go_on(q)
        pull = self.spring.pull(q, self._course.rate)
        first, second = self.spring.bodies
        pushes.torque(first, pull)
        pushes.torque(second, -pull)


class _OnSlide:
    """A spring along the line of a slider."""

    def __init__(
        self,
        scene: Scene,
        model: SpaceModel,
        spring: SlideSpring,
        slide: Prism | Slot,
        track: SliderCourse,
    ) -> None:
        self.spring, self._slide, self._track = spring, slide, track
        self._rider = riding_body(slide)
        self._anchor = anchor_of(scene, model, self._rider, slide.slider.point)

    def push(self, frames: Frames, pushes: Pushes) -> None:
        slider, rider = self._slide.slider, self._rider
        pull = self.spring.pull(self._track.course.value, self._track.course.rate)
        fx, fy = turned((-pull, 0.0), frames[slider.on].theta + slider.direction_rad)
        if isinstance(self._slide, Slot):
            pushes.note(slider.name, (fx, fy, 0.0))
        place = frames[rider].at(self._anchor)
        pushes.force(rider, frames[rider], place, (fx, fy))
        pushes.force(slider.on, frames[slider.on], place, (-fx, -fy))
