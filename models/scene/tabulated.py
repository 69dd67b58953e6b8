"""A characteristic as a table: values at places, with lines or cubics in between."""

from __future__ import annotations

import math
from bisect import bisect_right
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import Literal

import numpy as np

from models.array import Array
from models.scene.characteristics import EPS, Characteristic

Interpolation = Literal["linear", "pchip"]
END = 1e-9
"""Slack at the ends of a table, over its length: rounding moves the end of a stroke."""


@dataclass(frozen=True)
class Tabulated(Characteristic):
    """Values at places; in between straight (``linear``) or cubics without overshoot (``pchip``).

    With ``period`` it repeats for ever; the places then lie within one period, and the last value
    is the first if they fill it. Without, there is no value before its first place and after its
    last.
    """

    places: tuple[float, ...]
    values: tuple[float, ...]
    interpolation: Interpolation = "linear"
    period: float | None = None

    def __post_init__(self) -> None:
        if len(self.places) != len(self.values):
            raise ValueError(
                f"found {len(self.places)} places and {len(self.values)} values; give one each"
            )
        if len(self.places) < 2:
            raise ValueError(f"found {len(self.places)} rows; a table needs two or more")
        steps = np.diff(self.places)
        if np.min(steps) <= 0.0:
            k = int(np.argmin(steps > 0.0))
            raise ValueError(
                f"found {self.places[k + 1]:g} after {self.places[k]:g}; the places of a table "
                "have to increase from row to row"
            )
        with np.errstate(over="ignore", divide="ignore", invalid="ignore"):
            steep = ~np.isfinite(np.diff(self.values) / steps)
        if steep.any():
            k = int(np.argmax(steep))
            raise ValueError(
                f"found {self.values[k]:g} and {self.values[k + 1]:g} in rows {steps[k]:.3g} "
                "apart, a rise beyond all numbers; set the rows further apart"
            )
        if self.period is not None:
            self._check_period(self.period)

    def _check_period(self, period: float) -> None:
        span = self.places[-1] - self.places[0]
        if span > period * (1.0 + END):
            raise ValueError(
                f"found rows over {span:g}, more than the period, {period:g}; leave out repeated "
                "rows, or give the period"
            )
        if span > period * (1.0 - END) and self.values[0] != self.values[-1]:
            raise ValueError(
                f"found {self.values[0]:g} in the first row and {self.values[-1]:g} in the last, "
                "a period later; give them one value, or leave out the last row"
            )

    @property
    def repeats_after(self) -> float | None:
        return self.period

    @property
    def kinks(self) -> tuple[float, ...]:
        return self.places

    def kinks_between(self, first: float, last: float) -> Iterator[float]:
        if self.period is None:
            yield from super().kinks_between(first, last)
            return
        closed = self.places[-1] - self.places[0] > self.period * (1.0 - END)
        own = self.places[:-1] if closed else self.places
        # A period more on both sides, as quotients round.
        earliest = math.floor((first - own[0]) / self.period) - 1
        latest = math.ceil((last - own[0]) / self.period) + 1
        for turn in range(earliest, latest + 1):
            repeated = (kink + turn * self.period for kink in own)
            yield from (kink for kink in repeated if first <= kink <= last)

    @cached_property  # read at every step of an engine
    def _knots(self) -> tuple[Array, Array]:
        """Places and values; a period is closed by the first row of the next."""
        x, y = np.array(self.places), np.array(self.values)
        if self.period is not None and x[-1] - x[0] <= self.period * (1.0 - END):
            x, y = np.append(x, x[0] + self.period), np.append(y, y[0])
        return x, y

    @cached_property  # as the knots
    def _slopes(self) -> Array:
        return slopes(*self._knots, closed=self.period is not None)

    @cached_property  # as the knots
    def _rows(self) -> tuple[list[float], list[float], list[float]]:
        """Places, values and slopes as plain numbers: an array's are read ten times as slowly."""
        places, values = self._knots
        return places.tolist(), values.tolist(), self._slopes.tolist()

    def at(self, x: Array) -> Array:
        knots, values = self._knots
        if self.period is None:
            self._check_within(x)
        x = np.clip(self._folded(x), knots[0], knots[-1])
        if self.interpolation == "linear":
            return np.interp(x, knots, values)
        return spline(x, knots, values, self._slopes)

    def at_one(self, x: float) -> float:
        places, values, slope = self._rows
        if self.period is None:
            if not places[0] <= x <= places[-1]:
                self._check_within(np.array([x]))
        else:
            x = self.places[0] + (x - self.places[0]) % self.period
        x = min(max(x, places[0]), places[-1])
        k = min(bisect_right(places, x), len(places) - 1) - 1
        h, rise = places[k + 1] - places[k], values[k + 1] - values[k]
        if self.interpolation == "linear":
            return values[k + 1] if x == places[k + 1] else rise / h * (x - places[k]) + values[k]
        t, d0, d1 = (x - places[k]) / h, h * slope[k], h * slope[k + 1]  # as `spline`
        return values[k] + t * (d0 + t * (3.0 * rise - 2.0 * d0 - d1 + t * (d0 + d1 - 2.0 * rise)))

    def _folded(self, x: Array) -> Array:
        """``x`` without whole periods."""
        if self.period is None:
            return x
        return np.asarray(self.places[0] + np.mod(x - self.places[0], self.period))

    def nearest(self, x: float) -> float:
        return x if self.period is not None else min(max(x, self.places[0]), self.places[-1])

    def _check_within(self, x: Array) -> None:
        first, last = self.places[0], self.places[-1]
        slack = END * (last - first)
        off = (x < first - slack) | (x > last + slack)
        if off.any():
            beyond = np.where(off, np.maximum(first - x, x - last), 0.0)
            k = int(np.argmax(beyond))
            raise ValueError(
                f"the table goes from {first:.9g} to {last:.9g}, and {x[k]:.9g} is requested, "
                f"{beyond[k]:.3g} beyond; give it rows up to there"
            )

    def steepest(self, x: Array, by: Array | float) -> Array | float:
        knots, values = self._knots
        # A cubic without overshoot is nowhere steeper than three times its chord.
        factor = 1.0 if self.interpolation == "linear" else 3.0
        steep = factor * np.abs(np.diff(values) / np.diff(knots))
        near = largest_near(knots, steep, self._folded(x), by)
        if self.period is None:
            return near
        # Over the end of a period the next one begins.
        folded = self._folded(x)
        over = (folded - by <= knots[0]) | (folded + by >= knots[-1])
        return np.where(over, np.max(steep), near)

    def rounding(self, x: Array) -> Array | float:
        knots, values = self._knots
        sizes = np.maximum(np.abs(values[1:]), np.abs(values[:-1]))
        # Whole periods are taken off the argument, and one is added to the first place.
        reach = np.abs(x) + max(abs(self.places[0]), abs(self.places[-1])) + (self.period or 0.0)
        moved = 4 * EPS * reach if self.period is not None else 0.0
        size = largest_near(knots, sizes, self._folded(x), moved)
        own = size * (16 * EPS if self.interpolation == "linear" else 128 * EPS)
        return np.asarray(own + moved * self.steepest(x, moved))

    def carried(self, size: float, *, stretch: float = 1.0, shift: float = 0.0) -> Tabulated:
        rows = [
            (stretch * place + shift, size * value)
            for place, value in zip(self.places, self.values, strict=True)
        ]
        places, values = zip(*(rows if stretch > 0.0 else rows[::-1]), strict=True)
        period = None if self.period is None else abs(stretch) * self.period
        return Tabulated(places, values, self.interpolation, period)


def slopes(x: Array, y: Array, *, closed: bool) -> Array:
    """Return the slope at each row (n,) of a table with increasing ``x``; ``closed`` if periodic.

    Source: F. N. Fritsch, J. Butland, A method for constructing local monotone piecewise cubic
    interpolants, SIAM J. Sci. Stat. Comput. 5, 1984: the slope at a row is the weighted harmonic
    mean of the slopes of the chords beside it, 0 where these differ in sign.
    """
    h = np.diff(x)
    chord = np.diff(y) / h
    slope = np.empty_like(y)
    slope[1:-1] = _mean(h[:-1], h[1:], chord[:-1], chord[1:])
    if closed:
        slope[0] = slope[-1] = _mean(h[-1:], h[:1], chord[-1:], chord[:1])[0]
    elif len(y) == 2:
        slope[:] = chord[0]
    else:
        slope[0] = _end(h[0], h[1], chord[0], chord[1])
        slope[-1] = _end(h[-1], h[-2], chord[-1], chord[-2])
    return slope


def _mean(h0: Array, h1: Array, chord0: Array, chord1: Array) -> Array:
    """The harmonic mean of the chords before and after a row, the shorter one's weight larger."""
    same = chord0 * chord1 > 0.0
    before, after = np.where(same, chord0, 1.0), np.where(same, chord1, 1.0)
    w0, w1 = 2.0 * h1 + h0, h1 + 2.0 * h0
    return np.where(same, (w0 + w1) / (w0 / before + w1 / after), 0.0)


def _end(h0: float, h1: float, chord0: float, chord1: float) -> float:
    """Return the slope in an end row, by the parabola through three rows without overshoot."""
    slope = ((2.0 * h0 + h1) * chord0 - h0 * chord1) / (h0 + h1)
    if slope * chord0 <= 0.0:
        return 0.0
    if chord0 * chord1 <= 0.0 and abs(slope) > 3.0 * abs(chord0):
        return 3.0 * chord0
    return slope


def spline(x: Array, knots: Array, values: Array, slope: Array) -> Array:
    """The cubics between the rows at ``x``, within them."""
    k = np.clip(np.searchsorted(knots, x, side="right") - 1, 0, len(knots) - 2)
    h = knots[k + 1] - knots[k]
    t = (x - knots[k]) / h
    rise = values[k + 1] - values[k]
    # Hermite's form about the first row: y0 + t (h d0 + t (3 rise - h (2 d0 + d1) + t (...))).
    d0, d1 = h * slope[k], h * slope[k + 1]
    return np.asarray(
        values[k] + t * (d0 + t * (3.0 * rise - 2.0 * d0 - d1 + t * (d0 + d1 - 2.0 * rise)))
    )


def largest_near(knots: Array, of_intervals: Array, x: Array, by: Array | float) -> Array:
    """Return the largest of the intervals' numbers (n - 1,) within ``by`` of ``x``. Before the
    first row and after the last the interval there counts."""
    count = len(of_intervals)
    first = np.clip(np.searchsorted(knots, x - by, side="right") - 1, 0, count - 1)
    last = np.clip(np.searchsorted(knots, x + by, side="left") - 1, 0, count - 1)
    last = np.maximum(first, last)
    most = np.maximum(of_intervals[first], of_intervals[last])
    return np.where(last - first > 1, np.max(of_intervals), most)
