"""What is asked of scenes and engines where forces are asked for."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from analytic.forces.kinetostatics import forces
from models.scene import Scene
from sim.registry import engine


def refuse_forceless(scene: Scene, duration_s: float) -> None:
    """Refuse a scene whose forces are not known at the start and the end of a run.

    Raises
    ------
    CrankcheckError
        Nothing has a mass and nothing loads it; a table of a load does not reach so far.
    """
    forces(scene, np.array([0.0, duration_s]), bound=False, skip_dead_points=True)


def gives_forces(name: str) -> bool:
    """Whether an engine reports forces."""
    return engine(name).forces_of != "nothing"


def silent_note(engines: Iterable[str]) -> str:
    """What is said of engines that report no forces and are run without; "" where all do."""
    silent = [name for name in dict.fromkeys(engines) if not gives_forces(name)]
    if not silent:
        return ""
    return f"forces: {' and '.join(silent)} reports none, and is run without"
