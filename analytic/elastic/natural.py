"""Natural frequencies: of a mechanism whose driver is held still, and of its links alone.

Held at an angle the mechanism vibrates with K y = w^2 M y. M goes with the angle, as the coupler
moves the rocker more or less, and w with it; the means over a turn are what the frequencies of the
moving mechanism are near to.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from models.array import Array
from models.elastic_line import line_of
from models.scene import Scene

SHOWN = 3
"""Modes of a link, of each kind, that are told."""


@dataclass(frozen=True)
class LinkMode:
    """A mode of a link between its pins alone, both at rest: ``kind`` is across or along."""

    link: str
    kind: str
    number: int
    frequency_rad_s: float


def link_modes(scene: Scene, number: int = SHOWN) -> list[LinkMode]:
    """The first modes of all elastic links, of each kind that they have."""
    found = []
    for name, own in scene.elastic.items():
        line = line_of(scene, name)
        for kind, has, frequency in (
            ("across", own.bends, own.bending_rad_s),
            ("along", own.stretches, own.axial_rad_s),
        ):
            found += [
                LinkMode(name, kind, k, frequency(line.length_m, line.density_kg_m, k))
                for k in range(1, number + 1)
                if has
            ]
    return found


def lowest_rad_s(scene: Scene) -> float:
    """The lowest natural frequency of the elastic links alone: what frequency ratios are of."""
    return min(mode.frequency_rad_s for mode in link_modes(scene, 1))


@dataclass(frozen=True)
class NaturalModes:
    """``frequency_rad_s`` (N, m) at N angles of the driver, the lowest first, and coefficients of
    the shapes of each, (N, m, m), one a column, of modal mass 1."""

    frequency_rad_s: Array
    shape: Array

    @property
    def mean_rad_s(self) -> Array:
        """The mean over the turn, (m,)."""
        return np.asarray(self.frequency_rad_s.mean(axis=0))


def natural_modes(mass: Array, stiffness: Array) -> NaturalModes:
    """Of matrices (N, m, m). Where a mode has lost its stiffness its frequency is 0."""
    # With M = L L', symmetric for v = L' y.
    inverse = np.linalg.inv(np.linalg.cholesky(0.5 * (mass + np.swapaxes(mass, 1, 2))))
    onto = np.swapaxes(inverse, 1, 2)
    even = 0.5 * (stiffness + np.swapaxes(stiffness, 1, 2))
    squares, shapes = np.linalg.eigh(inverse @ even @ onto)
    return NaturalModes(np.sqrt(np.maximum(squares, 0.0)), onto @ shapes)
