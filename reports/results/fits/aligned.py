"""What floors the points of a curve allow where floor and step may be aligned in any way.

A curve is chosen with one alignment (`reports.results.fits.curves`), often with that of 1, as few
points tell no other. Its floor is then off where the true alignment is 0.3, by more than scatter
alone explains, so its doubt is that of curves of all alignments. They are written

    error = floor sqrt(1 + 2 a r y^p + (r y^p)^2)

with y the step over the finest one and r the part of the step over the floor there. The best floor
for given a, p and r is a mean of logarithms; these three are scanned.
"""

from __future__ import annotations

import numpy as np

from models.array import Array
from reports.results.fits.curves import Allowed, Curve

ALIGNMENTS = np.linspace(-0.8, 1.0, 10)
ORDERS = np.linspace(0.5, 3.0, 51)
LEAST, MOST = 1e-4, 3.0
"""Parts of the step over the floor at the finest step: nothing, and far beyond a floor that is
seen."""


def aligned_within(dt_s: Array, error: Array, best: Curve, more: float) -> Allowed:
    """Orders and floors of the curves of any alignment whose misfit is at most that of ``best``
    and ``more``; they hold those of ``best`` itself."""
    y, e = np.log(dt_s / dt_s.min()), np.log(error)
    a, p = (x.ravel() for x in np.meshgrid(ALIGNMENTS, ORDERS, indexing="ij"))
    a, rise = a[:, None, None], p[:, None, None] * y

    def rest(ratios: Array) -> Array:
        """ln (error / (curve over floor)) for logarithms of ratios, shape (k, m), as (k, m, n)."""
        step = np.exp(ratios[:, :, None] + rise)
        return np.asarray(e - 0.5 * np.log(1.0 + step * (2.0 * a + step)))

    middle = np.full(len(p), 0.5 * np.log(LEAST * MOST))
    width = 0.5 * np.log(MOST / LEAST)
    for number in (41, 11, 11):  # closer and closer around the best ratio of each
        tried = _around(middle, np.linspace(-width, width, number))
        at = rest(tried).var(axis=-1).argmin(axis=1)
        middle = np.take_along_axis(tried, at[:, None], axis=1)[:, 0]
        width *= 2.0 / (number - 1)
    steps = np.geomspace(2e-3, np.log(MOST / LEAST), 20)
    found = rest(_around(middle, np.concatenate([-steps[::-1], [0.0], steps])))
    slack = best.misfit + more - found.var(axis=-1) * len(e)
    at, _ = good = np.nonzero(slack >= 0.0)
    level, free = found.mean(axis=-1)[good], np.sqrt(slack[good] / len(e))
    return Allowed(
        (float(p[at].min(initial=best.order)), float(p[at].max(initial=best.order))),
        (
            float(np.exp(level - free).min(initial=best.floor)),
            float(np.exp(level + free).max(initial=best.floor)),
        ),
    )


def _around(middle: Array, offsets: Array) -> Array:
    """Logarithms of ratios in their range, shape (k, m)."""
    return np.asarray((middle[:, None] + offsets).clip(np.log(LEAST), np.log(MOST)))
