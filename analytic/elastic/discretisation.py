"""Descriptions of elastic links: the kind and the number of their shapes."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from analytic.elastic.beam import ElasticBody
from analytic.elastic.shapes import HermiteElements, LegendrePolynomials, Shapes, SineModes
from analytic.multibody.bodies import Marker, Markers
from models.array import Array
from models.errors import CrankcheckError
from models.files.elastic_table import SLENDER
from models.motion import Motion
from models.scene import Point, Scene
from models.scene.cut_links import LinkLine, line_of
from models.scene.cut_scenes import segment_spring
from models.scene.elastic import ElasticLink
from models.scene.joints import turned


@dataclass(frozen=True)
class Modes:
    """Ritz and Galerkin's method with so many sines across, and along, each elastic link that
    bends, or stretches."""

    across: int = 5
    along: int = 2

    @property
    def finer(self) -> Polynomials:
        """Polynomials: modes converge too slowly to show the size of their truncation."""
        return Polynomials(max(REFERENCE.across, self.across + 2), self.along + 2)


@dataclass(frozen=True)
class Polynomials:
    """So many polynomials across, and along, each elastic link: the shapes of the reference."""

    across: int = 8
    along: int = 3

    @property
    def finer(self) -> Polynomials:
        return Polynomials(self.across + 2, self.along + 1)


@dataclass(frozen=True)
class Elements:
    """So many beam elements of each elastic link."""

    count: int = 4

    @property
    def finer(self) -> Elements:
        return Elements(2 * self.count)


@dataclass(frozen=True)
class Segments:
    """So many rigid segments with springs between them: the chain that engines get for the beam.
    ``corrected`` springs give the chain the sag of the beam."""

    count: int = 16
    corrected: bool = False

    @property
    def finer(self) -> Segments:
        """The same segments: a chain has no finer description."""
        return self


Discretisation = Polynomials | Modes | Elements | Segments
REFERENCE = Polynomials()
"""The default: good to 1e-9 of the largest deflection, with resonances where the beam has them."""


def flexible_links(
    scene: Scene, by: Discretisation, *, stiffened: bool = True
) -> dict[str, ElasticBody | SegmentedBody]:
    """Return the makers of the bodies of a scene's elastic links, by name.

    Raises
    ------
    CrankcheckError
        Modes that are too short for a beam; none at all.
    """
    _check(scene, by)
    return {name: _flexible(scene, link, by, stiffened) for name, link in scene.elastic.items()}


def _check(scene: Scene, by: Discretisation) -> None:
    """Refuse a description that no elastic link can have. Raises CrankcheckError."""
    for name, link in scene.elastic.items():
        if isinstance(by, Modes | Polynomials):
            counts = [by.across] * link.bends + [by.along] * link.stretches
        else:
            counts = [by.count - isinstance(by, Segments)]
        if min(counts) < 0 or max(counts) < 1:
            raise CrankcheckError(f"{scene.name}: {by} does not describe elastic.{name}; take more")
        if isinstance(by, Modes) and link.bends and link.height_m:
            _check_waves(scene, name, by.across, SLENDER * link.height_m)


def _check_waves(scene: Scene, name: str, count: int, shortest_m: float) -> None:
    length = line_of(scene, name).length_m
    most = int(length / shortest_m * (1.0 + 1e-9))
    if count > most:
        raise CrankcheckError(
            f"{scene.name}: found {count} modes across; the half-waves of the last are "
            f"{length / count:.3g} m long on elastic.{name}, under {SLENDER:g} heights of its "
            f"section, where a beam bends by shear as well; use {most} or fewer"
        )


def _flexible(
    scene: Scene, link: ElasticLink, by: Discretisation, stiffened: bool
) -> ElasticBody | SegmentedBody:
    line = line_of(scene, link.link)
    if isinstance(by, Segments):
        return SegmentedBody(link, line, by.count, by.corrected)
    if isinstance(by, Elements):
        shapes: Shapes = HermiteElements(line.length_m, by.count, link.bends, link.stretches)
    else:
        across, along = by.across if link.bends else 0, by.along if link.stretches else 0
        kind = SineModes if isinstance(by, Modes) else LegendrePolynomials
        shapes = kind(line.length_m, across, along)
    return ElasticBody(link, line, shapes, stiffened)


@dataclass(frozen=True)
class ElasticDoubt:
    """Largest distances of a motion from any of the others, (T,) each: ``middle_m`` and
    ``extension_m`` of each elastic link [m], ``theta_rad`` of each link [rad], and ``torque_n_m``
    of the driver [N m], 0 where nothing drives it.

    Where the error at least halves from a description to the next finer one, it is at most twice
    that change.
    """

    middle_m: Mapping[str, Array]
    extension_m: Mapping[str, Array]
    theta_rad: Mapping[str, Array]
    torque_n_m: Array

    @staticmethod
    def between(motion: Motion, *others: Motion) -> ElasticDoubt:
        """Return the distances of a motion from others at the same instants."""
        shapes, links = motion.elastic, motion.links
        return ElasticDoubt(
            {
                n: _furthest(x.middle, (o.elastic[n].middle for o in others))
                for n, x in shapes.items()
            },
            {
                n: _furthest(x.extension, (o.elastic[n].extension for o in others))
                for n, x in shapes.items()
            },
            {n: _furthest(x.theta, (o.links[n].theta for o in others)) for n, x in links.items()},
            _furthest(_torque(motion), (_torque(other) for other in others)),
        )

    @property
    def so_far(self) -> ElasticDoubt:
        """The largest up to each instant: a motion that has gone astray does not come back."""
        return ElasticDoubt(
            _running(self.middle_m),
            _running(self.extension_m),
            _running(self.theta_rad),
            np.maximum.accumulate(self.torque_n_m),
        )


def _running(series: Mapping[str, Array]) -> Mapping[str, Array]:
    return {name: np.maximum.accumulate(each) for name, each in series.items()}


def _furthest(one: Array, others: Iterable[Array]) -> Array:
    return np.asarray(np.max([np.abs(one - other) for other in others], axis=0))


def _torque(motion: Motion) -> Array:
    return np.zeros(motion.time_s.size) if motion.forces is None else motion.forces.torque


Complexes = NDArray[np.complex128]


@dataclass(frozen=True)
class SegmentedBody:
    """Maker of the chain of a link (`Flexible`): ``count`` segments; ``corrected`` springs make the
    sag of the chain that of the beam.

    ::

        A o--1--@--2--@--3--@ ... --n--o B        @ a pin with a spring, n - 1 of them

    The body is the chain that `models.scene.cut_scenes` makes of an elastic link, so that an
    engine's chain has an exact one to compare with. Its coordinates are those of the first segment,
    then the angle of each segment against the one before it.
    """

    link: ElasticLink
    line: LinkLine
    count: int
    corrected: bool = False

    def body(self, markers: Sequence[Marker], gravity: Point) -> SegmentChain:
        return SegmentChain(self, markers, gravity)


class SegmentChain:
    """One chain (`Body`).

    A place on it, as a complex number, is o + sum_j P_j exp(i theta_j), with theta_j the angles of
    the segments, each of which turns a part P_j of the way.
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
        self.stiffness = np.eye(n - 1) * segment_spring(
            own.link, own.line.length_m, n, corrected=own.corrected
        )
        self.damping = own.link.damping_s * self.stiffness

    def _mark(self, markers: Sequence[Marker]) -> None:
        """Set P of each marker (K, n), its segment, and its angle ahead of that; the frame itself
        has no P."""
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
        """Return exp(i theta) of all segments, (T, n)."""
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
        """Deflections as `Beam` has them, with straight segments."""
        nodes = self._from_start(q)
        line = nodes[:, -1:]
        away = (nodes * line.conj()).imag / np.abs(line)
        at = np.clip((x / self._piece).astype(int), 0, self.own.count - 1)
        share = x / self._piece - at
        return np.asarray((1.0 - share) * away[:, at] + share * away[:, at + 1])

    def extension(self, q: Array) -> Array:
        return np.asarray(np.abs(self._from_start(q)[:, -1]) - self.own.line.length_m)

    def _from_start(self, q: Array) -> Complexes:
        """Return the vectors from A to the ends of all segments, (T, n + 1)."""
        nodes = np.zeros((len(q), self.own.count + 1), dtype=np.complex128)
        nodes[:, 1:] = np.cumsum(self._piece * self._directions(q), axis=1)
        return nodes

    def segment_angles(self, q: Array) -> Array:
        """Return the angles of all segments in the frame of the ground, (n,), from coordinates
        (size,), or their angular velocities from rates."""
        return np.asarray(self._turns @ q)
