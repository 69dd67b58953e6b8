"""Shapes that an elastic link may take: a few functions across its line, a few along it.

Ritz and Galerkin's method takes the deflection as a sum of given functions with unknown
coefficients. They are sines over the whole link or polynomials over parts of it; the rest needs
their values, slopes and curvatures alone.
"""

import math
from dataclasses import dataclass
from functools import lru_cache
from typing import Protocol

import numpy as np
from numpy.polynomial import Polynomial, legendre

from models.array import Array, Mask


class Shapes(Protocol):
    """Functions of a link of ``length_m`` [m]: ``across`` and ``along`` are their numbers,
    ``breaks`` (P + 1,) the places [m] between which they are smooth, from one end to the other.
    ``nodes`` of Gauss' rule from one break to the next integrate, to rounding, products of four
    slopes that were integrated in pairs."""

    @property
    def length_m(self) -> float: ...

    @property
    def across(self) -> int: ...

    @property
    def along(self) -> int: ...

    @property
    def slopes(self) -> Mask:
        """Mask of the coefficients, across and then along, that are slopes and not lengths."""

    @property
    def breaks(self) -> Array: ...

    @property
    def nodes(self) -> int: ...

    def deflections(self, x: Array, order: int) -> Array:
        """Return the functions across at places x (X,) [m], or their derivatives of an order up to
        2, (X, across). They are 0 at both ends."""

    def extensions(self, x: Array, order: int) -> Array:
        """Return those along, or their first derivatives, (X, along). They are 0 at x = 0."""


@lru_cache(maxsize=64)
def _rule(count: int) -> tuple[Array, Array]:
    """Return places in (0, 1) and weights of Gauss' rule."""
    x, w = legendre.leggauss(count)
    return 0.5 * (x + 1.0), 0.5 * w


def places(shapes: Shapes) -> tuple[Array, Array]:
    """Return the nodes of Gauss' rule between all breaks [m], and their weights [m]."""
    (share, weight), spans = _rule(shapes.nodes), np.diff(shapes.breaks)
    x = shapes.breaks[:-1, None] + spans[:, None] * share
    return x.ravel(), (spans[:, None] * weight).ravel()


def shortening(shapes: Shapes, x: Array) -> Array:
    """Return S (X, n, n) at places x (X,) [m]: a link bent to sum q_i f_i is shorter up to there by
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


@dataclass(frozen=True)
class WholeLink:
    """So many functions ``across`` and ``along`` a link of ``length_m`` [m], smooth from one end to
    the other, whose coefficients are lengths (`Shapes`)."""

    length_m: float
    across: int
    along: int = 0

    @property
    def slopes(self) -> Mask:
        return np.zeros(self.across + self.along, dtype=bool)

    @property
    def breaks(self) -> Array:
        return np.array([0.0, self.length_m])


@dataclass(frozen=True)
class SineModes(WholeLink):
    """The first ``across`` and ``along`` modes (`Shapes`).

        across   sin(i pi x / l)            along   sin((2 k - 1) pi x / (2 l))

    Source: Thesis on vibration of planar mechanisms with elastic links (2018), section 2.3.
    """

    @property
    def nodes(self) -> int:
        """Gauss' rule takes half a wave number over [-1, 1], and some: products of four sines have
        2 pi times that of the highest mode."""
        return 12 + math.ceil(1.1 * math.pi * max(self.across, self.along))

    def deflections(self, x: Array, order: int) -> Array:
        return self._sines(x, range(1, self.across + 1), 0.0, order)

    def extensions(self, x: Array, order: int) -> Array:
        return self._sines(x, range(1, self.along + 1), 0.5, order)

    def _sines(self, x: Array, modes: range, less: float, order: int) -> Array:
        """Return modes of so many half-waves, ``less`` so many, or their derivatives."""
        wave = np.array([mode - less for mode in modes]) * math.pi / self.length_m
        return np.asarray(wave**order * np.sin(x[:, None] * wave + order * math.pi / 2.0))


@dataclass(frozen=True)
class LegendrePolynomials(WholeLink):
    """Polynomials of degrees 2, 3, ... ``across`` and of degrees 1, 2, ... ``along`` (`Shapes`).

    They are Legendre's, integrated once, so that they are 0 at both ends; the first along the link
    is a straight line. An even load and a linear one bend a beam to polynomials of degree 5, which
    four of these hold exactly, while sines converge as i^-5. Source: B. Szabo, I. Babuska, Finite
    Element Analysis, chapter 3 (the p-version).
    """

    @property
    def nodes(self) -> int:
        """Two slopes integrated are of degree 2 m + 1."""
        return 2 * max(self.across, self.along) + 2

    def deflections(self, x: Array, order: int) -> Array:
        return self._integrated(x, range(1, 1 + self.across), order)

    def extensions(self, x: Array, order: int) -> Array:
        return self._integrated(x, range(self.along), order)

    def _integrated(self, x: Array, degrees: range, order: int) -> Array:
        """Return integrals from 0 of Legendre's polynomials of degrees, times the square root of 2
        k + 1, or derivatives of these integrals."""
        share, values = 2.0 * x / self.length_m - 1.0, np.empty((len(x), len(degrees)))
        for column, degree in enumerate(degrees):
            whole = legendre.legint(np.eye(degree + 1)[degree], lbnd=-1)
            own = legendre.legder(whole, order) if order else whole
            values[:, column] = legendre.legval(share, own) * np.sqrt(2.0 * degree + 1.0)
        return np.asarray(values * (2.0 / self.length_m) ** order)


# In s = x / l of an element: w at its start, slope at its start over l, the same at its end.
CUBICS = tuple(
    Polynomial(own) for own in ([1, 0, -3, 2], [0, 1, -2, 1], [0, 0, 3, -2], [0, 0, -1, 1])
)
LINES = (Polynomial([1, -1]), Polynomial([0, 1]))


@dataclass(frozen=True)
class HermiteElements:
    """Elements of one length, ``count`` of them (`Shapes`); a link that does not bend, or stretch,
    has no functions across, or along.

    ::

        node     0         1         2          the coefficients: at each node the deflection w and
                 o---------o---------o          the slope w', and the displacement u along the line;
          x      0         l         2 l        w is 0 at both ends, u at the first

    Source: Thesis on vibration of planar mechanisms with elastic links (2018), section 2.4 (X1 to
    X6).
    """

    length_m: float
    count: int
    bends: bool = True
    stretches: bool = False

    @property
    def across(self) -> int:
        """Slopes at all nodes, deflections at inner ones."""
        return 2 * self.count if self.bends else 0

    @property
    def along(self) -> int:
        return self.count if self.stretches else 0

    @property
    def slopes(self) -> Mask:
        """Mask of the second of the two coefficients of each node; both ends have no deflection."""
        odd = np.delete(np.arange(2 * self.count + 2) % 2 == 1, [0, 2 * self.count])
        return np.concatenate([odd[: self.across], np.zeros(self.along, dtype=bool)])

    @property
    def breaks(self) -> Array:
        return np.linspace(0.0, self.length_m, self.count + 1)

    @property
    def nodes(self) -> int:
        """Two slopes integrated are of degree 5, their squares of degree 10."""
        return 6

    def deflections(self, x: Array, order: int) -> Array:
        if not self.bends:
            return np.zeros((len(x), 0))
        own = self.length_m / self.count
        # Of node k: w in column 2 k, slope in 2 k + 1.
        scales = (1.0, own, 1.0, own)
        every = self._assembled(x, order, CUBICS, scales, width=2)
        last = 2 * self.count
        return np.delete(every, [0, last], axis=1)

    def extensions(self, x: Array, order: int) -> Array:
        if not self.stretches:
            return np.zeros((len(x), 0))
        return self._assembled(x, order, LINES, (1.0, 1.0), width=1)[:, 1:]

    def _assembled(
        self,
        x: Array,
        order: int,
        polynomials: tuple[Polynomial, ...],
        scales: tuple[float, ...],
        width: int,
    ) -> Array:
        """Return the functions of all nodes, ``width`` of each, (X, width (count + 1))."""
        own = self.length_m / self.count
        element = np.clip((x / own).astype(int), 0, self.count - 1)
        s = x / own - element
        row, values = np.arange(len(x)), np.zeros((len(x), width * (self.count + 1)))
        for k, (polynomial, scale) in enumerate(zip(polynomials, scales, strict=True)):
            derived = polynomial.deriv(order) if order else polynomial
            values[row, width * element + k] = scale * derived(s) / own**order
        return values
