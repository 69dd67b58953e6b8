"""Sines over the whole link: the modes of a beam between two pins, and of a rod held at one end.

    across   sin(i pi x / l)            along   sin((2 k - 1) pi x / (2 l))

Source: Thesis on vibration of planar mechanisms with elastic links (2018), section 2.3.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from analytic.elastic.whole_link import WholeLink
from models.array import Array


@dataclass(frozen=True)
class SineModes(WholeLink):
    """The first ``across`` and ``along`` modes (`Shapes`)."""

    @property
    def nodes(self) -> int:
        """Gauss' rule takes half a wave number over [-1, 1], and some: products of four have
        2 pi times that of the highest mode."""
        return 12 + math.ceil(1.1 * math.pi * max(self.across, self.along))

    def deflections(self, x: Array, order: int) -> Array:
        return self._sines(x, range(1, self.across + 1), 0.0, order)

    def extensions(self, x: Array, order: int) -> Array:
        return self._sines(x, range(1, self.along + 1), 0.5, order)

    def _sines(self, x: Array, modes: range, less: float, order: int) -> Array:
        """Modes of so many half-waves over the link, ``less`` so many, or their derivatives."""
        wave = np.array([mode - less for mode in modes]) * math.pi / self.length_m
        return np.asarray(wave**order * np.sin(x[:, None] * wave + order * math.pi / 2.0))
