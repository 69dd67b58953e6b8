"""Faults of dynamics: what the engine is given is sound, and another machine, which let go moves
otherwise. Driven by a crank most of them would move as they should."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from models.scene import Scene
from reports.selftest.fault import Fault
from reports.selftest.free_changes import (
    about_pin,
    along_lines,
    faster_start,
    heavier,
    held_at_start,
    in_free_scene,
    lasting,
    later,
    of_coupler,
    of_load,
    of_spring,
    off_centre,
    on_last_link,
    reversed_load,
    spring_elsewhere,
    stronger_gravity,
    turned_gravity,
    without_flywheel,
)
from reports.selftest.free_runs import FREE_RUNS, PRESS, PULSE, SPRING, SQUEEZER, SWING
from reports.selftest.mechanism import long_coupler

_STEP_S = FREE_RUNS[PULSE][0]


def _fault(
    name: str,
    what: str,
    change: Callable[[Scene, float], Scene],
    size: float | None = None,
    unit: str = "",
    *,
    scene: str = SWING,
    rule: str = "CC127",
    finer: bool = False,
) -> Fault:
    """A fault of the machine that the engine is given in the place of a scene."""
    plant = in_free_scene(change)
    return Fault("dynamics", name, what, rule, plant, size, unit, scenes=(scene,), finer=finer)


FAULTS = (
    _fault("mass-wrong", "a link is too heavy", of_coupler(heavier), 0.1, "of it"),
    _fault(
        "inertia-at-pin",
        "inertia about a pin, not the centre",
        of_coupler(about_pin),
        1.0,
        "m d^2",
    ),
    _fault("centre-moved", "a centre of mass is elsewhere", of_coupler(off_centre), 0.1, "of it"),
    _fault("gravity-scaled", "gravity is too strong", stronger_gravity, 1e-3, "of it"),
    _fault(
        "gravity-hardly",
        "the same, within this step's limit",
        stronger_gravity,
        1e-4,
        "of it",
        rule="CC110",
        finer=True,
    ),
    _fault("gravity-turned", "gravity is not straight down", turned_gravity, 1e-2, "rad"),
    _fault("start-faster", "the driver starts too fast", faster_start, 1e-2, "w", scene=SPRING),
    _fault(
        "torque-late",
        "a torque over time acts late",
        of_load("pulse", later(_STEP_S)),
        1.0,
        "steps",
        scene=PULSE,
    ),
    _fault(
        "torque-lasts",
        "a torque over time ends late",
        of_load("pulse", lasting(_STEP_S)),
        1.0,
        "steps",
        scene=PULSE,
    ),
    _fault(
        "torque-reversed",
        "a torque turns the other way",
        of_load("pulse", reversed_load),
        scene=PULSE,
    ),
    _fault(
        "torque-elsewhere",
        "a torque acts on another link",
        of_load("pulse", on_last_link),
        scene=PULSE,
    ),
    _fault(
        "motor-held", "a motor keeps its first torque", of_load("motor", held_at_start), scene=PRESS
    ),
    _fault(
        "table-in-lines",
        "a table read along straight lines",
        of_load("work", along_lines),
        scene=PRESS,
    ),
    _fault(
        "flywheel-lost", "the flywheel is forgotten", without_flywheel, 0.9, "of it", scene=PRESS
    ),
    _fault(
        "spring-stiff",
        "a spring is too stiff",
        of_spring(lambda one, share, _: replace(one, rate=(1.0 + share) * one.rate)),
        0.1,
        "of it",
        scene=SPRING,
    ),
    _fault(
        "spring-reversed",
        "a spring pushes where it should pull",
        of_spring(lambda one, swap, _: replace(one, rate=(1.0 - 2.0 * swap) * one.rate)),
        scene=SPRING,
    ),
    _fault(
        "spring-long",
        "a spring is slack elsewhere",
        of_spring(lambda one, _, off_m: replace(one, free=one.free + off_m)),
        0.1,
        "L",
        scene=SPRING,
    ),
    _fault(
        "spring-elsewhere",
        "a spring pulls at another point",
        spring_elsewhere,
        1e-2,
        "m",
        scene=SQUEEZER,
    ),
    _fault(
        "damper-lost",
        "a damper is forgotten",
        of_spring(lambda one, share, _: replace(one, damping=(1.0 - share) * one.damping)),
        1.0,
        "of it",
        scene=SPRING,
    ),
    _fault(
        "damper-reversed",
        "a damper drives",
        of_spring(lambda one, swap, _: replace(one, damping=(1.0 - 2.0 * swap) * one.damping)),
        scene=SPRING,
        rule="CC129",
    ),
    _fault("coupler-long", "a link is too long", long_coupler, 1e-2, "of it", rule="CC128"),
)
