"""How far each dyad of a motion stays from where its motion is not determined.

The conditioning of a dyad is the sine of its transmission angle or its like, a pure number for the
direction in which its parts lie. That of an RPR dyad whose line goes through the pin of its link is
always 1, though nothing says where the link points when the block stands on that pin: what counts
there is their distance.
"""

from __future__ import annotations

import numpy as np

from analytic.structure.mobility import analyse
from models.array import Array
from models.motion import Motion
from models.scene import Scene


def nearness(scene: Scene, motion: Motion) -> dict[str, Array]:
    """The distance of every dyad from its nearest singular position at the samples, (T,) by name.

    As ``motion.conditioning`` (1 best, 0 singular); of an RPR dyad times the distance of its two
    pins over the largest in the motion. The motion is one by `analytic.kinematics`, of ``scene``,
    with all its points.
    """
    distances = dict(motion.conditioning)
    for group in analyse(scene).groups:
        if group.kind == "RPR":
            ends = (motion.points[pin].position for pin in (group.outer1, group.outer2))
            apart = np.hypot(*np.subtract(*ends).T)
            distances[group.branch_key] = distances[group.branch_key] * apart / np.max(apart)
    return distances
