"""What an integration may be off by: two of them, with other nodes in other windows, beside each
other."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from analytic.dyads.plane import EPS
from analytic.free.chart import Chart
from analytic.free.coordinate_history import CoordinateHistory
from models.array import Array

SAFETY = 8.0
"""How much more than the largest difference so far the error may be."""
SHARES = (0.13, 0.5, 0.87)
"""Where windows are looked at: not at their ends, where what acts may jump."""


@dataclass(frozen=True, eq=False)
class Doubt:
    """What u, u' and u'' may be off by until the times ``time_s``: rows of ``off`` (3, T)."""

    time_s: Array
    off: Array

    @staticmethod
    def between(history: CoordinateHistory, other: CoordinateHistory) -> Doubt:
        """What two integrations of one motion leave in doubt of the first."""
        starts = np.repeat(history.starts_s, len(SHARES))
        ends = np.repeat([window.end_s for window in history.windows], len(SHARES))
        time_s = starts + np.tile(SHARES, len(history.windows)) * (ends - starts)
        own = np.array(history.state(time_s))
        off = np.zeros((3, len(time_s)))
        seen = np.array(other.state(time_s))
        window = other.windows_at(time_s)
        for chart, first, last in history.legs():
            span = slice(first * len(SHARES), last * len(SHARES))
            for k in np.unique(window[span]):
                at = np.arange(span.start, span.stop)[window[span] == k]
                there = _moved(other.windows[k].chart, chart, seen[:, at], own[0, at])
                off[:, at] = np.abs(there - own[:, at])
        sizes = np.abs(own) + np.abs(own).max(axis=1)[:, None]
        off = np.maximum.accumulate(off, axis=1)
        return Doubt(time_s, SAFETY * off + 4 * EPS * sizes)

    def at(self, time_s: Array) -> Array:
        """What u, u' and u'' may be off by, (3, T)."""
        # That of the next look: the differences before a time hold up to there.
        k = np.clip(np.searchsorted(self.time_s, time_s), 0, len(self.time_s) - 1)
        return np.asarray(self.off[:, k])


def _moved(of: Chart, to: Chart, state: Array, near: Array) -> Array:
    """A state (3, T) of one chart in another, next to coordinates ``near``: by the driver's angle
    where they are about different limits, which is away from both."""
    if of is to or to.limit is None:
        return state
    u, v, a = state
    assert of.limit is not None
    if of.limit.driver_rad == to.limit.driver_rad:
        sign = np.where(np.abs(u - near) <= np.abs(u + near), 1.0, -1.0)
        return np.asarray(state * sign)
    phi, first, second = of.driver(u)
    size = np.sqrt(np.maximum(0.0, to.limit.side * (to.limit.driver_rad - phi)))
    moved = np.where(near < 0.0, -size, size)
    _, slope, bend = to.driver(moved)
    rate = first * v / slope
    return np.stack([moved, rate, (second * v * v + first * a - bend * rate * rate) / slope])
