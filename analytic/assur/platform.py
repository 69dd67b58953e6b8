"""The central link of a triad over a chunk of samples, from a guess: place, rates, bounds.

Three rows, linear in each level of motion by one and the same matrix of wrenches: place by Newton's
method, rates and second rates directly. The certificate is that of `analytic.dyads.parts` in three
unknowns: residuals and errors of known values, through the inverse of the matrix, bound the
unknowns to first order, and up to twice that bounds them fully where the matrix changes little over
that distance (Newton-Kantorovich). Then the assembly is the only one nearby. Elsewhere no angle is
certain, nor any rate.
"""

from __future__ import annotations

import functools
import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Protocol

import numpy as np

from analytic.assur.sampled_rows import Gap, SampledRow
from analytic.dyads import plane
from analytic.dyads.plane import EPS, AngleError, BodyKinematics, PointError, Real, Vec, sample
from models.array import Array, Mask
from models.motion import Order

STEPS = 12
"""Most steps of Newton's method; a good guess takes two or three."""
TURN = 0.5
"""Largest turn of one step [rad]."""


@dataclass(frozen=True)
class Wrenches:
    """Inverse of the matrix whose rows are n and r x n over a length: by column three numbers, the
    last over that length; ``det`` over the product of the lengths of the rows is in [-1, 1]."""

    columns: Sequence[plane.Three]
    size_m: float
    det: Real

    @staticmethod
    def of(rows: Sequence[SampledRow], body: BodyKinematics, size_m: float) -> Wrenches:
        wrenches = (row.wrench(body) for row in rows)
        a, b, c = ((n.x, n.y, turning / size_m) for n, turning in wrenches)
        crosses = (plane.cross_three(b, c), plane.cross_three(c, a), plane.cross_three(a, b))
        det = plane.dot_three(a, crosses[0])
        with np.errstate(divide="ignore", invalid="ignore"):
            inverse = 1.0 / det
            columns = [(x * inverse, y * inverse, z * inverse) for x, y, z in crosses]
            sine = det / np.sqrt(
                plane.dot_three(a, a) * plane.dot_three(b, b) * plane.dot_three(c, c)
            )
        return Wrenches(columns, size_m, sine)

    def solve(self, gaps: Sequence[Real]) -> tuple[Vec, Real]:
        """Return the shift [m] and the turn [rad] that lower the rows by these gaps."""
        x, y, z = (
            sum(column[i] * gap for column, gap in zip(self.columns, gaps, strict=True))
            for i in range(3)
        )
        return Vec(x, y), z / self.size_m

    def bound(self, gaps: Sequence[Real]) -> tuple[Real, Real]:
        """Return the largest shift and turn for rows with these errors."""
        x, y, z = (
            sum(np.abs(column[i]) * gap for column, gap in zip(self.columns, gaps, strict=True))
            for i in range(3)
        )
        return np.hypot(x, y), z / self.size_m


@dataclass(frozen=True)
class SolvedPlatform:
    """Solved central link, with bounds if required; ``det`` in [-1, 1] is singular at 0, and of one
    sign from one singular position to the next. ``closed`` marks convergence of Newton's method to
    an assembly, and ``sure`` the only one within the bounds."""

    body: BodyKinematics
    det: Array
    closed: Mask
    sure: Mask


@np.errstate(all="ignore")
def solve_platform(
    rows: Sequence[SampledRow], place: Vec, turn: Vec, size_m: float, *, certified: bool
) -> SolvedPlatform:
    """Solve for the central link near a guess.

    Parameters
    ----------
    rows : three of them
    place, turn : Vec
        The guess: the anchor [m] and the direction of the link's frame, shape (T,).
    size_m : float
        A length of the link, which weighs angles against distances.
    certified : bool
        Give bounds; the parts of the rows must then carry theirs.
    """
    body, closed = _placed(rows, place, turn, size_m)
    wrenches = Wrenches.of(rows, body, size_m)
    body = _moving(rows, body, wrenches)
    det = np.asarray(wrenches.det)
    if not certified:
        return SolvedPlatform(body, det, closed, closed)
    body, sure = _bounded(rows, body, wrenches)
    return SolvedPlatform(body, det, closed, sure)


def _placed(
    rows: Sequence[SampledRow], place: Vec, turn: Vec, size_m: float
) -> tuple[BodyKinematics, Mask]:
    """Iterate by Newton's method; return the link and the mask of convergence."""
    body = _still(place, turn)
    last = np.full(np.shape(place.x), np.inf)
    for _ in range(STEPS):
        wrenches = Wrenches.of(rows, body, size_m)
        shift, by = wrenches.solve(_gaps(rows, 0, body))
        length = size_m + place.norm()
        least = np.minimum(1.0, TURN / np.maximum(np.abs(by) + shift.norm() / length, 1e-300))
        move = shift.norm() + size_m * np.abs(by)
        place, by = place - shift * least, -by * least
        turn = turn.turned(Vec(np.cos(by), np.sin(by)))
        turn = turn * (1.0 / turn.norm())
        body = _still(place, turn)
        settled = ~(move > 64 * EPS * (size_m + place.norm())) | ~(move < 0.5 * last)
        last = move
        if settled.all():
            break
    worst = functools.reduce(np.maximum, map(np.abs, _gaps(rows, 0, body)))
    return body, np.asarray(worst <= 1e-10 * (size_m + place.norm()))


def _still(place: Vec, turn: Vec) -> BodyKinematics:
    anchor = plane.PointKinematics(place, plane.ZERO, plane.ZERO, None)
    return BodyKinematics((0.0, 0.0), anchor, turn, 0.0, 0.0, None)


def _moving(rows: Sequence[SampledRow], body: BodyKinematics, wrenches: Wrenches) -> BodyKinematics:
    """Add the rates, from those of the rows of a link at rest, and the second ones likewise."""
    velocity, omega = wrenches.solve(_gaps(rows, 1, body))
    anchor = plane.PointKinematics(body.anchor.p, -velocity, plane.ZERO, None)
    body = replace(body, anchor=anchor, omega=-omega)
    pull, alpha = wrenches.solve(_gaps(rows, 2, body))
    return replace(body, anchor=replace(anchor, a=-pull), alpha=-alpha)


def _gaps(rows: Sequence[SampledRow], order: Order, body: BodyKinematics) -> list[Real]:
    return [row.gap(order, body)[0] for row in rows]


def _bounded(
    rows: Sequence[SampledRow], body: BodyKinematics, wrenches: Wrenches
) -> tuple[BodyKinematics, Mask]:
    """Return the link with bounds of all levels, and the mask where they are certain."""
    size = wrenches.size_m
    exact = replace(
        body, anchor=replace(body.anchor, error=plane.EXACT_POINT), error=plane.EXACT_ANGLE
    )
    shift, by = wrenches.bound(_loose(rows, 0, exact))
    # A box of up to twice the first order, in the larger of both measures.
    e = 2.02 * np.maximum(shift, size * by) + EPS * size
    t = e / size
    near = widened(body, e, t)
    sways = (row.sway(near) for row in rows)
    change = [lean * e + (turning + 8 * EPS * size) * t + 8 * EPS * e for lean, turning in sways]
    grown, more = wrenches.bound(change)
    # The second order takes no more than the first.
    share = np.maximum(grown, size * more) / e
    sure = np.asarray((share <= 0.49) & (t < 1.0))
    e, t = np.where(sure, shift + grown, np.inf), np.where(sure, by + more, math.pi)
    lost = np.where(sure, 1.0 / (1.0 - share), np.inf)
    near = widened(body, e, t)
    v, w = _weighed(wrenches.bound(_loose(rows, 1, near)), lost, size)
    near = _within(body, PointError(e, v, 0.0), AngleError(t, w, 0.0))
    a, g = _weighed(wrenches.bound(_loose(rows, 2, near)), lost, size)
    point = PointError(e, _infinite(v, sure), _infinite(a, sure))
    return _within(body, point, AngleError(t, _infinite(w, sure), _infinite(g, sure))), sure


def _weighed(bound: tuple[Real, Real], lost: Real, size_m: float) -> tuple[Real, Real]:
    """Return bounds through an inverse with a relative error, in the larger of both measures."""
    shift, by = bound
    most = np.maximum(shift, size_m * by) * (lost - 1.0)
    return shift + most, by + most / size_m


def _infinite(bound: Real, sure: Mask) -> Real:
    return np.where(sure & ~np.isnan(bound), bound, np.inf)


def _within(body: BodyKinematics, point: PointError, angle: AngleError) -> BodyKinematics:
    return replace(body, anchor=replace(body.anchor, error=point), error=angle)


def widened(body: BodyKinematics, e: Real, t: Real) -> BodyKinematics:
    """Return a pose that is known except ``e`` [m] in its place and ``t`` [rad] in its angle."""
    return _within(body, PointError(e, 0.0, 0.0), AngleError(t, 0.0, 0.0))


def _loose(rows: Sequence[SampledRow], order: Order, body: BodyKinematics) -> list[Real]:
    return [largest(row.gap(order, body)) for row in rows]


def largest(gap: Gap) -> Real:
    """Return the largest possible size of a gap."""
    return np.abs(gap[0]) + gap[1]


class RowsAt(Protocol):
    """Function of driver angles [rad], (T,), each uncertain by ``half``: the rows, at 1 rad/s."""

    def __call__(self, theta: Array, half: Array) -> Sequence[SampledRow]: ...


@dataclass(frozen=True)
class CentralPose:
    """Central link at a driver angle: place of its anchor [m], angle [rad], rates by it."""

    theta: float
    place: tuple[float, float]
    angle: float
    rate: tuple[float, float]
    omega: float
    second: tuple[float, float]
    alpha: float
    det: float


def pose_at(rows: RowsAt, theta: float, place: Vec, turn: Vec, size_m: float) -> CentralPose | None:
    """Return the assembly nearest to a guess, one sample; None where none is certain."""
    at = np.array([theta])
    own = rows(at, 8 * EPS * np.abs(at))
    solved = solve_platform(own, place, turn, size_m, certified=True)
    if not (solved.closed[0] and solved.sure[0]):
        return None
    return pose_of(solved.body, solved.det, theta, 0, math.atan2(turn.y[0], turn.x[0]))


def pose_of(body: BodyKinematics, det: Array, theta: float, k: int, near: float) -> CentralPose:
    """Return one sample as a pose, its angle nearest to a given one."""
    turned = math.atan2(sample(body.turn.y, k), sample(body.turn.x, k))
    angle = turned + math.tau * round((near - turned) / math.tau)
    place, rate, second = (
        (sample(vec.x, k), sample(vec.y, k))
        for vec in (body.anchor.p, body.anchor.v, body.anchor.a)
    )
    omega, alpha = sample(body.omega, k), sample(body.alpha, k)
    return CentralPose(theta, place, angle, rate, omega, second, alpha, sample(det, k))


def ahead(pose: CentralPose, theta: Array) -> tuple[Vec, Vec]:
    """Return the prediction of a pose at driver angles, to the second order."""
    d = theta - pose.theta
    half = 0.5 * d * d
    place = Vec(
        pose.place[0] + pose.rate[0] * d + pose.second[0] * half,
        pose.place[1] + pose.rate[1] * d + pose.second[1] * half,
    )
    angle = pose.angle + pose.omega * d + pose.alpha * half
    return place, Vec(np.cos(angle), np.sin(angle))
