"""How long a machine takes until all repeats that follows from where its driver is."""

from __future__ import annotations

import numpy as np

from analytic.kinematics import repeats_after
from models.array import Array
from models.errors import CrankcheckError
from models.laws import ConstantSpeed, Oscillating
from models.scene import Scene


def cycle_s(scene: Scene) -> float:
    """The time of a turn of the driver [s] (of two, where positions repeat after two only), or of a
    swing to and fro. Raises CrankcheckError for a law under which nothing repeats."""
    law = scene.driver.law
    if isinstance(law, ConstantSpeed):
        return repeats_after(scene) / abs(law.speed_rad_s)
    if isinstance(law, Oscillating):
        return law.period_s
    raise CrankcheckError(
        f"{scene.name}: its driver speeds up, so no cycle is like the next; give it the law "
        "constant or oscillating"
    )


def looks(scene: Scene, count: int) -> Array:
    """Instants over a cycle [s], none in the position at its start, which is often a dead point."""
    return np.asarray((np.arange(count) + 0.5) * (cycle_s(scene) / count))
