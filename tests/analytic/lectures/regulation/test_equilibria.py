"""Positions of rest: by hand, as extremes of the potential energy, and as motion has them."""

import math
from dataclasses import replace

import numpy as np
import pytest

from analytic.free.release import release
from analytic.kinematics import solve_driven
from analytic.lectures.regulation.equilibria import equilibria
from models.files.reading import load_scene
from models.scene import GROUND, Driver
from models.scene.driver import Released
from models.scene.loads import PinSpring
from tests.analytic.lectures.regulation.worked import shaft


@pytest.mark.parametrize("rate", [0.0, 3.0])
def test_a_pendulum_by_hand(rate: float) -> None:
    """J theta'' = -m g l cos(theta) - k (theta - free), m g l = 0.981 N m, J = 2 + m l^2."""
    scene = shaft({})
    crank = replace(scene.links["crank"], centre_m=(0.1, 0.0))
    springs = {"s": PinSpring("s", rate, 0.0, 0.3, "A", (GROUND, "crank"))} if rate else {}
    scene = replace(
        scene, links={**scene.links, "crank": crank}, springs=springs, gravity_m_s2=(0.0, -9.81)
    )
    found = [one for one in equilibria(scene).found if one.circuit == 0]
    assert [one.stiffness > 0.0 for one in found] == ([True] if rate else [True, False])
    for one in found:
        theta = one.driver_rad
        assert -0.981 * math.cos(theta) == pytest.approx(rate * (theta - 0.3), abs=1e-12)
        slope = rate - 0.981 * math.sin(theta)
        assert one.stiffness == pytest.approx(slope / 2.01, rel=1e-6)


@pytest.mark.parametrize(
    "name", ["fourbar-swing", "fourbar-double-rocker-swing", "slider-crank-spring"]
)
def test_a_stable_one_is_swung_about_and_has_the_least_potential(name: str) -> None:
    """Half a small oscillation later it stands on the other side; the lowest is the lowest of a
    circuit, whose limits are passed."""
    scene, rests = load_scene(name), equilibria(load_scene(name))
    own = [one for one in rests.found if one.circuit == rests.circuits.own[0]]
    for one in (each for each in own if each.stiffness > 0.0):
        start = one.driver_rad + 1e-4
        sign = dict(zip(rests.circuits.signed.dyads, one.signs, strict=True))
        driver = Driver(scene.driver.link, Released(start, 0.0, 1.0))
        half_s = math.pi / math.sqrt(one.stiffness)
        free = release(
            replace(scene, branch=sign, driver=driver, start=type(scene.start)()), half_s
        )
        undamped = all(spring.damping == 0.0 for spring in scene.springs.values())
        if undamped and not scene.friction:
            assert free.law.at(np.array([half_s]))[0][0] - one.driver_rad == pytest.approx(
                -1e-4, rel=1e-2
            )
    if scene.springs:
        return
    lowest = math.inf
    for arc, _ in rests.circuits.course:
        theta = arc.angles(4001)[1:-1]
        motion = solve_driven(rests.circuits.signed.with_signs(arc.signs), theta, 0.0, 0.0)
        height = np.zeros_like(theta)
        for link in scene.links.values():  # bars: their centres are between their ends
            ends = [motion.points[point].position[:, 1] for point in link.points]
            height += 9.81 * link.mass_kg * np.mean(ends, axis=0)
        lowest = min(lowest, float(height.min()))
    stable = [one.potential_j for one in own if one.stiffness > 0.0]
    assert min(stable) == pytest.approx(lowest, rel=1e-4)
    assert min(stable) <= lowest + 1e-12
    assert len(own) == 2 * len(stable)
