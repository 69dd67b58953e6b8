"""Elastic links of what is let go, over time, by a stiff method of a library: Radau's of order 5.

It shares the equations with `analytic.elastic.free_windows`, and nothing of the integration.
Source: E. Hairer, G. Wanner, Solving Ordinary Differential Equations II, section IV.8.
"""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass

import numpy as np
from scipy.integrate import OdeSolution, Radau  # type: ignore[import-untyped]  # ships no stubs

from analytic.elastic.tangent_form import Tangent, TangentForm
from analytic.multibody.switches import edges
from models.array import Array
from models.errors import CrankcheckError

FAR = 0.2
"""What y may come to until the tangent is taken anew."""


@dataclass(frozen=True)
class _Stretch:
    """A piece of the motion (`FreePiece`): the state is y, y' and the work."""

    start_s: float
    end_s: float
    tangent: Tangent
    state: OdeSolution

    def course(self, time_s: Array) -> tuple[Array, Array, Array]:
        state = self.state(time_s).T
        f = state.shape[1] // 2
        return state[:, :f], state[:, f : 2 * f], state[:, -1]


def by_library(
    form: TangentForm, q: Array, rates: Array, until_s: float, tolerance: float
) -> tuple[_Stretch, ...]:
    """The motion from a closed position and rates (n,) on; ``tolerance`` is that of y and y' per
    step. Raises CrankcheckError for a motion that can not go on."""
    found: list[_Stretch] = []
    work, step = 0.0, None
    for begin, end in itertools.pairwise(edges(form.dynamics.forces.scene, until_s)):
        now_s = begin
        while now_s < end:
            tangent = form.tangent(q)
            state = np.concatenate(
                [np.zeros(tangent.free.shape[1]), form.coordinates(tangent, rates), [work]]
            )
            stretch, step = _stretch(form, tangent, state, (now_s, end), tolerance, step)
            found.append(stretch)
            now_s, at = stretch.end_s, np.array([stretch.end_s])
            y, y_rates, works = stretch.course(at)
            last = form.at(at, tangent, y, y_rates).now
            q, rates, work = last.q[0], last.rates[0], float(works[0])
    return tuple(found)


def _stretch(
    form: TangentForm,
    tangent: Tangent,
    state: Array,
    between: tuple[float, float],
    tolerance: float,
    first_s: float | None,
) -> tuple[_Stretch, float]:
    """The motion in one tangent, and how long its last step was."""
    f, (begin, end) = len(state) // 2, between
    last_s = math.nextafter(end, begin)

    def slope(time_s: float, states: Array) -> Array:
        columns = states.reshape(2 * f + 1, -1).T
        times = np.full(len(columns), min(time_s, last_s))
        instant = form.at(times, tangent, columns[:, :f], columns[:, f : 2 * f])
        power = form.dynamics.power(instant.now, instant.applied)
        whole = np.concatenate([columns[:, f : 2 * f], instant.seconds, power[:, None]], axis=1)
        return np.asarray(whole.T.reshape(states.shape))

    def slopes(time_s: float, state: Array) -> Array:
        # What the work comes to changes nothing, and it is as good a step without its derivatives.
        whole = np.zeros((2 * f + 1, 2 * f + 1))
        whole[:f, f : 2 * f] = np.eye(f)
        own = form.derivatives(min(time_s, last_s), tangent, state[:f], state[f : 2 * f])
        whole[f : 2 * f, : 2 * f] = own
        return whole

    solver = Radau(
        slope, begin, state, end, rtol=tolerance, atol=tolerance, jac=slopes, vectorized=True,
        first_step=None if first_s is None else min(first_s, end - begin),
    )  # fmt: skip
    times, within = [begin], []
    while solver.status == "running" and np.abs(solver.y[:f]).max() < FAR:
        trouble = solver.step()
        if solver.status == "failed":
            raise CrankcheckError(
                f"{form.dynamics.assembly.scene.name}: the integration fails at {solver.t:g} s: "
                f"{trouble}"
            )
        times.append(float(solver.t))
        within.append(solver.dense_output())
    step_s = float(solver.h_abs)
    return _Stretch(begin, times[-1], tangent, OdeSolution(times, within)), step_s
