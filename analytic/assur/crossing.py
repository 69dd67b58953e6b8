"""The central link in and beside a change point of its group, where the rows give 0/0.

As at the change points of dyads, the smooth motion is an analytic function of the driver's angle,
and interpolated from both sides (`analytic.change_points.sign`).
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from analytic.change_points import sign
from analytic.change_points.sign import Interpolant
from analytic.dyads.chunk import DrivenCoordinate
from analytic.dyads.plane import EPS, AngleError, BodyKinematics, PointError, PointKinematics, Vec
from models.array import Array, Mask

Solved = Callable[[Array], BodyKinematics]
"""Central link at driver angles [rad], per unit speed of the driver, with bounds."""


@dataclass(frozen=True)
class CrossingPiece(sign.SmoothPiece):
    """Place and angle of the link as functions of the driver's angle."""

    series: tuple[Interpolant, Interpolant, Interpolant]

    @staticmethod
    def about(solved: Solved, centre: float, room: float, size_m: float) -> CrossingPiece | None:
        """Return the widest that is about as certain as any, within ``room`` [rad]; None where the
        motion is not certainly smooth."""
        halves = (half for half in sign.HALVES if half <= room)
        return sign.widest(halves, lambda half: _piece(solved, centre, half, size_m))

    def near(self, from_centre: Array) -> Mask:
        """Return the mask of driver angles, from the centre, at which it is used."""
        return np.asarray(np.abs(from_centre) < self.window)

    def put(
        self, body: BodyKinematics, from_centre: Array, driver: DrivenCoordinate
    ) -> BodyKinematics:
        """Return the link with its lost values about the change point restored."""
        index = np.flatnonzero(self.near(from_centre))
        if not index.size:
            return body
        rates = sign.rates_at(driver, index)
        found = [one.at(from_centre[index] / self.half, rates) for one in self.series]
        (x, y, angle), errors = zip(*found, strict=True)
        new, at = sign.into(from_centre.shape, index), body.anchor
        levels = zip((at.p, at.v, at.a), x, y, strict=True)
        p, v, a = (Vec(new(old.x, each_x), new(old.y, each_y)) for old, each_x, each_y in levels)
        turn = Vec(new(body.turn.x, np.cos(angle[0])), new(body.turn.y, np.sin(angle[0])))
        anchor = PointKinematics(p, v, a, at.error)
        omega, alpha = new(body.omega, angle[1]), new(body.alpha, angle[2])
        body = replace(body, anchor=anchor, turn=turn, omega=omega, alpha=alpha)
        if body.error is None or at.error is None:
            return body
        point = PointError(*map(new, at.error, map(np.hypot, errors[0], errors[1])))
        turned = AngleError(*map(new, body.error, errors[2]))
        return replace(body, anchor=replace(anchor, error=point), error=turned)


def _piece(solved: Solved, centre: float, half: float, size_m: float) -> CrossingPiece:
    wide, narrow = centre + half * sign.nodes(sign.COUNT), centre + half * sign.nodes(sign.FEWER)
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
    return CrossingPiece(half, doubt, (series[0], series[1], series[2]))


def _levels(body: BodyKinematics, theta: Array) -> list[tuple[Array, Array]]:
    """Return place and angle at the nodes, with two derivatives, and their bounds, each (3, n)."""
    assert body.error is not None
    assert body.anchor.error is not None
    at, e = body.anchor, body.anchor.error
    angle = np.unwrap(np.arctan2(body.turn.y, body.turn.x))
    turned = body.error._replace(theta=body.error.theta + 2 * EPS * (np.abs(angle) + math.pi))
    rows = (
        (at.p.x, at.v.x, at.a.x, *e),
        (at.p.y, at.v.y, at.a.y, *e),
        (angle, body.omega, body.alpha, *turned),
    )
    tables = (np.stack([np.broadcast_to(each, theta.shape) for each in row]) for row in rows)
    return [(table[:3], table[3:]) for table in tables]
