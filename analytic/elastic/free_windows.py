"""Free motion with elastic links over time: collocation in windows of adaptive length.

As `analytic.elastic.vibration`, in the tangent of the position with which each window begins. A
window is short enough where the series of its motion has converged. Gauss' nodes keep all
vibration, and its energy. Links that stretch ring along themselves a thousand times faster than
across, and too little to be seen: Radau's nodes let that die out, so that windows may be as long as
for bending. Loads over time are smooth within each window.
"""

import itertools
import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np
from numpy.polynomial import legendre
from scipy.linalg import block_diag  # type: ignore[import-untyped]  # ships no stubs

from analytic.elastic.tangent_form import FreeInstant, Tangent, TangentForm
from analytic.free.window import Gauss, gauss
from analytic.multibody.generalised_forces import edges, switches
from models.array import Array
from models.errors import CrankcheckError

NODES = 10
LIFT = gauss(NODES)
"""Its integrals of Legendre's polynomials are those of every rule."""
TAIL = 3
"""Number of last coefficients of a series, whose largest counts."""
MOST_ROUNDS, CLOSE = 30, 1e-15
"""Most rounds of Newton's method, and the change of y that ends them."""
MOST_WINDOWS, FIRST = 200_000, 1e-3
"""Most windows; and the first trial length of the first one, over the whole time."""
SHORTEST = 1e-9
"""Window over the whole time, below which the motion can not go on."""


@dataclass(frozen=True)
class FreeWindow:
    """Motion in one tangent: ``rates`` y' (f,) at its start, where y is 0; ``series`` (NODES, f) of
    y'' in Legendre's polynomials, ``power`` (NODES,) of the work's derivative."""

    start_s: float
    end_s: float
    tangent: Tangent
    rates: Array
    series: Array
    power: Array
    work: float

    def course(self, time_s: Array) -> tuple[Array, Array, Array]:
        """Return y and its rates (T, f), and the work done until then, (T,)."""
        h = self.end_s - self.start_s
        share = (time_s - self.start_s) / h
        x = 2.0 * share - 1.0
        once = legendre.legvander(x, NODES) @ LIFT.lift_once
        twice = legendre.legvander(x, NODES + 1) @ LIFT.lift_twice
        return (
            h * share[:, None] * self.rates + h * h * twice @ self.series,
            self.rates + h * once @ self.series,
            self.work + h * once @ self.power,
        )


def by_collocation(
    form: TangentForm, q: Array, rates: Array, until_s: float, tolerance: float
) -> tuple[FreeWindow, ...]:
    """Integrate the motion from a closed position and rates (n,).

    Parameters
    ----------
    tolerance : float
        Largest allowed last coefficients of y in each window.

    Raises
    ------
    CrankcheckError
        Loads with kinks over the state of the mechanism; a motion that can not go on.
    """
    check_smooth(form)
    stretches = any(link.stretches for link in form.dynamics.assembly.scene.elastic.values())
    rule = radau(NODES) if stretches else LIFT
    going = _Going(form, rule, q, rates, tolerance, FIRST * until_s)
    times = edges(form.dynamics.forces.scene, until_s)
    return tuple(
        window
        for begin, end in itertools.pairwise(times)
        for window in going.through(begin, end, SHORTEST * until_s)
    )


def check_smooth(form: TangentForm) -> None:
    """Raise CrankcheckError for loads with kinks over the state, which collocation does not
    take."""
    if own := switches(form.dynamics.forces):
        raise CrankcheckError(
            f"{form.dynamics.assembly.scene.name}: loads.{own[0].load.name} is not smooth over the "
            "motion, which collocation needs; integrate it by the equations with multipliers "
            "(analytic.multibody.release_multibody)"
        )


@dataclass
class _Going:
    """State of an integration: state and work at its last window's end, and the next length."""

    form: TangentForm
    rule: Gauss
    q: Array
    rates: Array
    tolerance: float
    next_s: float
    work: float = 0.0
    made: int = 0

    def through(self, begin_s: float, end_s: float, shortest_s: float) -> Iterator[FreeWindow]:
        """Yield the windows between two edges."""
        now_s = begin_s
        while now_s < end_s:
            tangent = self.form.tangent(self.q)
            left = end_s - now_s
            # Windows of one length up to the edge: none that is a sliver.
            h = left / np.ceil(left / self.next_s * (1.0 - 1e-9))
            stop_s = end_s if h == left else now_s + h
            window, tail = self._window(tangent, now_s, stop_s)
            ratio = (self.tolerance / max(tail, 1e-3 * self.tolerance)) ** (1.0 / NODES)
            self.next_s = h * min(max(0.9 * ratio, 0.3), 2.0)
            if window is None:
                self._check(now_s, shortest_s)
                continue
            yield window
            self._end(window)
            now_s = stop_s

    def _check(self, now_s: float, shortest_s: float) -> None:
        if self.next_s < shortest_s or self.made > MOST_WINDOWS:
            raise CrankcheckError(
                f"{self.form.dynamics.assembly.scene.name}: at {now_s:g} s the motion of its "
                "elastic links can not be followed further; take a shorter time, or give them "
                "fewer shapes"
            )

    def _end(self, window: FreeWindow) -> None:
        end = np.array([window.end_s])
        y, rates, work = window.course(end)
        now = self.form.at(end, window.tangent, y, rates).now
        self.q, self.rates, self.work = now.q[0], now.rates[0], float(work[0])
        self.made += 1

    def _window(
        self, tangent: Tangent, start_s: float, end_s: float
    ) -> tuple[FreeWindow | None, float]:
        """Return a window and the end of its series; no window where it is too long."""
        h = end_s - start_s
        rates = self.form.coordinates(tangent, self.rates)
        # Radau's last node is the end, where loads still have the value before it.
        times = np.minimum(start_s + h * self.rule.places, math.nextafter(end_s, start_s))
        try:
            found = self._met(tangent, times, h, rates)
        except (CrankcheckError, np.linalg.LinAlgError):
            return None, 1e3 * self.tolerance
        if found is None:
            return None, 1e3 * self.tolerance
        seconds, instant = found
        series = self.rule.series @ seconds
        tail = h * h * float(np.abs((LIFT.lift_twice @ series)[-TAIL:]).max())
        if tail > 4.0 * self.tolerance:
            return None, tail
        power = self.form.dynamics.power(instant.now, instant.applied)
        own = FreeWindow(
            start_s, end_s, tangent, rates, series, self.rule.series @ power, self.work
        )
        return own, tail

    def _met(
        self, tangent: Tangent, times: Array, h: float, rates: Array
    ) -> tuple[Array, FreeInstant] | None:
        """Return y'' at the nodes (NODES, f), with the equations there."""
        form, rule, f = self.form, self.rule, len(rates)
        # Rates are integrated as accelerations are: else the method would not be stable.
        twice = h * h * rule.once @ rule.once
        drift = h * rule.places[:, None] * rates
        start = form.at(times[:1], tangent, drift[:1], rates[None])
        # Inertia changes within a window; stiffness changes by far less.
        slopes = start.inertia[0] @ form.derivatives(float(times[0]), tangent, drift[0], rates)
        stiff = np.kron(twice, slopes[:, :f]) + np.kron(h * rule.once, slopes[:, f:])
        seconds, inverse, last = np.repeat(start.seconds, NODES, axis=0), None, np.inf
        for _ in range(MOST_ROUNDS):
            y, y_rates = drift + twice @ seconds, rates + h * rule.once @ seconds
            instant = form.at(times, tangent, y, y_rates)
            if inverse is None:
                inverse = np.linalg.inv(block_diag(*instant.inertia) - stiff)
            left = instant.inertia @ (instant.seconds - seconds)[:, :, None]
            step = (inverse @ left.ravel()).reshape(NODES, f)
            seconds = seconds + step
            size = h * h * float(np.abs(step).max())
            if size <= CLOSE or (size < 1e-3 * self.tolerance and size >= 0.5 * last):
                return seconds, instant
            if not size < 10.0 * last:
                return None
            last = size
        return None


@lru_cache(maxsize=8)
def radau(count: int) -> Gauss:
    """Return the rule of ``count`` nodes, with everything that `gauss` has.

    It is more stable than with Gauss' nodes: vibration far faster than a window is gone after a few
    windows, where Gauss' nodes keep it for ever. Of order 2 n - 1. Source: E. Hairer, G. Wanner,
    Solving Ordinary Differential Equations II, sections IV.3 and IV.5.
    """
    own = gauss(count)
    # P_n - P_(n-1) is 0 there.
    x = legendre.legroots([0.0] * (count - 1) + [-1.0, 1.0])
    x[-1] = 1.0
    series = np.asarray(np.linalg.inv(legendre.legvander(x, count - 1)), dtype=np.float64)
    once = legendre.legvander(x, count) @ own.lift_once @ series
    twice = legendre.legvander(x, count + 1) @ own.lift_twice @ series
    return replace(
        own,
        places=0.5 * (x + 1.0),
        once=once,
        twice=twice,
        end_once=own.lift_once.sum(axis=0) @ series,
        end_twice=own.lift_twice.sum(axis=0) @ series,
        series=series,
    )
