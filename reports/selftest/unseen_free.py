"""What no rule sees of free motion, and need not."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from models.scene import Scene
from reports.selftest.fault import in_log
from reports.selftest.free_changes import in_free_scene, of_all_matter
from reports.selftest.unseen import Unseen
from sim.engine import Energy, Run


def _even(_: Scene, done: Run, size: float) -> Run:
    """The energy of the start, at every instant."""
    if not (size and done.energy):
        return done
    level = np.full_like(done.energy.kinetic_j, done.energy.total_j[0])
    return replace(done, energy=Energy(done.energy.kinetic_j, level - done.energy.kinetic_j))


def _parts(_: Scene, done: Run, size: float) -> Run:
    """Each part of the energy is called by the name of the other."""
    if not (size and done.energy):
        return done
    return replace(done, energy=Energy(done.energy.potential_j, done.energy.kinetic_j))


def _half_a_step(_: Scene, done: Run, size: float) -> Run:
    """The potential energy of half a step before, beside the kinetic energy of the sample."""
    if not (size and done.energy):
        return done
    late = done.energy.potential_j.copy()
    late[1:] -= 0.5 * size * np.diff(late)
    return replace(done, energy=Energy(done.energy.kinetic_j, late))


UNSEEN_FREE = (
    Unseen(
        "matter-scaled",
        "every mass and inertia twice",
        "Under weight alone a mechanism moves as it does, whatever the factor of all its masses; "
        "its reactions differ, which --forces plants. One mass of several is seen (mass-wrong).",
        in_free_scene(of_all_matter),
        shows=False,  # of a factor of two not one bit changes in some engines
    ),
    Unseen(
        "energy-even",
        "the energy of the start at every instant",
        "The energy is worked out of the logged motion here, and not told by an engine: what "
        "damps or drives that motion is seen in it (damping-left-on, energy-fed).",
        in_log(_even),
    ),
    Unseen(
        "energy-half-step",
        "potential energy of half a step before",
        "The total comes and goes with the motion by as much as a step makes of it, as that of an "
        "engine does; its drift is judged, and the motion itself.",
        in_log(_half_a_step),
    ),
    Unseen(
        "energy-parts",
        "kinetic energy told as potential",
        "The total is judged: both parts are worked out of the logged motion here.",
        in_log(_parts),
        shows=False,  # a sum does not know its order
    ),
)
