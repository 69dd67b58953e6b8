"""A limit of the driver's angle, and the motion of the mechanism through it.

::

    x |    ___          x of a link over the driver's angle phi: at the limit phi* the driver turns
      |        \\        back, and the dyad passes from one assembly into the other
      |         |
      |     ___/        phi = phi* - side u^2      u > 0: the one assembly, u < 0: the other
      +---------|---
              phi*      over u everything is smooth, and x has a rate

The root of the dyad, which is 0 there, is the difference of nearly the same numbers beside it; it
is taken as u times its quotient by u, a smooth function. In u = 0 the formulas of the dyad give
0/0: there its unknowns are interpolated from both sides, as in a change point
(`analytic.change_points.sign`). Source: limit positions, e.g. Norton, Design of Machinery, section
4.10; u is the local coordinate of a fold.
"""

import math
from dataclasses import dataclass, replace
from functools import cached_property
from typing import ClassVar

import numpy as np
from numpy.polynomial import chebyshev

from analytic.change_points.sign import HALVES, Index, Rates, SignPiece, Unknown, put, widest
from analytic.dyads.chunk import Chunk
from analytic.dyads.parts import Dyad, First, OpenError, Second
from analytic.dyads.plane import EPS, EXACT_ANGLE, AngleError
from analytic.prepared import prepared
from models.array import Array
from models.errors import CrankcheckError, ReachError
from models.scene import Scene

REACH, AHEADS = 0.8, (0.1, 0.01, 1e-3, 0.0)
"""Share of a range that counts from its limit, and shares looked at beyond it: smaller ones where
an earlier dyad is open, and the square is not smooth."""
COUNTS = (24, 32, 48, 64, 96, 128, 192, 256)
SMOOTH, ROUNDED, ROUGH = 1e-14, 2e-13, 1e-9
"""Ends of a series over its largest coefficient: wanted, left by rounding, and too large for a
smooth square."""


@dataclass(frozen=True, eq=False)
class LimitPosition:
    """Limit ``driver_rad`` of the driver in the assembly of ``scene``, in which the dyad ``dyad``
    is stretched or folded. ``side`` is 1 where the driver's range, of ``length_rad``, ends there,
    -1 where it begins."""

    scene: Scene
    driver_rad: float
    side: int
    dyad: str
    length_rad: float

    def coordinate(self, driver_rad: float) -> float:
        """Return u of the assembly of the scene at a driver angle within its range."""
        return math.sqrt(max(0.0, self.side * (self.driver_rad - driver_rad)))

    def chunk(self, u: Array, rates: Rates, *, bound: bool) -> Chunk:
        """Return the mechanism at coordinates u (T,) with rates and errors of u. Raises
        ReachError."""
        theta = self.driver_rad - self.side * u * u
        first, second = -2.0 * self.side * u, -2.0 * self.side
        omega = first * rates.omega
        alpha = second * rates.omega**2 + first * rates.alpha
        error = self._driver_error(u, theta, rates) if bound else None
        passing, roots = {self.dyad: _Passing(self, u, rates)}, {self.dyad: self.root(u)}
        return prepared(self.scene).chunk(theta, omega, alpha, error, passing, roots)

    def root(self, u: Array) -> Array:
        """Return the root of the dyad at coordinates (T,), without its sign."""
        low, series = self._quotient
        high = REACH * self.length_rad
        square = chebyshev.chebval((2.0 * u * u - low - high) / (high - low), series)
        return np.asarray(np.abs(u) * np.sqrt(np.maximum(square, 0.0)))

    @cached_property
    def _quotient(self) -> tuple[float, Array]:
        """Square of the root over u^2, in Chebyshev's polynomials of u^2 from ``low``, a little
        before the limit, where the dyad is open, to `REACH` of the range. Raises CrankcheckError
        where the square is not smooth."""
        best, least, high = (0.0, np.zeros(1)), math.inf, REACH * self.length_rad
        for low in (-ahead * self.length_rad for ahead in AHEADS):
            for count in COUNTS:
                series = self._square(low, high, count)
                left = float(np.abs(series[-2:]).max() / np.abs(series).max())
                if left < least:
                    best, least = (low, series), left
                if left <= SMOOTH:
                    break
            if least <= ROUNDED:
                break
        if not least <= ROUGH:
            raise self._unclear()
        low, series = best
        return low, _over_argument(_trimmed(series), low, high)

    def _square(self, low: float, high: float, count: int) -> Array:
        """Return the series of the square of the root, of ``count`` polynomials of u^2."""
        x = chebyshev.chebpts1(count)
        w = 0.5 * (low + high) + 0.5 * (high - low) * x
        closure = prepared(self.scene).stretched(self.driver_rad - self.side * w).closures
        square = np.asarray(closure[self.dyad].square)
        series = chebyshev.chebvander(x, count - 1).T @ square * (2.0 / count)
        series[0] *= 0.5
        return np.asarray(series)

    def _driver_error(self, u: Array, theta: Array, rates: Rates) -> AngleError:
        """Return the errors of the driver from those of u and its rates, ``rates.error``."""
        e, v, a = rates.error, np.abs(rates.omega), np.abs(rates.alpha)
        far = np.abs(u) + e.theta
        return AngleError(
            2.0 * far * e.theta + 2 * EPS * (np.abs(theta) + abs(self.driver_rad)),
            2.0 * (far * e.omega + v * e.theta) + 4 * EPS * far * v,
            2.0 * ((2.0 * v + e.omega) * e.omega + far * e.alpha + a * e.theta)
            + 4 * EPS * (v * v + far * a),
        )

    @cached_property
    def piece(self) -> SignPiece:
        """Unknowns of the dyad about the limit, over u. Raises CrankcheckError where they are not
        smooth to within rounding."""
        size_m, beyond = self.scene.longest_m, (OpenError, ReachError)
        found = widest(HALVES, lambda half: SignPiece.of(self._solved, 0.0, half, size_m), beyond)
        if found is None:
            raise self._unclear()
        return found

    def _unclear(self) -> CrankcheckError:
        return CrankcheckError(
            f"{self.scene.name}: {self.scene.driver.link} reaches its limit at "
            f"{math.degrees(self.driver_rad):.6g} deg, where the smooth way of the dyad of "
            f"{self.dyad} into its other assembly cannot be distinguished from others within "
            "rounding; another singular position is too near: change a length"
        )

    def _solved(self, u: Array) -> tuple[Unknown, Unknown]:
        """Return the unknowns of the dyad in its branch, per unit of the rate of u."""
        theta = self.driver_rad - self.side * u * u
        alpha = np.full_like(u, -2.0 * self.side)
        bare = _Bare(u)
        passing, roots = {self.dyad: bare}, {self.dyad: self.root(u)}
        omega = -2.0 * self.side * u
        prepared(self.scene).chunk(theta, omega, alpha, EXACT_ANGLE, passing, roots)
        return bare.unknowns


def _trimmed(series: Array) -> Array:
    """Return the series without its end of rounding."""
    large = np.flatnonzero(np.abs(series) > 2e-15 * np.abs(series).max())
    return series[: int(large[-1]) + 3]


def _over_argument(series: Array, low: float, high: float) -> Array:
    """Return Chebyshev's series of (p(w) - p(0)) / w, from that of p(w) over [low, high]."""
    centre, half = 0.5 * (low + high), 0.5 * (high - low)
    count = len(series) - 1
    # w T_k = centre T_k + half (T_(k - 1) + T_(k + 1)) / 2, whose sum has to be p but for p(0).
    table = np.zeros((count + 1, count))
    for k in range(count):
        table[k, k] += centre
        table[abs(k - 1), k] += 0.5 * half
        table[k + 1, k] += 0.5 * half
    rest = series.copy()
    rest[0] -= chebyshev.chebval(-centre / half, series)
    return np.asarray(np.linalg.lstsq(table, rest, rcond=None)[0])


class _Bare:
    """Substitute of a passage while its piece is made: the dyad from its formulas."""

    period = math.tau  # of the mechanism on one side of it

    def __init__(self, u: Array) -> None:
        self.u = u
        self.unknowns: tuple[Unknown, Unknown]

    def sign(self, _: Array) -> Array:
        return np.where(self.u < 0.0, -1.0, 1.0)

    def mend(self, _: Chunk, dyad: Dyad[First, Second]) -> Dyad[First, Second]:
        short = dyad.closure.short_m
        assert short is not None
        if np.any(short > 0.5 * dyad.closure.rounding_m):
            raise OpenError(np.broadcast_to(short, self.u.shape))
        self.unknowns = dyad.first, dyad.second
        return dyad


@dataclass
class _Passing:
    """Passage of a dyad through a limit at coordinates ``u`` (T,)."""

    limit: LimitPosition
    u: Array
    rates: Rates
    period: ClassVar[float] = math.tau  # of the mechanism on one side of it

    def sign(self, _: Array) -> Array:
        return np.where(self.u < 0.0, -1.0, 1.0)

    def mend(self, chunk: Chunk, dyad: Dyad[First, Second]) -> Dyad[First, Second]:
        limit, closure = self.limit, dyad.closure
        assert closure.short_m is not None
        short = np.broadcast_to(closure.short_m, self.u.shape)
        # Beside the limit it closes, up to rounding; beyond its reach the root is not known. The
        # square of a root may be larger than its argument.
        beside = self.u * self.u <= REACH * limit.length_rad * (1.0 + 4.0 * EPS)
        if not beside.all():
            raise OpenError(np.where(beside, -np.abs(short), np.abs(short)))
        short = np.minimum(short, 0.0)
        first, second = dyad.first, dyad.second
        index = np.flatnonzero(np.abs(self.u) < limit.piece.window)
        if index.size:
            rates, x = self._at(index), self.u[index] / limit.piece.half
            first = put(first, self.u.shape, index, *limit.piece.first.at(x, rates))
            second = put(second, self.u.shape, index, *limit.piece.second.at(x, rates))
        sine = np.where(np.isnan(dyad.sine), 0.0, dyad.sine)
        return Dyad(first, second, sine, replace(closure, short_m=short))

    def _at(self, index: Index) -> Rates:
        e = self.rates.error
        each = (self.rates.omega, self.rates.alpha, e.theta, e.omega, e.alpha)
        omega, alpha, *bounds = (np.broadcast_to(one, self.u.shape)[index] for one in each)
        return Rates(omega, alpha, AngleError(*bounds))
