"""Inertia as one force, as two masses, at the driver, and in impulses that come a step late:
numbers worked by hand, and what the bodies have themselves."""

import math
import random
from dataclasses import replace

import numpy as np
import pytest

from analytic.forces.kinetostatics import forces
from analytic.forces.late_impulses import LateImpulses, late_impulses
from analytic.forces.virtual_power import reduced_machine
from analytic.kinematics import solve
from models.array import Array
from models.files.reading import load_scene, parse_scene
from models.scene import Driver
from models.scene.characteristics import Constant
from models.scene.laws import Accelerating, ConstantSpeed
from models.scene.loads import Load
from tests.analytic.test_bounds import SIX
from tests.second_opinions.reduction import plane_motion, rotation, two_masses
from tests.worlds.loading import loaded, sprung


def cross(a: Array, b: Array) -> Array:
    return np.asarray(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0])


def perp(a: Array) -> Array:
    return np.stack([-a[:, 1], a[:, 0]], axis=1)


def test_one_force_has_the_force_and_moment_of_the_link() -> None:
    """About A: -m a_S, and r x (-m a_S) - J alpha; where a_A is parallel to a_SA too."""
    rng = np.random.default_rng(7)
    centre = rng.uniform(0.1, 0.5) * np.stack([np.cos(a := rng.uniform(0, 7, 50)), np.sin(a)], 1)
    omega, alpha, a_a = rng.normal(0, 9, 50), rng.normal(0, 99, 50), rng.normal(0, 50, (50, 2))
    of_s = alpha[:, None] * perp(centre) - omega[:, None] ** 2 * centre
    a_a[::5] = 0.5 * of_s[::5]
    mass, inertia = 1.7, 0.03
    found = plane_motion(mass, inertia, centre, a_a, omega, alpha)
    force = -mass * (a_a + of_s)
    moment = cross(centre, force) - inertia * alpha
    scale = np.hypot(*found.place.T) * np.hypot(*force.T)
    np.testing.assert_array_equal(found.force, force)
    assert np.all(np.abs(cross(found.place, found.force) - moment) <= 1e-13 * (1.0 + scale))
    turning = rotation(mass, inertia, centre, omega, alpha)
    about = -(inertia + mass * np.sum(centre**2, axis=1)) * alpha
    assert cross(turning.place, turning.force) == pytest.approx(about, rel=1e-12, abs=1e-12)


def test_two_masses_and_their_couple_have_the_inertia_of_the_link() -> None:
    """Force, and moment about S, at any motion: sum r x (-m_i a_i) + excess alpha = -J alpha."""
    rng = np.random.default_rng(3)
    for _ in range(20):
        mass, inertia, l1, l2 = rng.uniform(0.1, 2.0, 4)
        omega, alpha, lean = rng.normal(0, 9, 3)
        a_s = rng.normal(0, 9, 2)
        found = two_masses(mass, inertia, l1, l2)
        along = np.array([math.cos(lean), math.sin(lean)])
        force, moment = np.zeros(2), found.excess * alpha
        for part, at in ((found.first, -l1 * along), (found.second, l2 * along)):
            a = a_s + alpha * np.array([-at[1], at[0]]) - omega**2 * at
            force -= part * a
            moment -= part * (at[0] * a[1] - at[1] * a[0])
        assert force == pytest.approx(-mass * a_s, rel=1e-12, abs=1e-11)
        assert moment == pytest.approx(-inertia * alpha, rel=1e-12, abs=1e-11)


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


def test_a_body_that_turns_evenly_has_late_accelerations_of_its_centre_alone() -> None:
    """T = (m r^2 + I) w^2 / 2 = 2 J; S = m r^2 w^4 / 2 = 6 J/s^2; and the acceleration turns by
    w dt in a step, so that over 3 s its differences make m r^2 w^6 / 2 dt^2 3000 = 24 dt^2 3000.
    A log of every tenth step says the same."""
    late, tenth = of_steps(1), of_steps(10)
    assert late.start == pytest.approx(2.0 * 6.0 * DT_S**2 / 2.0)
    assert (late.offset, tenth.offset) == pytest.approx((late.start, late.start))
    assert late.loss == pytest.approx(2.0 * 24.0 * DT_S**4 * 3000 / 2.0, rel=1e-5)
    assert tenth.loss == pytest.approx(late.loss, rel=1e-4)


def test_what_comes_and_goes_is_late_by_its_mean_over_the_first_or_the_last_while() -> None:
    times = DT_S * np.arange(1001)
    even = solve(ROTOR, times)
    crank = even.links["crank"]
    jolted = {"crank": replace(crank, alpha=np.where(times == 0.5, 1e6, crank.alpha))}
    whole = late_impulses(ROTOR, replace(even, links=jolted), DT_S, 0.1)
    assert whole.offset == pytest.approx(late_impulses(ROTOR, even, DT_S, 0.1).offset)
