"""What a load over time comes to in the stages of the steps of RK4, which keeps its order so.

A stage is at the start of its step, in the middle or at the end::

    start + dt (n + c)      c = 0, 1/2, 1

Two steps share an instant, and each sees its own side of it: a jump on the grid belongs to the step
that it begins. Grid and stage are found by the number of the step, as MuJoCo's clock adds up
rounding. A jump or kink within a step has stages of the parabola that has the same moments with 1,
c and c^2 over the step as the load. Simpson's rule, which RK4 is for a course over time, then has
speed and place as the load gives them, but for what the motion in the step does to it.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from models.array import Array
from models.characteristics import Characteristic
from models.loads import Load

INSIDE = 1e-9
"""How far within its step, in steps, a stage at its ends looks at the load: above the rounding of
times, below any error."""
STAGES = np.array([INSIDE, 0.5, 1.0 - INSIDE])
NODES, WEIGHTS = np.polynomial.legendre.leggauss(6)


class LoadStages:
    """The sizes of ``loads`` in the stages of the steps ``first`` to ``first + count - 1``, and
    which of them is asked for.

    RK4 works out the forces at the start, twice in the middle, and at the end of each step.
    """

    def __init__(
        self, loads: Sequence[Load], start_s: float, dt_s: float, first: int, count: int
    ) -> None:
        self._first, self._last, self._halves_per_s = first, count - 1, 2.0 / dt_s
        sizes = [stage_sizes(load, start_s, dt_s, first, count) for load in loads]
        # Lists, as a callback reads a number of an array ten times as slowly.
        self._sizes: list[list[list[float]]] = np.stack(sizes, axis=2).tolist()
        self._last_half = 2 * first  # as after a start: no middle was before

    def at(self, clock_s: float) -> list[float]:
        """The sizes in the stage that MuJoCo's clock is at; every stage has to ask, in turn."""
        half = round(self._halves_per_s * clock_s)
        step, stage = half // 2 - self._first, half % 2
        if stage == 0 and self._last_half == half - 1:  # after the middle comes the end
            step, stage = step - 1, 2
        self._last_half = half
        # MuJoCo puts a state that comes apart back to time 0; such a run is thrown away.
        return self._sizes[min(max(step, 0), self._last)][stage]


def stage_sizes(load: Load, start_s: float, dt_s: float, first: int, count: int) -> Array:
    """The sizes (count, 3) of a load over time in the stages of some steps [N or N m]."""
    begins = start_s + dt_s * np.arange(first, first + count)
    times = begins[:, None] + dt_s * STAGES
    sizes = load.magnitude(times.ravel()).reshape(times.shape)
    for step, cuts in _cut_steps(load.characteristic, start_s, dt_s, first, count).items():
        sizes[step - first] = _parabola(load, start_s + dt_s * step, dt_s, cuts)
    return np.asarray(sizes)


def _cut_steps(
    course: Characteristic, start_s: float, dt_s: float, first: int, count: int
) -> dict[int, list[float]]:
    """The steps with a kink within, and where in the step it is, between 0 and 1."""
    cuts: dict[int, list[float]] = {}
    end_s = start_s + dt_s * (first + count)
    for kink in course.kinks_between(start_s + dt_s * first, end_s):
        place = (kink - start_s) / dt_s
        step = math.floor(place)
        if first <= step < first + count and INSIDE < place - step < 1.0 - INSIDE:
            cuts.setdefault(step, []).append(place - step)
    return cuts


def _parabola(load: Load, begin_s: float, dt_s: float, cuts: Sequence[float]) -> Array:
    """At 0, 1/2 and 1 the parabola that comes nearest to the load over a step, in the mean square:
    the sum of Legendre's P0, P1, P2 with (2 k + 1) times the load's moment with each."""
    ends = np.array([0.0, *sorted(cuts), 1.0])
    half = 0.5 * np.diff(ends)[:, None]
    places = (ends[:-1, None] + half * (1.0 + NODES)).ravel()
    shares = (half * WEIGHTS).ravel() * load.magnitude(begin_s + dt_s * places)
    across = 2.0 * places - 1.0  # from -1 to 1
    mean, slope = shares.sum(), 3.0 * (shares * across).sum()
    bend = 5.0 * (shares * (1.5 * across**2 - 0.5)).sum()
    return np.array([mean - slope + bend, mean - 0.5 * bend, mean + slope + bend])
