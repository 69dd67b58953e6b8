"""Tables of loads that end before the motion does: told before anything runs."""

from __future__ import annotations

import numpy as np

from analytic.kinematics import solve
from models.scene import Scene

LOOKS = 721
"""Positions looked at in a period."""


def refuse_short_tables(scene: Scene, duration_s: float) -> None:
    """Refuse a run in which a load has no magnitude, over the displacements of a whole period and
    the times of the run. Raises CrankcheckError that names the load and how far it has to go."""
    loads = [load for load in scene.loads.values() if load.over != "angle"]
    if not loads:
        return
    turn = np.linspace(0.0, scene.driver.law.period_s, LOOKS)
    sliders = [load.slider for load in loads if load.slider is not None]
    motion = solve(scene, turn, links=(), points=(), sliders=sliders, bound=False)
    for load in loads:
        if load.over == "time":
            load.magnitude(np.array([0.0, duration_s]))
        elif load.slider is not None:
            load.magnitude(motion.sliders[load.slider].displacement)
