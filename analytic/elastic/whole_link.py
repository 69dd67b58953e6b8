"""Shapes of one formula over the whole link: what sines and polynomials have in common."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from models.array import Array, Mask


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
