"""A mechanism with its elastic links bent, all displacements from rigid links magnified.

A point is drawn at ``rigid + factor * (elastic - rigid)``, an elastic link bent by ``factor`` times
its deflection from the line between its pins.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from models.array import Array
from models.cut_links import line_of
from models.motion import Motion
from models.scene import Scene

SHOWN = 0.06
"""Of the size of what moves: about how far the largest displacement is drawn."""


def magnification(
    elastic: Motion, rigid: Motion, bent: Mapping[str, Array], size_m: float
) -> float:
    """The factor, 1, 2 or 5 times a power of ten and at least 1, that makes displacements seen."""
    moved = [
        np.hypot(*(point.position - rigid.points[name].position).T).max()
        for name, point in elastic.points.items()
    ]
    largest = float(max([*moved, *(np.abs(each).max() for each in bent.values())]))
    if not largest > 0.0:
        return 1.0
    wanted = SHOWN * size_m / largest
    power = 10.0 ** math.floor(math.log10(wanted))
    return max(1.0, power * max(x for x in (1.0, 2.0, 5.0) if x * power <= wanted * (1.0 + 1e-9)))


@dataclass(frozen=True)
class Magnified:
    """Both motions at the same instants; ``bent`` are deflections (T, K) at equal parts of each
    elastic link [m]."""

    scene: Scene
    elastic: Motion
    rigid: Motion
    bent: Mapping[str, Array]
    factor: float

    def place(self, point: str, index: int) -> Array:
        """A point at a sample [m], (2,)."""
        exact = self.rigid.points[point].position[index]
        moved = self.elastic.points[point].position[index] - exact
        return np.asarray(exact + self.factor * moved)

    def outline(self, link: str, index: int) -> Array:
        """The line or the corners of a link at a sample [m], (K, 2)."""
        if link not in self.bent:
            return np.array([self.place(p, index) for p in self.scene.links[link].points])
        start, end = (self.place(pin, index) for pin in line_of(self.scene, link).pins)
        along = end - start
        across = np.array([-along[1], along[0]]) / math.hypot(*along)
        off = self.factor * self.bent[link][index]
        shares = np.linspace(0.0, 1.0, off.size)
        return np.asarray(start + np.outer(shares, along) + np.outer(off, across))
