"""What an integration found: the motion in windows of time, each a polynomial in a chart."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from analytic.free.chart import Chart
from analytic.free.gauss import sums
from models.array import Array

MOST = 1.001
"""How far beyond what they were solved for polynomials are used."""


@dataclass(frozen=True, eq=False)
class Window:
    """From ``start_s`` to ``end_s`` the coefficients in Legendre's polynomials of u, u' and u''.

    The polynomials are over ``long_s``, which is that time or hardly less of it.
    ``change`` (2, 2) is the derivative of u and u' at its end by those at its start; ``swing``
    (2, n) that of u within it. ``wound`` are angles of springs in pins at its start; ``bends``
    says that it ends where a load, a stroke or friction goes over to another formula by where the
    machine is, or how fast.
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

    @property
    def end_s(self) -> float:
        return self.windows[-1].end_s

    def wound_at(self, windows: NDArray[np.intp]) -> dict[str, Array]:
        """Angles of springs in pins at the start of windows, by number, (T,) each."""
        names = self.windows[0].wound
        every = {name: np.array([one.wound[name] for one in self.windows]) for name in names}
        return {name: angles[windows] for name, angles in every.items()}

    def windows_at(self, time_s: Array) -> NDArray[np.intp]:
        """The number of the window of each time; at a border that of the later one."""
        found = np.searchsorted(self.starts_s, time_s, side="right") - 1
        return np.asarray(np.clip(found, 0, len(self.windows) - 1))

    def state(self, time_s: Array) -> tuple[Array, Array, Array]:
        """u, u' and u'' at times [s], (T,), each in the chart of its window."""
        k = self.windows_at(time_s)
        start, long_ = self.starts_s[k], self._long_s[k]
        share = np.clip((time_s - start) / long_, 0.0, MOST)
        return self.at(k, share)

    def at(self, windows: NDArray[np.intp], share: Array) -> tuple[Array, Array, Array]:
        """u, u' and u'' at shares of windows, by number, (T,)."""
        u, v, a = (sums(table[windows], share) for table in self._tables)
        return u, v, a

    def legs(self) -> Iterator[tuple[Chart, int, int]]:
        """The charts one after the other, with their first window and that after their last."""
        first = 0
        for k in range(1, len(self.windows) + 1):
            if k == len(self.windows) or self.windows[k].chart is not self.windows[first].chart:
                yield self.windows[first].chart, first, k
                first = k

    @cached_property
    def _long_s(self) -> Array:
        return np.array([window.long_s for window in self.windows])

    @cached_property
    def _tables(self) -> tuple[Array, Array, Array]:
        """The coefficients of all windows, those of short series filled with 0."""
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
