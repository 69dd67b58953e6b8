"""Result of an integration: the motion in windows of time, each a polynomial in a chart."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from analytic.dyads.plane import EPS
from analytic.free.chart import Chart
from analytic.free.window import gauss, sums
from models.array import Array, Mask

MOST = 1.001
"""Range in which polynomials are used, over that in which they were solved for."""


@dataclass(frozen=True, eq=False)
class Window:
    """Coefficients in Legendre's polynomials of u, u' and u'' from ``start_s`` to ``end_s``.

    The polynomials are over ``long_s``, which is that time or hardly less of it. ``change`` (2, 2)
    is the derivative of u and u' at its end by those at its start; ``swing`` (2, n) that of u
    within it. ``wound`` are angles of springs in pins at its start; ``bends`` says that it ends
    where a load, a stroke or friction changes formula with the position or speed of the machine.
    """

    chart: Chart
    start_s: float
    end_s: float
    long_s: float
    u: Array
    v: Array
    a: Array
    change: Array
    swing: Array
    wound: Mapping[str, float]
    bends: bool = False


@dataclass(frozen=True, eq=False)
class CoordinateHistory:
    """Windows one after the other, from time 0."""

    windows: tuple[Window, ...]

    @cached_property
    def starts_s(self) -> Array:
        return np.array([window.start_s for window in self.windows])

    @cached_property
    def long_s(self) -> Array:
        return np.array([window.long_s for window in self.windows])

    @property
    def end_s(self) -> float:
        return self.windows[-1].end_s

    def wound_at(self, windows: NDArray[np.intp]) -> dict[str, Array]:
        """Return the angles of springs in pins at the start of windows, by number, (T,) each."""
        names = self.windows[0].wound
        every = {name: np.array([one.wound[name] for one in self.windows]) for name in names}
        return {name: angles[windows] for name, angles in every.items()}

    def windows_at(self, time_s: Array) -> NDArray[np.intp]:
        """Return the number of the window of each time; at a border that of the later one."""
        found = np.searchsorted(self.starts_s, time_s, side="right") - 1
        return np.asarray(np.clip(found, 0, len(self.windows) - 1))

    def state(self, time_s: Array) -> tuple[Array, Array, Array]:
        """Return u, u' and u'' at times [s], (T,), each in the chart of its window."""
        k = self.windows_at(time_s)
        start, long_ = self.starts_s[k], self.long_s[k]
        share = np.clip((time_s - start) / long_, 0.0, MOST)
        return self.at(k, share)

    def at(self, windows: NDArray[np.intp], share: Array) -> tuple[Array, Array, Array]:
        """Return u, u' and u'' at shares of windows, by number, (T,)."""
        u, v, a = (sums(table[windows], share) for table in self._tables)
        return u, v, a

    def charts_at(self, time_s: Array) -> Iterator[tuple[Chart, Mask]]:
        """Yield the charts, each with the mask of the times [s] in it, (T,)."""
        window = self.windows_at(time_s)
        for chart, first, last in self.legs():
            yield chart, (window >= first) & (window < last)

    def legs(self) -> Iterator[tuple[Chart, int, int]]:
        """Yield the charts, each with its first window and that after its last."""
        first = 0
        for k in range(1, len(self.windows) + 1):
            if k == len(self.windows) or self.windows[k].chart is not self.windows[first].chart:
                yield self.windows[first].chart, first, k
                first = k

    @cached_property
    def _tables(self) -> tuple[Array, Array, Array]:
        """Coefficients of all windows, short series filled with 0."""
        return (
            _table([window.u for window in self.windows]),
            _table([window.v for window in self.windows]),
            _table([window.a for window in self.windows]),
        )


def _table(series: list[Array]) -> Array:
    table = np.zeros((len(series), max(map(len, series))))
    for row, one in zip(table, series, strict=True):
        row[: len(one)] = one
    return table


SAFETY = 8.0
"""Ratio of the error bound to the largest difference so far."""
SHARES = (0.13, 0.5, 0.87)
"""Shares of a window that are compared: not its ends, where forces may jump."""


@dataclass(frozen=True, eq=False)
class Doubt:
    """Errors of u, u' and u'' until the times ``time_s``: rows of ``off`` (3, T)."""

    time_s: Array
    off: Array

    @staticmethod
    def between(history: CoordinateHistory, other: CoordinateHistory) -> Doubt:
        """Estimate the errors of one integration from another of the same motion."""
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
        """Return the errors of u, u' and u'', (3, T)."""
        # The next sample holds the differences up to it.
        k = np.clip(np.searchsorted(self.time_s, time_s), 0, len(self.time_s) - 1)
        return np.asarray(self.off[:, k])


def _moved(of: Chart, to: Chart, state: Array, near: Array) -> Array:
    """Return a state (3, T) of one chart in another, next to coordinates ``near``: by the driver's
    angle where they are about different limits, which is away from both."""
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


STEEP = 0.1
"""Slope of the driver's angle by the coordinate. Nearer to a limit, where the slope is less, a
start is changed in the coordinate, as the angle is at its end there."""

AT_REST = 1e-10
"""Rate over those in a window, below which its end is at rest."""


def growth(history: CoordinateHistory, omega: float) -> tuple[Array, Array]:
    """Return times [s], and the largest growth of a small change of the start until then.

    It is the change of the driver's angle: the larger one for a changed angle, per rad, and for a
    changed speed, per ``omega`` [rad/s]; at least 1.

    Each window has the derivative of its end by its start; their product is that of the motion.
    Where the acceleration jumps at a place, a later arrival is pushed later; where it jumps as the
    machine comes to rest, the rates before and after are as the accelerations. Source: M. di
    Bernardo et al., Piecewise-smooth Dynamical Systems, section 2.5 (saltation matrices).
    """
    chart = history.windows[0].chart
    u0, v0 = (float(row[0]) for row in history.state(np.zeros(1))[:2])
    _, first, second = (float(row[0]) for row in chart.driver(np.array([u0])))
    steep = math.copysign(max(abs(first), STEEP), first)
    # The angle changed by 1 at the same speed; the speed changed by omega.
    change = np.array([[1.0 / steep, 0.0], [-second * v0 / steep**2, omega / steep]])
    times, sizes = [np.zeros(1)], [np.ones(1)]
    for k, window in enumerate(history.windows):
        at = window.start_s + window.long_s * gauss(window.swing.shape[1]).places
        turned = window.chart.driver(history.state(at)[0])[1]
        sizes.append(np.abs(turned * (window.swing.T @ change).T).max(axis=0))
        times.append(at)
        change = window.change @ change
        if k + 1 < len(history.windows):
            change = _across(window, history.windows[k + 1]) @ change
    time_s, size = np.concatenate(times), np.concatenate(sizes)
    return time_s, np.maximum.accumulate(np.maximum(size, 1.0))


def _across(before: Window, after: Window) -> Array:
    """Return the derivative from the end of a window to the start of the next one."""
    matrix = np.eye(2)
    v = float(before.v.sum())
    if before.bends and before.chart is after.chart:
        start = (-1.0) ** np.arange(max(len(after.v), len(after.a)))
        a, b = float(before.a.sum()), float(after.a @ start[: len(after.a)])
        v = float(after.v @ start[: len(after.v)])
        if abs(v) > AT_REST * float(np.abs(before.v).sum() + np.abs(after.v).sum()):
            matrix[1, 0] = (b - a) / v
        elif a:
            matrix[1, 1] = b / a
    if before.chart is not after.chart:
        matrix = _between(before.chart, after.chart, float(before.u.sum()), v) @ matrix
    return matrix


def _between(old: Chart, new: Chart, u: float, v: float) -> Array:
    """Return the derivative of the coordinate and the rate of one chart by those of another."""
    phi, first, second = (float(row[0]) for row in old.driver(np.array([u])))
    assert new.limit is not None
    x = np.array([new.limit.coordinate(phi)])
    _, own, bent = (float(row[0]) for row in new.driver(x))
    ratio = first / own
    return np.array([[ratio, 0.0], [(second - ratio * ratio * bent) * v / own, ratio]])
