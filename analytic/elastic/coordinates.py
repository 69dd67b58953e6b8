"""The motion of the rigid mechanism as coordinates of the multibody form, at all times at once."""

from __future__ import annotations

import numpy as np

from analytic.multibody.assembly import Assembly
from models.array import Array
from models.joints import block_name, sliding_angle
from models.motion import Motion
from models.scene import GROUND


def coordinates(assembly: Assembly, motion: Motion) -> Array:
    """The coordinates (T, n) of an assembly where a motion has its links; 0 for all that is not of
    a frame."""
    scene = assembly.scene
    q = np.zeros((len(motion.time_s), assembly.size))
    for name, link in scene.links.items():
        at, theta = assembly.at[name], motion.links[name].theta
        point, (x, y) = next(iter(link.points.items()))
        place, c, s = motion.points[point].position, np.cos(theta), np.sin(theta)
        q[:, at] = place[:, 0] - c * x + s * y
        q[:, at + 1] = place[:, 1] - s * x - c * y
        q[:, at + 2] = theta
    for slider in scene.sliders.values():
        if slider.link is None:
            at = assembly.at[block_name(slider)]
            guide = 0.0 if slider.on == GROUND else motion.links[slider.on].theta
            q[:, at : at + 2] = motion.points[slider.point].position
            q[:, at + 2] = guide + sliding_angle(slider)
    return q
