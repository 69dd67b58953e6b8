"""How a scene moves in truth, driven or let go, to be drawn."""

from __future__ import annotations

import pickle
from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np

from analytic.kinematics import solve
from models.array import Array
from models.motion import Motion
from models.scene import Scene

if TYPE_CHECKING:
    from analytic.free.free_motion import FreeMotion

BEYOND = 1.0001
"""How much further than it is drawn a motion is integrated."""


def true_motion(scene: Scene, time_s: Array) -> Motion:
    """The motion at times [s], without bounds. Raises CrankcheckError where there is none."""
    if not scene.is_free:
        return solve(scene, time_s, bound=False)
    # Runs of several steps end at the same time but for rounding, and share one integration.
    lasts_s = float(f"{BEYOND * float(np.max(time_s)):.6g}")
    return _let_go(pickle.dumps(scene), lasts_s).at(time_s, bound=False)


@lru_cache(maxsize=4)
def _let_go(pickled: bytes, lasts_s: float) -> FreeMotion:
    """The free motion of a scene, of which several runs are drawn."""
    from analytic.free.release import release  # loads scipy: for free motion alone

    return release(pickle.loads(pickled), lasts_s)
