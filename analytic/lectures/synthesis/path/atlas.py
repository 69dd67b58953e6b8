"""The atlas of coupler curves: which four-bars draw a closed curve like a given one.

It is generated when it is first asked for, from numbers spread evenly over the shapes of four-bars
with a crank and over places in their couplers, and kept while the process lives. Only curves of one
assembly are kept: those of the other one are their mirror images, for which a curve is mirrored.

Source of the idea: J. A. Hrones and G. L. Nelson, Analysis of the Four-Bar Linkage (1951).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache

import numpy as np

from analytic.lectures.synthesis.path.arc_length import at_shares, shares, smooth
from analytic.lectures.synthesis.path.coupler_curve import CouplerCurve, real_size
from analytic.lectures.synthesis.path.descriptors import descriptors, match
from analytic.lectures.synthesis.path.fit import Fitted, placed
from analytic.lectures.synthesis.path.spread import between, spread
from analytic.lectures.synthesis.path.task import UnitPath, refuse_points
from analytic.lectures.synthesis.path.unit_four_bar import (
    BOUNDS,
    FULL,
    Complexes,
    Family,
    direction,
    lengths,
)
from models.array import Array

ENTRIES: dict[Family, int] = {"crank-rocker": 9000, "double-crank": 4000}
LOOKS = 96
"""Crank angles at which a curve of the atlas is drawn."""
REACH = 2.2
"""How far a coupler point is from the middle of the coupler, over its length, at most."""
PLACES = ((0.0, 1.0), (0.0, 1.0))


@dataclass(frozen=True)
class Atlas:
    """Four-bars of one family: the numbers of their shapes (3, E), the coupler points in the
    coupler's frame over the ground (E,), and the descriptors of their curves."""

    family: Family
    x: Array
    arm: Complexes
    descriptors: Complexes


@dataclass(frozen=True)
class Similar:
    """A four-bar of the atlas, put over a curve as well as it fits, and how similar [0 to 1] the
    two curves are in shape."""

    similarity: float
    four_bar: CouplerCurve


@cache
def atlas(family: Family) -> Atlas:
    """The entries of a family: some thousands in a fraction of a second."""
    share = spread(ENTRIES[family], 5, seed=0)
    x = between(share[:, :3], BOUNDS[family])
    arm = arms(lengths(family, x)[1], share[:, 3:])
    return Atlas(family, x, arm, descriptors(curves(family, x, arm)))


def arms(coupler: Array, share: Array) -> Complexes:
    """Coupler points spread over a disc about the middle of the coupler, (E,)."""
    radius = REACH * np.sqrt(share[:, 0])
    return np.asarray(coupler * (0.5 + radius * np.exp(2j * np.pi * share[:, 1])))


def curves(family: Family, x: Array, arm: Complexes, phi: Array | None = None) -> Complexes:
    """The coupler curves of shapes (3, E), on a ground from 0 to 1: over a turn, or at the crank's
    angles [rad], (E, M)."""
    a, b, c = (each[:, None] for each in lengths(family, x))
    angles = np.linspace(0.0, math.tau, LOOKS + 1)[None] if phi is None else phi
    u, _ = direction((a, b, c), angles)
    return np.asarray(a * np.exp(1j * angles) + arm[:, None] * u)


def closed_starts(path: UnitPath, count: int) -> list[Fitted]:
    """The most similar four-bars of the atlas, put over a closed path in either sense of turning
    and in either assembly, the best first."""
    return [fit for _, fit in _ranked(path, count)]


def _ranked(path: UnitPath, count: int) -> list[tuple[float, Fitted]]:
    """The same with their similarity."""
    found: list[tuple[float, Fitted]] = []
    for mirrored in (False, True):
        own = path.mirrored if mirrored else path
        for back in (False, True):
            points = own.points[::-1] if back else own.points
            found += _over(points, count, mirrored=mirrored, back=back)
    found.sort(key=lambda each: -each[0])
    return found[:count]


def _over(
    points: Complexes, count: int, *, mirrored: bool, back: bool
) -> list[tuple[float, Fitted]]:
    """The most similar entries for points drawn forwards, with their similarity."""
    curve, share = smooth(points, closed=True)
    own = descriptors(curve[None])[0]
    found: list[tuple[float, Fitted]] = []
    for family in FULL:
        book = atlas(family)
        matched = match(own, book.descriptors)
        for k in np.argsort(-matched.similarity, kind="stable")[:count].tolist():
            x, arm = book.x[:, k], book.arm[k : k + 1]
            phi = _crank_angles(family, x, arm, share + matched.start[k])
            placing = placed(lengths(family, x), phi, points)
            if back:
                phi = phi[::-1]
            fit = Fitted(family, x, placing, phi, math.inf, mirrored)
            found.append((float(matched.similarity[k]), fit))
    return found


def _crank_angles(family: Family, x: Array, arm: Complexes, share: Array) -> Array:
    """The crank's angles [rad] where shares of an entry's curve are drawn, on through the turns."""
    drawn = shares(curves(family, x[:, None], arm))
    angles = np.linspace(0.0, math.tau, LOOKS + 1)[None]
    turns = np.floor(share)
    within = at_shares(drawn, angles, (share - turns)[None])[0].real
    return np.asarray(within + math.tau * turns)


def similar(points: Sequence[complex], count: int = 10) -> list[Similar]:
    """The four-bars of the atlas whose coupler curves are most like a closed curve, the most
    similar first.

    Parameters
    ----------
    points
        Points of the curve in order [m], as many as there are, the first one listed once.
    count
        How many.

    Raises
    ------
    CrankcheckError
        Points that are no path: fewer than four, or some that coincide with the next one.
    """
    refuse_points(points, closed=True)
    unit, middle, radius = UnitPath.of(np.array(points, dtype=np.complex128))
    return [
        Similar(similarity, real_size(fit)[0].moved(complex(radius), middle))
        for similarity, fit in _ranked(unit, count)
    ]
