"""What there is to know of a free run beside its errors."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from models.array import Array


@dataclass(frozen=True, eq=False)
class FreeFacts:
    """How far a run that was let go was followed, and what its errors were divided by.

    ``sensitivity`` is by how much a small change of the start has grown by ``until_s``, the last
    instant that is judged; ``left_out`` samples after it are not, as the truth is not known well
    enough there. ``time_s``, ``raw`` and ``judged`` are the largest error of phase and place up to
    some instants, as pure numbers: as it is, and over the sensitivity of its time.
    """

    sensitivity: float
    until_s: float
    left_out: int
    time_s: Array
    raw: Array
    judged: Array
    passages: int = 0

    def horizon_s(self, raw: float) -> float:
        """The time to which the error as it is stays within a number [s]."""
        return self._held(self.raw, raw)

    def judged_horizon_s(self, limit: float) -> float:
        """The time to which the error over the sensitivity stays within a number [s]."""
        return self._held(self.judged, limit)

    def _held(self, largest: Array, limit: float) -> float:
        broken = np.flatnonzero(~(largest <= limit))
        return float(self.time_s[max(broken[0] - 1, 0)] if broken.size else self.time_s[-1])
