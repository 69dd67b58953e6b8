"""What the crank is told at each step: an angle, or a speed, so that it is where its law wants it.

Joints that are closed in their places take the angle. Those that are closed in their rates take a
speed, and the trapezoidal rule makes of speeds v the angle ``theta' = theta + (v + v') dt / 2``:
`speeds` are those that lead to the angles of the law.
"""

from __future__ import annotations

import numpy as np

from models.array import Array
from models.laws import Law
from sim import drive as drives


def speeds(law: Law, start_s: float, dt_s: float, steps: int) -> Array:
    """The angular velocity [rad/s] at the start and after each of the ``steps``."""
    first = drives.start_speed(law, start_s, dt_s, 0.0)
    gained = np.cumsum(drives.pushes(law, start_s, dt_s, steps, 0.0))
    return first + dt_s * np.concatenate([[0.0], gained])


class CrankCourse:
    """The angles and speeds of a law at the steps of a run, as functions that exudyn calls.

    Between the steps, where a step that failed was cut, they are those of the law itself. Times
    count from the start of the run, angles from the angle there.
    """

    NEAR = 1e-6
    """Over the step: what is no nearer to a step lies between two."""

    def __init__(self, law: Law, start_s: float, dt_s: float) -> None:
        self._law, self._start_s, self._dt = law, start_s, dt_s
        self._first = float(law.at(np.array(start_s))[0])
        self._angles: list[float] = []
        self._speeds: list[float] = []
        self.reach(1)

    def reach(self, steps: int) -> None:
        """Be ready for so many steps from the start."""
        if len(self._angles) <= steps:
            longer = max(steps, 2 * len(self._angles))
            turned = drives.angles(self._law, self._start_s, self._dt, 0, longer) - self._first
            self._angles = turned.tolist()
            self._speeds = speeds(self._law, self._start_s, self._dt, longer).tolist()

    def angle(self, _system: object, time_s: float, _item: object, _offset: float) -> float:
        """The angle at a time [rad]."""
        step = self._step(time_s)
        if step is not None:
            return self._angles[step]
        return float(self._law.at(np.array(self._start_s + time_s))[0]) - self._first

    def speed(self, _system: object, time_s: float, _item: object, _offset: float) -> float:
        """The angular velocity at a time [rad/s]."""
        step = self._step(time_s)
        if step is not None:
            return self._speeds[step]
        return float(self._law.at(np.array(self._start_s + time_s))[1])

    def _step(self, time_s: float) -> int | None:
        """Which step a time is; none between them."""
        exact = time_s / self._dt
        near = round(exact)
        return near if abs(exact - near) < self.NEAR and near < len(self._angles) else None
