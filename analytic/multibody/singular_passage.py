"""Through a change point, on the branch that goes on smoothly.

In a change point the rows of the Jacobian depend on each other, and next to it what the equations
say is lost in rounding, by eps over the square of the smallest singular value. The motion itself is
smooth there: polynomials through what it has been for a while before carry it over the gap. On the
other side it has to be on the constraints again, to rounding, as only a motion through the change
point itself is: one that misses it by a little turns off, however shortly, into the other branch.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.polynomial import Chebyshev

from analytic.multibody.dynamics import Dynamics
from models.array import Array

NEAR = 1e-2
"""The smallest singular value, of rows of the largest entry 1, from which on a change point may be
ahead."""
LEAST = 4e-3
"""That at which a passage begins at the latest, and ends at the earliest."""
WINDOW = 25.0
"""For how long the motion before counts, over the duration of the passage."""
SHORTEST = 6.0
"""The same at least, where something has jumped shortly before."""
DEGREE, SAMPLES = 12, 48
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


def passage_ahead(
    dynamics: Dynamics,
    solution: Callable[[Array], Array],
    clear_s: float,
    now_s: float,
    smallest: float,
) -> SingularPassage | None:
    """The passage that begins about now, if the motion goes through a change point.

    Parameters
    ----------
    dynamics : Dynamics
        The mechanism.
    solution : Callable
        The state at times up to now.
    clear_s, now_s : float
        Since when nothing has jumped, and now [s].
    smallest : float
        The smallest singular value of now.
    """
    if not smallest < NEAR or now_s <= clear_s:
        return None
    back_s = 0.02 * (now_s - clear_s)
    before = solution(np.array([now_s - back_s]))[: dynamics.assembly.size, 0]
    slope = (smallest - smallest_singular(dynamics, before)) / back_s
    if slope >= 0.0:
        return None
    at_s = now_s - smallest / slope
    half_s = max(smallest, LEAST) / -slope
    begin_s = at_s - half_s
    window_s = min(WINDOW * 2.0 * half_s, begin_s - clear_s)
    if window_s < SHORTEST * 2.0 * half_s:
        return None
    # Points that lie closer towards both ends, where polynomials swing.
    lean = np.cos(np.pi * (np.arange(SAMPLES) + 0.5) / SAMPLES)
    times = begin_s - 0.5 * window_s * (1.0 + lean)
    states = solution(times)
    domain = [begin_s - window_s, begin_s]
    course = tuple(Chebyshev.fit(times, own, DEGREE, domain=domain) for own in states)
    passage = SingularPassage(begin_s, at_s, at_s + half_s, course)
    return passage if _closes(dynamics, passage) else None


def smallest_singular(dynamics: Dynamics, q: Array) -> float:
    """The smallest singular value of the constraints that count at coordinates (n,)."""
    assembly = dynamics.assembly
    rows = assembly.scaled(assembly.joints.jacobian(assembly.at_rest(q[None]))[0])
    return float(np.linalg.svd(rows, compute_uv=False)[dynamics.rank - 1])


def _closes(dynamics: Dynamics, passage: SingularPassage) -> bool:
    """Whether the other end is on the constraints."""
    n, units = dynamics.assembly.size, dynamics.assembly.units
    state = passage.state(np.array([passage.end_s]))[:, 0]
    q, _ = dynamics.closed(state[:n], state[n : 2 * n])
    return bool(np.abs((q - state[:n]) / units).max() <= OFF)
