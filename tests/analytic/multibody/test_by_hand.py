"""Motions, and accelerations of the start, that are known by hand."""

from __future__ import annotations

import math

import numpy as np
import pytest

from analytic.multibody.release_multibody import release_multibody, start_state
from tests.analytic.multibody.scenes import DOUBLE_PENDULUM, PARALLELOGRAM, ROTOR, ROTOR_J, G, scene

TIMES = np.linspace(0.0, 1.0, 21)


def test_a_pendulum_starts_by_its_moment_over_its_inertia() -> None:
    start = start_state(scene(ROTOR + "start_deg = 20.0\nspeed_rad_s = 3.0\n"))
    c, s = math.cos(math.radians(20.0)), math.sin(math.radians(20.0))
    moment = -1.2 * G * (0.2 * c - 0.05 * s)
    assert start.alpha["rod"] == pytest.approx(moment / ROTOR_J, rel=1e-13)
    assert start.omega["rod"] == pytest.approx(3.0, rel=1e-14)


@pytest.mark.parametrize(
    ("load", "theta"),
    [
        (
            'law = "steps"\nat_s = [0.25, 0.6]\ntorque_n_m = [0.3, -0.1]',
            lambda t: (0.3 * np.maximum(t - 0.25, 0) ** 2 - 0.4 * np.maximum(t - 0.6, 0) ** 2) / 2,
        ),
        (
            'law = "pulse"\ntorque_n_m = 0.03\nperiod_s = 0.7',
            lambda t: np.where(
                t < 0.7,
                0.03 * 0.7 / math.tau * (t - 0.7 / math.tau * np.sin(math.tau * t / 0.7)),
                0.03 * 0.7 / math.tau * 0.7,
            ),
        ),
        (  # 0.3 (1 - omega / 2): speed goes to 2 by exp(-t 0.15 / J)
            'law = "table"\nover = "omega"\ninterpolation = "linear"\n'
            "at_rad_s = [-2.0, 2.0]\ntorque_n_m = [0.6, 0.0]",
            lambda t: 2 * ROTOR_J * (t - ROTOR_J / 0.15 * -np.expm1(-t * 0.15 / ROTOR_J)),
        ),
    ],
    ids=["steps", "pulse", "motor"],
)
def test_a_rotor_turns_as_its_torque_is_integrated(load: str, theta: object) -> None:
    """Over time with jumps in it, and over its own speed; not heavy."""
    free = release_multibody(scene(f'{ROTOR}[loads.m]\nlink = "rod"\n{load}\n', 0.0), 1.0)
    wanted = theta(TIMES) / ROTOR_J  # type: ignore[operator]
    assert free.at(TIMES).links["rod"].theta == pytest.approx(wanted, abs=2e-11)
    assert np.ptp(free.energy(TIMES).balance) < 1e-12


def test_a_spring_in_a_pin_swings_with_its_damper() -> None:
    """J theta'' + c theta' + k theta = 0, whole turns of the free angle left out."""
    spring = '[springs.s]\npin = "A"\nrate_n_m_rad = 0.9\ndamping_n_m_s = 0.05\nfree_deg = 360.0\n'
    free = release_multibody(scene(ROTOR + "start_deg = 30.0\n" + spring, 0.0), 1.0)
    decay, stiff = 0.05 / (2 * ROTOR_J), 0.9 / ROTOR_J
    fast = math.sqrt(stiff - decay**2)
    swing = np.cos(fast * TIMES) + decay / fast * np.sin(fast * TIMES)
    wanted = math.radians(30.0) * np.exp(-decay * TIMES) * swing
    assert free.at(TIMES).links["rod"].theta == pytest.approx(wanted, abs=1e-11)


def test_a_double_pendulum_starts_as_its_two_equations_say() -> None:
    """Slender rods, angles from the horizontal: 2 x 2 equations of Lagrange."""
    m1, l1, m2, l2 = 0.3, 0.3, 0.2, 0.2
    a, b, u, v = math.radians(10.0), math.radians(-40.0), 1.0, 2.0
    mix = 0.5 * m2 * l1 * l2
    matrix = [
        [(m1 / 3 + m2) * l1**2, mix * math.cos(a - b)],
        [mix * math.cos(a - b), m2 * l2**2 / 3],
    ]
    right = [
        -mix * math.sin(a - b) * v**2 - (m1 / 2 + m2) * G * l1 * math.cos(a),
        mix * math.sin(a - b) * u**2 - 0.5 * m2 * G * l2 * math.cos(b),
    ]
    wanted = np.linalg.solve(matrix, right)
    start = start_state(scene(DOUBLE_PENDULUM))
    assert [start.alpha["upper"], start.alpha["lower"]] == pytest.approx(wanted, rel=1e-12)
    assert (start.omega["upper"], start.omega["lower"]) == pytest.approx((u, v), rel=1e-13)


def test_three_rods_that_carry_a_coupler_are_one_pendulum() -> None:
    """One of them is redundant: the motion is determined, and what it needs, together."""
    times = np.linspace(0.0, 0.3, 7)
    free = release_multibody(scene(PARALLELOGRAM), 0.3)
    assert free.dynamics.redundant
    inertia, weight = 3 * 0.5 * 0.3**2 / 3 + 2.0 * 0.3**2, (3 * 0.5 / 2 + 2.0) * G * 0.3
    motion, energy = free.at(times), free.energy(times)
    wanted = -weight * np.cos(motion.links["crank"].theta) / inertia
    for rod in ("crank", "rocker", "spare"):
        assert motion.links[rod].alpha == pytest.approx(wanted, abs=1e-10)
    assert np.ptp(energy.balance) < 1e-11 * energy.kinetic.max()
    held = sum(motion.forces.pins[p]["ground"][:, 1] for p in "AED")
    lifted = [motion.links["crank"].alpha, motion.links["crank"].omega ** 2]
    c, s = (one(motion.links["crank"].theta) for one in (np.cos, np.sin))
    rise = 0.3 * (lifted[0] * c - lifted[1] * s)
    assert -held == pytest.approx(3.5 * G + (2.0 + 0.75) * rise, abs=1e-9)
