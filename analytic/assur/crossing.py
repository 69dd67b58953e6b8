"""The central link in and beside a change point of its group, where the rows give 0/0.

As at the change points of dyads, the smooth motion is an analytic function of the driver's angle,
and interpolated from both sides (`analytic.change_points.sign`).
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from analytic.change_points.sign import (
    COUNT,
    FEWER,
    HALVES,
    LEAST_CERTAIN,
    WINDOW,
    Index,
    Interpolant,
    Rates,
    nodes,
)
from analytic.dyads.chunk import DrivenCoordinate
from analytic.dyads.plane import (
    EPS,
    EXACT_ANGLE,
    AngleError,
    BodyKinematics,
    PointError,
    PointKinematics,
    Real,
    Vec,
)
from models.array import Array, Mask

Solved = Callable[[Array], BodyKinematics]
"""Central link at driver angles [rad], per unit speed of the driver, with bounds."""


@dataclass(frozen=True)
class CrossingPiece:
    """Place and angle of the link as functions of the driver's angle, about ``centre`` [rad]."""

    centre: float
    half: float
    series: tuple[Interpolant, Interpolant, Interpolant]
    doubt: float

    @staticmethod
    def about(solved: Solved, centre: float, room: float, size_m: float) -> CrossingPiece | None:
        """Return the widest that is about as certain as any, within ``room`` [rad]; None where the
        motion is not certainly smooth."""
        best: CrossingPiece | None = None
        for half in HALVES:
            if half > room:
                continue
            piece = _piece(solved, centre, half, size_m)
            if best is None or not piece.doubt >= best.doubt:
                best = piece
            elif piece.doubt > 4.0 * best.doubt and best.doubt < LEAST_CERTAIN:
                break
        return best if best is not None and best.doubt < LEAST_CERTAIN else None

    def near(self, from_centre: Array) -> Mask:
        """Return the mask of driver angles, from the centre, at which it is used."""
        return np.asarray(np.abs(from_centre) < self.half * WINDOW)

    def put(
        self, body: BodyKinematics, from_centre: Array, driver: DrivenCoordinate
    ) -> BodyKinematics:
        """Return the link with its lost values about the change point restored."""
        index = np.flatnonzero(self.near(from_centre))
        if not index.size:
            return body
        shape = from_centre.shape
        rates = _rates(driver, index, shape)
        found = [one.at(from_centre[index] / self.half, rates) for one in self.series]
        (x, y, angle), errors = ([each[k] for each in found] for k in (0, 1))

        def into(old: Real, new: Array) -> Array:
            array = np.array(np.broadcast_to(old, shape))
            array[index] = new
            return array

        at = body.anchor
        p, v, a = (
            Vec(into(old.x, x[k]), into(old.y, y[k])) for k, old in enumerate((at.p, at.v, at.a))
        )
        turn = Vec(into(body.turn.x, np.cos(angle[0])), into(body.turn.y, np.sin(angle[0])))
        anchor = PointKinematics(p, v, a, at.error)
        body = replace(
            body, turn=turn, omega=into(body.omega, angle[1]), alpha=into(body.alpha, angle[2])
        )
        if body.error is None or at.error is None:
            return replace(body, anchor=anchor)
        place, e = at.error, body.error
        levels = zip((place.position, place.velocity, place.acceleration), range(3), strict=True)
        point = [into(old, np.hypot(errors[0][k], errors[1][k])) for old, k in levels]
        turned = [into(old, errors[2][k]) for k, old in enumerate((e.theta, e.omega, e.alpha))]
        anchor = replace(anchor, error=PointError(*point))
        return replace(body, anchor=anchor, error=AngleError(*turned))


@np.errstate(all="ignore")
def _piece(solved: Solved, centre: float, half: float, size_m: float) -> CrossingPiece:
    wide, narrow = centre + half * nodes(COUNT), centre + half * nodes(FEWER)
    fine, coarse = _levels(solved(wide), wide), _levels(solved(narrow), narrow)
    series = [
        Interpolant.of(one, other, half, turning=k == 2)
        for k, (one, other) in enumerate(zip(fine, coarse, strict=True))
    ]
    doubts = [
        one.worst() / (np.abs(one.values).max(axis=1) + (1.0 if k == 2 else size_m))
        for k, one in enumerate(series)
    ]
    doubt = float(np.nan_to_num(np.max(doubts), nan=math.inf))
    return CrossingPiece(centre, half, (series[0], series[1], series[2]), doubt)


def _levels(body: BodyKinematics, theta: Array) -> list[tuple[Array, Array]]:
    """Return place and angle at the nodes, with two derivatives, and their bounds, each (3, n)."""
    assert body.error is not None
    assert body.anchor.error is not None
    at, e, own = body.anchor, body.anchor.error, body.error
    angle = np.unwrap(np.arctan2(body.turn.y, body.turn.x))
    turned = own.theta + 2 * EPS * (np.abs(angle) + math.pi)
    rows = (
        ((at.p.x, at.v.x, at.a.x), (e.position, e.velocity, e.acceleration)),
        ((at.p.y, at.v.y, at.a.y), (e.position, e.velocity, e.acceleration)),
        ((angle, body.omega, body.alpha), (turned, own.omega, own.alpha)),
    )
    return [(_table(values, theta.shape), _table(bounds, theta.shape)) for values, bounds in rows]


def _table(rows: tuple[Real, ...], shape: tuple[int, ...]) -> Array:
    return np.stack([np.broadcast_to(row, shape) for row in rows])


def _rates(driver: DrivenCoordinate, index: Index, shape: tuple[int, ...]) -> Rates:
    error = driver.error or EXACT_ANGLE
    each = (driver.theta, driver.omega, driver.alpha, error.theta, error.omega, error.alpha)
    theta, omega, alpha, *bounds = (np.broadcast_to(one, shape)[index] for one in each)
    bounds[0] = bounds[0] + 4 * EPS * (np.abs(theta) + math.tau)
    return Rates(omega, alpha, AngleError(*bounds))
