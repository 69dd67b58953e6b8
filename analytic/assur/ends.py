"""Where an assembly ends, and as what, told by its last poses."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

import numpy as np

from analytic.assur.pose import Pose

FAR, SOON = 100.0, 5e-3
"""Times its size that a link is away when it runs to infinity, and a driver angle [rad]."""
EndKind = Literal["limit position", "change point", "run to infinity", "doubtful position"]


@dataclass(frozen=True)
class End:
    """Where a track ends or crosses another one: driver angle [rad], and as what.

    In a limit position two assemblies meet, and are no more beyond; in a change point two meet, and
    both go on. A run to infinity has a link whose lines become parallel. A doubtful position is
    none of these for sure: where what the group hangs on ends, say.
    """

    theta: float
    kind: EndKind


def end_beside(poses: list[Pose], way: float) -> End:
    """Where the determinant goes to zero, and how: like the root of the way that is left, or like
    the way itself."""
    last = poses[-1]
    theta = np.array([pose.theta for pose in poses[:-1]])
    det = np.abs([pose.det for pose in poses[:-1]])
    away = np.abs(theta - last.theta)
    near = [int(np.argmin(np.abs(np.log(np.maximum(away, 1e-300) / d)))) for d in (1e-5, 1e-3)]
    a, b = near
    if a == b or not 0.0 < det[a] < det[b]:
        return End(last.theta, "doubtful position")
    rates = [math.hypot(*poses[k].rate) for k in near]
    if rates[0] > 0.01 * (away[b] / away[a]) ** 2 * rates[1] > 0.0:
        return End(last.theta, "run to infinity")  # its speed goes as the inverse square of the way
    power = math.log(det[b] / det[a]) / math.log(away[b] / away[a])
    if power < 0.2 or power > 1.4:
        return End(last.theta, "doubtful position")
    kind: EndKind = "limit position" if power < 0.75 else "change point"
    order = 2.0 if kind == "limit position" else 1.0
    # The power of the determinant that is linear in the way is 0 a little beyond the last pose.
    ends = [det[a] ** order, abs(last.det) ** order]
    slope = (ends[0] - ends[1]) / away[a]
    left = ends[1] / slope if slope > 0.0 else 0.0
    return End(float(last.theta + way * left), kind)


def runs_away(start: Pose, last: Pose, size_m: float) -> bool:
    """Whether a link is far away, and grows twice as far before the driver has moved on by
    `SOON`: it runs to infinity."""
    away, rate = _away(start, last), math.hypot(*last.rate)
    return away > FAR * (size_m + math.hypot(*start.rate)) and away < SOON * rate


def end_at_infinity(poses: list[Pose]) -> End:
    """Where a link that runs away will be at infinity: the driver angle is a smooth function of
    the inverse of its distance, here a polynomial through five of its poses."""
    start, last = poses[0], poses[-1]
    inverse, theta = [1.0 / _away(start, last)], [last.theta]
    for pose in reversed(poses[1:]):
        if 2.0 * inverse[-1] * _away(start, pose) < 1.0 and len(theta) < 5:
            inverse.append(1.0 / _away(start, pose))
            theta.append(pose.theta)
    powers = np.arange(len(theta))
    scaled = np.array(inverse)[:, None] / inverse[-1]
    return End(float(np.linalg.solve(scaled**powers, np.array(theta))[0]), "run to infinity")


def _away(start: Pose, pose: Pose) -> float:
    """How far a pose is from that at the start [m]."""
    return math.hypot(pose.place[0] - start.place[0], pose.place[1] - start.place[1])
