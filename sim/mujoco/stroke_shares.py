"""Loads of one stroke in steps of RK4: how much of them acts in each stage of a step in which their
slider turns back.

Where the speed of a slider changes its sign, such a load jumps. Stages that look at their own speed
see some of the jump, whenever it was, and the step falls to first order. RK4 adds up a step as
Simpson's rule does, from its begin, middle and end; a load that acts for the first share s of the
step is kept by it, with its impulse and what goes along and with the square of time, in the parts

    begin  6 s - 9 s^2 + 4 s^3        middle  3 s^2 - 2 s^3        end  4 s^3 - 3 s^2

The impulse alone is not enough: at a dead centre the slider turns back where the load has no lever,
which grows from there. The rate of the speed is that of the stage before, which is the end of the
last step.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

Parts = tuple[float, float, float]
"""Of a load, at the begin, the middle and the end of a step."""


class StrokeShares:
    """The parts of loads on forward strokes in the steps from ``first`` on, of sliders whose rates
    stand at these places of the velocities."""

    def __init__(self, places: Mapping[str, int], dt_s: float, first: int) -> None:
        self._places, self._dt = places, dt_s
        self._last_half = 2 * first  # as after a start: no middle was before
        self._parts: dict[str, Parts] = {}

    def at(self, data: Any) -> Mapping[str, float]:
        """By slider, in the stage that MuJoCo's data are at; every stage has to ask, in turn."""
        half = round(2.0 * float(data.time) / self._dt)
        stage = 1 if half % 2 else 2 if self._last_half == half - 1 else 0
        if stage == 0:
            self._parts = {
                name: forward_parts(float(data.qvel[k]), self._dt * float(data.qacc[k]))
                for name, k in self._places.items()
            }
        self._last_half = half
        return {name: parts[stage] for name, parts in self._parts.items()}


def forward_parts(speed: float, change: float) -> Parts:
    """The parts of what acts while that goes forward which begins a step with a speed, and changes
    it evenly by so much."""
    after = speed + change
    if speed * after >= 0.0:
        whole = float(speed > 0.0 or (speed == 0.0 and after > 0.0))
        return whole, whole, whole
    s = abs(speed / change)
    until = (s * (6.0 - 9.0 * s + 4.0 * s * s), s * s * (3.0 - 2.0 * s), s * s * (4.0 * s - 3.0))
    if speed > 0.0:
        return until
    return 1.0 - until[0], 1.0 - until[1], 1.0 - until[2]
