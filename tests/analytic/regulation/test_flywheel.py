"""The flywheel for a coefficient of fluctuation: by hand, exact beside approximate, and without."""

from __future__ import annotations

import math
from dataclasses import replace
from functools import cache

import pytest

from analytic.regulation.cycle_scene import cycle_scene, with_flywheel
from analytic.regulation.cycle_search import steady_cycle
from analytic.regulation.flywheel import WantedFlywheel, wanted_flywheel
from analytic.regulation.turning_machine import TurningMachine
from models.characteristics import Polynomial, Sine
from models.errors import CrankcheckError
from models.files import load_scene
from models.released import Released
from models.scene import Scene
from tests.analytic.regulation.worked import shaft, yoke
from tests.worlds.tiers import few

PULL = {"pull": (Sine(20.0, math.tau), "angle")}
"""40 J of surplus."""


def wanted(scene: Scene, delta: float) -> WantedFlywheel:
    return wanted_flywheel(TurningMachine.of(scene), delta)


@cache
def evened(name: str) -> WantedFlywheel:
    """That of a shipped scene for a coefficient of 0.02."""
    return wanted(load_scene(name), 0.02)


def test_a_shaft_by_hand() -> None:
    """40 J at 10 rad/s for 0.02: J = 40 / (0.02 100) = 20 kg m^2, of which the shaft has 2. All
    ways agree: its own moment of inertia is constant."""
    found = wanted(shaft(PULL), 0.02)  # type: ignore[arg-type]  # literals
    near = found.approximations
    assert found.inertia_kg_m2 == pytest.approx(18.0, rel=1e-11)
    assert near.by_surplus == pytest.approx(18.0, rel=1e-7)
    assert near.by_own_energy == pytest.approx(18.0, rel=1e-7)
    assert near.by_tangents == pytest.approx(18.0, rel=1e-7)
    assert found.bare.delta == pytest.approx(0.2)
    assert found.slopes == pytest.approx((0.5 * 10.1**2, 0.5 * 9.9**2))


def test_a_yoke_without_loads_by_hand() -> None:
    """Energy stays: w_max / w_min = sqrt((J + 0.62) / (J + 0.5)) = (1 + delta/2) / (1 - delta/2) =
    q, so J = (0.62 - 0.5 q^2) / (q^2 - 1). There is no surplus of work, so that this approximation
    puts no flywheel on; own energy: 0.12 / (2 delta) less 0.5; tangents: both touch the line W = 0,
    at its ends, and meet in J = (0.62 k_max' - 0.5 ...) as below."""
    delta = 0.05
    found = wanted(yoke(), delta)
    q = ((1.0 + 0.5 * delta) / (1.0 - 0.5 * delta)) ** 2
    assert found.inertia_kg_m2 == pytest.approx((0.62 - 0.5 * q) / (q - 1.0), rel=1e-10)
    near = found.approximations
    assert near.by_surplus < 0.0
    assert near.by_own_energy == pytest.approx(0.06 / delta - 0.5, rel=1e-6)
    # max(-k_max J) = -0.5 k_max, min(-k_min J) = -0.62 k_min, with k = w^2 (1 +- delta) / 2.
    tangents = (0.62 * (1.0 - delta) - 0.5 * (1.0 + delta)) / (2.0 * delta)
    assert near.by_tangents == pytest.approx(tangents, rel=1e-6)


@pytest.mark.parametrize(
    "name",
    few(
        ["engine-four-stroke", "compressor", "toggle-press"],
        {"compressor"},
        "cycles of two turns and of a press: half a second each",
    ),
)
def test_the_scene_with_the_flywheel_has_the_coefficient(name: str) -> None:
    """As a scene of its own, and tangents of the exact slopes say the same: no torque follows the
    speed."""
    scene, found = load_scene(name), evened(name)
    again = steady_cycle(TurningMachine.of(with_flywheel(scene, found.inertia_kg_m2)))
    assert again.delta == pytest.approx(0.02, rel=1e-11)
    assert found.diagram.flywheel(*found.slopes) == pytest.approx(found.inertia_kg_m2, rel=1e-9)
    near = found.approximations
    for other in (near.by_surplus, near.by_own_energy):
        assert other == pytest.approx(found.inertia_kg_m2, rel=0.2)
    # What the drawn tangents leave out is delta^2 / 4 of the slopes.
    assert near.by_tangents == pytest.approx(found.inertia_kg_m2, rel=1e-4)
    assert (found.bare is None) == (name == "toggle-press")


def test_with_a_motor_the_flywheel_is_that_of_its_own_cycle() -> None:
    loads = {**PULL, "motor": (Polynomial((30.0, -1.0)), "omega")}
    scene = shaft(loads, free=True)  # type: ignore[arg-type]  # literals
    found = wanted(scene, 0.01)
    assert found.cycle.delta == pytest.approx(0.01, rel=1e-11)
    # The motor itself works against the fluctuation: it takes less than without it.
    bound = 40.0 / (0.01 * found.cycle.mean_rad_s**2) - 2.0
    assert 0.5 * bound < found.inertia_kg_m2 < bound
    again = steady_cycle(TurningMachine.of(with_flywheel(scene, found.inertia_kg_m2)))
    assert again.delta == pytest.approx(0.01, rel=1e-10)


def test_a_machine_is_let_go_in_its_cycle() -> None:
    found = evened("compressor")
    scene = cycle_scene(found.cycle, cycles=3.0)
    law = scene.driver.law
    assert isinstance(law, Released)
    assert law.duration_s == pytest.approx(3.0 * found.cycle.period_s)
    assert abs(law.speed_rad_s - found.cycle.mean_rad_s) <= 0.01 * found.cycle.mean_rad_s * 1.001
    assert set(scene.loads) == {"compression", "expansion", "drive"}
    # Its loads balance, and its start is the mean speed that is asked of it.
    same = replace(
        scene, driver=replace(scene.driver, law=replace(law, speed_rad_s=found.cycle.mean_rad_s))
    )
    again = steady_cycle(TurningMachine.of(same))
    assert again.delta == pytest.approx(0.02, rel=1e-9)
    assert again.drive_n_m == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize("delta", [0.0, -0.1, 1e-300, 9e-7, 2.0, 7.0, math.nan, math.inf])
def test_a_coefficient_that_is_none_is_refused(delta: float) -> None:
    with pytest.raises(CrankcheckError, match=rf"^delta {delta:g}: .*(0\.02|0\.2|1e-06 or more)"):
        wanted(shaft(PULL), delta)  # type: ignore[arg-type]  # literals


def test_a_flywheel_alone_may_be_all_that_moves() -> None:
    """Without masses there is no cycle; 40 J at 10 rad/s for 0.1 take 4 kg m^2."""
    found = wanted(shaft(PULL, inertia=0.0), 0.1)  # type: ignore[arg-type]  # literals
    assert found.bare is None
    assert found.inertia_kg_m2 == pytest.approx(4.0, rel=1e-11)
