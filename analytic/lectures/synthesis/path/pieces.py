"""Pieces of coupler curves: four-bars that draw an open path like a given one.

An open path has no Fourier descriptor. Pieces are compared by places at even shares of their
length, about their middle and over their size: the similarity of two is |sum of conj(z_i) w_i|,
from 0 to 1, which no turn changes.
"""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache

import numpy as np

from analytic.lectures.synthesis.path import atlas
from analytic.lectures.synthesis.path.fit import Fitted, placed
from analytic.lectures.synthesis.path.task import UnitPath
from analytic.lectures.synthesis.path.unit_four_bar import BOUNDS, Complexes, Family, lengths
from models.array import Array

ENTRIES: dict[Family, int] = {"crank-rocker": 60000, "double-crank": 30000, "limited": 40000}
LOOKS = 24
"""Number of crank angles at which a piece is drawn."""
PLACES = 12
"""Number of places at which pieces are compared."""
SPAN = (math.radians(25.0), math.radians(355.0))
"""Span of a crank that turns fully."""
NARROW = math.radians(8.0)
"""Least span of a crank with limits."""


@dataclass(frozen=True)
class Pieces:
    """Pieces of one family: the numbers of shapes (3, E), coupler points (E,) over the ground, the
    crank's angles at both ends (2, E), and places in standard form (E, PLACES)."""

    family: Family
    x: Array
    arm: Complexes
    ends: Array
    places: Complexes


@cache
def pieces(family: Family) -> Pieces:
    """Return the pieces of a family, drawn by growing angles of the crank."""
    share = atlas.spread(ENTRIES[family], 7, seed=0)
    x = atlas.between(share[:, :3], BOUNDS[family])
    arm = atlas.arms(lengths(family, x)[1], share[:, 3:5])
    if family == "limited":
        ends = _within_limits(lengths(family, x), share[:, 5:])
    else:
        start = math.tau * share[:, 5]
        ends = np.array([start, start + SPAN[0] + (SPAN[1] - SPAN[0]) * share[:, 6]])
    wide = ends[1] - ends[0] > NARROW
    x, arm, ends = x[:, wide], arm[wide], ends[:, wide]
    drawn = atlas.curves(family, x, arm, _angles(ends))
    even = np.tile(np.linspace(0.0, 1.0, PLACES), (len(drawn), 1))
    return Pieces(family, x, arm, ends, standard(atlas.at_shares(atlas.shares(drawn), drawn, even)))


def _angles(ends: Array) -> Array:
    """Return angles from end to end, (E, LOOKS)."""
    part = np.linspace(0.0, 1.0, LOOKS)
    return np.asarray(ends[0][:, None] + (ends[1] - ends[0])[:, None] * part)


def _within_limits(shape: tuple[Array, Array, Array], share: Array) -> Array:
    """Return ends of pieces between the limits of cranks, (2, E); two equal ones where none closes.
    A is |1 - a exp(i phi)| from O4, by the cosine of phi, and has to be within |b - c| to b + c."""
    a, b, c = shape
    high, low = (
        np.clip((1.0 + a**2 - far**2) / (2.0 * a), -1.0, 1.0) for far in (np.abs(b - c), b + c)
    )
    first, last = np.arccos(high), np.arccos(low)
    # About phi = 0 and phi = pi the two halves are one arc.
    first, last = np.where(high >= 1.0, -last, first), np.where(low <= -1.0, math.tau - first, last)
    part = np.sort(share, axis=1).T
    one, other = first + (last - first) * (0.01 + 0.98 * part)
    apart = (high < 1.0) & (low > -1.0) & (share[:, 0] > share[:, 1])
    return np.where(apart, np.array([-other, -one]), np.array([one, other]))


def standard(places: Complexes | Array) -> Complexes:
    """Return places (E, W) about their middles, with a sum of squares of 1."""
    own = places - np.mean(places, axis=1, keepdims=True)
    size = np.sqrt(np.sum(np.abs(own) ** 2, axis=1, keepdims=True))
    return np.asarray(own / np.maximum(size, np.finfo(np.float64).tiny))


def open_starts(path: UnitPath, count: int) -> list[Fitted]:
    """Return the most similar pieces, put over an open path in either sense of turning and in
    either assembly, the best first."""
    return [fit for _, fit in atlas.ranked(path, count, _over)]


def _over(points: Complexes, count: int) -> Iterator[tuple[float, Fitted]]:
    curve, share = atlas.smooth(points, closed=False)
    even = np.linspace(0.0, 1.0, PLACES)[None]
    own = standard(atlas.at_shares(atlas.shares(curve[None]), curve[None], even))[0]
    for family in ENTRIES:
        book = pieces(family)
        similarity = np.abs(book.places @ own.conj())
        for k in np.argsort(-similarity, kind="stable")[:count].tolist():
            x, angles = book.x[:, k], _angles(book.ends[:, k : k + 1])
            drawn = atlas.shares(atlas.curves(family, x[:, None], book.arm[k : k + 1], angles))
            phi = np.asarray(atlas.at_shares(drawn, angles, share[None])[0].real)
            placing = placed(lengths(family, x), phi, points)
            yield float(similarity[k]), Fitted(family, x, placing, phi, math.inf)
