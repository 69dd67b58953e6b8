"""Springs and dampers in driven scenes: by groups, by multipliers and by power; by hand."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from analytic.check import multipliers
from analytic.forces import kinetostatics
from analytic.forces.springs import spring_lengths
from analytic.kinematics import chunks, solve, solve_driven
from models.files import load_scene
from models.laws import ConstantSpeed
from models.scene import GROUND, Driver
from models.springs import LineSpring, PinSpring, SlideSpring
from tests.analytic.forces.beside import AGREED, apart


def test_a_slider_crank_with_springs_by_hand() -> None:
    """Crank 0.3, rod 0.5 m at 90 deg, 2 rad/s, nothing with mass: x_C = 0.4 m, x_C' = -0.6 m/s.
    A spring of 100 N/m and 10 N s/m, slack at 0.1 m, pulls the block back with 100 (0.4 - 0.1)
    - 10 0.6 = 24 N; the power 24 (-0.6) comes of the drive: M 2 = 24 (-0.6), M = -7.2 N m. The rod,
    (0.4, -0.3) / 0.5, holds the block with +24 N along x: so with -18 N across, and the guide
    with +18 N. In the pin A a spring of 2 N m/rad, slack at 30 deg: 2 pi/3 N m more."""
    scene = load_scene("slider-crank-central")
    crank = replace(
        scene.links["crank"], points={"A": (0.0, 0.0), "B": (0.3, 0.0)}, mass_kg=0.0,
        inertia_kg_m2=0.0,
    )  # fmt: skip
    rod = replace(
        scene.links["rod"], points={"B": (0.0, 0.0), "C": (0.5, 0.0)}, mass_kg=0.0,
        inertia_kg_m2=0.0,
    )  # fmt: skip
    sliders = {n: replace(s, mass_kg=0.0, inertia_kg_m2=0.0) for n, s in scene.sliders.items()}
    scene = replace(
        scene,
        links={"crank": crank, "rod": rod},
        sliders=sliders,
        driver=Driver("crank", ConstantSpeed(0.5 * math.pi, 2.0)),
        springs={"back": SlideSpring("back", 100.0, 10.0, 0.1, "C")},
        gravity_m_s2=(0.0, 0.0),
    )
    found = kinetostatics.forces(scene, [0.0])
    assert found.torque == pytest.approx([-7.2])
    assert found.pins["C"]["block C"][0] == pytest.approx([24.0, -18.0])
    assert found.sliders["C"].normal == pytest.approx([18.0])
    wound = PinSpring("wound", 2.0, 0.0, math.radians(30.0), "A", (GROUND, "crank"))
    both = replace(scene, springs={**scene.springs, "wound": wound})
    assert kinetostatics.forces(both, [0.0]).torque == pytest.approx([-7.2 + math.tau / 3.0])


def test_a_spring_in_a_pin_is_wound_up_turn_by_turn() -> None:
    """On the crank it holds against 3 turns after 3 turns; between crank and coupler, which comes
    round as often as the rocker, against as many the other way."""
    scene = load_scene("fourbar-lecture-1")
    crank = PinSpring("own", 2.0, 0.0, math.radians(600.0), "A", (GROUND, "crank"))
    coupler = PinSpring("far", 2.0, 0.0, -1.0, "B", ("crank", "coupler"))
    scene = replace(scene, springs={"own": crank, "far": coupler})
    period = scene.driver.law.period_s
    instants = np.array([0.0, 1.0, 3.0]) * period
    for _, chunk in chunks(scene, instants, bound=False):
        (_, q, _), (_, other, _) = spring_lengths(scene, chunk, counted=True)
    assert abs(q[0] - crank.free) <= math.pi
    assert q - q[0] == pytest.approx([0.0, math.tau, 3.0 * math.tau])
    assert abs(other[0] - coupler.free) <= math.pi
    assert other - other[0] == pytest.approx([0.0, -math.tau, -3.0 * math.tau])
    found = kinetostatics.forces(scene, instants)
    assert apart(found, multipliers.forces(scene, solve(scene, instants))) <= AGREED
    law = scene.driver.law.at(instants)
    given = kinetostatics.forces(scene, solve_driven(scene, *law, instants))
    assert apart(found, given) <= AGREED


def test_a_spring_without_a_free_length_may_come_to_nothing() -> None:
    """The crank's pin passes a point of the ground: nothing pulls there, and nothing is divided by
    the length."""
    scene = load_scene("fourbar-lecture-1")
    ground = {**scene.ground, "E": (0.0, 0.1)}
    spring = LineSpring("own", 50.0, 0.0, 0.0, ("E", "B"))
    scene = replace(scene, ground=ground, springs={"own": spring})
    assert scene.links["crank"].points["B"] == (0.1, 0.0)
    found = kinetostatics.forces(scene, [0.0])  # the crank stands at 90 deg
    plain = kinetostatics.forces(replace(scene, springs={}), [0.0])
    assert found.torque == pytest.approx(plain.torque)
    assert found.bound.torque[0] < 1e-12
