"""Driving torque and reactions with friction: textbooks, and other computations."""

import math
import random
from dataclasses import replace

import numpy as np
import pytest

from analytic.forces import kinetostatics
from analytic.forces.efficiency import friction_power
from analytic.kinematics import solve
from models.errors import CrankcheckError
from models.files.reading import load_scene, parse_scene
from models.scene import Scene
from models.scene.loads import ConstantFriction, CoulombFriction
from tests.analytic.dyads.test_redundant import parallelogram, with_strut
from tests.analytic.forces.beside import agreed, at, turn
from tests.analytic.test_bounds import SIX
from tests.worlds.loading import loaded, massless, rubbed

PRESS = """
name = "press"
source = "a test"
ground = { points = { A = [0.0, 0.0] } }
sliders = { piston = { point = "C", on = "ground", mass_kg = 1e-9 } }
driver = { link = "crank", speed_rad_s = 1.0 }
loads = { work = { block = "piston", direction_deg = 0.0, force_n = 1000.0 } }
[links]
crank = { bar = ["A", "B"], length_m = 0.1, mass_kg = 0.0, inertia_kg_m2 = 0.0 }
rod = { bar = ["B", "C"], length_m = 0.3, mass_kg = 0.0, inertia_kg_m2 = 0.0 }
"""
"""While the crank turns from 0 to 180 deg the piston comes back against the load."""


def press(**friction: CoulombFriction | ConstantFriction) -> Scene:
    return replace(parse_scene(PRESS, "press"), friction=friction)


@pytest.mark.parametrize(("phi_deg", "mu"), [(75.0, 0.0), (20.0, 0.4), (140.0, 0.1), (200.0, 0.4)])
def test_a_slider_rubs_as_the_textbook_has_it(phi_deg: float, mu: float) -> None:
    """With the rod's lean psi and its force S along it: S cos psi = F + mu S sin psi, so
    S = F / (cos psi - mu sin psi), and the torque is S r sin(phi + psi); past 180 deg psi < 0."""
    phi = math.radians(phi_deg)
    psi = math.asin(0.1 * math.sin(phi) / 0.3)
    rod = 1000.0 / (math.cos(psi) - mu * math.sin(psi))
    scene = press(piston=CoulombFriction("piston", mu))
    found = kinetostatics.forces(scene, at(scene, phi))
    assert found.torque[0] == pytest.approx(rod * 0.1 * math.sin(phi + psi), rel=1e-12)
    thrust, slider = rod * math.sin(psi), found.sliders["piston"]
    assert (abs(slider.normal[0]), slider.moment[0]) == pytest.approx((abs(thrust), 0.0), rel=1e-12)
    assert found.friction["piston"][0] == pytest.approx(mu * thrust, rel=1e-12)


def test_constant_friction_of_the_drive_adds_to_its_torque() -> None:
    scene = press(A=ConstantFriction("A", 2.0))
    for rate in (1.0, -1.0):
        motion = at(scene, math.radians(40.0), speed=rate)
        found = kinetostatics.forces(scene, motion)
        bare = kinetostatics.forces(replace(scene, friction={}), motion)
        assert found.torque[0] - bare.torque[0] == pytest.approx(2.0 * rate, rel=1e-12)
        assert found.friction["A"] == pytest.approx([-2.0 * rate])
    alone = replace(massless(scene), loads={})
    assert kinetostatics.forces(alone, [0.3]).torque == pytest.approx([2.0])


@pytest.mark.parametrize("name", SIX)
def test_three_computations_agree_with_friction(name: str) -> None:
    scene = rubbed(loaded(load_scene(name), random.Random(name)), random.Random(name), 0.1)
    time_s = turn(scene)
    found = kinetostatics.forces(scene, time_s, skip_dead_points=True)
    some = time_s[np.isfinite(found.bound.torque)][::5]
    assert len(some) >= 5
    found, _ = agreed(scene, some)
    for joint, watts in friction_power(scene, solve(scene, some), found.friction).items():
        assert np.all(watts <= 0.0), joint
    assert any(np.any(np.abs(each) > 0.0) for each in found.friction.values())


def test_a_joint_at_rest_but_for_rounding_may_rub_either_way() -> None:
    """At the inner dead centre the piston stands: its friction is taken as 0, bounded by mu N."""
    scene = press(piston=ConstantFriction("piston", 50.0))
    found = kinetostatics.forces(scene, at(scene, 0.0, 1.0))
    assert found.friction["piston"].tolist() == [0.0, 50.0]
    assert found.bound.friction["piston"][0] >= 50.0
    assert found.bound.friction["piston"][1] < 1e-9
    assert found.bound.pins["B"]["rod"][0] >= 50.0
    # In the outer dead centre it moves at 1e-17 m/s, because pi is no float.
    scene = replace(press(piston=CoulombFriction("piston", 0.2)), gravity_m_s2=(0.0, -9.81))
    heavy = replace(scene.sliders["piston"], mass_kg=10.0)
    motion = at(scene, math.pi)
    assert 0.0 < abs(motion.sliders["piston"].speed[0]) < 1e-15
    found = kinetostatics.forces(replace(scene, sliders={"piston": heavy}), motion)
    assert found.friction["piston"][0] == 0.0
    assert found.bound.friction["piston"][0] == pytest.approx(0.2 * 98.1)


def test_redundant_links_take_constant_friction_alone() -> None:
    scene = replace(with_strut(parallelogram(1), "B0", "B1"), gravity_m_s2=(0.0, -9.81))
    pivot = scene.driver_pivot
    held = replace(scene, friction={pivot: ConstantFriction(pivot, 3.0)})
    bare = kinetostatics.forces(scene, [0.1, 0.2])
    found = kinetostatics.forces(held, [0.1, 0.2])
    speed = scene.driver.law.at(np.zeros(1))[1][0]
    assert found.torque - bare.torque == pytest.approx(3.0 * np.sign(speed))
    assert not found.pins
    rubbing = replace(scene, friction={pivot: CoulombFriction(pivot, 0.1, 0.01)})
    with pytest.raises(CrankcheckError, match=r"redundant links .* so it can not be computed"):
        kinetostatics.forces(rubbing, [0.1])


def test_friction_that_is_not_there_is_refused() -> None:
    words = "friction.Q: 0 bodies meet there, and two rub .* use one of A, B, C, piston"
    with pytest.raises(CrankcheckError, match=words):
        kinetostatics.forces(press(Q=ConstantFriction("Q", 1.0)), [0.1])
