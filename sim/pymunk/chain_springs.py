"""The springs in the pins of a chain of segments, all at once.

One by one, as `sim.pymunk.spring_steps` has them, they would take most of the time of a run.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pymunk.batch

from models.array import Array
from models.joints import whole_turns
from models.loads import SegmentSpring
from models.scene import Scene
from sim.pymunk.body_rows import rows_of
from sim.pymunk.space import SpaceModel

TURNING = pymunk.batch.BodyFields.ANGLE | pymunk.batch.BodyFields.ANGULAR_VELOCITY
TORQUE = pymunk.batch.BodyFields.TORQUE


def chain_springs(scene: Scene) -> tuple[SegmentSpring, ...]:
    """The springs between the segments of the elastic links of a scene; no others that it has."""
    return tuple(one for one in scene.springs.values() if isinstance(one, SegmentSpring))


class ChainSprings:
    """What springs in pins do, with the angles and rates of the end of each step."""

    def __init__(self, model: SpaceModel, springs: Sequence[SegmentSpring], dt_s: float) -> None:
        self._space, self._dt, self._rows = model.space, dt_s, rows_of(model)
        self.numbers = {one.name: (one.rate, one.damping, one.free) for one in springs}
        """Rate, damping and the angle at which it is slack, of each by name."""
        self._angles, self._torques = pymunk.batch.Buffer(), pymunk.batch.Buffer()
        self._first, self._second = (
            np.array([self._rows[one.bodies[k]] for one in springs]) for k in (0, 1)
        )
        self._rate, self._damping, self._free = (
            np.array([getattr(one, key) for one in springs]) for key in ("rate", "damping", "free")
        )
        theta = self._turning()[:, 0]
        # Of each body, from each spring.
        self._share = np.zeros((len(theta), len(springs)))
        self._share[self._first, range(len(springs))] = 1.0
        self._share[self._second, range(len(springs))] = -1.0
        opened = theta[self._second] - theta[self._first]
        self._whole = np.array(
            [whole_turns(one, angle) for one, angle in zip(springs, opened.tolist(), strict=True)]
        )
        self._last = [opened + self._whole]

    def by_body(self) -> dict[str, float]:
        """The torques on all bodies in the next step [N m]."""
        torques = self._next().tolist()
        return {name: torques[row] for name, row in self._rows.items()}

    def push(self) -> None:
        """Have them act in the next step, where nothing else does."""
        self._torques.set_float_buf(self._next())
        pymunk.batch.set_space_bodies(self._space, TORQUE, self._torques)

    def _next(self) -> Array:
        """The torques in the next step [N m], by row of a batch."""
        theta, omega = self._turning().T
        theta = theta + self._dt * omega
        q = theta[self._second] - theta[self._first] + self._whole
        self._last = [*self._last[-2:], q]
        pull = self._rate * (q - self._free) + self._damping * self._speed()
        return np.asarray(self._share @ pull)

    def _turning(self) -> Array:
        """Angle and angular velocity of all bodies of the space, (rows, 2)."""
        self._angles.clear()
        pymunk.batch.get_space_bodies(self._space, TURNING, self._angles)
        return np.frombuffer(self._angles.float_buf()).reshape(-1, 2)

    def _speed(self) -> Array:
        """At the end of the step, as `sim.pymunk.step_end.Course` has it."""
        if len(self._last) < 3:
            return np.asarray((self._last[-1] - self._last[0]) / self._dt)
        first, second, third = self._last
        return np.asarray((3.0 * third - 4.0 * second + first) / (2.0 * self._dt))
