"""Positions of the bodies of a space: from a batch, and at the end of the next step.

A step of Chipmunk moves the positions x with the present velocity v, and then changes v by the
given forces and by the joints. The velocities belong to half a step after the positions, so that
this is the leapfrog, of second order with the forces at the end of the step::

    x(t + dt) = x(t) + dt v(t + dt/2)
    v(t + 3/2 dt) = v(t + dt/2) + dt a(x, v, t + dt)

The velocity at that instant itself, for dampers and motors, would be half by the step to come. It
is taken from the last three positions, to the second order.
"""

from collections.abc import Mapping
from typing import Generic, TypeVar

import numpy as np
import pymunk
import pymunk.batch

from models.array import Array
from models.scene import GROUND, Point
from models.scene.joints import FIXED, Frame, Prism, Slot, less, riding_body, turned
from sim.engine import BodyPose
from sim.engine.measure import across, arms
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
        origin=row[:, 0:2] - arms(theta, centre),
        theta=theta,
        velocity=row[:, 3:5] - omega[:, None] * across(arms(theta + lag_s * omega, centre)),
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
