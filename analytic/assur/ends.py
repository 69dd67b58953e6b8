"""Where an assembly ends, and as what, told by its last poses."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

import numpy as np

from analytic.assur.pose import Pose

FAR = 1e3
"""Times the lengths at the start that a link is away when it runs to infinity."""
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


def end_beside(poses: list[Pose], way: float, size_m: float) -> End:
    """Where the determinant goes to zero, and how: like the root of the way that is left, or like
    the way itself; and whether the link is far away there."""
    last = poses[-1]
    reach = np.array([math.hypot(*pose.place) for pose in poses])
    if reach[-1] > FAR * (reach[0] + size_m):
        # The inverse of the distance is linear in the way.
        far = next(k for k in range(len(poses) - 1, -1, -1) if reach[k] < 0.5 * reach[-1])
        left = abs(last.theta - poses[far].theta) / (reach[-1] / reach[far] - 1.0)
        return End(last.theta + way * left, "run to infinity")
    theta = np.array([pose.theta for pose in poses[:-1]])
    det = np.abs([pose.det for pose in poses[:-1]])
    away = np.abs(theta - last.theta)
    near = [int(np.argmin(np.abs(np.log(np.maximum(away, 1e-300) / d)))) for d in (1e-5, 1e-3)]
    a, b = near
    if a == b or not 0.0 < det[a] < det[b]:
        return End(last.theta, "doubtful position")
    power = math.log(det[b] / det[a]) / math.log(away[b] / away[a])
    if power < 0.2 or power > 1.4:
        return End(last.theta, "doubtful position")
    kind: EndKind = "limit position" if power < 0.75 else "change point"
    order = 2.0 if kind == "limit position" else 1.0
    # The power of the determinant that is linear in the way is 0 a little beyond the last pose.
    ends = [det[a] ** order, abs(last.det) ** order]
    slope = (ends[0] - ends[1]) / away[a]
    return End(last.theta + way * (ends[1] / slope if slope > 0.0 else 0.0), kind)
