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

FIRST, WIDEST, NARROWEST = 0.02, 0.1, 1e-5
"""Cells of the driver's angle [rad]: the first that is tried, the widest, and the narrowest, beside
which the assembly ends."""
MOST_TURNS = 24
"""Of the driver, after which an assembly that has not come back is given up."""
SAME = 1e-7
"""Of the link's size and of an angle [rad]: two poses that are one."""
AT_ONCE = 6
"""Cells that are looked at together: one look costs hardly more than one cell."""
FITTED, APART = 6, 1.6
"""Nodes beside an end that tell where it is, and by how much their determinants differ."""

EndKind = Literal["limit position", "change point"]
Solve = Callable[[Array, Array, Vec, Vec], SolvedPlatform]
"""The central link at driver angles that are uncertain by so much [rad], near a guess; the driver
at unit speed."""


@dataclass(frozen=True)
class End:
    """Where the assembly meets another one: a driver angle [rad], and the pose there."""

    theta: float
    kind: EndKind
    pose: tuple[float, float, float]

    def guess(self, theta: Array, last: Array) -> list[Array]:
        """The pose between the last node, a row of the table, and the end: as the root of the
        distance from a limit position, and as that itself where two assemblies cross."""
        share = np.clip((theta - self.theta) / (last[0] - self.theta), 0.0, 1.0)
        if self.kind == "limit position":
            share = np.sqrt(share)
        return [end + share * (at - end) for end, at in zip(self.pose, last[1:4], strict=True)]


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
    seconds: tuple[float, float, float] = (0.0, 0.0, 0.0)

    def ahead(self, by: Array) -> tuple[Vec, Vec]:
        """The pose that the rates, and second rates, lead to."""
        x, y, phi = (
            at + (rate + 0.5 * second * by) * by
            for at, rate, second in zip(
                (self.x, self.y, self.phi), (self.dx, self.dy, self.dphi), self.seconds, strict=True
            )
        )
        return Vec(x, y), Vec(np.cos(phi), np.sin(phi))


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
    table: Array = field(default_factory=lambda: np.empty((0, 7)))

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
            track._go(-1.0, repeats, farthest)
        rows = [[n.theta, n.x, n.y, n.phi, n.dx, n.dy, n.dphi] for n in track.nodes]
        track.table = np.array(sorted(rows))
        return track

    @property
    def side(self) -> float:
        """The sign of the determinant all along."""
        return math.copysign(1.0, self.nodes[0].det)

    def _go(self, way: float, repeats: float | None, farthest: float) -> None:
        """On from the start, to an end, until it repeats, or as far as is looked."""
        node = first = self.nodes[0]
        width, due = FIRST, repeats
        while True:
            left = (math.inf if due is None else due) - abs(node.theta - first.theta)
            count = min(AT_ONCE, max(1, math.ceil(left / width))) if due is not None else AT_ONCE
            step = min(width, left / count)
            found = self._cells(node, way * step, count)
            self.nodes += found
            if not found:
                width = 0.3 * step
                if width < NARROWEST:
                    self._end(node, way)
                    return
                continue
            node = found[-1]
            width = min(1.5 * max(width, step), WIDEST) if len(found) == count else 0.5 * width
            gone = abs(node.theta - first.theta)
            if due is not None and repeats is not None and gone >= due * (1.0 - 1e-12):
                if self._same(node, first):
                    self.period = due
                    return
                due += repeats
            if due is None and abs(node.theta) >= farthest:
                return
            if gone > MOST_TURNS * math.tau:
                raise CrankcheckError("the assembly has not come back after many turns")

    def _cells(self, node: Node, step: float, count: int) -> list[Node]:
        """The nodes at the ends of cells one after the other, of those that are sure."""
        ends = step * np.arange(1.0, count + 1.0)
        by = np.concatenate([ends - 0.5 * step, ends])
        half = np.repeat([0.5 * abs(step) * (1.0 + 1e-9), 0.0], count)
        solved = self.solve(node.theta + by, half, *node.ahead(by))
        body = solved.body
        assert body.error is not None
        assert body.anchor.error is not None
        good = solved.closed & solved.sure & self.on_side(solved.det)
        x, y, phi = body.anchor.p.x, body.anchor.p.y, np.arctan2(body.turn.y, body.turn.x)
        e, t = body.anchor.error.position, body.error.theta
        found: list[Node] = []
        for k in range(count):
            last = found[-1] if found else node
            inside = [
                math.hypot(px - x[k], py - y[k]) <= e[k]
                and abs(math.remainder(angle - phi[k], math.tau)) <= t[k]
                for px, py, angle in (
                    (last.x, last.y, last.phi),
                    (x[count + k], y[count + k], phi[count + k]),
                )
            ]
            if not (good[k] and good[count + k] and all(inside)):
                break
            nearest = last.phi + math.remainder(float(phi[count + k]) - last.phi, math.tau)
            found.append(_node(node.theta + float(ends[k]), solved, count + k, nearest))
        return found

    def _same(self, node: Node, first: Node) -> bool:
        apart = math.hypot(node.x - first.x, node.y - first.y)
        turned = abs(math.remainder(node.phi - first.phi, math.tau))
        return apart <= SAME * self.size_m and turned <= SAME

    def _end(self, last: Node, way: float) -> None:
        """The end beside a node, by the angle as a function of the determinant, at 0: a series that
        has no linear term at a limit position, and one where two assemblies cross."""
        crosses = self._crosses(last, way)
        beside = [last]
        for node in sorted(self.nodes, key=lambda n: -way * n.theta):
            if len(beside) < FITTED and abs(node.det) > APART * abs(beside[-1].det):
                beside.append(node)
        dets = np.array([node.det for node in beside]) / beside[-1].det
        powers = np.arange(len(beside)) + (0 if crosses else np.arange(len(beside)) > 0)
        thetas = np.array([node.theta - last.theta for node in beside])
        theta = last.theta + float(np.linalg.solve(dets[:, None] ** powers, thetas)[0])
        poses = np.array([(node.x, node.y, node.phi) for node in beside])
        x, y, phi = np.linalg.solve(dets[:, None] ** np.arange(len(beside)), poses)[0].tolist()
        end = End(theta, "change point" if crosses else "limit position", (x, y, phi))
        if way > 0.0:
            self.high = end
        else:
            self.low = end

    def _crosses(self, last: Node, way: float) -> bool:
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
        for end, last, outside in (
            (self.low, table[0], theta < table[0, 0]),
            (self.high, table[-1], theta > table[-1, 0]),
        ):
            if end is not None and outside.any():
                poses = end.guess(theta, last)
                x, y, phi = (
                    np.where(outside, *each) for each in zip(poses, (x, y, phi), strict=True)
                )
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
    each = (at.p.x, at.p.y, at.v.x, at.v.y, body.omega, solved.det, at.a.x, at.a.y, body.alpha)
    x, y, dx, dy, dphi, det, *seconds = (
        float(np.broadcast_to(one, solved.det.shape)[index]) for one in each
    )
    return Node(theta, x, y, phi, dx, dy, dphi, det, (seconds[0], seconds[1], seconds[2]))


def start_node(theta: float, solved: SolvedPlatform, phi: float) -> Node:
    """The node of one solved sample, its angle the one that is nearest to ``phi`` [rad]."""
    body = solved.body
    found = float(np.arctan2(body.turn.y, body.turn.x)[0])
    return _node(theta, solved, 0, phi + math.remainder(found - phi, math.tau))
