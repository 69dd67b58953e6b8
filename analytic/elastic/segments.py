"""A link as a chain of rigid segments with springs between them: what engines make of a bent link.

::

    A o--1--@--2--@--3--@ ... --n--o B        @ a pin with a spring, n - 1 of them

The chain that `models.cut_scenes` makes of an elastic link, as a body of the multibody form: so an
engine's chain has an exact one beside it. Its coordinates are those of the first segment, then the
angle of each segment against the one before it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from analytic.multibody.bodies import Marker, Markers
from models.array import Array
from models.cut_links import Line
from models.cut_scenes import segment_spring
from models.elastic import ElasticLink
from models.joints import turned
from models.scene import Point

Complexes = NDArray[np.complex128]


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
    """One chain (`Body`).

    A place of it is a sum over the segments, each of which turns a part of the way: as complex
    numbers o + sum_j P_j exp(i theta_j), with theta_j the angles of the segments.
    """

    def __init__(self, own: SegmentedBody, markers: Sequence[Marker], gravity: Point) -> None:
        self.own, self._gravity, self._lean = own, complex(*gravity), own.line.lean_rad
        n = own.count
        self.size = n + 2
        self.length_m = own.line.length_m
        self.angular = np.arange(self.size) >= 2
        self._piece = own.line.length_m / n
        self._turns = np.zeros((n, self.size))  # d angle of segment / d coordinates
        self._turns[:, 2:] = np.tril(np.ones((n, n)))
        # From the origin of the frame to A, as seen from the first segment.
        self._start = complex(*turned(own.line.start, -self._lean))
        centres = self._piece * (np.tril(np.ones((n, n)), -1) + 0.5 * np.eye(n)) + 0j
        centres[:, 0] += self._start
        self._mass = own.line.density_kg_m * self._piece
        self._first = self._mass * centres.sum(axis=0)
        self._second = self._mass * centres.T.conj() @ centres
        self._inertia = self._mass * self._piece**2 / 12.0
        self._mark(markers)
        self.stiffness = np.eye(n - 1) * own.spring_n_m_rad
        self.damping = own.link.damping_s * self.stiffness

    def _mark(self, markers: Sequence[Marker]) -> None:
        """P of each marker (K, n), the segment that it is on, and its angle ahead of that; the
        frame itself has none."""
        n = self.own.count
        self._ahead = np.array([angle for _, angle in markers])
        self._parts = np.zeros((len(markers), n), dtype=np.complex128)
        self._of = np.zeros(len(markers), dtype=int)
        for k, (place, _) in enumerate(markers):
            if place is None:
                continue
            x, y = self.own.line.along(place)
            i = min(max(int(x / self._piece + 1e-9), 0), n - 1)
            self._of[k] = i
            self._parts[k, :i], self._parts[k, i] = self._piece, complex(x - i * self._piece, y)
            self._parts[k, 0] += self._start

    def _directions(self, q: Array) -> Complexes:
        """exp(i theta) of all segments, (T, n)."""
        return np.asarray(np.exp(1j * (q @ self._turns.T + self._lean)))

    def mark(self, q: Array, rates: Array) -> Markers:
        way = self._parts * self._directions(q)[:, None]
        count, markers = len(q), len(self._of)
        place, drift = np.zeros((count, markers, 3)), np.zeros((count, markers, 3))
        gradient = np.zeros((count, markers, 3, self.size))
        away, pulled = way.sum(axis=2), -(way * ((rates @ self._turns.T) ** 2)[:, None]).sum(axis=2)
        place[:, :, 0], place[:, :, 1] = q[:, 0:1] + away.real, q[:, 1:2] + away.imag
        drift[:, :, 0], drift[:, :, 1] = pulled.real, pulled.imag
        # A coordinate turns its own segment and all after it.
        after = np.cumsum(way[:, :, ::-1], axis=2)[:, :, ::-1]
        gradient[:, :, 0, 0] = gradient[:, :, 1, 1] = 1.0
        gradient[:, :, 0, 2:], gradient[:, :, 1, 2:] = -after.imag, after.real
        turn = self._turns[self._of]
        place[:, :, 2] = q @ turn.T + self._ahead
        gradient[:, :, 2] = turn
        return Markers(place, gradient, drift)

    def weigh(self, q: Array, rates: Array) -> tuple[Array, Array]:
        direction, square = self._directions(q), (rates @ self._turns.T) ** 2
        first = self._first * direction
        second = direction.conj()[:, :, None] * self._second * direction[:, None]
        count, n, mass = len(q), self.own.count, self._mass * self.own.count
        # By the place of the frame and the angles of the segments.
        matrix, right = np.zeros((count, n + 2, n + 2)), np.empty((count, n + 2))
        matrix[:, 0, 0] = matrix[:, 1, 1] = mass
        matrix[:, 0, 2:], matrix[:, 1, 2:] = -first.imag, first.real
        matrix[:, 2:, 0], matrix[:, 2:, 1] = -first.imag, first.real
        matrix[:, 2:, 2:] = second.real + self._inertia * np.eye(n)
        pulled = mass * self._gravity + (first * square).sum(axis=1)
        right[:, 0], right[:, 1] = pulled.real, pulled.imag
        right[:, 2:] = (first.conj() * self._gravity).imag
        right[:, 2:] += (second.imag @ square[:, :, None])[:, :, 0]
        # By the coordinates.
        turns = np.eye(n + 2)
        turns[2:] = self._turns
        matrix, right = turns.T @ (matrix @ turns), right @ turns
        right[:, 3:] -= q[:, 3:] @ self.stiffness + rates[:, 3:] @ self.damping
        return matrix, right

    def height_energy(self, q: Array) -> Array:
        mass, first = self._mass * self.own.count, self._directions(q) @ self._first
        strain = 0.5 * np.einsum("ti,ij,tj->t", q[:, 3:], self.stiffness, q[:, 3:])
        weighed = (mass * q[:, 0] + first.real) * self._gravity.real
        weighed += (mass * q[:, 1] + first.imag) * self._gravity.imag
        return np.asarray(strain - weighed)

    def lost(self, rates: Array) -> Array:
        own = rates[:, 3:]
        return np.asarray(np.einsum("ti,ij,tj->t", own, self.damping, own))

    def deflections(self, q: Array, x: Array) -> Array:
        """As those of `Beam`, with straight segments."""
        nodes = self._from_start(q)
        line = nodes[:, -1:]
        away = (nodes * line.conj()).imag / np.abs(line)
        at = np.clip((x / self._piece).astype(int), 0, self.own.count - 1)
        share = x / self._piece - at
        return np.asarray((1.0 - share) * away[:, at] + share * away[:, at + 1])

    def extension(self, q: Array) -> Array:
        return np.asarray(np.abs(self._from_start(q)[:, -1]) - self.own.line.length_m)

    def _from_start(self, q: Array) -> Complexes:
        """From A to the ends of all segments, (T, n + 1)."""
        nodes = np.zeros((len(q), self.own.count + 1), dtype=np.complex128)
        nodes[:, 1:] = np.cumsum(self._piece * self._directions(q), axis=1)
        return nodes

    def segment_angles(self, q: Array) -> Array:
        """Of coordinates (size,) the angles of all segments in the frame of the ground, or of rates
        their angular velocities, (n,)."""
        return np.asarray(self._turns @ q)
