"""Loads of one stroke in steps of RK4: the share of a step in which their slider is on it.

Where the speed of a slider changes its sign, such a load jumps. Stages that look at their own speed
see some of the jump, whenever it was, and the step falls to first order; with the share of the step
in all its stages it keeps the impulse. The rate of the speed is that of the stage before, which is
the end of the last step.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any


class StrokeShares:
    """The shares of the steps from ``first`` on in which sliders, whose rates stand at these places
    of the velocities, go forward."""

    def __init__(self, places: Mapping[str, int], dt_s: float, first: int) -> None:
        self._places, self._dt = places, dt_s
        self._last_half = 2 * first  # as after a start: no middle was before
        self._forward: dict[str, float] = {}

    def at(self, data: Any) -> Mapping[str, float]:
        """By slider, in the stage that MuJoCo's data are at; every stage has to ask, in turn."""
        half = round(2.0 * float(data.time) / self._dt)
        if half % 2 == 0 and self._last_half != half - 1:  # after the middle comes the end
            self._forward = {
                name: forward_share(float(data.qvel[k]), self._dt * float(data.qacc[k]))
                for name, k in self._places.items()
            }
        self._last_half = half
        return self._forward


def forward_share(speed: float, change: float) -> float:
    """The share of a step in which what begins it with a speed, and changes that evenly by so much,
    goes forward."""
    after = speed + change
    if speed * after < 0.0:
        return max(speed, after) / abs(change)
    return float(speed > 0.0 or (speed == 0.0 and after > 0.0))
