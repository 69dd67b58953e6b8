"""A machine as a scene that is let go in its steady cycle, for engines to run."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from analytic.lectures.regulation.steady_cycle import SteadyCycle
from models.characteristics import Constant
from models.driver import Released
from models.loads import Load
from models.scene import Driver, Scene

DRIVE = "drive"


def with_flywheel(scene: Scene, inertia_kg_m2: float) -> Scene:
    """The scene with a flywheel more on its driver."""
    link = scene.links[scene.driver.link]
    heavier = replace(link, inertia_kg_m2=link.inertia_kg_m2 + inertia_kg_m2)
    return replace(scene, links={**scene.links, link.name: heavier})


def cycle_scene(cycle: SteadyCycle, cycles: float = 5.0, *, flywheel: bool = True) -> Scene:
    """The scene of a cycle, with its flywheel if asked for, let go at its start with the speed that
    the cycle has there, for so many cycles; the constant torque of the drive is a load of it."""
    machine = cycle.machine
    scene = with_flywheel(machine.scene, cycle.solution.flywheel) if flywheel else machine.scene
    start = machine.way * float(cycle.solution.speed_at(np.zeros(1))[0])
    law = Released(machine.start_rad, start, cycles * cycle.period_s)
    loads = dict(scene.loads)
    if cycle.drive_n_m:
        name = DRIVE if DRIVE not in loads else f"{DRIVE}-of-the-cycle"
        torque = Constant(machine.way * cycle.drive_n_m)
        loads[name] = Load(name, scene.driver.link, None, torque)
    return replace(scene, driver=Driver(scene.driver.link, law), loads=loads)
