"""The chain of windows: its closed form against 50 digits, its equation against all bodies."""

from __future__ import annotations

import math
from collections.abc import Iterator

import mpmath
import numpy as np
import pytest

from analytic.check.constraints import Constraints
from analytic.free.window_chain import Amplitude, ChainMotion
from analytic.kinematics import solve_driven
from analytic.structure.mobility import analyse
from models.errors import CrankcheckError
from models.poses import centre_of, mass_of
from models.scene import Scene
from models.window_chain import UPRIGHT, Chain
from tests.analytic.free.second_method import newton_euler
from tests.worlds.tiers import few

CHAINS = [Chain(1), Chain(40), Chain(3, 0.5, 2.0, 3.0, -0.7), Chain(2, gravity_m_s2=0.0)]


@pytest.mark.parametrize("count", [1, 2, 7, 40, 200])
def test_a_chain_has_as_many_rods_and_dyads_as_windows_want(count: int) -> None:
    scene = Chain(count).scene()
    assert len(scene.links) == 2 * count + 1
    assert {"A0", f"B{count}", "B0"} <= scene.pins.keys()
    assert {len(bodies) for bodies in scene.pins.values()} == ({2, 3} if count > 1 else {2})
    found = analyse(scene)
    assert (found.mobility, found.count, len(found.groups)) == (1, 1, count)
    assert all(mass_of(scene, name) == (1.0, 1.0 / 12.0) for name in scene.links)


@pytest.mark.parametrize(
    ("wrong", "said"),
    [
        ({"count": -1}, "found -1 windows, where 0 is the least"),
        ({"length_m": 0.0, "mass_kg": math.nan}, "length_m 0, .*; mass_kg nan"),
        ({"gravity_m_s2": -9.81}, "gravity_m_s2 -9.81, where 0 is the least"),
        ({"speed_m_s": 0.0}, "speed_m_s 0, where another number"),
    ],
)
def test_numbers_that_make_no_chain_are_refused(wrong: dict[str, float], said: str) -> None:
    with pytest.raises(CrankcheckError, match=said):
        Chain(**{"count": 2, **wrong})  # type: ignore[arg-type]


@pytest.mark.parametrize("rest", [1.0, 0.3, 1e-3, 1e-9])
def test_the_amplitude_is_jacobis_to_rounding(rest: float) -> None:
    found = Amplitude(rest)
    with mpmath.workdps(50):
        m = 1 - mpmath.mpf(rest)
        assert abs(found.quarter / mpmath.ellipk(m) - 1) < 1e-15
        for u in np.linspace(-3.7, 3.7, 23) * found.quarter:
            am = found.at(np.array([u]))[0]
            off = mpmath.ellipf(mpmath.mpf(float(am)), m) - mpmath.mpf(float(u))
            assert abs(off) < 4e-15 * (1.0 + abs(u)) / math.sqrt(rest) ** 0.5


def taylor(theta: mpmath.mpf, omega: mpmath.mpf, gain: mpmath.mpf) -> Iterator[tuple]:
    """theta, theta' after each 0.05 s of theta'' = -gain cos(theta), in series of 24 terms."""
    step = mpmath.mpf("0.05")
    while True:
        yield theta, omega
        a, c, s = [theta, omega], [mpmath.cos(theta)], [mpmath.sin(theta)]
        for n in range(23):
            a.append(-gain * c[n] / ((n + 1) * (n + 2)))
            c.append(-sum((k + 1) * a[k + 1] * s[n - k] for k in range(n + 1)) / (n + 1))
            s.append(sum((k + 1) * a[k + 1] * c[n - k] for k in range(n + 1)) / (n + 1))
        theta, omega = mpmath.polyval(a[::-1], step, derivative=True)


@pytest.mark.parametrize("chain", few(CHAINS, CHAINS[2:3], "the one in which no number is 1"))
def test_closed_form_solves_the_reduced_equation_by_series_in_30_digits(chain: Chain) -> None:
    """From the equation and the start alone, over more than a turn."""
    n, turning = chain.count, ChainMotion(chain)
    times = 0.05 * np.arange(101)
    theta, omega, alpha = turning.at(times)
    assert abs(theta[-1] - theta[0]) > min(math.tau, 5.0 / chain.length_m) - 1e-9
    with mpmath.workdps(30):
        g, length = mpmath.mpf(chain.gravity_m_s2), mpmath.mpf(chain.length_m)
        gain = g / length * (mpmath.mpf(3 * n + 1) / 2) / (mpmath.mpf(4 * n + 1) / 3)
        path = taylor(mpmath.pi / 2, -mpmath.mpf(chain.speed_m_s) / length, gain)
        for i, (angle, rate) in zip(range(len(times)), path, strict=False):
            assert abs(angle - theta[i]) < 4e-14 * (1.0 + abs(theta[i])), times[i]
            assert abs(rate - omega[i]) < 1e-13 * turning.fastest_rad_s * (1.0 + times[i])
            assert abs(-gain * mpmath.cos(angle) - alpha[i]) < 1e-12


@pytest.mark.parametrize("chain", CHAINS)
def test_energy_over_all_bodies_is_that_of_the_closed_form_and_constant(chain: Chain) -> None:
    turning, times = ChainMotion(chain), np.linspace(0.0, 20.0, 401)
    theta, omega, _ = turning.at(times)
    energy = turning.energy(theta, omega)
    scale = turning.exchanged_j + energy[0]
    assert np.abs(energy - energy[0]).max() < 1e-14 * scale
    assert np.abs(energy - summed(chain.scene(), turning, times)).max() < 1e-14 * scale


def summed(scene: Scene, turning: ChainMotion, times: np.ndarray) -> np.ndarray:
    """Kinetic and potential energy, body by body, from the motion of their points."""
    motion, total = turning.motion(times), np.zeros_like(times)
    for name, link in scene.links.items():
        mass, inertia = mass_of(scene, name)
        assert centre_of(scene, name) == (0.5 * scene.longest_m, 0.0)
        ends = [motion.points[point] for point in link.points]
        speed = (ends[0].velocity + ends[1].velocity) / 2
        height = (ends[0].position[:, 1] + ends[1].position[:, 1]) / 2
        total += mass * ((speed**2).sum(axis=1) / 2 - scene.gravity_m_s2[1] * height)
        total += inertia * motion.links[name].omega ** 2 / 2
    return total


@pytest.mark.parametrize("count", [0, 1, 2, 5])
def test_the_equation_of_motion_follows_from_newton_euler_of_all_bodies(count: int) -> None:
    scene, turning = Chain(count).scene(), ChainMotion(Chain(count))
    system = Constraints(scene)
    for t in (0.0, 0.3, 0.7):
        motion = turning.motion(np.array([t]))
        q, rates = np.zeros((2, system.size))
        for name, link in scene.links.items():
            i, first = system.at[name], motion.points[next(iter(link.points))]
            q[i : i + 3] = *first.position[0], motion.links[name].theta[0]
            rates[i : i + 3] = *first.velocity[0], motion.links[name].omega[0]
        found = newton_euler(scene, system, q, rates)
        for name in scene.links:
            assert abs(found[system.at[name] + 2] - motion.links[name].alpha[0]) < 1e-11


def test_the_motion_of_the_pins_is_that_of_the_closed_form_of_the_linkage() -> None:
    turning, times = ChainMotion(Chain(2)), np.linspace(0.0, 0.5, 11)
    found = turning.motion(times)
    rocker = found.links["rocker0"]
    other = solve_driven(Chain(2).scene(), rocker.theta, rocker.omega, rocker.alpha)
    for name, point in found.points.items():
        for quantity, array in vars(point).items():
            assert array == pytest.approx(getattr(other.points[name], quantity), abs=1e-11)
    for name, link in found.links.items():
        assert link.alpha == pytest.approx(other.links[name].alpha, abs=1e-11)
        assert link.omega == pytest.approx(other.links[name].omega, abs=1e-12)


def test_a_period_is_a_whole_turn_against_the_sense_of_the_axes() -> None:
    turning = ChainMotion(Chain(40))
    theta, omega, alpha = turning.at(turning.period_s * np.array([0.0, 0.5, 1.0, 5.0]))
    assert theta == pytest.approx(UPRIGHT - math.tau * np.array([0.0, 0.5, 1.0, 5.0]), abs=1e-12)
    assert omega == pytest.approx([-1.0, -turning.fastest_rad_s, -1.0, -1.0], abs=1e-12)
    assert alpha == pytest.approx(np.zeros(4), abs=1e-11)
