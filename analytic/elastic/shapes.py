"""What shapes an elastic link may take: a few functions across its line, a few along it.

Ritz and Galerkin's method takes the deflection as a sum of functions that are given, with
coefficients that are looked for. Whether these are sines over the whole link or polynomials over
parts of it, the rest asks for their values, slopes and curvatures alone.
"""

from __future__ import annotations

from functools import lru_cache
from typing import Protocol

import numpy as np
from numpy.polynomial import legendre

from models.array import Array, Mask


class Shapes(Protocol):
    """The functions of a link of ``length_m`` [m]; ``across`` and ``along`` are how many there are,
    ``breaks`` (P + 1,) the places [m] between which they are smooth, from one end to the other,
    and ``nodes`` how many of Gauss' rule it takes from one break to the next to integrate, to
    rounding, products of four slopes that were integrated in pairs."""

    @property
    def length_m(self) -> float: ...

    @property
    def across(self) -> int: ...

    @property
    def along(self) -> int: ...

    @property
    def slopes(self) -> Mask:
        """Which coefficients, those across and then those along, are slopes, and not lengths."""

    @property
    def breaks(self) -> Array: ...

    @property
    def nodes(self) -> int: ...

    def deflections(self, x: Array, order: int) -> Array:
        """The functions across at places x (X,) [m], or their derivatives of an order up to 2,
        (X, across). They are 0 at both ends."""

    def extensions(self, x: Array, order: int) -> Array:
        """Those along, or their first derivatives, (X, along). They are 0 at x = 0."""


@lru_cache(maxsize=64)
def _rule(count: int) -> tuple[Array, Array]:
    """Places in (0, 1) and weights of Gauss' rule."""
    x, w = legendre.leggauss(count)
    return 0.5 * (x + 1.0), 0.5 * w


def places(shapes: Shapes) -> tuple[Array, Array]:
    """The nodes of Gauss' rule between all breaks [m], and their weights [m]."""
    (share, weight), spans = _rule(shapes.nodes), np.diff(shapes.breaks)
    x = shapes.breaks[:-1, None] + spans[:, None] * share
    return x.ravel(), (spans[:, None] * weight).ravel()


def shortening(shapes: Shapes, x: Array) -> Array:
    """S (X, n, n) at places x (X,) [m]: a link bent to sum q_i f_i is shorter up to there by
    q S q / 2, S_ij = int f_i' f_j' from 0 to x."""
    breaks, (share, weight) = shapes.breaks, _rule(shapes.nodes)
    nodes, weights = places(shapes)
    slopes = shapes.deflections(nodes, 1)
    each = weights[:, None, None] * slopes[:, :, None] * slopes[:, None]
    whole = each.reshape(len(breaks) - 1, len(share), *each.shape[1:]).sum(axis=1)
    before = np.concatenate([np.zeros_like(whole[:1]), np.cumsum(whole, axis=0)])
    panel = np.clip(np.searchsorted(breaks, x, side="right") - 1, 0, len(breaks) - 2)
    way = (x - breaks[panel])[:, None]
    within = breaks[panel][:, None] + way * share
    part = shapes.deflections(within.ravel(), 1).reshape(len(x), len(share), shapes.across)
    rest = np.swapaxes(part * (way * weight)[:, :, None], 1, 2) @ part
    return np.asarray(before[panel] + rest)
