"""The next cells of an assembly, and the next, until it ends or is where it was asked for."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from analytic.assur.cells_along import CellsAlong, along
from analytic.assur.ends import End, end_at_infinity, end_beside, runs_away
from analytic.assur.pose import Pose, RowsAt, ahead, pose_at, pose_of
from models.array import Array

BLOCK = 16
"""Cells that are looked at together."""
WIDEST = 0.1
"""A cell [rad]."""
NARROWEST = 1e-10
"""A cell [rad] that no assembly is followed through."""
MOST = 20_000
"""Poses of a track."""
SIDE = 1e-4
"""How far beyond a crossing the other side is looked for [rad]."""


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
            if runs_away(start, last, size_m):
                return Piece(poses, end_at_infinity(poses), crossings)
        stride = stride.after(cells.good, halves)
        if cells.good == 0 and halves[0] < NARROWEST * max(1.0, abs(last.theta)):
            end = end_beside(poses, way)
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
            pose = pose_of(body, det, float(theta[k]), k, angle)
            found.append(pose)
            angle = pose.angle
    return found


def _beyond(rows: RowsAt, poses: list[Pose], end: End, way: float, size_m: float) -> Pose | None:
    """The assembly on the other side of a crossing: straight on, its determinant of other sign."""
    before = next((p for p in reversed(poses) if abs(p.theta - end.theta) > SIDE), poses[0])
    theta = end.theta + way * SIDE
    place, turn = ahead(before, np.array([theta]))
    found = pose_at(rows, theta, place, turn, size_m)
    if found is None or found.det * before.det >= 0.0:
        return None
    turns = round((before.angle - found.angle) / math.tau)
    return replace(found, angle=found.angle + math.tau * turns)
