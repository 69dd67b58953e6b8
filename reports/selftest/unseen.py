"""Deviations that no rule sees, and need not: planted all the same, and shown with the reason."""

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np

from models.scene import Same, Scene
from reports.compare.compare import truth_of
from reports.selftest import engines, free_changes, requests
from reports.selftest.elastic_changes import at_quarter, in_chain_log, in_given
from reports.selftest.elastic_faults import segments, springs, stiffer
from reports.selftest.fault import Plant, Unseen, in_log, in_scene, planting, switched
from reports.selftest.log_faults import moved, of_output, taken
from sim.engine import Cost, Energy, Run
from sim.registry import engine, offering
from sim.run import run, setup


@planting
def _all_renamed(
    size: float, scene: Scene, state: Any, name: str, profile: str, **options: Any
) -> Run:
    """Run another engine, with every word as in the requested run."""
    asked = setup(scene, state, name, profile, **options)
    other = requests.other_engine(name)
    if not size or other is None:
        return run(scene, state, name, profile, **options)
    done = run(scene, state, other, profile, **{**options, "settings": None})
    held = engine(name).holds(asked.asked, asked.dt_s, asked.drive)
    return replace(done, **vars(asked), settings=held)


def _as_silent(name: str) -> bool:
    """True if there is another engine that reports what this one does."""
    other, silent = requests.other_engine(name), not engine(name).reports_accelerations
    return other is not None and (silent or engine(other).reports_accelerations)


def _tenth(scene: Scene, done: Run, size: float) -> Run:
    own = moved(done)
    true = truth_of(Same(scene)).at(own.time_s)
    kept = 1.0 - 0.9 * size
    places = {"links": ["theta"], "points": ["position"], "sliders": ["displacement"]}
    near = taken(own, true, lambda one, right: right + kept * (one - right), **places)
    return replace(done, motion=near)


def _even_taken(scene: Scene, done: Run, size: float) -> Run:
    """Give the moving pin of the crank the places of the closed form."""
    own = moved(done)
    pins = scene.links[scene.driver.link].points
    name = next(point for point in pins if point not in scene.ground)
    true = truth_of(Same(scene)).at(own.time_s).points[name]
    points = {**own.points, name: replace(own.points[name], position=true.position)}
    return replace(done, motion=replace(own, points=points)) if size else done


def _one_shut(_: Scene, done: Run, size: float) -> Run:
    first, *others = sorted(done.gaps, key=lambda name: float(done.gaps[name].max()))
    shut = {first: (1.0 - size) * done.gaps[first]} if others else {}
    return replace(done, gaps={**done.gaps, **shut})


def _cheaper(_: Scene, done: Run, size: float) -> Run:
    cost = done.cost or Cost(0.0, 0, logged=True)
    return replace(done, cost=replace(cost, wall_s=cost.wall_s * (1.0 - 0.5 * size)))


def _of_energy(change: Callable[[Energy], Energy]) -> Plant:
    return switched(lambda _, done: replace(done, energy=done.energy and change(done.energy)))


def _even(energy: Energy) -> Energy:
    """Put the energy of the start at every instant."""
    level = np.full_like(energy.kinetic_j, energy.total_j[0])
    return Energy(energy.kinetic_j, level - energy.kinetic_j)


def _half_a_step(energy: Energy) -> Energy:
    """Put the potential energy of half a step before beside the kinetic energy of the sample."""
    late = energy.potential_j.copy()
    late[1:] -= 0.5 * np.diff(late)
    return Energy(energy.kinetic_j, late)


_NO_FORCES = (
    "Under a prescribed crank the lengths alone determine the motion; masses and loads "
    "determine the forces, which no rule compares."
)
UNSEEN = (
    Unseen("mass-other", "the scene that is run has a heavier link",
           f"{_NO_FORCES} A mass in the engine that is not the scene's is refused (mass-off).",
           in_scene(free_changes.of_link(free_changes.heavier_by, -1))),
    Unseen("gravity-midway", "gravity is switched on in mid-run",
           f"{_NO_FORCES} Gravity at the start is refused (gravity-left-on).",
           engines.after_a_third(lambda tools: lambda session, n: tools.pull(session, 9.81 * n)),
           needs=lambda name: name in offering("spoiler")),
    Unseen("error-tenth", "places with a tenth of their error",
           "An engine with smaller errors is better; errors below its order are seen (too-good).",
           in_log(_tenth)),
    Unseen("even-taken", "the crank's pin, from the reference",
           "A body that moves evenly with the crank is right to rounding in an engine as well.",
           in_log(_even_taken), shows=False),  # where the engine has those very numbers
    Unseen("gap-shut", "one gap of several is 0, as in the reference",
           "An engine may hold some of its joints exactly, by its coordinates; the widest gap is "
           "checked (too-good-gaps).",
           in_log(_one_shut), shows=False),
    Unseen("all-renamed", "another engine's run, all its words false",
           "Numbers within every limit, from a run that claims the requested words and "
           "settings throughout, are as good as those of that run; one false word is seen "
           "(engine-renamed).",
           _all_renamed, needs=_as_silent),
    Unseen("turns-counted", "an angle counted from another whole turn",
           "Engines count turns from any start; one gained or lost on the way is seen "
           "(whole-turn).",
           in_log(of_output("theta", lambda theta, size: theta + 2.0 * np.pi * round(size))),
           shows=False),
    Unseen("cost-halved", "half the time that the run took",
           "Times are advice, measured separately, and no rule judges them.",
           in_log(_cheaper), shows=False),
)  # fmt: skip
UNSEEN_FREE = (
    Unseen("matter-scaled", "every mass and inertia twice",
           "Under weight alone a common factor of all masses leaves the motion unchanged; the "
           "reactions differ, which --forces plants. One mass of several is seen (mass-wrong).",
           free_changes.in_free_scene(free_changes.of_all_matter),
           shows=False),  # of a factor of two not one bit changes in some engines
    Unseen("energy-even", "the energy of the start at every instant",
           "The energy is computed from the logged motion here, and not reported by an engine: "
           "damping or driving of that motion is seen in it (damping-left-on, energy-fed).",
           _of_energy(_even)),
    Unseen("energy-half-step", "potential energy of half a step before",
           "The total varies with the motion by the error of a step, as that of an engine does; "
           "its drift and the motion itself are judged.",
           _of_energy(_half_a_step)),
    Unseen("energy-parts", "kinetic energy reported as potential",
           "The total is judged: both parts are computed from the logged motion here.",
           _of_energy(lambda energy: Energy(energy.potential_j, energy.kinetic_j)),
           shows=False),  # a sum does not know its order
)  # fmt: skip
UNSEEN_ELASTIC = (
    Unseen("node-elsewhere", "a node away from the middle, 1 % too far out",
           "The distance of the middle from the line between the pins is compared; a chain that "
           "bends differently elsewhere also moves differently in its middle, unless only its "
           "log is wrong.",
           in_chain_log(lambda truth, motion, size: at_quarter(truth, motion, 1e-2 * size)),
           shows=False),  # nothing of it is among the errors
    Unseen("modulus-hardly", "the modulus, by 0.01 %",
           "Within the limit of this step; 1 % is seen (modulus-off).",
           in_given(springs(lambda one, n, size: stiffer(one, n, 1e-4 * size)))),
    Unseen("turning-inertia", "segments with 1 % less inertia about their centre",
           "Most of the inertia of a chain comes from its moving masses; the share of the rods "
           "about their own centres falls as 1/n^2, and three times that share is seen "
           "(inertia-at-ends).",
           in_given(segments(lambda link, size: free_changes.turning_light(link, 1e-2 * size)))),
)  # fmt: skip
