"""Integrate the equations of motion with steps of one size, as the thesis on elastic mechanisms."""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass

import numpy as np
from scipy.interpolate import CubicHermiteSpline  # type: ignore[import-untyped]  # ships no stubs

from analytic.multibody.dynamics import Dynamics
from analytic.multibody.generalised_forces import Strokes
from analytic.multibody.state_history import StateHistory
from analytic.multibody.switches import edges, state_cells, strokes, switches
from models.array import Array
from models.errors import CrankcheckError

LARGEST = 1e12
"""Of a coordinate or rate, over what it counts as one of: beyond it a motion has come apart."""


@dataclass(frozen=True)
class FixedSteps:
    """The method of Runge and Kutta of order 4 with steps of one size, as the thesis on elastic
    mechanisms has it; in between cubics, of the same order. Edges over time are at steps."""

    dynamics: Dynamics
    step_s: float

    def history(self, q: Array, rates: Array, until_s: float) -> StateHistory:
        """The motion from a state to a time [s]. Raises CrankcheckError where it comes apart."""
        own = switches(self.dynamics.forces)
        state = np.concatenate([q, rates, [0.0]])
        times, states, slopes = [], [], []
        edge = edges(self.dynamics.assembly.scene, until_s)
        for begin, end in itertools.pairwise(edge):
            count = max(1, math.ceil((end - begin) / self.step_s * (1.0 - 1e-9)))
            h, last = (end - begin) / count, math.nextafter(end, begin)
            for i in range(count):
                at_s = begin + i * h
                held = strokes(own, state_cells(own, self.dynamics.forces, state))
                slope, state_after = self._step(at_s, h, last, state, held)
                times.append(at_s)
                states.append(state)
                slopes.append(slope)
                state = state_after
                self._check(state, at_s + h)
        held = strokes(own, state_cells(own, self.dynamics.forces, state))
        times.append(until_s)
        states.append(state)
        slopes.append(self.dynamics.rates(until_s, state, held))
        spline = CubicHermiteSpline(np.array(times), np.array(states), np.array(slopes))
        return StateHistory(lambda time_s: np.asarray(spline(time_s).T), len(times) - 1)

    def _step(
        self, at_s: float, h: float, last: float, state: Array, held: Strokes
    ) -> tuple[Array, Array]:
        """The slope at the begin of a step, and the state at its end."""
        rates = self.dynamics.rates
        with np.errstate(all="ignore"):
            k1 = rates(at_s, state, held)
            k2 = rates(min(at_s + 0.5 * h, last), state + 0.5 * h * k1, held)
            k3 = rates(min(at_s + 0.5 * h, last), state + 0.5 * h * k2, held)
            k4 = rates(min(at_s + h, last), state + h * k3, held)
        return k1, state + h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4)

    def _check(self, state: Array, time_s: float) -> None:
        if not np.abs(state).max() < LARGEST:
            raise CrankcheckError(
                f"{self.dynamics.assembly.scene.name}: with steps of {self.step_s:g} s the motion "
                f"comes apart at {time_s:g} s; take smaller ones, or a smaller alpha and beta"
            )
