"""Cells of an assembly, one after the other, until it ends or is at the requested angle."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from analytic.assur import platform
from analytic.assur.platform import CentralPose, RowsAt, SolvedPlatform, largest
from analytic.assur.sampled_rows import SampledRow
from analytic.dyads import plane
from analytic.dyads.plane import EPS, ZERO, BodyKinematics, Vec
from models.array import Array, Mask

SHARE = 0.5
"""Largest growth of a box by its own size, over the box: then it holds no other assembly."""


@dataclass(frozen=True)
class CellsAlong:
    """Successive cells: the driver angles of their middles and far borders [rad], the central link
    there, and the number of them, from the first on, that are certainly handed over."""

    theta: Array
    far: Array
    middle: SolvedPlatform
    border: SolvedPlatform
    good: int


@np.errstate(all="ignore")
def along(
    rows: RowsAt, last: CentralPose, halves: Array, to: float | None, size_m: float
) -> CellsAlong:
    """Return cells of half-widths ``halves`` [rad] (below 0: to lower angles), one after the other
    from a pose on, the last up to driver angle ``to`` where that is given."""
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
    return CellsAlong(theta, far, middle, border, good)


def _solved(
    rows: RowsAt, last: CentralPose, theta: Array, size_m: float
) -> tuple[SolvedPlatform, Sequence[SampledRow]]:
    """Return the assembly that a pose leads to, at driver angles known to rounding."""
    place, turn = platform.ahead(last, theta)
    own = rows(theta, 8 * EPS * np.abs(theta))
    return platform.solve_platform(own, place, turn, size_m, certified=True), own


def _boxes(
    rows: Sequence[SampledRow],
    over: Sequence[SampledRow],
    body: BodyKinematics,
    half: Array,
    size_m: float,
) -> tuple[Array, Array, Mask]:
    """Return the largest distance of the assembly from the straight way of the middle, in a cell,
    and the mask where it is the only one so near; ``over`` are the whole cell's rows."""
    wrenches = platform.Wrenches.of(rows, body, size_m)
    still = plane.PointKinematics(body.anchor.p, body.anchor.v, ZERO, plane.EXACT_POINT)
    straight = replace(body, anchor=still, alpha=0.0, error=plane.EXACT_ANGLE)
    way, swing = body.anchor.v.norm() * half, np.abs(body.omega) * half
    open_ = []
    moved = platform.widened(straight, way, swing)
    for row, whole in zip(rows, over, strict=True):
        place, rate = largest(row.gap(0, straight)), largest(row.gap(1, straight))
        open_.append(place + half * rate + 0.5 * half * half * largest(whole.gap(2, moved)))
    shift, by = wrenches.bound(open_)
    e, t = 2.02 * shift + 16 * EPS * size_m, 2.02 * by + 16 * EPS
    sway = [row.sway(platform.widened(straight, way + e, swing + t)) for row in over]
    change = [(lean + 8 * EPS) * e + (turning + 8 * EPS * size_m) * t for lean, turning in sway]
    grown, more = wrenches.bound(change)
    share = np.maximum(grown / e, more / t)
    sure = (share <= SHARE) & np.isfinite(e) & (t + swing < 1.0)
    return np.asarray(e), np.asarray(t), np.asarray(sure)


def _shifted(last: CentralPose, border: BodyKinematics) -> BodyKinematics:
    """Return the near borders: the last pose, and then each far border but one."""

    def after(first: float, rest: plane.Real) -> Array:
        return np.concatenate([[first], np.asarray(rest)[:-1]])

    assert border.error is not None
    assert border.anchor.error is not None
    p, turn = border.anchor.p, border.turn
    place = Vec(after(last.place[0], p.x), after(last.place[1], p.y))
    error = plane.PointError(after(0.0, border.anchor.error.position), 0.0, 0.0)
    anchor = plane.PointKinematics(place, ZERO, ZERO, error)
    along_ = Vec(after(math.cos(last.angle), turn.x), after(math.sin(last.angle), turn.y))
    angle = plane.AngleError(after(0.0, border.error.theta), 0.0, 0.0)
    return BodyKinematics((0.0, 0.0), anchor, along_, 0.0, 0.0, angle)


def _inside(middle: BodyKinematics, border: BodyKinematics, by: Array, e: Array, t: Array) -> Mask:
    """Return the mask where the assembly at a border, with its doubt, is in the box of a cell."""
    assert border.error is not None
    assert border.anchor.error is not None
    off = border.anchor.p - (middle.anchor.p + middle.anchor.v * by)
    swing = middle.omega * by
    turn = middle.turn.turned(Vec(np.cos(swing), np.sin(swing)))
    turned = np.abs(np.arctan2(turn.cross(border.turn), turn.dot(border.turn)))
    near = off.norm() + border.anchor.error.position <= e
    return np.asarray(near & (turned + border.error.theta <= t))


FAR, SOON = 100.0, 5e-3
"""Distance of a link that runs to infinity, over its size, and a driver angle [rad]."""
EndKind = Literal["limit position", "change point", "run to infinity", "doubtful position"]


@dataclass(frozen=True)
class TrackEnd:
    """End of a track, or crossing with another: driver angle [rad] and kind.

    In a limit position two assemblies meet, and end; in a change point two meet, and both go on. A
    run to infinity has a link whose lines become parallel. A doubtful position is none of these for
    sure: the end of a supporting group, say.
    """

    theta: float
    kind: EndKind


def end_beside(poses: list[CentralPose], way: float) -> TrackEnd:
    """Return the end where the determinant goes to zero, and its kind: like the root of the
    remaining way, or like the way itself."""
    last = poses[-1]
    if len(poses) < 2:  # a start in the end itself
        return TrackEnd(last.theta, "doubtful position")
    theta = np.array([pose.theta for pose in poses[:-1]])
    det = np.abs([pose.det for pose in poses[:-1]])
    away = np.abs(theta - last.theta)
    near = [int(np.argmin(np.abs(np.log(np.maximum(away, 1e-300) / d)))) for d in (1e-5, 1e-3)]
    a, b = near
    if a == b or not 0.0 < det[a] < det[b]:
        return TrackEnd(last.theta, "doubtful position")
    rates = [math.hypot(*poses[k].rate) for k in near]
    # There the speed goes as the inverse square of the way.
    if rates[0] > 0.01 * (away[b] / away[a]) ** 2 * rates[1] > 0.0:
        return TrackEnd(last.theta, "run to infinity")
    power = math.log(det[b] / det[a]) / math.log(away[b] / away[a])
    if power < 0.2 or power > 1.4:
        return TrackEnd(last.theta, "doubtful position")
    kind: EndKind = "limit position" if power < 0.75 else "change point"
    order = 2.0 if kind == "limit position" else 1.0
    # The power of the determinant that is linear in the way is 0 a little beyond the last pose.
    ends = [det[a] ** order, abs(last.det) ** order]
    slope = (ends[0] - ends[1]) / away[a]
    left = ends[1] / slope if slope > 0.0 else 0.0
    return TrackEnd(float(last.theta + way * left), kind)


def runs_away(start: CentralPose, last: CentralPose, size_m: float) -> bool:
    """True if a link is far away, and doubles its distance before the driver has moved on by
    `SOON`: it runs to infinity."""
    away, rate = math.dist(start.place, last.place), math.hypot(*last.rate)
    return away > FAR * (size_m + math.hypot(*start.rate)) and away < SOON * rate


def end_at_infinity(poses: list[CentralPose]) -> TrackEnd:
    """Return the driver angle at which a link is at infinity: it is a smooth function of the
    inverse of its distance, here a polynomial through five of its poses."""
    start, last = poses[0].place, poses[-1]
    inverse, theta = [1.0 / math.dist(start, last.place)], [last.theta]
    for pose in reversed(poses[1:]):
        if 2.0 * inverse[-1] * math.dist(start, pose.place) < 1.0 and len(theta) < 5:
            inverse.append(1.0 / math.dist(start, pose.place))
            theta.append(pose.theta)
    powers = np.arange(len(theta))
    scaled = np.array(inverse)[:, None] / inverse[-1]
    return TrackEnd(float(np.linalg.solve(scaled**powers, np.array(theta))[0]), "run to infinity")


BLOCK = 16
"""Number of cells that are computed together."""
WIDEST = 0.1
"""Largest width of a cell [rad]."""
NARROWEST = 1e-10
"""Width of a cell [rad] below which no assembly is followed."""
MOST = 20_000
"""Most poses of a track."""
SIDE = 1e-4
"""Distance beyond a crossing at which the other side is searched [rad]."""


@dataclass(frozen=True)
class TrackPiece:
    """Part of a track, the poses at the borders and in the middle of its cells, in its own order of
    driver angles; ``end`` where it ends, None where it reached the requested angle."""

    poses: list[CentralPose]
    end: TrackEnd | None
    crossings: list[TrackEnd]


def follow(rows: RowsAt, start: CentralPose, to: float, size_m: float) -> TrackPiece:
    """Follow the assembly of ``start`` to the driver angle ``to`` [rad], as far as it goes."""
    way = 1.0 if to >= start.theta else -1.0
    poses, crossings, last = [start], list[TrackEnd](), start
    stride = Stride(0.25 * WIDEST, 0.04)
    while last.theta != to and len(poses) < MOST:
        halves = stride.halves(abs(to - last.theta), _room(poses))
        cells = along(rows, last, way * halves, to if stride.arrives else None, size_m)
        found = _handed_over(cells, last)
        if found:
            poses += found
            last = found[-1]
            if runs_away(start, last, size_m):
                return TrackPiece(poses, end_at_infinity(poses), crossings)
        stride = stride.after(cells.good, halves)
        if cells.good == 0 and halves[0] < NARROWEST * max(1.0, abs(last.theta)):
            end = end_beside(poses, way)
            beyond = _beyond(rows, poses, end, way, size_m) if end.kind == "change point" else None
            if beyond is None or way * (to - beyond.theta) <= 0.0:
                return TrackPiece(poses, end, crossings)
            crossings.append(end)
            poses.append(beyond)
            last, stride = beyond, Stride(0.1 * SIDE, 0.04)
    doubt = TrackEnd(last.theta, "doubtful position") if last.theta != to else None
    return TrackPiece(poses, doubt, crossings)


@dataclass
class Stride:
    """Width of the next cells: their halves are at most ``half`` [rad], and a ``share`` of the way
    to an end."""

    half: float
    share: float
    arrives: bool = False

    def halves(self, left: float, room: float) -> Array:
        """Return the half-widths [rad] of cells over the ``left`` way, ``room`` to an end."""
        found: list[float] = []
        self.arrives = False
        for _ in range(BLOCK):
            half = min(self.half, self.share * room)
            if 2.0 * half >= left:
                found.append(0.5 * left)
                self.arrives = True
                break
            found.append(half)
            left, room = left - 2.0 * half, room - 2.0 * half
        return np.array(found)

    def after(self, good: int, halves: Array) -> Stride:
        """Return the stride after so many cells were good."""
        if good == len(halves):
            return Stride(min(1.6 * self.half, 0.5 * WIDEST), min(1.3 * self.share, 0.2))
        less = 0.75 if good else 0.5
        return Stride(less * min(self.half, float(halves[good]) / 0.75), less * self.share)


def _room(poses: list[CentralPose]) -> float:
    """Return the distance to the predicted zero of the determinant's falling square [rad]."""
    if len(poses) < 3:
        return math.inf
    a, b = poses[-3], poses[-1]
    fall = a.det**2 - b.det**2
    return abs(b.theta - a.theta) * b.det**2 / fall if fall > 0.0 else math.inf


def _handed_over(cells: CellsAlong, last: CentralPose) -> list[CentralPose]:
    """Return the middles and the far borders of the cells up to the first that is not sure, the
    angles counted on from that of the ``last`` pose."""
    found: list[CentralPose] = []
    angle = last.angle
    for j in range(cells.good):
        for solved, theta in ((cells.middle, cells.theta), (cells.border, cells.far)):
            pose = platform.pose_of(solved.body, solved.det, float(theta[j]), j, angle)
            found.append(pose)
            angle = pose.angle
    return found


def _beyond(
    rows: RowsAt, poses: list[CentralPose], end: TrackEnd, way: float, size_m: float
) -> CentralPose | None:
    """Return the assembly beyond a crossing: straight on, its determinant of other sign."""
    before = next((p for p in reversed(poses) if abs(p.theta - end.theta) > SIDE), poses[0])
    theta = end.theta + way * SIDE
    place, turn = platform.ahead(before, np.array([theta]))
    found = platform.pose_at(rows, theta, place, turn, size_m)
    if found is None or found.det * before.det >= 0.0:
        return None
    turns = round((before.angle - found.angle) / math.tau)
    return replace(found, angle=found.angle + math.tau * turns)
