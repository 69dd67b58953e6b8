"""Cubic interpolation that does not overshoot: rises where its table rises, and nowhere else.

Source: F. N. Fritsch, J. Butland, A method for constructing local monotone piecewise cubic
interpolants, SIAM J. Sci. Stat. Comput. 5, 1984: the slope at a row is the weighted harmonic mean
of the slopes of the chords beside it, 0 where these differ in sign.
"""

from __future__ import annotations

import numpy as np

from models.array import Array


def slopes(x: Array, y: Array, *, closed: bool) -> Array:
    """The slope at each row (n,) of a table with increasing ``x``; ``closed`` where it repeats."""
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
    """The slope in an end row: of the parabola through three rows, if it does not overshoot."""
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
    """The largest of the numbers of the intervals between rows (n - 1,) within ``by`` of ``x``.

    Before the first row and after the last that of the interval there counts.
    """
    count = len(of_intervals)
    first = np.clip(np.searchsorted(knots, x - by, side="right") - 1, 0, count - 1)
    last = np.clip(np.searchsorted(knots, x + by, side="left") - 1, 0, count - 1)
    last = np.maximum(first, last)
    most = np.maximum(of_intervals[first], of_intervals[last])
    return np.where(last - first > 1, np.max(of_intervals), most)
