"""Springs and dampers in driven scenes: by groups, by multipliers and by power; by hand."""

from __future__ import annotations

import math
import random
from dataclasses import replace

import numpy as np
import pytest

from analytic.check import multipliers
from analytic.forces import kinetostatics
from analytic.forces.reduced_machine import reduced_machine
from analytic.forces.springs import spring_lengths
from analytic.kinematics import chunks, solve, solve_driven
from models.files import load_scene, shipped
from models.laws import Accelerating, ConstantSpeed
from models.scene import GROUND, Driver
from models.springs import LineSpring, PinSpring, SlideSpring
from tests.analytic.forces.beside import AGREED, apart, out_of_balance, turn, unlocked
from tests.analytic.forces.test_force_bounds import beside
from tests.worlds.loading import loaded_mechanism
from tests.worlds.sprung import sprung
from tests.worlds.tiers import slowly


@pytest.mark.parametrize(
    "seeds", [range(1), slowly(range(1, 6), reason="springs at random")], ids=len
)
@pytest.mark.parametrize("name", [*shipped(), *shipped("forces")])
def test_three_computations_agree_with_springs(name: str, seeds: range) -> None:
    for seed in seeds:
        scene = sprung(load_scene(name), random.Random(seed))
        time_s = unlocked(scene, turn(scene))
        found = kinetostatics.forces(scene, time_s)
        assert apart(found, multipliers.forces(scene, solve(scene, time_s))) <= AGREED
        assert out_of_balance(scene, time_s, found) <= AGREED
        plain = kinetostatics.forces(replace(scene, springs={}), time_s)
        assert apart(found, plain) > 1e3 * AGREED


@pytest.mark.parametrize("count", [16, slowly(200, reason="random mechanisms")])
def test_random_mechanisms_with_springs_agree(count: int) -> None:
    """Springs on moving guides and on blocks among them."""
    for number in range(0, count, 2):
        scene = sprung(loaded_mechanism(number)[0], random.Random(number))
        time_s = np.linspace(0.01, 1.0, 5) * scene.driver.law.period_s
        found = kinetostatics.forces(scene, time_s)
        assert apart(found, multipliers.forces(scene, solve(scene, time_s))) <= AGREED, number
        assert out_of_balance(scene, time_s, found) <= AGREED, number


@pytest.mark.parametrize("count", [8, slowly(100, reason="random mechanisms")])
def test_bounds_hold_with_springs(count: int) -> None:
    """Half of them near a dead point."""
    loose = []
    for number in range(count):
        plain, near = loaded_mechanism(number)
        scene = sprung(plain, random.Random(number))
        time_s = 0.0 if near else random.Random(number).uniform(-1.0, 1.0)
        rows = beside(scene, np.array([time_s * scene.driver.law.period_s]))
        assert not [row for row in rows if not row.error <= row.bound], number
        loose += [row.bound / row.error for row in rows if row.error > 0.0 and row.bound < np.inf]
    assert np.median(loose) < 4000.0


@pytest.mark.parametrize(("rate", "damping"), [(1e7, 0.0), (1.0, 1e7)])
def test_bounds_hold_where_a_stiff_spring_is_all_but_slack(rate: float, damping: float) -> None:
    """After thousands of swings: then what its length, or its speed, may be wrong by is all of the
    error."""
    for number in range(0, 12, 2):
        scene = sprung(loaded_mechanism(number)[0], random.Random(number))
        time_s = np.array([3.1e4 * scene.driver.law.period_s])
        _, chunk = next(iter(chunks(scene, time_s, bound=False)))
        for spring, q, speed in spring_lengths(scene, chunk, counted=True):
            free = float(q[0]) + damping / rate * float(speed[0])
            slack = replace(spring, rate=rate, damping=damping, free=free)
            rows = beside(replace(scene, springs={spring.name: slack}), time_s)
            assert not [row for row in rows if not row.error <= row.bound], (number, spring)


def test_the_reduced_torque_has_the_springs_in_it() -> None:
    """torque = I alpha + I' omega^2 / 2 - M, under a driver that speeds up."""
    scene = sprung(load_scene("shaper"), random.Random(1))
    law = Accelerating(0.4, 0.5, 1.0)
    scene = replace(scene, driver=Driver(scene.driver.link, law))
    time_s = np.linspace(0.01, 0.9, 7)
    machine, (_, omega, alpha) = reduced_machine(scene, time_s), law.at(time_s)
    torque = machine.inertia * alpha + 0.5 * machine.slope * omega**2 - machine.torque
    found = kinetostatics.forces(scene, time_s).torque
    assert torque == pytest.approx(found, abs=1e-11 * np.abs(found).max())


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
