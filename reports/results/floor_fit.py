"""Least squares of a floor and a part C dt^p on the logarithms of errors, without a starting value.

A largest error over a run scatters by a share of itself, so residuals are taken of logarithms.
With y the step over the finest one and a the alignment the curve
(`reports.results.floor_fit`) is written

    error^2 = E^2 ((1 - q)^2 + 2 a (1 - q) q y^p + q^2 y^(2 p))
    floor = E (1 - q),    C = E q / finest^p

so that q, the share that still falls with the step, is 1 without a floor, 0 for an error that no
step changes, and, with full alignment (a = 1), below 0 where the error comes up to its floor. The
best E for given a, p and q is a mean of logarithms; these three are scanned. The best curve of any
alignment needs a scan of p alone: error^2 is linear in the other three numbers.

    error^2 = floor^2 + 2 a floor C dt^p + (C dt^p)^2

Both parts are errors over a whole run. With alignment a = 1 they point the same way everywhere and
error = floor + C dt^p; MuJoCo's soft pins and its first-order step often work against each other
(a < 0), and the error then dips before it rises to its floor.
"""

import itertools
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from models.array import Array


@dataclass(frozen=True)
class ErrorCurve:
    """A curve through points; ``coefficient`` is C [unit / s^order], below 0 for errors that come
    up to the floor.

    ``misfit`` is the sum of squared residuals of ln error, ``points`` and ``parameters`` counts.
    """

    order: float
    floor: float
    coefficient: float
    finest_s: float
    misfit: float
    points: int
    parameters: int
    alignment: float = 1.0

    @property
    def freedom(self) -> int:
        return self.points - self.parameters

    @property
    def scatter(self) -> float:
        """Root mean square residual per degree of freedom, as a share of the error."""
        return math.sqrt(self.misfit / max(self.freedom, 1))

    @property
    def slope(self) -> float:
        """Slope d ln error / d ln dt at the finest step."""
        step = self.coefficient * self.finest_s**self.order
        square = self.at(self.finest_s) ** 2
        return float(self.order * step * (self.alignment * self.floor + step) / square)

    @property
    def rest(self) -> float:
        """Floor as a share of the error at the finest step."""
        return self.floor / self.at(self.finest_s)

    def at(self, dt_s: float) -> float:
        step = self.coefficient * dt_s**self.order
        square = self.floor**2 + 2.0 * self.alignment * self.floor * step + step**2
        return math.sqrt(max(square, 0.0))


@dataclass(frozen=True)
class Allowed:
    """Least and largest order and floor of all curves whose misfit is below a limit."""

    order: tuple[float, float]
    floor: tuple[float, float]


def straight(dt_s: Array, error: Array) -> ErrorCurve:
    """Fit C dt^p, p of any sign, through two points or more (shape (n,))."""
    x, e = np.log(dt_s / dt_s.min()), np.log(error)
    away = x - x.mean()
    order = float(away @ e / (away @ away))
    level = float(e.mean() - order * x.mean())
    misfit = float(np.sum((e - level - order * x) ** 2))
    finest = float(dt_s.min())
    return ErrorCurve(order, 0.0, math.exp(level) / finest**order, finest, misfit, len(e), 2)


def curvature(dt_s: Array, error: Array) -> Array:
    """Return misfits of a straight line and of a parabola in the logarithms, shape (2,).

    One order after another leaves much between the two, and scatter does not.
    """
    x, e = np.log(dt_s / dt_s.min()), np.log(error)
    powers = np.vander(x - x.mean(), 3)
    bases = (powers[:, 1:], powers)
    return np.array([np.sum((e - base @ np.linalg.lstsq(base, e)[0]) ** 2) for base in bases])


STEPS_OF_HALVING = 60
"""Number of halvings of an interval of ln dt: to rounding."""


def reach(
    knots: Sequence[tuple[float, float]],
    target: float,
    error_at: Callable[[float], float | None] = lambda dt_s: None,
) -> float | None:
    """Return the coarsest step at which, and at all finer ones, the error is at most ``target``.

    ``knots`` are (step, error), finest first; the error between two comes from ``error_at``, or
    where that is None from a straight line in the logarithms. None where the finest error is over
    the target already, and where no error is: the step is then outside of the knots.
    """
    pairs = itertools.pairwise(knots)
    rise = next((x for x in pairs if x[0][1] > target or x[1][1] >= target), None)
    if rise is None or rise[0][1] > target:
        return None
    (fine, below), (coarse, above) = rise
    low, high = math.log(fine), math.log(coarse)
    for _ in range(STEPS_OF_HALVING):
        middle = 0.5 * (low + high)
        dt_s = math.exp(middle)
        error = error_at(dt_s)
        if error is None:
            error = interpolate((fine, coarse), (below, above), dt_s) or 0.0
        low, high = (middle, high) if error <= target else (low, middle)
    return math.exp(low)


def interpolate(dt_s: Sequence[float], values: Sequence[float], at_s: float) -> float | None:
    """Interpolate a positive quantity, such as the time per turn, at a step between measured ones.

    A straight line in the logarithms; None outside of the measured steps.
    """
    points = sorted(zip(dt_s, values, strict=True))
    for (fine, first), (coarse, second) in itertools.pairwise(points):
        if fine <= at_s <= coarse:
            if not (first > 0.0 and second > 0.0 and coarse > fine):
                return second if at_s == coarse else first
            part = math.log(at_s / fine) / math.log(coarse / fine)
            return math.exp((1.0 - part) * math.log(first) + part * math.log(second))
    return None


ORDERS = np.linspace(0.3, 5.0, 48)
"""Orders that are tried for an error over a floor."""
OPPOSED_ORDERS = np.linspace(0.5, 3.0, 101)
"""Orders that are tried where floor and step do not point the same way."""
ALIGNMENTS = (*np.linspace(-0.8, 0.8, 9), 1.0)
"""Alignments that are tried for the range of floors."""
NEAR = np.array([-0.1, -0.03, -0.01, -0.003, 0.0, 0.003, 0.01, 0.03, 0.1])
"""Offsets of further alignments about a known one."""
LEAST_SHARE = 1e-9
"""Share below which there is none: an error that falls by nine decades to its floor fits."""
BELOW = -0.3
"""Farthest that the finest error may be below a floor that it rises to, as a share of itself: more
would be a guess about steps that nobody ran."""


def added(dt_s: Array, error: Array) -> ErrorCurve:
    """Fit floor + C dt^p through three points or more (shape (n,))."""
    scan, same = _Scan(dt_s, error), np.ones(1)
    near, width = ORDERS, ORDERS[1] - ORDERS[0]
    for _ in range(4):  # closer and closer around the best order
        units, misfits = scan.best(same, near)
        best = int(np.argmin(misfits[0]))
        order, unit, misfit = float(near[best]), units[:, [best], None], float(misfits[0, best])
        near = np.clip(order + np.linspace(-width, width, 11), ORDERS[0], ORDERS[-1])
        width /= 5.0
    level, _ = scan.fit(same, np.array([order]), unit)
    size, share, finest = math.exp(level.item()), _share(unit).item(), float(dt_s.min())
    coefficient = size * share / finest**order
    return ErrorCurve(order, size * (1.0 - share), coefficient, finest, misfit, len(error), 3)


def opposed(dt_s: Array, error: Array) -> ErrorCurve | None:
    """Fit the curve of any alignment through four points or more (shape (n,)); None without one.

    Residuals are half the relative ones of error^2 = floor^2 + b y^p + c y^(2 p), for a small
    scatter equal to those of the logarithm.
    """
    finest = float(dt_s.min())
    powers = (dt_s / finest) ** OPPOSED_ORDERS[:, None]
    base = np.stack([np.ones_like(powers), powers, powers**2], axis=-1) / error[:, None] ** 2
    size = np.linalg.norm(base, axis=1)
    squares = np.linalg.pinv(base / size[:, None, :]).sum(axis=-1) / size
    misfit = np.sum((np.einsum("kni,ki->kn", base, squares) - 1.0) ** 2, axis=-1) / 4.0
    floor, cross, step = squares.T
    possible = (floor > 0.0) & (step > 0.0) & (cross**2 <= 4.0 * floor * step)
    misfit = np.where(possible, misfit, np.inf)
    best = int(np.argmin(misfit))
    if not possible[best]:
        return None
    order, level, part = float(OPPOSED_ORDERS[best]), math.sqrt(floor[best]), math.sqrt(step[best])
    alignment, coefficient = float(cross[best]) / (2.0 * level * part), part / finest**order
    least = float(misfit[best])
    return ErrorCurve(order, level, coefficient, finest, least, len(error), 4, alignment)


def within(
    dt_s: Array,
    error: Array,
    best: ErrorCurve,
    more: Sequence[float],
    alignments: Sequence[float] = (),
) -> list[Allowed]:
    """Return orders and floors of the curves with at most the misfit of ``best`` and ``more``, for
    each of several; for the alignment of ``best`` alone, or also for others, and all near it."""
    scan, limits = _Scan(dt_s, error), [best.misfit + each for each in more]
    own, orders = best.alignment + NEAR * bool(len(alignments)), np.union1d(ORDERS, [best.order])
    a = np.union1d(alignments, own.clip(-1.0, 1.0))
    for _ in range(3):  # closer and closer around the orders that are allowed
        _, misfit = scan.best(a, orders)
        good = np.flatnonzero(misfit.min(axis=0) <= max(limits))
        if not good.size:
            break
        low, high = max(good[0] - 1, 0), min(good[-1] + 1, len(orders) - 1)
        orders = np.union1d(np.linspace(orders[low], orders[high], 31), [best.order])
    steps = np.geomspace(1e-3, 2.0 * _HIGH, 40)
    units, _ = scan.best(a, orders)
    tried = scan.clipped(a, units[..., None] + np.concatenate([-steps[::-1], [0.0], steps]))
    level, misfit = scan.fit(a, orders, tried)
    rest = 1.0 - _share(tried)
    return [_allowed(best, orders, rest, level, (limit - misfit) / len(error)) for limit in limits]


def _allowed(best: ErrorCurve, orders: Array, rest: Array, level: Array, slack: Array) -> Allowed:
    """Return least and largest order and floor of ``best`` and the curves that leave a ``slack``
    per point; ``rest`` is the share of E that is floor. Shapes (i, k, m)."""
    inside = slack >= 0.0
    order = orders[np.nonzero(inside)[1]]
    level, rest, free = level[inside], rest[inside], np.sqrt(slack[inside])  # of E alone
    return Allowed(
        (float(order.min(initial=best.order)), float(order.max(initial=best.order))),
        (
            float((rest * np.exp(level - free)).min(initial=best.floor)),
            float((rest * np.exp(level + free)).max(initial=best.floor)),
        ),
    )


class _Scan:
    """Level ln E and misfit for alignments (i), orders (k), and scanning units of shares (m)."""

    def __init__(self, dt_s: Array, error: Array) -> None:
        self._x = np.log(dt_s / dt_s.min())[:, None, None, None]
        self._e = np.log(error)[:, None, None, None]

    def fit(self, alignments: Array, orders: Array, units: Array) -> tuple[Array, Array]:
        """Return levels and misfits, shape (i, k, m); infinite where no error would be positive."""
        rise, share = np.expm1(orders[:, None] * self._x), _share(units)
        curve = share * rise
        square = curve * (2.0 + curve)
        if np.any(alignments != 1.0):
            lost = 2.0 * (1.0 - alignments[:, None, None]) * (1.0 - share) * share
            square -= lost * (1.0 + rise)
        bad = (square <= -1.0) | (curve <= -1.0)
        rest = self._e - 0.5 * np.log1p(np.where(bad, 0.0, square))
        level = rest.mean(axis=0)
        misfit = np.sum((rest - level) ** 2, axis=0)
        return level, np.where(bad.any(axis=0), np.inf, misfit)

    def best(self, alignments: Array, orders: Array) -> tuple[Array, Array]:
        """Return units of least misfit per alignment and order, with the misfit, shape (i, k)."""
        middle = np.full((len(alignments), len(orders)), 0.5 * (_LOW + _HIGH))
        width = 0.5 * (_HIGH - _LOW)
        for number in (41, *[11] * 4):
            tried = self.clipped(alignments, middle[..., None] + np.linspace(-width, width, number))
            _, misfit = self.fit(alignments, orders, tried)
            at = misfit.argmin(axis=-1)[..., None]
            middle = np.take_along_axis(tried, at, axis=-1)[..., 0]
            width = 2.0 * width / (number - 1)
        return middle, np.take_along_axis(misfit, at, axis=-1)[..., 0]

    def clipped(self, alignments: Array, units: Array) -> Array:
        """Clip units to their range: shares below 0 with full alignment only."""
        low = np.where(alignments == 1.0, _LOW, 0.0)[:, None, None]
        return np.asarray(np.clip(units, low, _HIGH))


def _share(units: Array) -> Array:
    """Return the share q of scanning units: evenly spaced in ln |q| on both sides of 0."""
    return np.asarray(LEAST_SHARE * np.sinh(units))


_LOW, _HIGH = math.asinh(BELOW / LEAST_SHARE), math.asinh(1.0 / LEAST_SHARE)
