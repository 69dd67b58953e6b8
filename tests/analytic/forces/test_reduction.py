"""Inertia at the driver, and in impulses that come a step late: numbers worked by hand."""

import random
from dataclasses import replace

import numpy as np
import pytest

from analytic.forces.kinetostatics import forces
from analytic.forces.late_impulses import LateImpulses, late_impulses
from analytic.forces.virtual_power import reduced_machine
from analytic.kinematics import solve
from models.files.reading import load_scene, parse_scene
from models.scene import Driver
from models.scene.characteristics import Constant
from models.scene.laws import Accelerating, ConstantSpeed
from models.scene.loads import Load
from tests.analytic.test_bounds import SIX
from tests.worlds.loading import loaded, sprung


@pytest.mark.parametrize(("name", "springs"), [*((n, False) for n in SIX), ("shaper", True)])
def test_the_reduced_machine_takes_the_torque_of_the_drive(name: str, springs: bool) -> None:
    """torque = I alpha + I' omega^2 / 2 - M, under an accelerating driver and any loads."""
    scene = load_scene(name)
    scene = sprung(scene, random.Random(1)) if springs else loaded(scene, random.Random(name))
    law = Accelerating(float(scene.driver.law.at(np.zeros(1))[0][0]), 0.5, 1.0)
    scene = replace(scene, driver=Driver(scene.driver.link, law))
    time_s = np.linspace(0.01, 0.9 if springs else 0.2, 7)
    machine, (_, omega, alpha) = reduced_machine(scene, time_s), law.at(time_s)
    torque = machine.inertia * alpha + 0.5 * machine.slope * omega**2 - machine.torque
    found = forces(scene, time_s).torque
    assert torque == pytest.approx(found, abs=1e-11 * np.abs(found).max())


def test_a_scotch_yoke_worked_by_hand() -> None:
    """Yoke of mass m on a crank r: I = J_crank + m r^2 sin^2 phi, M = -F r sin phi."""
    scene = load_scene("scotch-yoke")
    crank, yoke = scene.links["crank"], scene.links["yoke"]
    sliders = {n: replace(s, mass_kg=0.0, inertia_kg_m2=0.0) for n, s in scene.sliders.items()}
    push = Load("push", "yoke", next(iter(yoke.points)), Constant(40.0))
    driver = Driver("crank", ConstantSpeed(0.3, 1.0))
    scene = replace(scene, sliders=sliders, loads={"push": push}, driver=driver)
    time_s = np.linspace(0.0, 6.0, 13)
    machine = reduced_machine(scene, time_s)
    r, phi = crank.points["B"][0], machine.theta
    own = crank.inertia_kg_m2 + crank.mass_kg * crank.centre_m[0] ** 2
    assert phi == pytest.approx(0.3 + time_s)
    assert machine.inertia == pytest.approx(own + yoke.mass_kg * r**2 * np.sin(phi) ** 2)
    assert machine.slope == pytest.approx(yoke.mass_kg * r**2 * np.sin(2 * phi), abs=1e-15)
    assert machine.torque == pytest.approx(-40.0 * r * np.sin(phi), abs=1e-13)


DT_S = 1e-3
TEXT = """
name = "rotor"
source = "a test"
ground = { points = { A = [0.0, 0.0] } }
links = { crank = { bar = ["A", "B"], length_m = 1.0, mass_kg = 3.0 } }
driver = { link = "crank", speed_rad_s = 2.0 }
"""
ROTOR = parse_scene(TEXT, "rotor")


def of_steps(every: int) -> LateImpulses:
    times = every * DT_S * np.arange(3000 // every + 1)
    return late_impulses(ROTOR, solve(ROTOR, times), DT_S, 0.3)


def test_impulses_are_late_by_accelerations_of_centres_in_the_first_or_the_last_while() -> None:
    """T = (m r^2 + I) w^2 / 2 = 2 J; S = m r^2 w^4 / 2 = 6 J/s^2; and the acceleration turns by
    w dt in a step, so that over 3 s its differences make m r^2 w^6 / 2 dt^2 3000 = 24 dt^2 3000.
    A log of every tenth step says the same."""
    late, tenth = of_steps(1), of_steps(10)
    assert late.start == pytest.approx(2.0 * 6.0 * DT_S**2 / 2.0)
    assert (late.offset, tenth.offset) == pytest.approx((late.start, late.start))
    assert late.loss == pytest.approx(2.0 * 24.0 * DT_S**4 * 3000 / 2.0, rel=1e-5)
    assert tenth.loss == pytest.approx(late.loss, rel=1e-4)
    # What comes and goes is late by its mean over the first or the last while.
    times = DT_S * np.arange(1001)
    even = solve(ROTOR, times)
    crank = even.links["crank"]
    jolted = {"crank": replace(crank, alpha=np.where(times == 0.5, 1e6, crank.alpha))}
    whole = late_impulses(ROTOR, replace(even, links=jolted), DT_S, 0.1)
    assert whole.offset == pytest.approx(late_impulses(ROTOR, even, DT_S, 0.1).offset)
