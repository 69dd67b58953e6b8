"""A flywheel that was worked out does in an engine what it was worked out for."""

import math
from dataclasses import dataclass

import numpy as np
import pytest

from analytic.lectures.regulation.flywheel import WantedFlywheel, wanted_flywheel
from analytic.lectures.regulation.steady_cycle import SteadyCycle, cycle_scene
from analytic.lectures.regulation.turning_machine import TurningMachine
from models.files.reading import load_scene
from models.scene import Scene
from tests.worlds.runs import ran
from tests.worlds.tiers import slowly

DELTA = 0.02
WITHIN, WITHIN_DEG = 0.01, 0.5
"""What a measured coefficient may be off, over itself, and the angles of extreme speed."""


@dataclass(frozen=True)
class Measured:
    """The coefficient of fluctuation of a cycle, and the driver's angles at its extremes [deg]."""

    delta: float
    fastest_deg: float
    slowest_deg: float


def wanted(scene: Scene) -> WantedFlywheel:
    return wanted_flywheel(TurningMachine.of(scene), DELTA)


def measured(scene: Scene, engine: str, cycle: SteadyCycle, steps: int) -> list[Measured]:
    """The cycles of a scene that is let go in an engine, one after the other."""
    logged = ran(scene, engine, per_turn=steps, drive="free")
    link = logged.motion.links[scene.driver.link]
    turned = np.abs(link.theta - link.theta[0])
    whole, found = cycle.machine.cycle_rad, []
    for k in range(math.floor(turned[-1] / whole)):
        inside = (turned >= k * whole) & (turned <= (k + 1) * whole)
        speed, theta = np.abs(link.omega[inside]), link.theta[inside]
        high, low = float(speed.max()), float(speed.min())
        ends = (math.degrees(theta[at]) for at in (np.argmax(speed), np.argmin(speed)))
        found.append(Measured(2.0 * (high - low) / (high + low), *ends))
    return found


def holds(one: Measured, cycle: SteadyCycle) -> None:
    """The coefficient, and the angles within the driver's cycle."""
    assert one.delta == pytest.approx(DELTA, rel=WITHIN)
    whole = math.degrees(cycle.machine.cycle_rad)
    for angle, u in ((one.fastest_deg, cycle.fastest), (one.slowest_deg, cycle.slowest)):
        off = math.remainder(angle - math.degrees(cycle.driver_rad(u)), whole)
        assert abs(off) < WITHIN_DEG


@pytest.mark.parametrize(("name", "engine", "steps"), [
    ("engine-four-stroke", "mujoco", 1400),
    *(
        slowly(*case, 2800, reason="2 s each: other machines, and another engine")
        for case in (
            ("toggle-press", "mujoco"),
            ("compressor", "pymunk"),
        )
    ),
])  # fmt: skip
def test_an_engine_runs_the_cycle_that_the_flywheel_is_for(
    name: str, engine: str, steps: int
) -> None:
    """The drive a constant torque, two cycles: nothing settles, so that the second is as the
    first. Some 2 s each, as loads that hang on the angle are asked for at every stage of a step."""
    cycle = wanted(load_scene(name)).cycle
    found = measured(cycle_scene(cycle, 2.05), engine, cycle, steps)
    assert len(found) == 2
    for one in found:
        holds(one, cycle)
