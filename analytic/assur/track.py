"""One assembly of a triad followed along the driver, by cells in which there is no other nearby.

::

    phi |          __--+        Over a cell the assembly stays within a box that moves with its
        |   +---+--   _|        middle's own rate, and no other comes into that box, wherever in the
        |   | _-+---+- |        cell the driver is. At a border that is known to rounding, and lies
        |   +-  |   |  |        in both boxes, one box hands over to the next: no step can jump.
        +---+---+---+--+----- driver

The proof is that of `analytic.assur.platform`, with the gaps of the rows along the straight way of
the box: half of their second rate, at most, times the square of the way. A track ends where no cell
is narrow enough: there two assemblies meet. After one or more whole turns of the driver it may be
back.

Source: R. E. Moore, R. B. Kearfott and M. J. Cloud, Introduction to Interval Analysis, 2009,
chapter 8 (a root in a box that is the only one there).
"""

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from analytic.assur.following import TrackEnd, TrackPiece, follow
from analytic.assur.platform import CentralPose, RowsAt
from analytic.dyads.plane import Vec
from models.array import Array, Mask

TURNS = 6
"""Most assemblies of a triad, which is thus back after as many periods of its supports."""


@dataclass(frozen=True, eq=False)
class AssemblyTrack:
    """One assembly of a group along the driver, from the ``start`` on to both sides.

    ``base_period`` [rad] is that of the group's supports; None where the driver does not turn.
    """

    rows: RowsAt
    start: CentralPose
    size_m: float
    base_period: float | None

    @cached_property
    def _up(self) -> tuple[TrackPiece, float | None]:
        """The track from the start on, until it is back or at an end; and its period."""
        if self.base_period is None:
            return follow(self.rows, self.start, math.pi, self.size_m), None
        poses, crossings, last = [self.start], list[TrackEnd](), self.start
        for k in range(1, TURNS + 1):
            to = self.start.theta + k * self.base_period
            piece = follow(self.rows, last, to, self.size_m)
            poses, crossings = poses + piece.poses[1:], crossings + piece.crossings
            last = poses[-1]
            if piece.end is not None:
                return TrackPiece(poses, piece.end, crossings), None
            if self._is_start(last):
                return TrackPiece(poses, None, crossings), k * self.base_period
        return TrackPiece(poses, TrackEnd(last.theta, "doubtful position"), crossings), None

    def _is_start(self, pose: CentralPose) -> bool:
        """True if a pose is that of the start, up to whole turns: different ones are as far apart
        as the boxes of cells are wide, and rounding is much less."""
        off = math.dist(pose.place, self.start.place)
        turned = math.remainder(pose.angle - self.start.angle, math.tau)
        slack = 1e-13 * (1.0 + abs(pose.theta)) / max(min(abs(self.start.det), 1.0), 1e-6)
        scale = self.size_m + math.hypot(*self.start.place) + math.hypot(*self.start.rate)
        return off <= slack * scale and abs(turned) <= slack * (1.0 + abs(self.start.omega)) * (
            scale / self.size_m
        )

    @cached_property
    def _down(self) -> TrackPiece:
        """The track from the start back, where it does not repeat."""
        if self.period is not None:
            return TrackPiece([self.start], None, [])
        lowest = (
            -math.pi if self.base_period is None else self.start.theta - TURNS * self.base_period
        )
        return follow(self.rows, self.start, lowest, self.size_m)

    @property
    def period(self) -> float | None:
        """Driver angle after which the assembly is back [rad]; None where it never is."""
        return self._up[1]

    @property
    def ends(self) -> tuple[TrackEnd | None, TrackEnd | None]:
        """Lower and upper end, None where there is none."""
        return self._down.end, self._up[0].end

    @property
    def range(self) -> tuple[float, float]:
        """Driver angles between the ends [rad]; a period where the assembly is back."""
        low, high = self.ends
        return (
            self._down.poses[-1].theta if low is None else low.theta,
            self._up[0].poses[-1].theta if high is None else high.theta,
        )

    @cached_property
    def crossings(self) -> list[TrackEnd]:
        """Change points within the range, in increasing order."""
        return sorted(self._down.crossings + self._up[0].crossings, key=lambda end: end.theta)

    def from_crossing(self, k: int, theta: Array) -> Array:
        """Return driver angles, brought home, from the k-th of the crossings [rad]."""
        off = theta - self.crossings[k].theta
        if self.period is None:
            return np.asarray(off)
        return np.asarray(np.remainder(off + 0.5 * self.period, self.period) - 0.5 * self.period)

    def room_about(self, k: int) -> float:
        """Return the distance from the k-th crossing to the next one or to an end [rad]."""
        at = self.crossings[k].theta
        places = [end.theta for end in (*self.crossings, *self.ends) if end is not None]
        if self.period is not None:
            places += [place + way * self.period for place in places for way in (-1.0, 1.0)]
        return min((abs(place - at) for place in places if place != at), default=math.inf)

    @cached_property
    def _nodes(self) -> Array:
        """Driver angle, place, angle and their rates at the poses, (7, n), increasing."""
        poses = self._down.poses[:0:-1] + self._up[0].poses
        return np.array([(p.theta, *p.place, p.angle, *p.rate, p.omega) for p in poses]).T.copy()

    def home(self, theta: Array) -> Array:
        """Move driver angles [rad], (T,), by whole periods, or turns, into the track's range."""
        low, high = self.range
        if self.period is not None:
            return np.asarray(low + np.remainder(theta - low, self.period))
        if self.base_period is None or high - low >= self.base_period:
            return theta
        turns = np.round((theta - 0.5 * (low + high)) / self.base_period)
        return np.asarray(theta - turns * self.base_period)

    def beyond(self, theta: Array) -> Array:
        """Return how far driver angles, brought home, are beyond the ends [rad]; below 0 within."""
        if self.period is not None:
            return np.full(theta.shape, -math.pi)
        low, high = self.range
        return np.asarray(np.clip(np.maximum(low - theta, theta - high), -math.pi, math.pi))

    def on_side(self, theta: Array, det: Array) -> Mask:
        """Return the mask where an assembly at driver angles, brought home, with such determinants
        is this one, and not the one that it meets at an end or in a crossing."""
        start = self.start
        sign = np.full(np.shape(theta), math.copysign(1.0, start.det))
        for end in self.crossings:
            passed = theta > end.theta if end.theta > start.theta else theta < end.theta
            sign = np.where(passed, -sign, sign)
        return np.asarray(det * sign > 0.0)

    def guess(self, theta: Array) -> tuple[Vec, Vec]:
        """Return place of the anchor [m] and direction of the link near driver angles [rad], (T,),
        that were brought home; beyond an end those at the end."""
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
            _hermite(
                u, width, nodes[row][k], nodes[row][k + 1], nodes[row + 3][k], nodes[row + 3][k + 1]
            )
            for row in (1, 2, 3)
        )
        for end in self.ends:
            if end is not None and end.kind == "run to infinity":
                x, y = self._far(end, theta, x, y)
        return Vec(x, y), Vec(np.cos(angle), np.sin(angle))

    def _far(self, end: TrackEnd, theta: Array, x: Array, y: Array) -> tuple[Array, Array]:
        """Return the place between the last pose and infinity: distance as 1 over the way."""
        nodes = self._nodes
        k = 0 if end is self.ends[0] else -1
        left, way = end.theta - theta, end.theta - nodes[0, k]
        with np.errstate(divide="ignore", invalid="ignore"):
            growth = np.where((left / way > 0.0) & (left / way < 1.0), way / left, 1.0)
        return np.asarray(x + (growth - 1.0) * (nodes[1, k] - self.start.place[0])), np.asarray(
            y + (growth - 1.0) * (nodes[2, k] - self.start.place[1])
        )


def _hermite(u: Array, width: Array, a: Array, b: Array, da: Array, db: Array) -> Array:
    """Return the cubic between two values with their slopes."""
    rise = b - a
    p, q = width * da - rise, rise - width * db
    return np.asarray(a + u * (rise + (1.0 - u) * (p * (1.0 - u) + q * u)))
