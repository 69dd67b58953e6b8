"""What shapes an elastic link may take: a few functions across its line, a few along it.

Ritz and Galerkin's method takes the deflection as a sum of functions that are given, with
coefficients that are looked for. Whether these are sines over the whole link or polynomials over
parts of it, the rest asks for their values, slopes and curvatures alone.
"""

from __future__ import annotations

from typing import Protocol

import numpy as np

from analytic.free.gauss import gauss
from models.array import Array

NODES = 16
"""Of Gauss' rule between two breaks: exact to rounding for the squares of a half-wave, and for the
polynomials of elements."""


class Shapes(Protocol):
    """The functions of a link of ``length_m`` [m]; ``across`` and ``along`` are how many there are,
    ``breaks`` (P + 1,) the places [m] between which they are smooth, from one end to the other."""

    @property
    def length_m(self) -> float: ...

    @property
    def across(self) -> int: ...

    @property
    def along(self) -> int: ...

    @property
    def breaks(self) -> Array: ...

    def deflections(self, x: Array, order: int) -> Array:
        """The functions across at places x (X,) [m], or their derivatives of an order up to 2,
        (X, across). They are 0 at both ends."""

    def extensions(self, x: Array, order: int) -> Array:
        """Those along, or their first derivatives, (X, along). They are 0 at x = 0."""


def places(breaks: Array) -> tuple[Array, Array]:
    """The nodes of Gauss' rule between all breaks [m], and their weights [m]."""
    rule, spans = gauss(NODES), np.diff(breaks)
    x = breaks[:-1, None] + spans[:, None] * rule.places
    return x.ravel(), (spans[:, None] * rule.end_once).ravel()


def shortening(shapes: Shapes, x: Array) -> Array:
    """S (X, n, n) at places x (X,) [m]: a link bent to sum q_i f_i is shorter up to there by
    q S q / 2, S_ij = int f_i' f_j' from 0 to x."""
    breaks = shapes.breaks
    nodes, weights = places(breaks)
    slopes = shapes.deflections(nodes, 1)
    each = np.einsum("g,gi,gj->gij", weights, slopes, slopes)
    whole = each.reshape(len(breaks) - 1, NODES, *each.shape[1:]).sum(axis=1)
    before = np.concatenate([np.zeros_like(whole[:1]), np.cumsum(whole, axis=0)])
    panel = np.clip(np.searchsorted(breaks, x, side="right") - 1, 0, len(breaks) - 2)
    rule, start = gauss(NODES), breaks[panel]
    within = start[:, None] + (x - start)[:, None] * rule.places
    part = shapes.deflections(within.ravel(), 1).reshape(len(x), NODES, -1)
    rest = np.einsum("xg,xgi,xgj->xij", (x - start)[:, None] * rule.end_once, part, part)
    return np.asarray(before[panel] + rest)
