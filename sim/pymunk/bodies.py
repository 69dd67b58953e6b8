"""Positions of the bodies of a space, now and at the end of the next step; springs from these.

A step of Chipmunk moves the positions x with the present velocity v, and then changes v by the
given forces and by the joints. The velocities belong to half a step after the positions, so that
this is the leapfrog, of second order with the forces at the end of the step::

    x(t + dt) = x(t) + dt v(t + dt/2)
    v(t + 3/2 dt) = v(t + dt/2) + dt a(x, v, t + dt)

The velocity at that instant itself, for dampers and motors, would be half by the step to come. It
is taken from the last three positions, to the second order.
"""

import math
from collections.abc import Collection, Mapping, Sequence
from typing import Generic, TypeVar

import numpy as np
import pymunk
import pymunk.batch

from models.array import Array
from models.scene import GROUND, Point, Scene
from models.scene.joints import FIXED, Frame, Prism, Slot, less, riding_body, turned, whole_turns
from models.scene.loads import LineSpring, PinSpring, SegmentSpring, SlideSpring, Spring
from sim.engine import BodyPose, measure, ties
from sim.pymunk.native import Pushes
from sim.pymunk.space import SpaceModel

FIELDS = (
    pymunk.batch.BodyFields.POSITION
    | pymunk.batch.BodyFields.ANGLE
    | pymunk.batch.BodyFields.VELOCITY
    | pymunk.batch.BodyFields.ANGULAR_VELOCITY
)
Value = TypeVar("Value", float, Array)
WIDTH = 6
"""Numbers per body: x, y, angle, vx, vy, omega."""


def finite(rows: Array) -> int:
    """Return the number of finite samples (T, bodies, numbers) before the first other one."""
    good = np.isfinite(rows).all(axis=(1, 2))
    return len(rows) if good.all() else int(np.argmin(good))


def rows_of(model: SpaceModel) -> dict[str, int]:
    """Return the row of each body in a batch; the static body of the space has one too."""
    buffer = pymunk.batch.Buffer()
    pymunk.batch.get_space_bodies(model.space, pymunk.batch.BodyFields.BODY_ID, buffer)
    order = np.frombuffer(buffer.int_buf(), dtype=np.uintp).tolist()
    return {name: order.index(body.id) for name, body in model.bodies.items()}


def pose(row: Array, centre: Point, lag_s: float) -> BodyPose:
    """Return the frame with the origin of the pymunk body at ``centre``; no accelerations."""
    theta, omega = row[:, 2], row[:, 5]
    none = np.full(len(theta), np.nan)
    return BodyPose(
        origin=row[:, 0:2] - measure.arms(theta, centre),
        theta=theta,
        velocity=row[:, 3:5]
        - omega[:, None] * measure.across(measure.arms(theta + lag_s * omega, centre)),
        omega=omega,
        origin_acceleration=np.full((len(theta), 2), np.nan),
        alpha=none,
    )


Frames = Mapping[str, Frame]
"""Frames of the pymunk bodies, with their own origins, and of the ground."""


def frames_at_end(model: SpaceModel, dt_s: float) -> Frames:
    """Return the frames of all bodies at the end of the next step; they have no velocities."""
    return {GROUND: FIXED} | {
        name: Frame(
            (
                body.position[0] + dt_s * body.velocity[0],
                body.position[1] + dt_s * body.velocity[1],
            ),
            body.angle + dt_s * body.angular_velocity,
            (0.0, 0.0),
            0.0,
        )
        for name, body in model.bodies.items()
    }


class Course(Generic[Value]):
    """A quantity, or many, at the ends of the last steps, and its rate."""

    def __init__(self, start: Value, dt_s: float) -> None:
        self._dt = dt_s
        self._values: list[Value] = [start]

    def go_on(self, value: Value) -> None:
        """Go on to the end of the next step."""
        self._values.append(value)
        del self._values[:-3]

    @property
    def value(self) -> Value:
        """Value at the end of the step."""
        return self._values[-1]

    @property
    def rate(self) -> Value:
        """Rate there, by the parabola through the last three values, or the line through two."""
        if len(self._values) < 3:
            return (self._values[-1] - self._values[0]) / self._dt
        first, second, third = self._values
        return (3.0 * third - 4.0 * second + first) / (2.0 * self._dt)

    @property
    def rate_before(self) -> Value:
        """Rate half a step before the end."""
        return (self._values[-1] - self._values[-2]) / self._dt


class SliderCourse:
    """Displacement of a slider [m], and pushes along its line."""

    def __init__(self, model: SpaceModel, slide: Prism | Slot, dt_s: float) -> None:
        self._slide, slider, self._rider = slide, slide.slider, riding_body(slide)
        self._guide = slider.on
        self._anchor = model.anchor(self._rider, slider.point)
        self._start = less(slider.through_m, model.centre[slider.on])
        self._along = turned((1.0, 0.0), slider.direction_rad)
        self.course = Course(model.state.displacement[slider.name], dt_s)

    def follow(self, frames: Frames) -> None:
        """Go on to the positions of the bodies at the end of a step."""
        seen = frames[self._guide].into(frames[self._rider].at(self._anchor))
        x, y = less(seen, self._start)
        self.course.go_on(x * self._along[0] + y * self._along[1])

    def push(self, size: float, frames: Frames, pushes: Pushes) -> None:
        """Push the sliding body by so much along the line [N], and the guide back."""
        slider, rider, guide = self._slide.slider, frames[self._rider], frames[self._guide]
        fx, fy = turned((size, 0.0), guide.theta + slider.direction_rad)
        if isinstance(self._slide, Slot):
            pushes.note(slider.name, (fx, fy, 0.0))
        place = rider.at(self._anchor)
        pushes.force(self._rider, rider, place, (fx, fy))
        pushes.force(self._guide, guide, place, (-fx, -fy))


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
            for body, place in ties.spring_ends(model.scene, spring)
        )
        self._ends = first, second
        self._course = Course(self._length(start), dt_s)

    def _length(self, frames: Frames) -> float:
        return math.dist(*(frames[body].at(anchor) for body, anchor in self._ends))

    def push(self, frames: Frames, pushes: Pushes) -> None:
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
