"""Faults of what is handed back of free motion."""

from __future__ import annotations

from dataclasses import replace
from functools import partial

import numpy as np

from analytic.kinematics import solve_driven
from models.scene import Scene
from reports.compare.free.free_truth import free_truth
from reports.selftest.clock import late
from reports.selftest.fault import Fault, in_log, switched
from reports.selftest.free_runs import SPRING, SWING
from reports.selftest.logs import last, moved, output, with_link
from sim.engine import Energy, Run


def _copied(scene: Scene, done: Run) -> Run:
    """The reference, in the engine's place."""
    motion = moved(done)
    true = free_truth(scene, done.steps, done.dt_s).at(motion.time_s)
    return replace(
        done,
        motion=replace(motion, links=true.links, points=true.points, sliders=true.sliders),
        velocity_time_s=motion.time_s,
        acceleration_time_s=motion.time_s,
    )


def _quick(scene: Scene, done: Run, share: float) -> Run:
    return with_link(done, last(scene), omega=(1.0 + share) * output(scene, done).omega)


def _in_other_assembly(scene: Scene, done: Run) -> Run:
    """The logged driver angle, and all places of the other assembly there."""
    own = moved(done)
    crank = own.links[scene.driver.link]
    other = replace(scene, branch={key: -sign for key, sign in scene.branch.items()})
    still = np.zeros_like(crank.theta)
    there = solve_driven(other, crank.theta, crank.omega, still, own.time_s, bound=False)
    links = {
        name: replace(link, theta=there.links[name].theta, omega=there.links[name].omega)
        for name, link in own.links.items()
    }
    points = {
        name: replace(
            point, position=there.points[name].position, velocity=there.points[name].velocity
        )
        for name, point in own.points.items()
    }
    return replace(done, motion=replace(own, links=links, points=points))


def _without_energy(_: Scene, done: Run) -> Run:
    return replace(done, energy=None)


def _leaking(_: Scene, done: Run, share: float) -> Run:
    """Energy that is lost evenly, as a share of the largest kinetic energy."""
    assert done.energy is not None
    kinetic, potential = done.energy.kinetic_j, done.energy.potential_j
    lost = share * kinetic.max() * np.linspace(0.0, 1.0, len(kinetic))
    return replace(done, energy=Energy(kinetic, potential - lost))


_fault = partial(Fault, "record", scenes=(SWING,))
FAULTS = (
    _fault("row-later", "every sample is a later one", "CC127", late, 1.0, "sample", whole=True),
    _fault("rate-off", "a logged velocity is too large", "CC106", in_log(_quick), 0.1, "of it"),
    _fault("energy-leaks", "energy that is lost evenly", "CC129", in_log(_leaking), 1e-2, "T"),
    _fault("other-assembly", "the other assembly is logged", "CC101", switched(_in_other_assembly)),
    _fault("energy-missing", "no energy is in the log", "CC109", switched(_without_energy)),
    _fault(
        "free-copied",
        "the reference, handed back",
        "CC111",
        switched(_copied),
        scenes=(SWING, SPRING),
    ),
)
