"""Nodes of cubic elements that start with the strain they should, and not with what they lock by.

A cubic through places and unit tangents of a curve is longer than it in one half of an element and
shorter in the other, by about h^3 k k', k the curvature. Elements that hardly stretch answer that
with forces of about EA (w/l)^2/n^3 on their pins. How long the tangents are, and where along the
curve the nodes within lie, is free: they are taken so that the strain is nearest to what is asked.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.polynomial import legendre

from models.array import Array

POINTS = 5


def strain_places(element_m: float, count: int) -> Array:
    """Where along the link strains are compared, (count, POINTS) [m]: the nodes of Gauss' rule."""
    share = 0.5 * (legendre.leggauss(POINTS)[0] + 1.0)
    return element_m * (np.arange(count)[:, None] + share)


@dataclass(frozen=True)
class CubicNodes:
    """``place`` and ``drift`` (n + 1, 3) are x, y [m] and the tangent's angle of each node, and
    their rates; ``strain`` and ``strain_rate`` (n + 1,) by how much longer than 1 the tangents
    are."""

    place: Array
    drift: Array
    strain: Array
    strain_rate: Array


def cubic_nodes(
    place: Array, drift: Array, wanted: Array, wanted_rate: Array, element_m: float
) -> CubicNodes:
    """The nodes nearest to ``place`` and ``drift`` whose elements have strains and rates that are
    wanted at `strain_places`; the two at the pins stay where they are."""
    c, s = np.cos(place[:, 2:]), np.sin(place[:, 2:])
    tangent, turning = np.hstack([c, s]), drift[:, 2:] * np.hstack([-s, c])
    x, weight = legendre.leggauss(POINTS)
    share = 0.5 * (x + 1.0)
    chord, near, far = (
        6.0 * share * (1.0 - share),
        (1.0 - share) * (1.0 - 3.0 * share),
        (share * (3.0 * share - 2.0)),
    )

    def derivative(places: Array, tangents: Array) -> Array:
        """By the length along an element, (n, POINTS, 2)."""
        ways = np.diff(places, axis=0)[:, None] / element_m * chord[:, None]
        return ways + tangents[:-1, None] * near[:, None] + tangents[1:, None] * far[:, None]

    slope = derivative(place[:, :2], tangent)
    long = np.hypot(slope[..., 0], slope[..., 1])
    along = slope / long[..., None]
    count = len(place) - 1
    by = np.zeros((count, POINTS, 2 * (count + 1)))  # lengths of tangents, then places over h
    for i in range(count):
        first, last = along[i] @ tangent[i], along[i] @ tangent[i + 1]
        by[i, :, i], by[i, :, i + 1] = near * first, far * last
        by[i, :, count + 1 + i], by[i, :, count + 2 + i] = -chord * first, chord * last
    by = np.delete(by, [count + 1, 2 * count + 1], axis=2)  # the pins stay
    root = np.sqrt(weight)[None, :, None]

    def solved(left: Array) -> tuple[Array, Array]:
        """Lengths of tangents, and how far the nodes within go along them [m]."""
        found = np.linalg.lstsq(
            (root * by).reshape(count * POINTS, -1), (root[..., 0] * left).ravel(), rcond=None
        )[0]
        return np.asarray(found[: count + 1]), np.asarray(element_m * found[count + 1 :])

    strain, moved = solved(wanted - (long - 1.0))
    rate = (along * derivative(drift[:, :2], turning)).sum(axis=2)
    strain_rate, sped = solved(wanted_rate - rate)
    place, drift = place.copy(), drift.copy()
    place[1:-1, :2] += moved[:, None] * tangent[1:-1]
    drift[1:-1, :2] += sped[:, None] * tangent[1:-1]
    return CubicNodes(place, drift, strain, strain_rate)
