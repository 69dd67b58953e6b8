"""The pose of a central link at one driver angle, and where it leads to."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from analytic.assur.platform import solve_platform
from analytic.assur.sampled_rows import SampledRow
from analytic.dyads.plane import EPS, BodyKinematics, Vec
from models.array import Array


class RowsAt(Protocol):
    """The rows at driver angles [rad], (T,), each uncertain by ``half``; the driver at 1 rad/s."""

    def __call__(self, theta: Array, half: Array) -> Sequence[SampledRow]: ...


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


def pose_at(rows: RowsAt, theta: float, place: Vec, turn: Vec, size_m: float) -> Pose | None:
    """The assembly nearest to a guess, one sample; None where there is none that is certain."""
    at = np.array([theta])
    own = rows(at, 8 * EPS * np.abs(at))
    solved = solve_platform(own, place, turn, size_m, certified=True)
    if not (solved.closed[0] and solved.sure[0]):
        return None
    return pose_of(solved.body, solved.det, theta, 0, math.atan2(turn.y[0], turn.x[0]))


def pose_of(body: BodyKinematics, det: Array, theta: float, k: int, near: float) -> Pose:
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
