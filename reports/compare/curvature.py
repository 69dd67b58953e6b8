"""How sharply a reference bends: what the errors of an engine grow with."""

from __future__ import annotations

import itertools

import numpy as np

from models.motion import Motion
from models.scene import Scene
from reports.compare.series import length


def curvature(scene: Scene, reference: Motion) -> float:
    """The largest pure acceleration of the reference, at least 1, where it is a number."""
    square = scene.pace_rad_s**2
    turning = (link.alpha / square for link in reference.links.values())
    moving = (
        point.acceleration / (scene.longest_m * square) for point in reference.points.values()
    )
    sizes = (length(series) for series in itertools.chain(turning, moving))
    return max(float(np.max(each, where=np.isfinite(each), initial=1.0)) for each in sizes)
