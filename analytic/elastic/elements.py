"""Beam elements: cubic polynomials across (Hermite's), straight lines along, element by element.

::

    node     0         1         2          the coefficients: at each node the deflection w and
             o---------o---------o          the slope w', and the displacement u along the line;
      x      0         l         2 l        w is 0 at both ends, u at the first

Source: Thesis on vibration of planar mechanisms with elastic links (2018), section 2.4 (X1 to X6).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.polynomial import Polynomial

from models.array import Array, Mask

# In s = x / l of an element: w at its start, slope at its start over l, the same at its end.
CUBICS = tuple(
    Polynomial(own) for own in ([1, 0, -3, 2], [0, 1, -2, 1], [0, 0, 3, -2], [0, 0, -1, 1])
)
LINES = (Polynomial([1, -1]), Polynomial([0, 1]))


@dataclass(frozen=True)
class HermiteElements:
    """``count`` elements of one length (`Shapes`); what does not bend or stretch has no functions
    for it."""

    length_m: float
    count: int
    bends: bool = True
    stretches: bool = False

    @property
    def across(self) -> int:
        """Slopes at all nodes, deflections at those within."""
        return 2 * self.count if self.bends else 0

    @property
    def along(self) -> int:
        return self.count if self.stretches else 0

    @property
    def slopes(self) -> Mask:
        """Of each node the second of its two, where both ends have no deflection."""
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
        """Functions of all nodes, ``width`` of each, (X, width (count + 1))."""
        own = self.length_m / self.count
        element = np.clip((x / own).astype(int), 0, self.count - 1)
        s = x / own - element
        row, values = np.arange(len(x)), np.zeros((len(x), width * (self.count + 1)))
        for k, (polynomial, scale) in enumerate(zip(polynomials, scales, strict=True)):
            derived = polynomial.deriv(order) if order else polynomial
            values[row, width * element + k] = scale * derived(s) / own**order
        return values
