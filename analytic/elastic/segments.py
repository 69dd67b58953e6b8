"""A link as a chain of rigid segments with springs between them: what engines make of a bent link.

::

    A o--1--@--2--@--3--@ ... --n--o B        @ a pin with a spring, n - 1 of them

The chain that `models.segmented` makes of an elastic link, as a body of the multibody form: so an
engine's chain has an exact one beside it. Its coordinates are those of the first segment, then the
angle of each segment against the one before it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from analytic.multibody.body_set import Marker, Markers
from models.array import Array
from models.elastic import ElasticLink
from models.elastic_line import Line
from models.scene import Point
from models.segmented import segment_spring


@dataclass(frozen=True)
class SegmentedBody:
    """What makes the chain of a link (`Flexible`): ``count`` segments; ``corrected`` springs make
    the sag of the chain that of the beam."""

    link: ElasticLink
    line: Line
    count: int
    corrected: bool = False

    @property
    def spring_n_m_rad(self) -> float:
        """The rate of one of the springs."""
        return segment_spring(self.link, self.line.length_m, self.count, corrected=self.corrected)

    def body(self, markers: Sequence[Marker], gravity: Point) -> SegmentChain:
        return SegmentChain(self, markers, gravity)


class SegmentChain:
    """One chain (`Body`)."""

    def __init__(self, own: SegmentedBody, markers: Sequence[Marker], gravity: Point) -> None:
        self.own, self._gravity, self._lean = own, gravity, own.line.lean_rad
        n = own.count
        self.size = n + 2
        self.length_m = own.line.length_m
        self.angular = np.arange(self.size) >= 2
        self._piece = own.line.length_m / n
        self._turns = np.zeros((n, self.size))  # d angle of segment / d coordinates
        self._turns[:, 2:] = np.tril(np.ones((n, n)))
        self._start = np.array(own.line.start)
        before = np.tril(np.ones((n, n)), -1)
        self._centres = self._piece * (before + 0.5 * np.eye(n))
        self._mass = own.line.density_kg_m * self._piece
        self._inertia = self._mass * self._piece**2 / 12.0
        self._ahead = np.array([angle for _, angle in markers])
        self._on_link = np.array([place is not None for place, _ in markers], dtype=bool)
        # Of each marker: how far along and across every segment it lies from A.
        self._along, self._across = np.zeros((len(markers), n)), np.zeros((len(markers), n))
        self._of = np.zeros(len(markers), dtype=int)
        for k, (place, _) in enumerate(markers):
            x, y = own.line.along(place or own.line.start)
            i = min(max(int(x / self._piece + 1e-9), 0), n - 1)
            self._of[k] = i
            self._along[k, :i], self._along[k, i] = self._piece, x - i * self._piece
            self._across[k, i] = y
        self.stiffness = np.eye(n - 1) * own.spring_n_m_rad
        self.damping = own.link.damping_s * self.stiffness

    def _directions(self, q: Array) -> tuple[Array, Array]:
        """Along and across every segment, (T, n, 2)."""
        angle = q @ self._turns.T + self._lean
        along = np.stack([np.cos(angle), np.sin(angle)], axis=2)
        return along, np.stack([-along[:, :, 1], along[:, :, 0]], axis=2)

    def _placed(self, q: Array, along_by: Array, across_by: Array) -> tuple[Array, Array, Array]:
        """Places (T, K, 2), their derivatives by the angles of segments (T, K, n, 2), and what
        these make of squares of rates: minus the places from A by segment."""
        along, across = self._directions(q)
        by_segment = along_by[:, :, None] * along[:, None] + across_by[:, :, None] * across[:, None]
        turned_by = along_by[:, :, None] * across[:, None] - across_by[:, :, None] * along[:, None]
        c, s = np.cos(q[:, 2]), np.sin(q[:, 2])
        a_x, a_y = self._start
        base = q[:, :2] + np.stack([c * a_x - s * a_y, s * a_x + c * a_y], axis=1)
        return base[:, None] + by_segment.sum(axis=2), turned_by, by_segment

    def _arm(self, q: Array) -> Array:
        """From A to the origin of the frame, (T, 2)."""
        c, s = np.cos(q[:, 2]), np.sin(q[:, 2])
        a_x, a_y = self._start
        return np.stack([c * a_x - s * a_y, s * a_x + c * a_y], axis=1)

    def _moved(
        self, q: Array, rates: Array, along_by: Array, across_by: Array
    ) -> tuple[Array, Array, Array]:
        """Places (T, K, 2), derivatives by the coordinates (T, K, 2, size), drift (T, K, 2)."""
        place, turned_by, by_segment = self._placed(q, along_by, across_by)
        gradient = np.einsum("tknx,ns->tkxs", turned_by, self._turns)
        arm = self._arm(q)
        gradient[:, :, 0, 0] = gradient[:, :, 1, 1] = 1.0
        gradient[:, :, 0, 2] -= arm[:, None, 1]
        gradient[:, :, 1, 2] += arm[:, None, 0]
        square = (rates @ self._turns.T) ** 2
        drift = -np.einsum("tknx,tn->tkx", by_segment, square)
        drift -= (rates[:, 2] ** 2)[:, None, None] * arm[:, None]
        return place, gradient, drift

    def mark(self, q: Array, rates: Array) -> Markers:
        places, gradients, drifts = self._moved(q, rates, self._along, self._across)
        count, markers = len(q), len(self._of)
        place, drift = np.zeros((count, markers, 3)), np.zeros((count, markers, 3))
        gradient = np.zeros((count, markers, 3, self.size))
        on = self._on_link
        place[:, :, :2] = np.where(on[:, None], places, q[:, None, :2])
        gradient[:, on, :2] = gradients[:, on]
        gradient[:, ~on, 0, 0] = gradient[:, ~on, 1, 1] = 1.0
        drift[:, on, :2] = drifts[:, on]
        turn = np.where(on[:, None], self._turns[self._of], self._turns[0])
        place[:, :, 2] = q @ turn.T + self._ahead
        gradient[:, :, 2] = turn
        return Markers(place, gradient, drift)

    def weigh(self, q: Array, rates: Array) -> tuple[Array, Array]:
        _, gradient, drift = self._moved(q, rates, self._centres, np.zeros_like(self._centres))
        rows = gradient.reshape(len(q), -1, self.size)
        matrix = self._mass * np.swapaxes(rows, 1, 2) @ rows
        matrix += self._inertia * self._turns.T @ self._turns
        felt = (np.array(self._gravity) - drift).reshape(len(q), -1, 1)
        right = self._mass * (np.swapaxes(rows, 1, 2) @ felt)[:, :, 0]
        right[:, 3:] -= q[:, 3:] @ self.stiffness + rates[:, 3:] @ self.damping
        return matrix, right

    def height_energy(self, q: Array) -> Array:
        place, _, _ = self._placed(q, self._centres, np.zeros_like(self._centres))
        strain = 0.5 * np.einsum("ti,ij,tj->t", q[:, 3:], self.stiffness, q[:, 3:])
        return np.asarray(strain - self._mass * (place @ np.array(self._gravity)).sum(axis=1))

    def lost(self, rates: Array) -> Array:
        own = rates[:, 3:]
        return np.asarray(np.einsum("ti,ij,tj->t", own, self.damping, own))

    def deflections(self, q: Array, x: Array) -> Array:
        """As those of `Beam`, with straight segments."""
        nodes, line = self._from_line(q)
        far = np.hypot(line[:, 0], line[:, 1])[:, None]
        across = np.stack([-line[:, 1], line[:, 0]], axis=1) / far
        away = np.einsum("tkx,tx->tk", nodes, across)
        at = np.clip((x / self._piece).astype(int), 0, self.own.count - 1)
        share = x / self._piece - at
        return np.asarray((1.0 - share) * away[:, at] + share * away[:, at + 1])

    def extension(self, q: Array) -> Array:
        _, line = self._from_line(q)
        return np.asarray(np.hypot(line[:, 0], line[:, 1]) - self.own.line.length_m)

    def _from_line(self, q: Array) -> tuple[Array, Array]:
        """From A to the ends of all segments (T, n + 1, 2), and to B (T, 2)."""
        along, _ = self._directions(q)
        nodes = np.zeros((len(q), self.own.count + 1, 2))
        nodes[:, 1:] = np.cumsum(self._piece * along, axis=1)
        return nodes, nodes[:, -1]

    def segment_angles(self, q: Array) -> Array:
        """Of coordinates (size,) the angles of all segments in the frame of the ground, or of rates
        their angular velocities, (n,)."""
        return np.asarray(self._turns @ q)
