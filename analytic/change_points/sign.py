"""The way of one dyad through its change points: the sign of its root, and the motion in them."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from analytic.change_points.smooth import WINDOW, Index, Piece, Rates, Unknown, put
from analytic.dyads.chunk import Chunk
from analytic.dyads.driven import told
from analytic.dyads.parts import Dyad, First, OpenError, Second
from analytic.dyads.plane import EPS, EXACT_ANGLE, STEADY, AngleError
from analytic.dyads.steps import Step
from models.array import Array, Mask
from models.errors import CrankcheckError
from models.scene import Scene

SIDE = 1e-3
"""Where a touch must be closed on both sides, and its root be a V [rad]."""
AT_START = 1e-7
"""A run that starts nearer to a change point than this [rad] is on the branch that it goes to."""
HALVES = tuple(2.0 ** (-0.5 * k) for k in range(21))
"""Half-widths [rad] that are tried for the interpolation through a change point."""
LEAST_CERTAIN = 1e-3
"""The largest bound of a derivative, over its size, with which motion counts as continued."""


@dataclass
class ChangePoints:
    """The change points of one dyad, and the way through them.

    ``angles`` are those of a ``period`` from ``start`` on, an even number: after a period all
    signs are as before. ``steps`` end with the dyad's own; ``before`` are the passages of others.
    """

    scene: Scene
    steps: Sequence[Step]
    before: Mapping[str, ChangePoints]
    start: float
    period: float
    angles: Array
    pieces: dict[int, Piece | None] = field(default_factory=dict)

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
            speed = _rates(chunk, index)
            first = put(first, theta.shape, index, *piece.first.at(x[index] / piece.half, speed))
            second = put(second, theta.shape, index, *piece.second.at(x[index] / piece.half, speed))
            short[index] = np.minimum(short[index], 0.0)
        if not chunk.stretch and np.any(open_ := short > 0.5 * closure.rounding_m):
            raise OpenError(np.where(open_, short, -np.abs(short)))
        sine = np.where(np.isnan(dyad.sine), 0.0, dyad.sine)  # 0/0 where two pins meet
        return Dyad(first, second, sine, replace(closure, short_m=short))

    def is_near(self, theta: Array) -> Mask:
        """Whether driver angles are close to a change point."""
        near = np.zeros(theta.shape, dtype=bool)
        for centre in self.angles:
            near |= np.abs(self._from(float(centre), theta)) < HALVES[0] * WINDOW
        return near

    def _from(self, centre: float, theta: Array) -> Array:
        """Driver angles from one of the change points, within half a period."""
        half = 0.5 * self.period
        return np.asarray(np.remainder(theta - centre + half, self.period) - half)

    def _refuse(self, chunk: Chunk, x: Array) -> None:
        """Refuse samples, at ``x`` from it, in a change point without a smooth motion through it.

        Raises
        ------
        CrankcheckError
            Scene, driver angle and dyad; not where a chunk is only looked at.
        """
        inside = np.abs(x) < SIDE
        if not chunk.stretch and inside.any():
            angle = whole_turns_off(float(chunk.theta[inside][0]))
            raise CrankcheckError(
                f"{self.scene.name}: at {self.scene.driver.joint} {told(self.scene, angle)} the "
                "dyad of "
                f"{self.key} is in a change point with no smooth motion through it that can be "
                "told from others to within rounding; another singular position is too near: "
                "change a length, or keep the driver's range away from there"
            )

    def piece(self, i: int) -> Piece | None:
        """The motion through change point ``i``, worked out once; None where it is not smooth."""
        if i not in self.pieces:
            self.pieces[i] = self._piece(float(self.angles[i]))
        return self.pieces[i]

    @np.errstate(all="ignore")
    def _piece(self, centre: float) -> Piece | None:
        """The widest piece that is about as certain as any; narrower ones lose digits."""
        best, least = None, math.inf
        for half in HALVES:
            try:
                piece = Piece.of(self._solved, centre, half, self.scene.longest_m)
            except OpenError:
                continue
            if piece.doubt < least:
                best, least = piece, piece.doubt
            elif piece.doubt > 4.0 * least and least < LEAST_CERTAIN:
                break
        return best if least < LEAST_CERTAIN else None

    @property
    def key(self) -> str:
        return self.steps[-1].key

    def _solved(self, theta: Array) -> tuple[Unknown, Unknown]:
        """The dyad's unknowns as it stands, for a driver of unit speed."""
        own = _Own(self)
        chunk = Chunk.begin(
            self.scene, theta, 1.0, STEADY, EXACT_ANGLE, passages={**self.before, self.key: own}
        )
        for step in self.steps:
            step.advance(chunk)
        return own.unknowns


class _Own:
    """In place of a passage while its own pieces are made: the dyad as its formulas have it."""

    def __init__(self, passage: ChangePoints) -> None:
        self.sign = passage.sign
        self.unknowns: tuple[Unknown, Unknown]

    def mend(self, _: Chunk, dyad: Dyad[First, Second]) -> Dyad[First, Second]:
        short = dyad.closure.short_m
        assert short is not None
        if np.any(short > 0.5 * dyad.closure.rounding_m):
            raise OpenError(short)
        self.unknowns = dyad.first, dyad.second
        return dyad


def _rates(chunk: Chunk, index: Index) -> Rates:
    """The driver's rates at the samples ``index``; those of a chunk without bounds are exact."""
    theta, error = chunk.theta, chunk.driver.error or EXACT_ANGLE
    each = (chunk.driver.omega, chunk.driver.alpha, error.theta, error.omega, error.alpha)
    omega, alpha, *bounds = (np.broadcast_to(one, theta.shape)[index] for one in each)
    # The distance from the change point is rounded as the angles are.
    bounds[0] = bounds[0] + 4 * EPS * (np.abs(theta[index]) + math.tau)
    return Rates(omega, alpha, AngleError(*bounds))


def whole_turns_off(angle: float) -> float:
    """A driver angle in [0, 2 pi), 0 where it is that but for rounding."""
    turned = angle % math.tau
    return 0.0 if min(turned, math.tau - turned) < AT_START else turned
