"""What jumps over time, as an implicit step of second order wants it."""

from __future__ import annotations

import math

from models.characteristics import Staircase


class StepMeans:
    """The mean of a staircase about each step's end, later and earlier times counting less and less
    up to a step away.

    A step weighs its two ends alike, so that a jump that only one of them feels acts half a step
    too early or too late, wherever in the step it is; with these means the impulse over both steps
    is right, and belongs to the right instant. Before ``start_s`` there is no step: what jumps then
    or at once is on from there.
    """

    def __init__(self, stairs: Staircase, start_s: float, dt_s: float) -> None:
        self._start_s, self._dt = start_s, dt_s
        rises = zip(stairs.places, stairs.values, (0.0, *stairs.values), strict=False)
        self._jumps = [(place, value - before) for place, value, before in rises]

    def at(self, time_s: float) -> float:
        """The mean at the end of a step, or at the start [N or N m]."""
        return math.fsum(height * self._share(time_s, place) for place, height in self._jumps)

    def _share(self, time_s: float, place: float) -> float:
        """How much of a jump counts."""
        if place <= self._start_s:
            return 1.0
        since = min(max((time_s - place) / self._dt, -1.0), 1.0)
        if time_s <= self._start_s:  # the half of the mean that there is
            return (1.0 + since) ** 2
        return 1.0 - 0.5 * (1.0 - since) ** 2 if since > 0.0 else 0.5 * (1.0 + since) ** 2
