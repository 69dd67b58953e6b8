"""How a scene moves in truth, driven or let go, to be drawn."""

from __future__ import annotations

import numpy as np

from analytic.kinematics import solve
from models.array import Array
from models.motion import Motion
from models.scene import Scene
from reports.compare.free.free_truth import kept_motion


def true_motion(scene: Scene, time_s: Array) -> Motion:
    """The motion at times [s], without bounds. Raises CrankcheckError where there is none."""
    if not scene.is_free:
        return solve(scene, time_s, bound=False)
    return kept_motion(scene, float(np.max(time_s))).at(time_s, bound=False)
