"""Cells of the driver in which one assembly of a triad is the only one within a moving box."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from analytic.assur.platform import SolvedPlatform, Wrenches, solve_platform
from analytic.assur.pose import Pose, RowsAt, ahead
from analytic.assur.sampled_rows import SampledRow
from analytic.dyads.plane import (
    EPS,
    EXACT_ANGLE,
    EXACT_POINT,
    ZERO,
    AngleError,
    BodyKinematics,
    PointError,
    PointKinematics,
    Real,
    Vec,
)
from models.array import Array, Mask

SHARE = 0.5
"""Of the box, what its own size may add to it: then nothing else is in it."""


@dataclass(frozen=True)
class CellsAlong:
    """Cells one after the other: the driver angles of their middles and far borders [rad], the
    central link there, and how many of them, from the first on, are handed over without a doubt."""

    theta: Array
    far: Array
    middle: BodyKinematics
    border: BodyKinematics
    det_middle: Array
    det_border: Array
    good: int


@np.errstate(all="ignore")
def along(rows: RowsAt, last: Pose, halves: Array, to: float | None, size_m: float) -> CellsAlong:
    """Cells of half-widths ``halves`` [rad] (below 0: to lower angles), one after the other from a
    pose on, the last up to driver angle ``to`` where that is given."""
    far = last.theta + 2.0 * np.cumsum(halves)
    if to is not None:
        far[-1] = to
    theta = far - halves
    middle, own = _solved(rows, last, theta, size_m)
    border, _ = _solved(rows, last, far, size_m)
    near = np.concatenate([[last.theta], far[:-1]])
    width = np.maximum(np.abs(far - theta), np.abs(theta - near)) * (1.0 + 1e-6)
    width += 8 * EPS * np.abs(far)
    e, t, sure = _boxes(own, rows(theta, width), middle.body, width, size_m)
    sure &= middle.closed & border.closed & border.sure
    sure &= _inside(middle.body, border.body, far - theta, e, t)
    sure &= _inside(middle.body, _shifted(last, border.body), near - theta, e, t)
    good = int(sure.size if sure.all() else np.argmin(sure))
    return CellsAlong(theta, far, middle.body, border.body, middle.det, border.det, good)


def _solved(
    rows: RowsAt, last: Pose, theta: Array, size_m: float
) -> tuple[SolvedPlatform, Sequence[SampledRow]]:
    """The assembly that a pose leads to, at driver angles known to rounding."""
    place, turn = ahead(last, theta)
    own = rows(theta, 8 * EPS * np.abs(theta))
    return solve_platform(own, place, turn, size_m, certified=True), own


def _boxes(
    rows: Sequence[SampledRow],
    over: Sequence[SampledRow],
    body: BodyKinematics,
    half: Array,
    size_m: float,
) -> tuple[Array, Array, Mask]:
    """How far the assembly may be from the straight way of the middle, anywhere in a cell, and
    whether it is the only one so near; ``over`` are the rows of the whole cell."""
    wrenches = Wrenches.of(rows, body, size_m)
    still = PointKinematics(body.anchor.p, body.anchor.v, ZERO, EXACT_POINT)
    straight = replace(body, anchor=still, alpha=0.0, error=EXACT_ANGLE)
    way, swing = body.anchor.v.norm() * half, np.abs(body.omega) * half
    open_ = []
    moved = _widened(straight, way, swing)
    for row, whole in zip(rows, over, strict=True):
        place, rate, second = row.gap(0, straight), row.gap(1, straight), whole.gap(2, moved)
        open_.append(_most(place) + half * _most(rate) + 0.5 * half * half * _most(second))
    shift, by = wrenches.bound((open_[0], open_[1], open_[2]))
    e, t = 2.02 * shift + 16 * EPS * size_m, 2.02 * by + 16 * EPS
    sway = [row.sway(_widened(straight, way + e, swing + t)) for row in over]
    change = [(lean + 8 * EPS) * e + (turning + 8 * EPS * size_m) * t for lean, turning in sway]
    grown, more = wrenches.bound((change[0], change[1], change[2]))
    share = np.maximum(grown / e, more / t)
    sure = (share <= SHARE) & np.isfinite(e) & (t + swing < 1.0)
    return np.asarray(e), np.asarray(t), np.asarray(sure)


def _most(gap: tuple[Real, Real]) -> Real:
    return np.abs(gap[0]) + gap[1]


def _widened(body: BodyKinematics, e: Real, t: Real) -> BodyKinematics:
    anchor = replace(body.anchor, error=PointError(e, 0.0, 0.0))
    return replace(body, anchor=anchor, error=AngleError(t, 0.0, 0.0))


def _shifted(last: Pose, border: BodyKinematics) -> BodyKinematics:
    """The near borders: the last pose, and then each far border but one."""

    def after(first: float, rest: Real) -> Array:
        return np.concatenate([[first], np.asarray(rest)[:-1]])

    assert border.error is not None
    assert border.anchor.error is not None
    p, turn = border.anchor.p, border.turn
    place = Vec(after(last.place[0], p.x), after(last.place[1], p.y))
    error = PointError(after(0.0, border.anchor.error.position), 0.0, 0.0)
    anchor = PointKinematics(place, ZERO, ZERO, error)
    along_ = Vec(after(math.cos(last.angle), turn.x), after(math.sin(last.angle), turn.y))
    angle = AngleError(after(0.0, border.error.theta), 0.0, 0.0)
    return BodyKinematics((0.0, 0.0), anchor, along_, 0.0, 0.0, angle)


def _inside(middle: BodyKinematics, border: BodyKinematics, by: Array, e: Array, t: Array) -> Mask:
    """Whether the assembly at a border, with its doubt, is in the box of a cell."""
    assert border.error is not None
    assert border.anchor.error is not None
    off = border.anchor.p - (middle.anchor.p + middle.anchor.v * by)
    swing = middle.omega * by
    turn = middle.turn.turned(Vec(np.cos(swing), np.sin(swing)))
    turned = np.abs(np.arctan2(turn.cross(border.turn), turn.dot(border.turn)))
    near = off.norm() + border.anchor.error.position <= e
    return np.asarray(near & (turned + border.error.theta <= t))
