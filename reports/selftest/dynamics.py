"""Faults of dynamics: what the engine is given is sound, and another machine, which let go moves
otherwise. Driven by a crank most of them would move as they should."""

from __future__ import annotations

from dataclasses import replace
from functools import partial

from reports.selftest.fault import Fault
from reports.selftest.free_changes import (
    about_pin,
    faster_start,
    heavier,
    held_at_start,
    in_free_scene,
    later,
    of_coupler,
    of_first_load,
    of_spring,
    off_centre,
    on_last_link,
    reversed_load,
    stronger_gravity,
    turned_gravity,
    without_flywheel,
)
from reports.selftest.free_runs import FREE_RUNS, PRESS, PULSE, SPRING, SWING
from reports.selftest.mechanism import long_coupler

_fault = partial(Fault, "dynamics", rule="CC127", scenes=(SWING,))
_STEP_S = FREE_RUNS[PULSE][0]
FAULTS = (
    _fault(
        "mass-wrong",
        "a link is too heavy",
        plant=in_free_scene(of_coupler(heavier)),
        size=0.1,
        unit="of it",
    ),
    _fault(
        "inertia-at-pin",
        "inertia about a pin, not the centre",
        plant=in_free_scene(of_coupler(about_pin)),
        size=1.0,
        unit="m d^2",
    ),
    _fault(
        "centre-moved",
        "a centre of mass is elsewhere",
        plant=in_free_scene(of_coupler(off_centre)),
        size=0.1,
        unit="of it",
    ),
    _fault(
        "gravity-scaled",
        "gravity is too strong",
        rule="CC110",
        plant=in_free_scene(stronger_gravity),
        size=1e-3,
        unit="of it",
        finer=True,
    ),
    _fault(
        "gravity-turned",
        "gravity is not straight down",
        plant=in_free_scene(turned_gravity),
        size=1e-2,
        unit="rad",
    ),
    _fault(
        "start-faster",
        "the driver starts too fast",
        plant=in_free_scene(faster_start),
        size=1e-2,
        unit="w",
        scenes=(SPRING,),
    ),
    _fault(
        "torque-late",
        "a torque over time acts late",
        plant=in_free_scene(of_first_load(later(_STEP_S))),
        size=1.0,
        unit="steps",
        scenes=(PULSE,),
    ),
    _fault(
        "torque-reversed",
        "a torque turns the other way",
        plant=in_free_scene(of_first_load(reversed_load)),
        scenes=(PULSE,),
    ),
    _fault(
        "torque-elsewhere",
        "a torque acts on another link",
        plant=in_free_scene(of_first_load(on_last_link)),
        scenes=(PULSE,),
    ),
    _fault(
        "motor-held",
        "a motor keeps its first torque",
        plant=in_free_scene(of_first_load(held_at_start)),
        scenes=(PRESS,),
    ),
    _fault(
        "flywheel-lost",
        "the flywheel is forgotten",
        plant=in_free_scene(without_flywheel),
        size=0.9,
        unit="of it",
        scenes=(PRESS,),
    ),
    _fault(
        "spring-stiff",
        "a spring is too stiff",
        plant=in_free_scene(
            of_spring(lambda one, share, _: replace(one, rate=(1.0 + share) * one.rate))
        ),
        size=0.1,
        unit="of it",
        scenes=(SPRING,),
    ),
    _fault(
        "spring-long",
        "a spring is slack elsewhere",
        plant=in_free_scene(of_spring(lambda one, _, off_m: replace(one, free=one.free + off_m))),
        size=0.1,
        unit="L",
        scenes=(SPRING,),
    ),
    _fault(
        "damper-lost",
        "a damper is forgotten",
        plant=in_free_scene(
            of_spring(lambda one, share, _: replace(one, damping=(1.0 - share) * one.damping))
        ),
        size=1.0,
        unit="of it",
        scenes=(SPRING,),
    ),
    _fault(
        "coupler-long",
        "a link is too long",
        rule="CC128",
        plant=in_free_scene(long_coupler),
        size=1e-2,
        unit="of it",
    ),
)
