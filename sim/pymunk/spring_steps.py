"""Springs and dampers of a scene, applied like loads: with the lengths and rates of the end of the
step."""

import math
from collections.abc import Collection, Mapping, Sequence

import numpy as np
import pymunk.batch

from models.array import Array
from models.scene import Scene
from models.scene.joints import less, whole_turns
from models.scene.loads import LineSpring, PinSpring, SegmentSpring, SlideSpring, Spring
from sim.engine.ties import spring_ends
from sim.pymunk.bodies import Course, Frames, SliderCourse, frames_at_end, rows_of
from sim.pymunk.native import Pushes
from sim.pymunk.space import SpaceModel


class SpringSteps:
    """Springs of a scene that are not the space's own, ``but`` the springs of a chain."""

    def __init__(
        self,
        model: SpaceModel,
        tracks: Mapping[str, SliderCourse],
        dt_s: float,
        but: Collection[Spring],
    ) -> None:
        start = frames_at_end(model, 0.0)
        self._steps: list[_OnLine | _InPin | _OnSlide] = []
        for name, spring in model.scene.springs.items():
            if name in model.springs or spring in but:
                continue
            if isinstance(spring, LineSpring):
                self._steps.append(_OnLine(model, spring, start, dt_s))
            elif isinstance(spring, PinSpring):
                self._steps.append(_InPin(spring, start, dt_s))
            else:
                self._steps.append(_OnSlide(spring, tracks[spring.slider]))

    def __bool__(self) -> bool:
        return bool(self._steps)

    @property
    def numbers(self) -> dict[str, tuple[float, float, float]]:
        """Rate, damping and slack length of each spring by name."""
        springs = (step.spring for step in self._steps)
        return {one.name: (one.rate, one.damping, one.free) for one in springs}

    def push(self, frames: Frames, pushes: Pushes) -> None:
        """Apply the springs."""
        for step in self._steps:
            step.push(frames, pushes)


class _OnLine:
    def __init__(self, model: SpaceModel, spring: LineSpring, start: Frames, dt_s: float) -> None:
        self.spring = spring
        first, second = (
            (body, less(place, model.centre[body]))
            for body, place in spring_ends(model.scene, spring)
        )
        self._ends = first, second
        self._course = Course(self._length(start), dt_s)

    def _length(self, frames: Frames) -> float:
        return math.dist(*(frames[body].at(anchor) for body, anchor in self._ends))

    def push(self, frames: Frames, pushes: Pushes) -> None:
        """Apply the spring at the end of the step."""
        length = self._length(frames)
        self._course.go_on(length)
        pushes.pull(*self._ends, frames, self.spring.pull(length, self._course.rate))


class _InPin:
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
    def __init__(self, spring: SlideSpring, track: SliderCourse) -> None:
        self.spring, self._track = spring, track

    def push(self, frames: Frames, pushes: Pushes) -> None:
        course = self._track.course
        self._track.push(-self.spring.pull(course.value, course.rate), frames, pushes)


TURNING = pymunk.batch.BodyFields.ANGLE | pymunk.batch.BodyFields.ANGULAR_VELOCITY
TORQUE = pymunk.batch.BodyFields.TORQUE


def chain_springs(scene: Scene) -> tuple[SegmentSpring, ...]:
    """Return the springs between the segments of a scene's elastic links, and no others."""
    return tuple(one for one in scene.springs.values() if isinstance(one, SegmentSpring))


class ChainSprings:
    """Springs in pins of a chain of segments, applied all at once, with the angles and rates of the
    end of each step: one by one, as in `SpringSteps`, they would take most of a run's time."""

    def __init__(self, model: SpaceModel, springs: Sequence[SegmentSpring], dt_s: float) -> None:
        self._space, self._dt, self._rows = model.space, dt_s, rows_of(model)
        self.numbers = {one.name: (one.rate, one.damping, one.free) for one in springs}
        """Rate, damping and slack angle of each spring by name."""
        self._angles, self._torques = pymunk.batch.Buffer(), pymunk.batch.Buffer()
        self._first, self._second = (
            np.array([self._rows[one.bodies[k]] for one in springs]) for k in (0, 1)
        )
        self._rate, self._damping, self._free = (
            np.array([getattr(one, key) for one in springs]) for key in ("rate", "damping", "free")
        )
        theta = self._turning()[:, 0]
        # Rows for bodies, columns for springs.
        self._share = np.zeros((len(theta), len(springs)))
        self._share[self._first, range(len(springs))] = 1.0
        self._share[self._second, range(len(springs))] = -1.0
        opened = theta[self._second] - theta[self._first]
        self._whole = np.array(
            [whole_turns(one, angle) for one, angle in zip(springs, opened.tolist(), strict=True)]
        )
        self._course = Course(opened + self._whole, dt_s)

    def by_body(self) -> dict[str, float]:
        """Return the torques on all bodies in the next step [N m]."""
        torques = self._next().tolist()
        return {name: torques[row] for name, row in self._rows.items()}

    def push(self) -> None:
        """Apply the springs in the next step, where they act alone."""
        self._torques.set_float_buf(self._next())
        pymunk.batch.set_space_bodies(self._space, TORQUE, self._torques)

    def _next(self) -> Array:
        """Return the torques in the next step [N m], by row of a batch."""
        theta, omega = self._turning().T
        theta = theta + self._dt * omega
        q = theta[self._second] - theta[self._first] + self._whole
        self._course.go_on(q)
        pull = self._rate * (q - self._free) + self._damping * self._course.rate
        return np.asarray(self._share @ pull)

    def _turning(self) -> Array:
        """Return angle and angular velocity of all bodies of the space, (rows, 2)."""
        self._angles.clear()
        pymunk.batch.get_space_bodies(self._space, TURNING, self._angles)
        return np.frombuffer(self._angles.float_buf()).reshape(-1, 2)
