"""The machine reduced to its driver: numbers by hand, and the torque that the reactions give."""

from __future__ import annotations

import random
from dataclasses import replace

import numpy as np
import pytest

from analytic.forces.kinetostatics import forces
from analytic.forces.reduced_machine import reduced_machine
from models.characteristics import Constant
from models.files import load_scene, parse_scene, shipped
from models.laws import Accelerating, ConstantSpeed
from models.loads import Load
from models.scene import Driver
from tests.worlds.loading import loaded


@pytest.mark.parametrize("name", shipped())
def test_the_reduced_machine_takes_the_torque_of_the_drive(name: str) -> None:
    """torque = I alpha + I' omega^2 / 2 - M, under an accelerating driver and any loads."""
    scene = loaded(load_scene(name), random.Random(name))
    start = float(scene.driver.law.at(np.zeros(1))[0][0])
    law = Accelerating(start, 0.5, 1.0)
    scene = replace(scene, driver=Driver(scene.driver.link, law))
    time_s = np.linspace(0.01, 0.2, 7)
    machine = reduced_machine(scene, time_s)
    _, omega, alpha = law.at(time_s)
    torque = machine.inertia * alpha + 0.5 * machine.slope * omega**2 - machine.torque
    found = forces(scene, time_s).torque
    assert torque == pytest.approx(found, abs=1e-11 * np.abs(found).max())


def test_a_scotch_yoke_worked_by_hand() -> None:
    """Yoke of mass m on a crank r: I = J_crank + m r^2 sin^2 phi, M = -F r sin phi."""
    scene = load_scene("scotch-yoke")
    crank, yoke = scene.links["crank"], scene.links["yoke"]
    sliders = {n: replace(s, mass_kg=0.0, inertia_kg_m2=0.0) for n, s in scene.sliders.items()}
    push = Load("push", "yoke", next(iter(yoke.points)), Constant(40.0))
    law = ConstantSpeed(0.3, 1.0)
    driver = Driver("crank", law)
    scene = replace(scene, sliders=sliders, loads={"push": push}, driver=driver)
    time_s = np.linspace(0.0, 6.0, 13)
    machine = reduced_machine(scene, time_s)
    r, phi = crank.points["B"][0], machine.theta
    own = crank.inertia_kg_m2 + crank.mass_kg * crank.centre_m[0] ** 2
    assert phi == pytest.approx(0.3 + time_s)
    assert machine.inertia == pytest.approx(own + yoke.mass_kg * r**2 * np.sin(phi) ** 2)
    assert machine.slope == pytest.approx(yoke.mass_kg * r**2 * np.sin(2 * phi), abs=1e-15)
    assert machine.torque == pytest.approx(-40.0 * r * np.sin(phi), abs=1e-13)


def test_a_slider_crank_worked_by_hand() -> None:
    """Crank 0.3 m without mass at 90 deg, rod 0.5 m: the rod is in translation there, all of it at
    0.3 m/rad against x. Rod 2 kg, block 4 kg: J = 6 0.3^2 = 0.54 kg m^2. 100 N along x on the block
    and weights: M = 100 (-0.3) = -30 N m, as a level motion lifts nothing. The rod's slope is
    -0.3 / 0.5, x' = -0.3, theta'_rod = -0.3 cos 90 / 0.4 = 0, theta''_rod = 0.3 / 0.4 = 0.75;
    x_C'' = -0.3 cos 90 - (0.5 (0.8) 0^2 + 0.5 (-0.6) 0.75) = 0.225; x_S'' half of that. So
    J' = 2 (4 (-0.3) 0.225 + 2 (-0.3) 0.1125) = -0.675 kg m^2/rad."""
    text = """
name = "worked"
source = "a test"
ground = { points = { A = [0.0, 0.0] } }
gravity_m_s2 = [0.0, -9.81]
[links]
crank = { bar = ["A", "B"], length_m = 0.3, mass_kg = 0.0 }
rod = { bar = ["B", "C"], length_m = 0.5, mass_kg = 2.0 }
[sliders.C]
on = "ground"
mass_kg = 4.0
[driver]
link = "crank"
speed_rad_s = 1.0
start_deg = 90.0
[loads.push]
block = "C"
force_n = 100.0
"""
    machine = reduced_machine(parse_scene(text, "worked"), np.zeros(1))
    assert machine.inertia == pytest.approx([0.54])
    assert machine.torque == pytest.approx([-30.0])
    assert machine.slope == pytest.approx([-0.675])
