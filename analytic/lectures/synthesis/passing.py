"""When a driver goes through the angles of a task."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from models.array import Array
from models.laws import Law, Oscillating


def passing_times(law: Law, angles: Sequence[float]) -> Array:
    """When a driver has angles [rad], one after the other [s]: in the first turn and those after
    it, or in the first whole swing from end to end that leads through them in their order."""
    theta = np.asarray(angles)
    if isinstance(law, Oscillating):
        rising = len(angles) < 2 or theta[-1] >= theta[0]
        phase = np.arcsin(np.clip((theta - law.centre_rad) / law.amplitude_rad, -1.0, 1.0))
        phase = phase + math.tau if rising else math.pi - phase
        return np.asarray((phase - law.phase_rad) / law.frequency_rad_s)
    start, speed, _ = (float(each[0]) for each in law.at(np.zeros(1)))
    return np.asarray((theta - start) / speed)
