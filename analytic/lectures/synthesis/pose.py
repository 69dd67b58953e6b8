"""Positions of a body in the plane, the poles and bisectors between them, and pairs of dyads."""

import cmath
import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from models.array import Array
from models.errors import CrankcheckError

PARALLEL = 1e-9
"""Angle [rad] between two positions below which they are a pure translation: its pole lies beyond
all distances of a mechanism."""


@dataclass(frozen=True)
class PlanePose:
    """Position of a body: its reference point [m], and the angle of its own x-axis [rad]."""

    point: complex
    angle: float

    def at(self, place: complex) -> complex:
        """Return the place in the plane of a place in the body's own frame."""
        return self.point + cmath.exp(1j * self.angle) * place

    def back(self, place: complex) -> complex:
        """Return the place in the body's own frame of a place in the plane."""
        return (place - self.point) * cmath.exp(-1j * self.angle)


@dataclass(frozen=True)
class Bisector:
    """Line of all points as far from one place as from another."""

    middle: complex
    along: complex
    """Unit vector, a quarter turn to the left of the way from the first place to the second."""

    def at(self, distance: float) -> complex:
        """Return the point at a distance from the middle."""
        return self.middle + distance * self.along


def bisector(first: complex, second: complex) -> Bisector:
    """Return the bisector of two places. Raises CrankcheckError where they coincide."""
    across = second - first
    if across == 0.0:
        raise CrankcheckError(
            f"a point that stays at ({first.real:g}, {first.imag:g}) m has no bisector between its "
            "places; move it, or take it for a fixed pivot"
        )
    return Bisector(0.5 * (first + second), 1j * across / abs(across))


def turn_between(first: PlanePose, second: PlanePose) -> float:
    """Return the angle from one position to another [rad], in (-pi, pi]."""
    turn = math.remainder(second.angle - first.angle, math.tau)
    return math.pi if turn == -math.pi else turn


def pole(first: PlanePose, second: PlanePose) -> complex | None:
    """Return the rotopole, about which a body turns from one position into the other; None for a
    pure translation, whose pole is at infinity, across the way."""
    turn = turn_between(first, second)
    if abs(turn) < PARALLEL:
        return None
    rotation = cmath.exp(1j * (second.angle - first.angle))
    return (second.point - rotation * first.point) / (1.0 - rotation)


def circle_through(a: complex, b: complex, c: complex) -> complex | None:
    """Return the centre of the circle through three points; None where they lie on a line."""
    p, q = b - a, c - a
    across = (p.conjugate() * q).imag
    if abs(across) <= 1e-12 * abs(p) * abs(q):
        return None
    return a + 1j * (p * abs(q) ** 2 - q * abs(p) ** 2) / (2.0 * across)


def refuse_coinciding(poses: Sequence[PlanePose], size: float) -> None:
    """Refuse coincident positions, over a ``size`` [m]. Raises CrankcheckError."""
    for j, second in enumerate(poses):
        for i, first in enumerate(poses[:j]):
            near = abs(second.point - first.point) <= 1e-9 * size
            if near and abs(turn_between(first, second)) <= PARALLEL:
                raise CrankcheckError(
                    f"positions {i + 1} and {j + 1} coincide; give positions that differ in place "
                    "or in angle"
                )


@dataclass(frozen=True)
class PoseDyad:
    """Crank: its fixed pivot [m], its moving pivot in the body's own frame [m]."""

    fixed: complex
    moving: complex

    def radius(self, poses: Sequence[PlanePose]) -> float:
        """Return the distance of its pivots [m]."""
        return abs(poses[0].at(self.moving) - self.fixed)

    def turns(self, poses: Sequence[PlanePose]) -> list[float]:
        """Return its angle in each position [rad]."""
        return [cmath.phase(pose.at(self.moving) - self.fixed) for pose in poses]


def about_bisector(poses: Sequence[PlanePose], moving: complex, distance_m: float) -> PoseDyad:
    """Dyad of two positions: fixed pivot on the bisector of a moving one's places, at a distance
    from the middle, to the left of its way. Raises CrankcheckError for a point that stays."""
    first, second = (pose.at(moving) for pose in poses)
    return PoseDyad(bisector(first, second).at(distance_m), moving)


FAR = 1e4
"""Radius of a circle, over the way on it, beyond which it is a line: no crank is so long."""


@dataclass(frozen=True)
class PoseSlide:
    """Point on a line, in place of a crank whose centre is at infinity: a moving point of the body
    [m, own frame] on a line of the ground, or ``inverted`` a fixed point on a line of the body. The
    line goes through a place [m] of its own body, in a direction [rad]; the point is up to ``off``
    [m] beside it."""

    point: complex
    through: complex
    direction: float
    inverted: bool = False
    off: float = 0.0

    @staticmethod
    def of(places: Sequence[complex], point: complex, *, inverted: bool = False) -> "PoseSlide":
        """Take the line through the two places furthest apart."""
        one, other = max(itertools.combinations(places, 2), key=lambda two: abs(two[1] - two[0]))
        along = (other - one) / (abs(other - one) or 1.0) or 1.0
        off = max(abs(((place - one) / along).imag) for place in places)
        return PoseSlide(point, one, cmath.phase(along), inverted, off)


def about_circumcentre(poses: Sequence[PlanePose], moving: complex) -> PoseDyad | PoseSlide:
    """Return the dyad of three positions: the fixed pivot in the middle of the circle through a
    moving one's places; a slide where they lie on a line."""
    places = [pose.at(moving) for pose in poses]
    return crank_or_slide(places, circle_through(*places), moving)


def crank_or_slide(
    places: Sequence[complex], centre: complex | None, moving: complex
) -> PoseDyad | PoseSlide:
    """Return the crank about the centre of places, or a slide where it is too far away."""
    near = _is_near(centre, places)
    return PoseDyad(centre, moving) if near and centre is not None else PoseSlide.of(places, moving)


def about_given_pivot(poses: Sequence[PlanePose], fixed: complex) -> PoseDyad | PoseSlide:
    """Return the dyad of three positions and a fixed pivot, by inversion: seen from the body the
    pivot is in three places, and the middle of their circle is the moving pivot; a slide of the
    body where they lie on a line."""
    seen = [pose.back(fixed) for pose in poses]
    centre = circle_through(*seen)
    if centre is None or not _is_near(centre, seen):
        return PoseSlide.of(seen, fixed, inverted=True)
    return PoseDyad(fixed, centre)


def _is_near(centre: complex | None, places: Sequence[complex]) -> bool:
    way = max(abs(place - places[0]) for place in places)
    return centre is not None and abs(centre - places[0]) <= FAR * way


@dataclass(frozen=True)
class SoundPairs:
    """All pairs of dyads, driven at the first, (K, 2): those without a defect first, ``sound`` of
    them, the best transmitting before others."""

    pairs: NDArray[np.intp]
    sound: int


def sound_pairs(poses: Sequence[PlanePose], dyads: Sequence[PoseDyad]) -> SoundPairs:
    """Return the pairs, those first whose first crank leads through the poses in order and in one
    assembly; each part by the least sine of the transmission angle in the poses. They are chosen
    among thousands, and examined by the reference afterwards."""
    fixed = np.array([dyad.fixed for dyad in dyads])
    own = np.array([dyad.moving for dyad in dyads])
    places = np.array([[pose.at(dyad.moving) for dyad in dyads] for pose in poses])
    radius = np.abs(places[0] - fixed)
    i, k = np.nonzero(~np.eye(len(dyads), dtype=bool))
    ground, coupler = fixed[k] - fixed[i], np.abs(own[k] - own[i])
    a, c, d = radius[i], radius[k], np.abs(ground)
    with np.errstate(divide="ignore", invalid="ignore"):
        crank = (places[:, i] - fixed[i]) / ground * d
        side = ((fixed[k] - places[:, i]).conj() * (places[:, k] - places[:, i])).imag
        sine = np.abs(_cross(places[:, k] - places[:, i], places[:, k] - fixed[k])) / (coupler * c)
    same_sign = np.all(side > 0.0, axis=0) | np.all(side < 0.0, axis=0)
    turns = (a + d <= coupler + c) & (np.abs(a - d) >= np.abs(coupler - c))
    angles = np.angle(crank)
    sound = same_sign & np.where(turns, _in_turn(angles), _in_swing(angles, a, coupler, c, d))
    sound &= np.isfinite(sine).all(axis=0)
    least = np.nan_to_num(np.min(sine, axis=0), nan=-1.0) + 2.0 * sound
    order = np.argsort(-least, kind="stable")
    return SoundPairs(np.stack([i[order], k[order]], axis=1), int(np.count_nonzero(sound)))


def _cross(one: NDArray[np.complex128], other: NDArray[np.complex128]) -> Array:
    return np.asarray((one.conj() * other).imag)


def _in_turn(angles: Array) -> NDArray[np.bool_]:
    """Return the mask of cranks that meet their angles (N, K) in order within a turn one way."""
    ways = np.diff(angles, axis=0) % (2.0 * np.pi)
    back = -np.diff(angles, axis=0) % (2.0 * np.pi)
    in_order = (ways.sum(axis=0) < 2.0 * np.pi) | (back.sum(axis=0) < 2.0 * np.pi)
    return np.asarray(in_order)


def _in_swing(angles: Array, a: Array, b: Array, c: Array, d: Array) -> NDArray[np.bool_]:
    """Return the mask of swinging cranks that meet their angles (N, K), from the ground's
    direction, in order and within one range: about 0, about pi, or one on either side."""
    # B is |a - d| from D at angle 0, a + d at pi: beyond coupler and output, or too near.
    no_pi, no_zero = a + d > b + c, np.abs(a - d) < np.abs(b - c)
    turned = np.where(no_zero, angles % (2.0 * np.pi), angles)
    ways = np.diff(turned, axis=0)
    in_order = np.all(ways > 0.0, axis=0) | np.all(ways < 0.0, axis=0)
    one_side = np.all(angles > 0.0, axis=0) | np.all(angles < 0.0, axis=0)
    return np.asarray(in_order & np.where(no_pi & no_zero, one_side, True))
