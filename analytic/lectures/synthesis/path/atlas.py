"""Atlas of coupler curves and of pieces of them: four-bars whose path is like a given one.

It is generated on first use, from numbers spread evenly over the shapes of four-bars with a crank
and over places in their couplers, and kept while the process lives. Only curves of one assembly are
kept: those of the other one are their mirror images, for which the given curve is mirrored.

Source of the idea: J. A. Hrones and G. L. Nelson, Analysis of the Four-Bar Linkage (1951).

A curve drawn at constant speed is z(s) = sum of c_k exp(2 pi i k s), s its share of the length. A
descriptor is the coefficients c_k of -H..H but for c_0, which is the place, over the root of the
sum of all squares, which is the size. A turn by rho and a start later by sigma make of c_k the
number c_k exp(i rho + 2 pi i k sigma). The similarity of two curves is

    max over sigma of | sum of conj(c_k) d_k exp(2 pi i k sigma) |      from 0 to 1,

which no turn and no start changes. With coefficients normalised one by one to a phase of 0, as in
the sources, a nearly round curve, whose c_-1 is nearly 0, would have a descriptor by chance.

Source: J. R. McGarva and G. Mullineux, Harmonic representation of closed curves, Applied
Mathematical Modelling 17 (1993), pages 213 to 218; I. Ullah and S. Kota, Optimal synthesis of
mechanisms for path generation using Fourier descriptors and global search methods, Journal of
Mechanical Design 119 (1997), pages 504 to 510.

An open path has no Fourier descriptor. Pieces are compared by places at even shares of their
length, about their middle and over their size: the similarity of two is |sum of conj(z_i) w_i|,
from 0 to 1, which no turn changes.
"""

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cache

import numpy as np
from scipy.interpolate import CubicSpline  # type: ignore[import-untyped]  # ships no stubs

from analytic.lectures.synthesis.path.coupler_curve import CouplerCurve, real_size
from analytic.lectures.synthesis.path.fit import Fitted, placed
from analytic.lectures.synthesis.path.task import (
    BOUNDS,
    FULL,
    Complexes,
    Family,
    UnitPath,
    direction,
    lengths,
    refuse_points,
)
from models.array import Array

FINE = 32
"""Number of chords of each piece of a spline, for its length."""


def shares(curves: Complexes) -> Array:
    """Return the share of the whole length drawn at each point of curves (E, M), from 0 to 1."""
    steps = np.abs(np.diff(curves, axis=1))
    total = np.cumsum(steps, axis=1)
    share = np.concatenate([np.zeros((len(curves), 1)), total], axis=1)
    return np.asarray(share / np.maximum(share[:, -1:], np.finfo(np.float64).tiny))


def at_shares(share: Array, values: Complexes | Array, wanted: Array) -> Complexes | Array:
    """Interpolate values (E, M) at their own shares to wanted shares (E, W), each within 0 to 1.
    All rows at once: each is moved by its number, so that they follow each other on one axis."""
    rows = 2.0 * np.arange(len(share))[:, None]
    flat = (share + rows).ravel()
    upper = np.searchsorted(flat, (wanted + rows).ravel(), side="right").reshape(wanted.shape)
    first = np.arange(len(share))[:, None] * share.shape[1]
    upper = np.clip(upper, first + 1, first + share.shape[1] - 1)
    low, high = share.ravel()[upper - 1], share.ravel()[upper]
    part = (wanted - low) / np.maximum(high - low, 1e-300)
    before, after = values.ravel()[upper - 1], values.ravel()[upper]
    between: Complexes | Array = before + part * (after - before)
    return between


def smooth(points: Complexes, closed: bool) -> tuple[Complexes, Array]:
    """Return a fine curve through points, in order, and the shares of its length in them, (N,). It
    is a cubic spline over the length of the chords; a closed curve ends where it starts, and the
    shares are below 1."""
    knots = np.append(points, points[0]) if closed else points
    at = np.concatenate([[0.0], np.cumsum(np.abs(np.diff(knots)))])
    spline = CubicSpline(at, knots, bc_type="periodic" if closed else "not-a-knot")
    inner = np.linspace(0.0, 1.0, FINE, endpoint=False)
    fine = np.append((at[:-1, None] + np.diff(at)[:, None] * inner).ravel(), at[-1])
    curve = spline(fine)
    share = shares(curve[None])[0][::FINE]
    return curve, share[: len(points)]


HARMONICS = 10
"""Coefficients on either side: the rest of a four-bar's coupler curve is below a hundredth."""
SAMPLES = 64
"""Number of places on a curve for its coefficients."""
STARTS = 128
"""Number of starts that are compared."""
ORDERS = np.concatenate([np.arange(1, HARMONICS + 1), np.arange(-HARMONICS, 0)])


@dataclass(frozen=True)
class Match:
    """Match of a curve with each of others: the similarity, (E,), and the start [share of the
    length], (E,), that the curve's own start has on them."""

    similarity: Array
    start: Array


def descriptors(curves: Complexes) -> Complexes:
    """Return the descriptors of closed curves (E, M), last point as the first, (E, 2 HARMONICS)."""
    even = np.tile(np.arange(SAMPLES) / SAMPLES, (len(curves), 1))
    drawn = at_shares(shares(curves), curves, even)
    every = np.fft.fft(drawn, axis=1)
    every[:, 0] = 0.0
    # Over the size of all coefficients, a curve of finer waves than are kept is like none.
    size = np.sqrt(np.sum(np.abs(every) ** 2, axis=1, keepdims=True))
    return np.asarray(every[:, ORDERS] / np.maximum(size, np.finfo(np.float64).tiny))


def match(one: Complexes, others: Complexes) -> Match:
    """Match one descriptor (2 HARMONICS,) with others (E, 2 HARMONICS), over all starts."""
    product = np.zeros((len(others), STARTS), dtype=np.complex64)
    product[:, ORDERS] = one.conj() * others
    # The inverse transform sums the products at all starts at once.
    value = np.abs(np.fft.ifft(product, axis=1)) * STARTS
    best = np.argmax(value, axis=1)
    return Match(np.asarray(value[np.arange(len(others)), best], dtype=np.float64), best / STARTS)


def spread(count: int, dimensions: int, seed: int) -> Array:
    """Return so many points of the unit box, (count, dimensions): multiples of irrational numbers.

    Source: M. Roberts, The unreasonable effectiveness of quasirandom sequences (2018): powers of
    the root of x^(d+1) = x + 1; the seed moves all points by one random vector.
    """
    root = 2.0
    for _ in range(60):
        root = (1.0 + root) ** (1.0 / (dimensions + 1))
    steps = root ** -np.arange(1.0, dimensions + 1.0)
    start = np.random.default_rng(seed).random(dimensions)
    return np.asarray((start + np.arange(1, count + 1)[:, None] * steps) % 1.0)


def between(share: Array, bounds: tuple[tuple[float, float], ...]) -> Array:
    """Return shares of a box (count, d) as numbers within bounds, (d, count)."""
    low, high = np.array(bounds).T[:, :, None]
    return np.asarray(low + (high - low) * share.T)


ENTRIES: dict[Family, int] = {"crank-rocker": 9000, "double-crank": 4000}
LOOKS = 96
"""Number of crank angles at which a curve of the atlas is drawn."""
REACH = 2.2
"""Largest distance of a coupler point from the middle of the coupler, over its length."""


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
    """Four-bar of the atlas, put over a curve as well as it fits, and the similarity [0 to 1] of
    the two curves' shapes."""

    similarity: float
    four_bar: CouplerCurve


@cache
def atlas(family: Family) -> Atlas:
    """Return the entries of a family: some thousands in a fraction of a second."""
    _, x, arm = _drawn(family, ENTRIES[family], 5)
    return Atlas(family, x, arm, descriptors(curves(family, x, arm)))


def _drawn(family: Family, count: int, width: int) -> tuple[Array, Array, Complexes]:
    """Return shares of even spread (E, width), and the shapes (3, E) and coupler points (E,) by the
    first five of them."""
    share = spread(count, width, seed=0)
    x = between(share[:, :3], BOUNDS[family])
    return share, x, arms(lengths(family, x)[1], share[:, 3:5])


def arms(coupler: Array, share: Array) -> Complexes:
    """Return coupler points spread over a disc about the middle of the coupler, (E,)."""
    radius = REACH * np.sqrt(share[:, 0])
    return np.asarray(coupler * (0.5 + radius * np.exp(2j * np.pi * share[:, 1])))


def curves(family: Family, x: Array, arm: Complexes, phi: Array | None = None) -> Complexes:
    """Return the coupler curves of shapes (3, E), on a ground from 0 to 1: over a turn, or at the
    crank's angles [rad], (E, M)."""
    a, b, c = (each[:, None] for each in lengths(family, x))
    angles = np.linspace(0.0, math.tau, LOOKS + 1)[None] if phi is None else phi
    u, _ = direction((a, b, c), angles)
    return np.asarray(a * np.exp(1j * angles) + arm[:, None] * u)


def closed_starts(path: UnitPath, count: int) -> list[Fitted]:
    """Return the most similar four-bars of the atlas, put over a closed path in either sense of
    turning and in either assembly, the best first."""
    return [fit for _, fit in ranked(path, count, _over)]


Over = Callable[[Complexes, int], Iterator[tuple[float, Fitted]]]
"""Function that yields the most similar four-bars for points drawn forwards, so many of each
family, with their similarity."""


def ranked(path: UnitPath, count: int, over: Over) -> list[tuple[float, Fitted]]:
    """Return the most similar four-bars for a path in either sense of turning and in either
    assembly, the best first, with their similarity."""
    found: list[tuple[float, Fitted]] = []
    for mirrored in (False, True):
        points = (path.mirrored if mirrored else path).points
        found += [(same, replace(fit, mirrored=mirrored)) for same, fit in over(points, count)]
        for same, fit in over(points[::-1], count):
            found.append((same, replace(fit, mirrored=mirrored, phi=fit.phi[::-1])))
    found.sort(key=lambda each: -each[0])
    return found[:count]


def _over(points: Complexes, count: int) -> Iterator[tuple[float, Fitted]]:
    curve, share = smooth(points, closed=True)
    own = descriptors(curve[None])[0]
    angles = np.linspace(0.0, math.tau, LOOKS + 1)[None]
    for family in FULL:
        book = atlas(family)
        matched = match(own, book.descriptors)
        for k in np.argsort(-matched.similarity, kind="stable")[:count].tolist():
            x, wanted = book.x[:, k], share + matched.start[k]
            turns = np.floor(wanted)
            drawn = shares(curves(family, x[:, None], book.arm[k : k + 1]))
            within = at_shares(drawn, angles, (wanted - turns)[None])[0].real
            phi = np.asarray(within + math.tau * turns)
            placing = placed(lengths(family, x), phi, points)
            yield float(matched.similarity[k]), Fitted(family, x, placing, phi, math.inf)


def similar(points: Sequence[complex], count: int = 10) -> list[Similar]:
    """Return the four-bars of the atlas whose coupler curves are most like a closed curve, the most
    similar first.

    Parameters
    ----------
    points
        Points of the curve in order [m], any number, the first one listed once.
    count
        Number of four-bars.

    Raises
    ------
    CrankcheckError
        An invalid path: fewer than four points, or some that coincide with the next one.
    """
    refuse_points(points, closed=True)
    unit, middle, radius = UnitPath.of(np.array(points, dtype=np.complex128))
    return [
        Similar(similarity, real_size(fit)[0].moved(complex(radius), middle))
        for similarity, fit in ranked(unit, count, _over)
    ]


PIECES: dict[Family, int] = {"crank-rocker": 60000, "double-crank": 30000, "limited": 40000}
PIECE_LOOKS = 24
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
    share, x, arm = _drawn(family, PIECES[family], 7)
    if family == "limited":
        ends = _within_limits(lengths(family, x), share[:, 5:])
    else:
        start = math.tau * share[:, 5]
        ends = np.array([start, start + SPAN[0] + (SPAN[1] - SPAN[0]) * share[:, 6]])
    wide = ends[1] - ends[0] > NARROW
    x, arm, ends = x[:, wide], arm[wide], ends[:, wide]
    drawn = curves(family, x, arm, _angles(ends))
    even = np.tile(np.linspace(0.0, 1.0, PLACES), (len(drawn), 1))
    return Pieces(family, x, arm, ends, standard(at_shares(shares(drawn), drawn, even)))


def _angles(ends: Array) -> Array:
    """Return angles from end to end, (E, LOOKS)."""
    part = np.linspace(0.0, 1.0, PIECE_LOOKS)
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
    return [fit for _, fit in ranked(path, count, _over_pieces)]


def _over_pieces(points: Complexes, count: int) -> Iterator[tuple[float, Fitted]]:
    curve, share = smooth(points, closed=False)
    even = np.linspace(0.0, 1.0, PLACES)[None]
    own = standard(at_shares(shares(curve[None]), curve[None], even))[0]
    for family in PIECES:
        book = pieces(family)
        similarity = np.abs(book.places @ own.conj())
        for k in np.argsort(-similarity, kind="stable")[:count].tolist():
            x, angles = book.x[:, k], _angles(book.ends[:, k : k + 1])
            drawn = shares(curves(family, x[:, None], book.arm[k : k + 1], angles))
            phi = np.asarray(at_shares(drawn, angles, share[None])[0].real)
            placing = placed(lengths(family, x), phi, points)
            yield float(similarity[k]), Fitted(family, x, placing, phi, math.inf)
