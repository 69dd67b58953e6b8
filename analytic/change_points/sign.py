"""Motion of one dyad through its change points: the sign of its root, and the unknowns there.

::

            . o  o   o     o       q, q', q'' of an unknown of the dyad at Chebyshev nodes, q by the
        o o                        driver's angle; none of them is in the change point, and all
    o       |  window  |           lie on the branch that passes it smoothly
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from analytic.dyads.chunk import Chunk, DrivenCoordinate, told
from analytic.dyads.parts import Dyad, First, OpenError, Second, SlideError, Sliding, Turning
from analytic.dyads.plane import EPS, EXACT_ANGLE, STEADY, AngleError, Real, Vec
from analytic.dyads.steps import Step
from models.array import Array, Mask
from models.errors import CrankcheckError
from models.scene import Scene

COUNT, FEWER = 24, 20
"""Nodes of an interpolation, and of the compared one; even, so that none is central."""
PROBES = np.linspace(-1.0, 1.0, 32)
SAFETY = 2.0

Index = NDArray[np.intp]
Unknown = Turning | Sliding
Series = tuple[Array, ...]
Solved = Callable[[Array], tuple[Unknown, Unknown]]
"""Two unknowns of a dyad at driver angles, per unit speed of the driver, with bounds."""


def nodes(count: int) -> Array:
    """Return Chebyshev nodes of the first kind in (-1, 1), increasing."""
    return np.asarray(-np.cos((2 * np.arange(count) + 1) * (np.pi / (2 * count))))


WINDOW = 0.99 * float(nodes(COUNT)[COUNT // 2])
"""Half of the gap in the middle of the nodes, or hardly less, over half their range."""


def weights(count: int, x: Array) -> Array:
    """Return weights of the nodes' values for the value at places ``x``, none of them a node."""
    places = np.arange(count)
    one = (-1.0) ** places * np.sin((2 * places + 1) * (np.pi / (2 * count)))
    terms = one / (x[:, None] - nodes(count))
    return np.asarray(terms / terms.sum(axis=1, keepdims=True))


@dataclass(frozen=True)
class Interpolant:
    """Unknown with its first two derivatives by the driver's angle.

    ``values`` and ``bounds`` belong to the nodes, (3, n); ``doubt`` is the error of interpolation,
    (3,), and ``third`` bounds the third derivative in the window.
    """

    values: Array
    bounds: Array
    doubt: Array
    third: float

    @staticmethod
    def of(
        fine: tuple[Array, Array], coarse: tuple[Array, Array], half: float, *, turning: bool
    ) -> Interpolant:
        """Make the series of some nodes, compared with others; angles up to whole turns."""
        values, bounds = fine
        at = PROBES * WINDOW
        seen = values @ weights(COUNT, at).T
        apart = seen - coarse[0] @ weights(FEWER, at).T
        if turning:
            apart[0] -= 2.0 * np.pi * np.round(apart[0] / (2.0 * np.pi))
        doubt = np.abs(apart).max(axis=1)
        doubt = SAFETY * doubt + COUNT * EPS * np.abs(values).max(axis=1)
        third = np.abs(np.diff(seen[2])).max() / (half * WINDOW * float(PROBES[1] - PROBES[0]))
        return Interpolant(
            values, bounds, doubt, SAFETY * float(third + doubt[2] / (half * WINDOW))
        )

    def worst(self) -> Array:
        """Return the largest bounds in the window, (3,)."""
        share = np.abs(weights(COUNT, PROBES * WINDOW))
        return np.asarray((self.bounds @ share.T).max(axis=1) + self.doubt)

    def at(self, x: Array, speed: Rates) -> tuple[tuple[Array, ...], tuple[Array, ...]]:
        """Return the unknown, its rate and acceleration, and their bounds, at places in (-1, 1)."""
        share = weights(COUNT, x)
        q, q1, q2 = self.values @ share.T
        b, b1, b2 = self.bounds @ np.abs(share).T + self.doubt[:, None]
        w, g, e = np.abs(speed.omega), np.abs(speed.alpha), speed.error
        # The driver's angle is uncertain too: over e.theta each derivative changes by the next.
        s1, s2 = np.abs(q1) + b1, np.abs(q2) + b2
        b, b1, b2 = b + s1 * e.theta, b1 + s2 * e.theta, b2 + self.third * e.theta
        rate = (w + e.omega) * b1 + s1 * e.omega
        second = (g + e.alpha) * b1 + s1 * e.alpha + (w + e.omega) ** 2 * b2
        second = second + s2 * e.omega * (2.0 * w + e.omega)
        found = q, q1 * speed.omega, q1 * speed.alpha + q2 * speed.omega**2
        sizes = 1.0 + np.abs(q), s1 * w, s2 * w**2 + s1 * g
        bounds = (b, rate, second)
        return found, tuple(e + 4 * EPS * k for e, k in zip(bounds, sizes, strict=True))


@dataclass(frozen=True)
class Rates:
    """Driver's rate and acceleration at some samples, with the bounds of all three levels."""

    omega: Array
    alpha: Array
    error: AngleError


@dataclass(frozen=True)
class SmoothPiece:
    """Motion around a change point.

    ``half`` is half the range of the nodes; ``doubt`` is the largest bound of a derivative by the
    driver's angle over that derivative, or over 1 and the length that weighs places.
    """

    half: float
    doubt: float

    @property
    def window(self) -> float:
        """Distance from the change point up to which it is used [rad]."""
        return self.half * WINDOW


@dataclass(frozen=True)
class SignPiece(SmoothPiece):
    """Two unknowns of a dyad around a change point.

    On that branch the unknowns are analytic functions of the driver's angle, also where the
    formulas of the dyad give 0/0. Source of the interpolation and of its stability: J.-P. Berrut
    and L. N. Trefethen, Barycentric Lagrange interpolation, SIAM Review 46 (2004), section 5 and 7.
    """

    first: Interpolant
    second: Interpolant

    @staticmethod
    def of(solved: Solved, centre: float, half: float, longest_m: float) -> SignPiece:
        """Make the piece around driver angle ``centre``. Raises OpenError at nodes out of reach."""
        wide, narrow = centre + half * nodes(COUNT), centre + half * nodes(FEWER)
        series: list[Interpolant] = []
        doubt = 0.0
        for fine, coarse in zip(solved(wide), solved(narrow), strict=True):
            turning = isinstance(fine, Turning)
            found = Interpolant.of(
                _levels(fine, wide), _levels(coarse, narrow), half, turning=turning
            )
            sizes = np.abs(found.values).max(axis=1) + (1.0 if turning else longest_m)
            doubt = max(doubt, float((found.worst() / sizes)[1:].max()))
            series.append(found)
        return SignPiece(half, doubt, series[0], series[1])


def _levels(found: Unknown, theta: Array) -> tuple[Array, Array]:
    """Return values and bounds of an unknown at the nodes, each (3, n); angles without jumps."""
    assert found.error is not None
    if isinstance(found, Sliding):
        rows = [found.s, found.speed, found.acceleration, *found.error]
    else:
        angle = np.arctan2(found.turn.y, found.turn.x)
        # Whole turns beyond the rate at both ends of a step are jumps.
        step = np.diff(angle) - 0.5 * np.diff(theta) * (found.omega[1:] + found.omega[:-1])
        angle[1:] -= np.cumsum(np.round(step / (2.0 * np.pi))) * (2.0 * np.pi)
        turn = found.error.theta + 2 * EPS * (np.abs(angle) + np.pi)
        rows = [angle, found.omega, found.alpha, turn, found.error.omega, found.error.alpha]
    table = np.stack([np.broadcast_to(row, theta.shape) for row in rows])
    return table[:3], table[3:]


def into(shape: tuple[int, ...], index: Index) -> Callable[[Real, Array], Array]:
    """Return the function that puts new values of a series at the samples ``index``."""

    def put_in(old: Real, new: Array) -> Array:
        array = np.array(np.broadcast_to(old, shape))
        array[index] = new
        return array

    return put_in


def put(
    unknown: First, shape: tuple[int, ...], index: Index, values: Series, bounds: Series
) -> First:
    """Return an unknown over all samples, with new values and bounds at those of ``index``."""
    new = into(shape, index)
    if isinstance(unknown, Sliding):
        s, speed, acceleration = map(new, (unknown.s, unknown.speed, unknown.acceleration), values)
        e = unknown.error
        e = None if e is None else SlideError(*map(new, e, bounds))
        return Sliding(s, speed, acceleration, e)
    angle, length, error = values[0], unknown.length, unknown.error
    x = new(unknown.turn.x, length * np.cos(angle))
    y = new(unknown.turn.y, length * np.sin(angle))
    omega, alpha = map(new, (unknown.omega, unknown.alpha), values[1:])
    error = None if error is None else AngleError(*map(new, error, bounds))
    return Turning(Vec(x, y), omega, alpha, error, length)


SIDE = 1e-3
"""Distance from a touch [rad] where the dyad must close on both sides, and its root be a V."""
AT_START = 1e-7
"""Distance [rad] of a start from a change point, below which it is on the branch ahead."""
HALVES = tuple(2.0 ** (-0.5 * k) for k in range(21))
"""Half-widths [rad] tried for the interpolation through a change point."""
LEAST_CERTAIN = 1e-3
"""Largest bound of a derivative, over its size, of a motion that counts as continued."""


Piece = TypeVar("Piece", bound=SmoothPiece)


@np.errstate(all="ignore")
def widest(
    halves: Iterable[float],
    made: Callable[[float], Piece],
    beyond: tuple[type[Exception], ...] = (OpenError,),
) -> Piece | None:
    """Return the widest piece that is about as certain as any, as narrower ones lose digits; None
    where the motion is not certainly smooth. Half-widths [rad] out of reach, for which
    making a piece raises ``beyond``, are left out."""
    best, least = None, math.inf
    for half in halves:
        try:
            piece = made(half)
        except beyond:
            continue
        if piece.doubt < least:
            best, least = piece, piece.doubt
        elif piece.doubt > 4.0 * least and least < LEAST_CERTAIN:
            break
    return best if least < LEAST_CERTAIN else None


@dataclass
class ChangePoints:
    """Change points of one dyad, and the motion through them.

    ``angles`` cover a ``period`` from ``start`` on, an even number: after a period all signs are as
    before. ``steps`` end with the dyad's own; ``before`` are the passages of others.
    """

    scene: Scene
    steps: Sequence[Step]
    before: Mapping[str, ChangePoints]
    start: float
    period: float
    angles: Array
    pieces: dict[int, SignPiece | None] = field(default_factory=dict)

    def sign(self, theta: Array) -> Array:
        phase = np.remainder(theta - self.start, self.period)
        return np.asarray(1.0 - 2.0 * (np.searchsorted(self.angles - self.start, phase) % 2))

    def mend(self, chunk: Chunk, dyad: Dyad[First, Second]) -> Dyad[First, Second]:
        theta, closure = chunk.theta, dyad.closure
        assert closure.short_m is not None
        short = np.array(np.broadcast_to(closure.short_m, theta.shape))
        first, second = dyad.first, dyad.second
        for i, centre in enumerate(self.angles):
            x = self._from(float(centre), theta)
            if not (np.abs(x) < HALVES[0] * WINDOW).any():
                continue
            piece = self.piece(i)
            if piece is None:
                self._refuse(chunk, x)
                continue
            index = np.flatnonzero(np.abs(x) < piece.window)
            speed = rates_at(chunk.driver, index)
            first = put(first, theta.shape, index, *piece.first.at(x[index] / piece.half, speed))
            second = put(second, theta.shape, index, *piece.second.at(x[index] / piece.half, speed))
            short[index] = np.minimum(short[index], 0.0)
        if not chunk.stretch and np.any(open_ := short > 0.5 * closure.rounding_m):
            raise OpenError(np.where(open_, short, -np.abs(short)))
        sine = np.where(np.isnan(dyad.sine), 0.0, dyad.sine)  # 0/0 where two pins meet
        return Dyad(first, second, sine, replace(closure, short_m=short))

    def is_near(self, theta: Array) -> Mask:
        """Return the mask of driver angles that are close to a change point."""
        near = np.zeros(theta.shape, dtype=bool)
        for centre in self.angles:
            near |= np.abs(self._from(float(centre), theta)) < HALVES[0] * WINDOW
        return near

    def _from(self, centre: float, theta: Array) -> Array:
        """Return driver angles from one of the change points, within half a period."""
        half = 0.5 * self.period
        return np.asarray(np.remainder(theta - centre + half, self.period) - half)

    def _refuse(self, chunk: Chunk, x: Array) -> None:
        """Refuse samples, at ``x`` from it, in a change point without a smooth motion through it,
        by a CrankcheckError; let those of a stretched chunk pass."""
        inside = np.abs(x) < SIDE
        if not chunk.stretch and inside.any():
            angle = whole_turns_off(float(chunk.theta[inside][0]))
            raise CrankcheckError(
                f"{self.scene.name}: at {self.scene.driver.joint} {told(self.scene, angle)} the "
                f"dyad of {self.key} is in a change point whose smooth motion cannot be "
                "distinguished from others within rounding; another singular position is too near: "
                "change a length, or keep the driver's range away from there"
            )

    def piece(self, i: int) -> SignPiece | None:
        """Return the motion through change point ``i``, computed once; None if not smooth."""
        if i not in self.pieces:
            centre, size_m = float(self.angles[i]), self.scene.longest_m
            self.pieces[i] = widest(
                HALVES, lambda half: SignPiece.of(self._solved, centre, half, size_m)
            )
        return self.pieces[i]

    @property
    def key(self) -> str:
        return self.steps[-1].key

    def _solved(self, theta: Array) -> tuple[Unknown, Unknown]:
        """Return the dyad's unknowns in its branch, for a driver of unit speed."""
        own = _Own(self)
        chunk = Chunk.begin(
            self.scene, theta, 1.0, STEADY, EXACT_ANGLE, passages={**self.before, self.key: own}
        )
        for step in self.steps:
            step.advance(chunk)
        return own.unknowns


class _Own:
    """Substitute of a passage while its own pieces are made: the dyad from its formulas."""

    def __init__(self, passage: ChangePoints) -> None:
        self.sign, self.period = passage.sign, passage.period
        self.unknowns: tuple[Unknown, Unknown]

    def mend(self, _: Chunk, dyad: Dyad[First, Second]) -> Dyad[First, Second]:
        short = dyad.closure.short_m
        assert short is not None
        if np.any(short > 0.5 * dyad.closure.rounding_m):
            raise OpenError(short)
        self.unknowns = dyad.first, dyad.second
        return dyad


def rates_at(driver: DrivenCoordinate, index: Index) -> Rates:
    """Return the driver's rates at the samples ``index``; exact for a driver without bounds."""
    theta, each = driver.theta, (driver.omega, driver.alpha, *(driver.error or EXACT_ANGLE))
    omega, alpha, *bounds = (np.broadcast_to(one, theta.shape)[index] for one in each)
    # The distance from the change point is rounded as the angles are.
    bounds[0] = bounds[0] + 4 * EPS * (np.abs(theta[index]) + math.tau)
    return Rates(omega, alpha, AngleError(*bounds))


def whole_turns_off(angle: float) -> float:
    """Return a driver angle in [0, 2 pi), 0 where it is that up to rounding."""
    turned = angle % math.tau
    return 0.0 if min(turned, math.tau - turned) < AT_START else turned
