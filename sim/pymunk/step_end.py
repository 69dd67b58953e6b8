"""Where bodies will be at the end of a step of Chipmunk, which is known before it.

A step moves the positions x with the velocity v that is there, and then changes that by the forces
it was given and by the joints. The velocities stand half a step after the positions, so that this
is the leapfrog, of second order if the forces are those of the end of the step::

    x(t + dt) = x(t) + dt v(t + dt/2)
    v(t + 3/2 dt) = v(t + dt/2) + dt a(x, v, t + dt)

The velocity of that instant itself, which dampers and motors follow, would be half of what the step
is about to make. It is taken from the last three places, to the second order.
"""

from __future__ import annotations

from collections.abc import Mapping

from models.joints import Prism, Slot, less, local_point, riding_body, turned
from models.poses import FIXED, Frame
from models.scene import GROUND, Point, Scene
from sim.pymunk.space import SpaceModel

Frames = Mapping[str, Frame]
"""The frames of the pymunk bodies, whose origins are their own, and of the ground."""


def frames_at_end(model: SpaceModel, dt_s: float) -> Frames:
    """The frames of all bodies at the end of the next step; they have no velocities."""
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


def anchor_of(scene: Scene, model: SpaceModel, body: str, point: str) -> Point:
    """A named point in the coordinates of the pymunk body that carries it [m]."""
    return less(local_point(scene, body, point), model.centre[body])


class Course:
    """A quantity at the ends of the last steps, and its rate."""

    def __init__(self, start: float, dt_s: float) -> None:
        self._dt = dt_s
        self._values = [start]

    def go_on(self, value: float) -> None:
        """To the end of the next step."""
        self._values = [*self._values[-2:], value]

    @property
    def value(self) -> float:
        """At the end of the step."""
        return self._values[-1]

    @property
    def rate(self) -> float:
        """There: that of the parabola through the last three values, or of the line through two."""
        if len(self._values) < 3:
            return (self._values[-1] - self._values[0]) / self._dt
        first, second, third = self._values
        return (3.0 * third - 4.0 * second + first) / (2.0 * self._dt)

    @property
    def rate_before(self) -> float:
        """Half a step before the end."""
        return (self._values[-1] - self._values[-2]) / self._dt


class SliderCourse:
    """The displacement of a slider [m]."""

    def __init__(
        self, scene: Scene, model: SpaceModel, slide: Prism | Slot, start_m: float, dt_s: float
    ) -> None:
        slider, self._rider = slide.slider, riding_body(slide)
        self._guide = slider.on
        self._anchor = anchor_of(scene, model, self._rider, slider.point)
        self._start = less(slider.through_m, model.centre[slider.on])
        self._along = turned((1.0, 0.0), slider.direction_rad)
        self.course = Course(start_m, dt_s)

    def follow(self, frames: Frames) -> None:
        """Go on to where the bodies will be at the end of a step."""
        seen = frames[self._guide].into(frames[self._rider].at(self._anchor))
        x, y = less(seen, self._start)
        self.course.go_on(x * self._along[0] + y * self._along[1])
