"""One assembly of a triad followed along the driver, by cells in which there is no other nearby.

::

    phi |          __--+        Over a cell the assembly stays within a box that moves with its
        |   +---+--   _|        middle's own rate, and no other comes into that box, wherever in the
        |   | _-+---+- |        cell the driver is. At a border that is known to rounding, and lies
        |   +-  |   |  |        in both boxes, one box hands over to the next: no step can jump.
        +---+---+---+--+----- driver

The proof is that of `analytic.assur.platform`, with what the rows open along the straight way of the
box: half of their second rate, at most, times the square of the way. A track ends where no cell is
narrow enough: there two assemblies meet. After a whole turn of the driver, or some, it may be back.

Source: N. Rojas and F. Thomas on the position analysis of Assur groups; R. E. Moore et al.,
Introduction to Interval Analysis, 2009, section 8.3 (Krawczyk's test).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Literal, Protocol

import numpy as np
from numpy.typing import NDArray

from analytic.assur.cells_along import CellsAlong, along
from analytic.assur.platform import solve_platform
from analytic.assur.sampled_rows import SampledRow
from analytic.dyads.plane import EPS, BodyKinematics, Vec
from models.array import Array, Mask

BLOCK = 16
"""Cells that are looked at together."""
WIDEST = 0.1
"""A cell [rad]."""
NARROWEST = 1e-10
"""A cell [rad] that no assembly is followed through."""
MOST = 20_000
"""Cells of a track."""
SIDE = 1e-4
"""How far beyond a crossing the other side is looked for [rad]."""
FAR = 1e3
"""Times the lengths at the start that a link is away when it runs to infinity."""
TURNS = 6
"""A triad has no more assemblies, and so is back after as many periods of what it hangs on."""
EndKind = Literal["limit position", "change point", "run to infinity", "doubtful position"]


class RowsAt(Protocol):
    """The rows at driver angles [rad], (T,), each uncertain by ``half``; the driver at 1 rad/s."""

    def __call__(self, theta: Array, half: Array) -> Sequence[SampledRow]: ...


@dataclass(frozen=True)
class End:
    """Where a track ends or crosses another one: driver angle [rad], and as what.

    In a limit position two assemblies meet, and are no more beyond; in a change point two meet, and
    both go on. A run to infinity has a link whose lines become parallel. A doubtful position is
    none of these for sure: where what the group hangs on ends, say.
    """

    theta: float
    kind: EndKind


@dataclass(frozen=True)
class Pose:
    """The central link at a driver angle: place of its anchor [m], angle [rad], rates by it."""

    theta: float
    place: tuple[float, float]
    angle: float
    rate: tuple[float, float]
    omega: float
    second: tuple[float, float]
    alpha: float
    det: float


@dataclass(frozen=True)
class Piece:
    """Part of a track, the poses at the borders and in the middle of its cells, in its own order of
    driver angles; ``end`` where it ends, None where it was not asked for more."""

    poses: list[Pose]
    end: End | None
    crossings: list[End]


def follow(rows: RowsAt, start: Pose, to: float, size_m: float) -> Piece:
    """The assembly of ``start`` followed to the driver angle ``to`` [rad], as far as that goes."""
    way = 1.0 if to >= start.theta else -1.0
    poses, crossings, last = [start], list[End](), start
    stride = Stride(0.25 * WIDEST, 0.04)
    while last.theta != to and len(poses) < MOST:
        halves = stride.halves(abs(to - last.theta), _room(poses))
        cells = along(rows, last, way * halves, to if stride.arrives else None, size_m)
        found = _handed_over(cells, last)
        if found:
            poses += found
            last = found[-1]
        stride = stride.after(cells.good, halves)
        if cells.good == 0 and halves[0] < NARROWEST * max(1.0, abs(last.theta)):
            end = _end(poses, way, size_m)
            beyond = _beyond(rows, poses, end, way, size_m) if end.kind == "change point" else None
            if beyond is None or way * (to - beyond.theta) <= 0.0:
                return Piece(poses, end, crossings)
            crossings.append(end)
            poses.append(beyond)
            last, stride = beyond, Stride(0.1 * SIDE, 0.04)
    doubt = End(last.theta, "doubtful position") if last.theta != to else None
    return Piece(poses, doubt, crossings)


@dataclass
class Stride:
    """How wide the next cells are made: half of them at most ``half`` [rad], and a ``share`` of the
    room before an end."""

    half: float
    share: float
    arrives: bool = False

    def halves(self, left: float, room: float) -> Array:
        """The half-widths [rad] of cells over what is ``left`` of the way, ``room`` to an end."""
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
        """The stride after so many cells were good."""
        if good == len(halves):
            return Stride(min(1.6 * self.half, 0.5 * WIDEST), min(1.3 * self.share, 0.2))
        less = 0.75 if good else 0.5
        return Stride(less * min(self.half, float(halves[good]) / 0.75), less * self.share)


def _room(poses: list[Pose]) -> float:
    """How far it is to where the square of the determinant, which goes down, would be 0 [rad]."""
    if len(poses) < 3:
        return math.inf
    a, b = poses[-3], poses[-1]
    fall = a.det**2 - b.det**2
    return abs(b.theta - a.theta) * b.det**2 / fall if fall > 0.0 else math.inf


def _handed_over(cells: CellsAlong, last: Pose) -> list[Pose]:
    """The middles and the far borders of the cells up to the first that is not sure, the angles
    counted on from that of the ``last`` pose."""
    found: list[Pose] = []
    angle = last.angle
    for j in range(cells.good):
        for body, det, theta, k in (
            (cells.middle, cells.det_middle, cells.theta, j),
            (cells.border, cells.det_border, cells.far, j),
        ):
            pose = _pose(body, det, float(theta[k]), k, angle)
            found.append(pose)
            angle = pose.angle
    return found


def pose_at(rows: RowsAt, theta: float, place: Vec, turn: Vec, size_m: float) -> Pose | None:
    """The assembly nearest to a guess, one sample; None where there is none that is certain."""
    at = np.array([theta])
    own = rows(at, 8 * EPS * np.abs(at))
    solved = solve_platform(own, place, turn, size_m, certified=True)
    if not (solved.closed[0] and solved.sure[0]):
        return None
    return _pose(solved.body, solved.det, theta, 0, math.atan2(turn.y[0], turn.x[0]))


def _pose(body: BodyKinematics, det: Array, theta: float, k: int, near: float) -> Pose:
    """One sample as a pose, the angle that which is nearest to another."""

    def one(value: object) -> float:
        flat = np.ravel(np.asarray(value))
        return float(flat[k if flat.size > 1 else 0])

    turned = math.atan2(one(body.turn.y), one(body.turn.x))
    angle = turned + math.tau * round((near - turned) / math.tau)
    at = body.anchor
    return Pose(
        theta, (one(at.p.x), one(at.p.y)), angle, (one(at.v.x), one(at.v.y)), one(body.omega),
        (one(at.a.x), one(at.a.y)), one(body.alpha), one(det),
    )  # fmt: skip


def _end(poses: list[Pose], way: float, size_m: float) -> End:
    """Where the determinant goes to zero, and how: like the root of the way that is left, or like
    the way itself; and whether the link is far away there."""
    last = poses[-1]
    reach = np.array([math.hypot(*pose.place) for pose in poses])
    if reach[-1] > FAR * (reach[0] + size_m):
        # The inverse of the distance is linear in the way.
        far = next(k for k in range(len(poses) - 1, -1, -1) if reach[k] < 0.5 * reach[-1])
        left = abs(last.theta - poses[far].theta) / (reach[-1] / reach[far] - 1.0)
        return End(last.theta + way * left, "run to infinity")
    theta = np.array([pose.theta for pose in poses[:-1]])
    det = np.abs([pose.det for pose in poses[:-1]])
    away = np.abs(theta - last.theta)
    near = [int(np.argmin(np.abs(np.log(np.maximum(away, 1e-300) / d)))) for d in (1e-5, 1e-3)]
    a, b = near
    if a == b or not 0.0 < det[a] < det[b]:
        return End(last.theta, "doubtful position")
    power = math.log(det[b] / det[a]) / math.log(away[b] / away[a])
    if power < 0.2 or power > 1.4:
        return End(last.theta, "doubtful position")
    kind: EndKind = "limit position" if power < 0.75 else "change point"
    order = 2.0 if kind == "limit position" else 1.0
    # The power of the determinant that is linear in the way is 0 a little beyond the last pose.
    ends = [det[a] ** order, abs(last.det) ** order]
    slope = (ends[0] - ends[1]) / away[a]
    return End(last.theta + way * (ends[1] / slope if slope > 0.0 else 0.0), kind)


def _beyond(
    rows: RowsAt, poses: list[Pose], end: End, way: float, size_m: float
) -> Pose | None:
    """The assembly on the other side of a crossing: straight on, its determinant of other sign."""
    before = next((p for p in reversed(poses) if abs(p.theta - end.theta) > SIDE), poses[0])
    theta = end.theta + way * SIDE
    place, turn = ahead(before, np.array([theta]))
    found = pose_at(rows, theta, place, turn, size_m)
    if found is None or found.det * before.det >= 0.0:
        return None
    turns = round((before.angle - found.angle) / math.tau)
    return Pose(**{**vars(found), "angle": found.angle + math.tau * turns})


def ahead(pose: Pose, theta: Array) -> tuple[Vec, Vec]:
    """Where a pose leads to at driver angles, to the second order."""
    d = theta - pose.theta
    half = 0.5 * d * d
    place = Vec(
        pose.place[0] + pose.rate[0] * d + pose.second[0] * half,
        pose.place[1] + pose.rate[1] * d + pose.second[1] * half,
    )
    angle = pose.angle + pose.omega * d + pose.alpha * half
    return place, Vec(np.cos(angle), np.sin(angle))


@dataclass(frozen=True)
class Track:
    """One assembly of a group along the driver, from the ``start`` on to both sides.

    ``period`` [rad] is that of what the group hangs on; None where the driver does not turn.
    """

    rows: RowsAt
    start: Pose
    size_m: float
    base_period: float | None

    @cached_property
    def _up(self) -> tuple[Piece, float | None]:
        """From the start on, until it is back or at an end; and after which driver angle it is."""
        if self.base_period is None:
            return follow(self.rows, self.start, math.pi, self.size_m), None
        poses, crossings, last = [self.start], list[End](), self.start
        for k in range(1, TURNS + 1):
            to = self.start.theta + k * self.base_period
            piece = follow(self.rows, last, to, self.size_m)
            poses, crossings = poses + piece.poses[1:], crossings + piece.crossings
            last = poses[-1]
            if piece.end is not None:
                return Piece(poses, piece.end, crossings), None
            if self._is_start(last):
                return Piece(poses, None, crossings), k * self.base_period
        return Piece(poses, End(last.theta, "doubtful position"), crossings), None

    def _is_start(self, pose: Pose) -> bool:
        """Whether a pose is that of the start, but for whole turns: two that are not are as far
        apart as the boxes of cells are wide, and rounding is much less."""
        off = math.hypot(pose.place[0] - self.start.place[0], pose.place[1] - self.start.place[1])
        turned = math.remainder(pose.angle - self.start.angle, math.tau)
        slack = 1e-13 * (1.0 + abs(pose.theta)) / max(min(abs(self.start.det), 1.0), 1e-6)
        scale = self.size_m + math.hypot(*self.start.place) + math.hypot(*self.start.rate)
        return off <= slack * scale and abs(turned) <= slack * (1.0 + abs(self.start.omega)) * (
            scale / self.size_m
        )

    @cached_property
    def _down(self) -> Piece:
        """From the start back, where it does not repeat."""
        if self.period is not None:
            return Piece([self.start], None, [])
        lowest = -math.pi if self.base_period is None else self.start.theta - TURNS * self.base_period
        return follow(self.rows, self.start, lowest, self.size_m)

    @property
    def period(self) -> float | None:
        """The driver angle after which the assembly is back [rad]; None where it never is."""
        return self._up[1]

    @property
    def ends(self) -> tuple[End | None, End | None]:
        """The lower and the upper end, None where there is none."""
        return self._down.end, self._up[0].end

    @property
    def low(self) -> End | None:
        """The end at the lowest driver angle."""
        return self.ends[0]

    @property
    def high(self) -> End | None:
        """The end at the highest driver angle."""
        return self.ends[1]

    @property
    def range(self) -> tuple[float, float]:
        """The driver angles between the ends [rad]; of one that is back, a period."""
        low, high = self.ends
        return (
            self._down.poses[-1].theta if low is None else low.theta,
            self._up[0].poses[-1].theta if high is None else high.theta,
        )

    @property
    def crossings(self) -> list[End]:
        """The change points within the range, in increasing order."""
        return sorted(self._down.crossings + self._up[0].crossings, key=lambda end: end.theta)

    @cached_property
    def _nodes(self) -> Array:
        """Driver angle, place, angle and their rates at the poses, (7, n), and increasing."""
        poses = self._down.poses[:0:-1] + self._up[0].poses
        return np.array([(p.theta, *p.place, p.angle, *p.rate, p.omega) for p in poses]).T.copy()

    def home(self, theta: Array) -> Array:
        """Driver angles [rad], (T,), by whole periods, or turns, to where the track is."""
        low, high = self.range
        if self.period is not None:
            return np.asarray(low + np.remainder(theta - low, self.period))
        if self.base_period is None or high - low >= self.base_period:
            return theta
        turns = np.round((theta - 0.5 * (low + high)) / self.base_period)
        return np.asarray(theta - turns * self.base_period)

    def beyond(self, theta: Array) -> Array:
        """How far driver angles, brought home, are beyond the ends [rad]; below 0 within."""
        if self.period is not None:
            return np.full(theta.shape, -math.pi)
        low, high = self.range
        return np.asarray(np.clip(np.maximum(low - theta, theta - high), -math.pi, math.pi))

    def on_side(self, theta: Array, det: Array) -> Mask:
        """Whether an assembly at driver angles, brought home, with such determinants is this one,
        and not the one that it meets at an end or in a crossing."""
        start = self.start
        sign = np.full(np.shape(theta), math.copysign(1.0, start.det))
        for end in self.crossings:
            passed = theta > end.theta if end.theta > start.theta else theta < end.theta
            sign = np.where(passed, -sign, sign)
        return np.asarray(det * sign > 0.0)

    def guess(self, theta: Array) -> tuple[Vec, Vec]:
        """Place of the anchor [m] and direction of the link near driver angles [rad], (T,), that were
        brought home; beyond an end those at the end."""
        nodes = self._nodes
        at = nodes[0]
        if at.size < 2:
            place = Vec(np.full(theta.shape, nodes[1, 0]), np.full(theta.shape, nodes[2, 0]))
            angle = np.full(theta.shape, nodes[3, 0])
            return place, Vec(np.cos(angle), np.sin(angle))
        k: NDArray[np.intp] = np.clip(np.searchsorted(at, theta) - 1, 0, at.size - 2)
        width = at[k + 1] - at[k]
        u = np.clip((theta - at[k]) / width, 0.0, 1.0)
        x, y, angle = (
            _hermite(u, width, nodes[row][k], nodes[row][k + 1], nodes[row + 3][k], nodes[row + 3][k + 1])
            for row in (1, 2, 3)
        )
        return Vec(x, y), Vec(np.cos(angle), np.sin(angle))


def _hermite(u: Array, width: Array, a: Array, b: Array, da: Array, db: Array) -> Array:
    """The cubic between two values with their slopes."""
    rise = b - a
    p, q = width * da - rise, rise - width * db
    return np.asarray(a + u * (rise + (1.0 - u) * (p * (1.0 - u) + q * u)))
