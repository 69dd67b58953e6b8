"""Through a change point, on the branch that goes on smoothly.

In a change point the rows of the Jacobian depend on each other, and next to it what the equations
say is lost in rounding, by eps over the square of the smallest singular value. The motion itself is
smooth there: polynomials through what its accelerations have been for a while before carry them
over the gap, where they are integrated from the state at its begin. On the other side the motion
has to be on the constraints again, to rounding, as only one through the change point itself is: one
that misses it by a little turns off, however shortly, into the other branch.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.polynomial import Chebyshev

from analytic.multibody.dynamics import Dynamics
from analytic.multibody.generalised_forces import Strokes
from models.array import Array

NEAR = 1e-2
"""The smallest singular value, of rows of the largest entry 1, from which on rounding tells: steps
become short for it, unless their tolerance grows with its inverse square as what is lost does."""
LEAST = 2e-3
"""That at which a passage begins at the latest; from `NEAR` on it does where steps are short."""
CLOSE = 1.1
"""A singular value over that one, from which on it counts as it."""
SHORT = 0.1
"""A step that is short, over the time up to the change point."""
WINDOWS = {25.0: 12, 12.0: 12, 6.0: 12, 3.0: 8, 1.5: 6}
"""For how long the motion before may count, over the duration of the passage, and the degree of the
polynomials: a long time spreads what accelerations are off by, a short one follows fast changes,
and is all there is where something has just jumped."""
LONG = 6.0
"""Shorter ones are taken where none of the others will do."""
SAMPLES = 24
OFF = 1e-9
"""What coordinates may have to be moved by on the other side, in their units."""


@dataclass(frozen=True)
class SingularPassage:
    """From ``begin_s`` to ``end_s`` through a change point at ``at_s`` [s]."""

    begin_s: float
    at_s: float
    end_s: float
    course: tuple[Chebyshev, ...]

    def state(self, time_s: Array) -> Array:
        """The state at times [s], (2 n + 1, T)."""
        return np.array([one(np.asarray(time_s)) for one in self.course])

    def slope(self, time_s: Array) -> Array:
        """Its derivative by time."""
        return np.array([one.deriv()(np.asarray(time_s)) for one in self.course])


def singular_at(
    dynamics: Dynamics, within: Callable[[Array], Array], now_s: float, back_s: float
) -> float:
    """When the smallest singular value is 0, as it falls now [s]; infinite where it grows.

    ``within`` says the state at times up to now, at least as far as ``back_s`` [s].
    """
    states = within(np.array([now_s - back_s, now_s]))[: dynamics.assembly.size]
    before, now = (smallest_singular(dynamics, q) for q in states.T)
    return now_s + back_s * now / (before - now) if now < before else math.inf


def passage_ahead(
    dynamics: Dynamics,
    solution: Callable[[Array], Array],
    clear_s: float,
    now_s: float,
    at_s: float,
    strokes: Strokes,
) -> SingularPassage | None:
    """The passage that begins now, if the motion goes through a change point.

    Parameters
    ----------
    dynamics : Dynamics
        The mechanism.
    solution : Callable
        The state at times up to now.
    clear_s, now_s, at_s : float
        Since when nothing has jumped, now, and when the change point is expected [s].
    strokes : Strokes
        Which loads of one stroke act.
    """
    width_s = 2.0 * (at_s - now_s)
    least, best = OFF, None
    for window, degree in WINDOWS.items():
        if window * width_s > now_s - clear_s or (best and window < LONG):
            continue
        course = _course(dynamics, solution, now_s, window * width_s, degree, strokes)
        passage = SingularPassage(now_s, at_s, now_s + width_s, course)
        if (off := _open(dynamics, passage)) <= least:
            least, best = off, passage
    return best


def _course(
    dynamics: Dynamics,
    solution: Callable[[Array], Array],
    now_s: float,
    window_s: float,
    degree: int,
    strokes: Strokes,
) -> tuple[Chebyshev, ...]:
    """The state from now on [s], by what its slopes have been for a while."""
    # Points that lie closer towards both ends, where polynomials swing.
    lean = np.cos(np.pi * (np.arange(SAMPLES) + 0.5) / SAMPLES)
    times = now_s - 0.5 * window_s * (1.0 + lean)
    slopes = []
    for time_s, state in zip(times, solution(times).T, strict=True):
        slopes.append(dynamics.rates(time_s, dynamics.closed_state(state), strokes))
    begin, n = solution(np.array([now_s]))[:, 0], dynamics.assembly.size

    def integrated(slope: Chebyshev, value: float) -> Chebyshev:
        return slope.integ(lbnd=now_s, k=value)

    domain = [now_s - window_s, now_s]
    fits = [Chebyshev.fit(times, own, degree, domain=domain) for own in np.array(slopes).T[n:]]
    last = [integrated(fit, value) for fit, value in zip(fits, begin[n:], strict=True)]
    places = [integrated(rate, value) for rate, value in zip(last, begin[:n], strict=False)]
    return (*places, *last)


def smallest_singular(dynamics: Dynamics, q: Array) -> float:
    """The smallest singular value of the constraints that count at coordinates (n,)."""
    assembly = dynamics.assembly
    rows = assembly.scaled(assembly.joints.jacobian(assembly.at_rest(q[None]))[0])
    return float(np.linalg.svd(rows, compute_uv=False)[dynamics.rank - 1])


def _open(dynamics: Dynamics, passage: SingularPassage) -> float:
    """How far off the constraints the other end is, in the units of coordinates."""
    n = dynamics.assembly.size
    state = passage.state(np.array([passage.end_s]))[:, 0]
    off = (dynamics.closed_state(state) - state)[:n] / dynamics.assembly.units
    return float(np.abs(off).max())
