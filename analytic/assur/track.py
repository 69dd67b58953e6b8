"""One assembly of a group followed along the driver, by steps that can not jump to another one.

::

      pose |        ____
           |   __--+----+     Over a cell of the driver's angles the certificate of the middle, for
           | _+--+ |____|     what the group hangs on being uncertain by as much as it moves in the
           |_|   +-+          cell, holds one assembly and no other. The pose at one end of the cell
           |                  is in there, and so the one that is found at its other end is the
           +------------ psi  same assembly, led on.

Source: R. E. Moore, R. B. Kearfott and M. J. Cloud, Introduction to Interval Analysis, chapter 8
(a root in a box that is the only one there); the boxes are those of `analytic.assur.platform`.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Literal

import numpy as np

from analytic.assur.platform import SolvedPlatform
from analytic.dyads.plane import Vec
from models.array import Array, Mask
from models.errors import CrankcheckError

FIRST, WIDEST, NARROWEST = 0.02, 0.1, 1e-9
"""Cells of the driver's angle [rad]: the first that is tried, the widest, and the narrowest, beside
which the assembly ends."""
MOST_TURNS = 24
"""Of the driver, after which an assembly that has not come back is given up."""
SAME = 1e-7
"""Of the link's size and of an angle [rad]: two poses that are one."""
BISECTIONS = 48

EndKind = Literal["limit position", "change point"]
Solve = Callable[[Array, Array, Vec, Vec], SolvedPlatform]
"""The central link at driver angles that are uncertain by so much [rad], near a guess; the driver
at unit speed."""


@dataclass(frozen=True)
class End:
    """Where the assembly meets another one, at a driver angle [rad]."""

    theta: float
    kind: EndKind


@dataclass(frozen=True)
class Node:
    """The pose at a driver angle, with its rates by that angle; the angle is continuous."""

    theta: float
    x: float
    y: float
    phi: float
    dx: float
    dy: float
    dphi: float
    det: float

    def ahead(self, by: Array) -> tuple[Vec, Vec]:
        """The pose that the rates lead to."""
        phi = self.phi + self.dphi * by
        place = Vec(self.x + self.dx * by, self.y + self.dy * by)
        return place, Vec(np.cos(phi), np.sin(phi))


@dataclass
class Track:
    """The way of one assembly: nodes from the lowest driver angle to the highest.

    ``period`` is the driver angle after which it comes back [rad], None where it ends before:
    ``low`` and ``high`` are the ends then, or None where it goes on as far as anybody looks.
    """

    solve: Solve
    size_m: float
    nodes: list[Node]
    period: float | None = None
    low: End | None = None
    high: End | None = None
    table: Array = field(default_factory=lambda: np.empty((0, 8)))

    @staticmethod
    def of(
        solve: Solve, size_m: float, start: Node, repeats: float | None, farthest: float
    ) -> Track:
        """The track through a start.

        Parameters
        ----------
        repeats : float or None
            The driver angle after which what the group hangs on is as before; None of a slider.
        farthest : float
            The driver angles to either side of 0 within which a slider is looked at.
        """
        track = Track(solve, size_m, [start])
        track._go(+1.0, repeats, farthest)
        if track.period is None:
            track._go(-1.0, None if track.high is None else None, farthest, start)
        rows = [[n.theta, n.x, n.y, n.phi, n.dx, n.dy, n.dphi, n.det] for n in track.nodes]
        track.table = np.array(sorted(rows))
        return track

    @property
    def side(self) -> float:
        """The sign of the determinant all along."""
        return math.copysign(1.0, self.nodes[0].det)

    def _go(
        self, way: float, repeats: float | None, farthest: float, start: Node | None = None
    ) -> None:
        """On from the start, to an end, until it repeats, or as far as is looked."""
        node = first = self.nodes[0]
        width, due = FIRST, repeats
        limit = MOST_TURNS * math.tau if repeats is not None or start is None else farthest
        while True:
            stop = math.inf if due is None else abs(due)
            gone = abs(node.theta - first.theta)
            step = min(width, max(stop - gone, 0.0)) if stop > gone else width
            found = self._cell(node, way * step)
            if found is None:
                width = 0.5 * step
                if width < NARROWEST:
                    self._end(node, way)
                    return
                continue
            node, width = found, min(1.6 * max(step, width if step < width else step), WIDEST)
            self.nodes.append(node)
            gone = abs(node.theta - first.theta)
            if due is not None and gone >= abs(due) * (1.0 - 1e-12):
                if self._same(node, first):
                    self.period = abs(due)
                    return
                assert repeats is not None
                due = due + repeats
            if repeats is None and abs(node.theta) >= farthest:
                return
            if gone > limit:
                raise CrankcheckError("the assembly has not come back after many turns")

    def _cell(self, node: Node, step: float) -> Node | None:
        """The node at the other end of a cell; None where the cell is too wide."""
        by = np.array([0.5 * step, step])
        place, turn = node.ahead(by)
        half = np.array([0.5 * abs(step) * (1.0 + 1e-9), 0.0])
        solved = self.solve(node.theta + by, half, place, turn)
        body = solved.body
        if not (solved.closed.all() and solved.sure.all()):
            return None
        if np.any(np.sign(solved.det) != math.copysign(1.0, node.det)):
            return None
        assert body.error is not None
        assert body.anchor.error is not None
        e, t = float(body.anchor.error.position[0]), float(body.error.theta[0])
        x, y = body.anchor.p.x, body.anchor.p.y
        phi = np.arctan2(body.turn.y, body.turn.x)
        ends = ((node.x, node.y, node.phi), (float(x[1]), float(y[1]), float(phi[1])))
        for px, py, angle in ends:
            off = abs(math.remainder(angle - float(phi[0]), math.tau))
            if math.hypot(px - float(x[0]), py - float(y[0])) > e or off > t:
                return None
        nearest = node.phi + math.remainder(float(phi[1]) - node.phi, math.tau)
        return _node(node.theta + step, solved, 1, nearest)

    def _same(self, node: Node, first: Node) -> bool:
        apart = math.hypot(node.x - first.x, node.y - first.y)
        turned = abs(math.remainder(node.phi - first.phi, math.tau))
        return apart <= SAME * self.size_m and turned <= SAME

    def _end(self, last: Node, way: float) -> None:
        """The end beside a node: where it no longer closes on its side, or where it can not be
        told from another that it crosses."""
        open_ = last.theta + way * 4.0 * self._room(last)
        closes = last.theta
        for _ in range(BISECTIONS):
            middle = 0.5 * (closes + open_)
            if self._closes(last, middle):
                closes = middle
            else:
                open_ = middle
        kind: EndKind = "change point" if self._crosses(last, closes, way) else "limit position"
        end = End(closes, kind)
        if way > 0.0:
            self.high = end
        else:
            self.low = end

    def _room(self, last: Node) -> float:
        """About how far a limit position is: the determinant goes as the root of the distance."""
        return max(abs(last.det) / max(abs(last.dphi), 1e-300), 16.0 * NARROWEST)

    def _closes(self, last: Node, theta: float) -> bool:
        place, turn = Vec(np.array([last.x]), np.array([last.y])), last.ahead(np.zeros(1))[1]
        solved = self.solve(np.array([theta]), np.zeros(1), place, turn)
        return bool(solved.closed[0]) and float(solved.det[0]) * self.side > 0.0

    def _crosses(self, last: Node, end: float, way: float) -> bool:
        """Whether the rates stay finite: at a limit position they grow as the determinant falls."""
        before = next(
            (n for n in reversed(self.nodes) if way * (last.theta - n.theta) > 0.0
             and abs(n.det) >= 2.0 * abs(last.det)),
            None,
        )  # fmt: skip
        if before is None:
            return False
        growth = _speed(last, self.size_m) / max(_speed(before, self.size_m), 1e-300)
        return growth < 1.0 + 0.5 * (abs(before.det / last.det) - 1.0)

    def home(self, theta: Array) -> Array:
        """Driver angles, by whole periods (or turns) to where the track is."""
        low, high = self.table[0, 0], self.table[-1, 0]
        if self.period is not None:
            return np.asarray(low + np.remainder(theta - low, self.period))
        if self.low is None or self.high is None:
            return theta
        width = self.high.theta - self.low.theta
        if width >= math.tau:
            return theta
        middle = 0.5 * (low + high)
        return np.asarray(theta - math.tau * np.round((theta - middle) / math.tau))

    def beyond(self, theta: Array) -> Array:
        """How far driver angles, brought home, are beyond the ends [rad]; below 0 within."""
        if self.period is not None:
            return np.full(theta.shape, -math.pi)
        low = -np.inf if self.low is None else self.low.theta
        high = np.inf if self.high is None else self.high.theta
        return np.clip(np.maximum(low - theta, theta - high), -math.pi, math.pi)

    def guess(self, theta: Array) -> tuple[Vec, Vec]:
        """The pose at driver angles that were brought home: by cubics between the nodes."""
        table = self.table
        at = np.clip(theta, table[0, 0], table[-1, 0])
        k = np.clip(np.searchsorted(table[:, 0], at, side="right") - 1, 0, max(len(table) - 2, 0))
        left, right = table[k], table[np.minimum(k + 1, len(table) - 1)]
        width = right[:, 0] - left[:, 0]
        width = np.where(width > 0.0, width, 1.0)
        s = (at - left[:, 0]) / width
        h = ((1 + 2 * s) * (1 - s) ** 2, s * (1 - s) ** 2, s * s * (3 - 2 * s), s * s * (s - 1))
        x, y, phi = (
            h[0] * left[:, i] + h[1] * width * left[:, i + 3]
            + h[2] * right[:, i] + h[3] * width * right[:, i + 3]
            for i in (1, 2, 3)
        )  # fmt: skip
        return Vec(x, y), Vec(np.cos(phi), np.sin(phi))

    def on_side(self, det: Array) -> Mask:
        """Whether an assembly with such a determinant is this one, and not the one that it meets
        at its end."""
        return np.asarray(det * self.side > 0.0)


def _speed(node: Node, size_m: float) -> float:
    return math.hypot(node.dx, node.dy, size_m * node.dphi)


def _node(theta: float, solved: SolvedPlatform, index: int, phi: float) -> Node:
    body = solved.body
    at = body.anchor
    each = (at.p.x, at.p.y, at.v.x, at.v.y, body.omega, solved.det)
    x, y, dx, dy, dphi, det = (float(np.broadcast_to(v, solved.det.shape)[index]) for v in each)
    return Node(theta, x, y, phi, dx, dy, dphi, det)


def start_node(theta: float, solved: SolvedPlatform, phi: float) -> Node:
    """The node of one solved sample, its angle the one that is nearest to ``phi`` [rad]."""
    body = solved.body
    found = float(np.arctan2(body.turn.y, body.turn.x)[0])
    return _node(theta, solved, 0, phi + math.remainder(found - phi, math.tau))
