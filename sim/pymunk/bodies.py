"""Positions of the bodies of a space, now and at the end of the next step; springs from these.

A step of Chipmunk moves the positions x with the present velocity v, and then changes v by the
given forces and by the joints. The velocities belong to half a step after the positions, so that
this is the leapfrog, of second order with the forces at the end of the step::

    x(t + dt) = x(t) + dt v(t + dt/2)
    v(t + 3/2 dt) = v(t + dt/2) + dt a(x, v, t + dt)
"""

from collections.abc import Sequence

import numpy as np
import pymunk
import pymunk.batch

from models.array import Array
from models.scene import GROUND, Scene
from models.scene.joints import FIXED, Frame, whole_turns
from models.scene.loads import SegmentSpring
from sim.engine.acting import Course, Frames
from sim.pymunk.space import SpaceModel

FIELDS = (
    pymunk.batch.BodyFields.POSITION
    | pymunk.batch.BodyFields.ANGLE
    | pymunk.batch.BodyFields.VELOCITY
    | pymunk.batch.BodyFields.ANGULAR_VELOCITY
)
WIDTH = 6
"""Numbers per body: x, y, angle, vx, vy, omega."""


def rows_of(model: SpaceModel) -> dict[str, int]:
    """Return the row of each body in a batch; the static body of the space has one too."""
    buffer = pymunk.batch.Buffer()
    pymunk.batch.get_space_bodies(model.space, pymunk.batch.BodyFields.BODY_ID, buffer)
    order = np.frombuffer(buffer.int_buf(), dtype=np.uintp).tolist()
    return {name: order.index(body.id) for name, body in model.bodies.items()}


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
