"""The free motion of a scene: integrated once for all that is compared with it and drawn of it."""

from __future__ import annotations

import pickle
from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np

from models.driver import LONGEST_S
from models.motion import State
from models.scene import Scene, as_bytes

if TYPE_CHECKING:
    from analytic.free.free_motion import FreeMotion

BEYOND = 1.01
"""How much longer than asked for is integrated, where loads over time say so much: some velocities
belong to half a step after a run."""
LOOK = 1e-3
"""The part of the scene's own duration that is integrated for what is at its start."""


def kept_motion(scene: Scene, lasts_s: float) -> FreeMotion:
    """The motion of a scene that is let go, for so long [s] at least. Raises CrankcheckError as
    `analytic.free.release`."""
    return _released(as_bytes(scene), long_enough_s(scene, lasts_s))


def released_state(scene: Scene) -> State:
    """What a scene that is let go starts from: the same to the last bit however long it is left
    free, with the accelerations that its masses and forces give it. Raises CrankcheckError as
    `analytic.free.release`."""
    return kept_motion(scene, LOOK * scene.driver.law.period_s).at(np.zeros(1), bound=False).state()


def long_enough_s(scene: Scene, lasts_s: float) -> float:
    """Until when a motion is integrated that a run of so long is compared with [s]."""
    return max(lasts_s, _told_s(scene, BEYOND * lasts_s))


def _told_s(scene: Scene, until_s: float) -> float:
    """Until when the loads over time are given, and a motion may last, up to a time [s]."""
    ends = [
        load.characteristic.nearest(until_s) for load in scene.loads.values() if load.over == "time"
    ]
    # Without its rounding it is one for all steps of a sweep.
    return min(float(f"{until_s:.9g}"), LONGEST_S, *ends)


@lru_cache(maxsize=4)
def _released(pickled: bytes, until_s: float) -> FreeMotion:
    """The motion of a scene, which may come from another process: kept by what it holds."""
    from analytic.free.release import release  # slow to import, and for free motion alone

    return release(pickle.loads(pickled), until_s)
