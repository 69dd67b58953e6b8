"""The shipped scenes of free motion: a second method, the multibody form, energy and what a kink
costs; periods by quadrature, beside the integrated motion; and the chain of windows: its closed
form against 50 digits, its equation against all bodies."""

import math
from collections.abc import Iterator

import mpmath
import numpy as np
import pytest
from scipy.optimize import brentq

from analytic.dyads.chunk import Chunk
from analytic.free.exact_motions import Amplitude, ChainMotion
from analytic.free.free_motion import FreeMotion
from analytic.free.integration import Integration
from analytic.free.release import release
from analytic.free.solved_motion import MachineMotion
from analytic.kinematics import solve_driven
from analytic.prepared import Prepared
from analytic.structure.mobility import analyse
from models.array import Array
from models.errors import CrankcheckError
from models.files.reading import load_scene, shipped
from models.scene import Scene
from models.scene.hard import UPRIGHT, WindowChain
from models.scene.joints import centre_of, mass_of
from tests.analytic.free.mechanisms import (
    driver_by_steps,
    fourbar,
    newton_euler,
    released,
    slider_crank,
)
from tests.analytic.multibody.scenes import by_bodies
from tests.second_opinions.constraints import Constraints
from tests.second_opinions.period import period
from tests.worlds.tiers import few, slowly

SHORT_S = {"engine-flywheel": 0.004, "squeezer": 0.03, "fourbar-double-rocker-swing": 0.35}
SHARES = np.array([0.137, 0.359, 0.611, 0.829, 1.0])
"""Of a time, four of which are the end of no window."""
SEVERAL_FREEDOMS = ("double-pendulum",)
"""These have the multibody form alone, which is held to itself elsewhere."""
NAMES = [name for name in shipped("free") if name not in SEVERAL_FREEDOMS]
STEADY = 100.0
"""The sensitivity up to which the digits of the issue are asked for."""
AT_MOST = {"engine-flywheel": 1.0, "squeezer": 1.0}
"""A second of the engine has 1320 kinks of its table, and costs a minute; its own time is 0.12 s.
The squeezer's is 1 s: in ten its motor spins it up, which takes minutes to integrate."""


def brief_and_long(*quick: str) -> list[object]:
    """Each scene for a short time, of which some are ``quick``, and for as long as it may last."""
    often, late = "the others show each kind of force", "errors that grow over many swings"
    brief = {name: SHORT_S.get(name, 0.12) for name in NAMES}
    long = {name: sorted({1.0, AT_MOST.get(name, 10.0)}) for name in NAMES}
    return [
        *((name, brief[name]) for name in quick),
        *(slowly(name, brief[name], reason=often) for name in NAMES if name not in quick),
        *(slowly(name, until_s, reason=late) for name in NAMES for until_s in long[name]),
    ]


def steady(name: str, until_s: float) -> tuple[MachineMotion, Array]:
    """A shipped scene that is let go, and instants up to where its sensitivity is too large."""
    free = released(load_scene(name), until_s)
    assert isinstance(free, MachineMotion)
    looks = np.linspace(0.0, until_s, 2001)
    known = looks[free.sensitivity(looks) < STEADY]
    return free, SHARES * known[-1]


@pytest.mark.parametrize(
    ("name", "until_s"), brief_and_long("fourbar-swing", "engine-flywheel", "press-motor")
)
def test_two_methods_agree_at_any_time(name: str, until_s: float) -> None:
    free, time_s = steady(name, until_s)
    theta, omega = driver_by_steps(free, time_s)
    allowed = np.where(time_s <= 1.0, 1e-11, 1e-9) * np.maximum(1.0, np.abs(theta))
    found = free.law.at(time_s)
    assert np.all(np.abs(found[0] - theta) <= allowed)
    assert np.all(np.abs(found[1] - omega) <= allowed * max(1.0, free.peak_speed_rad_s))
    assert np.all(free.error_rad(time_s) <= allowed)


@pytest.mark.parametrize(
    ("name", "until_s"),
    brief_and_long("fourbar-double-rocker-swing", "engine-flywheel", "slider-crank-spring"),
)
def test_the_multibody_form_agrees_with_every_link(name: str, until_s: float) -> None:
    if name == "engine-flywheel":
        until_s = min(until_s, load_scene(name).driver.law.period_s)
    free, time_s = steady(name, until_s)
    found = by_bodies(free.scene, until_s).at(time_s)
    wanted, grown = free.at(time_s), free.sensitivity(time_s)
    for link, motion in found.links.items():
        off = np.abs(motion.theta - wanted.links[link].theta)
        assert np.all(off <= 1e-9 * grown), link


@pytest.mark.parametrize(("name", "until_s"), brief_and_long(*NAMES))
def test_energy_balances_at_any_time(name: str, until_s: float) -> None:
    energy = released(load_scene(name), until_s).energy(np.linspace(0.0, until_s, 1999))
    off = np.abs(energy.balance - energy.balance[0])
    assert off.max() <= 1e-11 * energy.kinetic.max()


@pytest.mark.parametrize(
    "until_s", [0.5, slowly(1.0, reason="the closest limit"), slowly(10.0, reason="many turns")]
)
def test_the_chain_goes_as_its_closed_form_says(until_s: float) -> None:
    free, time_s = released(load_scene("fourbar-chain"), until_s), np.linspace(0.0, until_s, 333)
    off = np.abs(free.law.at(time_s)[0] - ChainMotion(WindowChain(2)).at(time_s)[0])
    assert off.max() <= (1e-11 if until_s <= 1.0 else 1e-9)
    assert np.all(off <= free.error_rad(time_s) + 1e-13)


def test_the_period_of_the_chain_is_that_of_its_closed_form() -> None:
    one = period(load_scene("fourbar-chain"))
    assert one.swing_rad is None
    assert one.time_s == pytest.approx(ChainMotion(WindowChain(2)).period_s, abs=1e-12)


@pytest.mark.parametrize("until_s", [1.2, slowly(10.0, reason="many swings")])
def test_the_swing_is_back_at_rest_after_its_periods(until_s: float) -> None:
    swing = load_scene("fourbar-swing")
    one, free = period(swing), released(swing, until_s)
    time_s = one.time_s * np.arange(1, int(until_s / one.time_s) + 1)
    theta, omega, alpha = free.law.at(time_s)
    assert np.abs(theta - swing.driver.law.start_rad).max() < 1e-11
    late_s = omega / alpha
    assert np.abs(np.diff(late_s, prepend=0.0)).max() < 1e-12


def test_a_kink_asks_for_the_mechanism_about_twice(monkeypatch: pytest.MonkeyPatch) -> None:
    """Two rounds of Newton's method; where the kinks are is asked of the driver alone."""
    asked: list[int] = []
    windows: list[int] = []
    chunk, run = Prepared.chunk, Integration.run

    def counted(self: Prepared, *given: object) -> Chunk:
        asked.append(1)
        return chunk(self, *given)  # type: ignore[arg-type]

    def followed(self: Integration) -> object:
        before = len(asked)
        found = run(self)
        windows.append(len(found.windows))
        assert len(asked) - before < 3 * len(found.windows)
        return found

    monkeypatch.setattr(Prepared, "chunk", counted)
    monkeypatch.setattr(Integration, "run", followed)
    motion = release(load_scene("engine-flywheel"), 0.03001)
    assert min(windows) > 35
    assert np.isfinite(motion.at(np.array([0.03])).links["crank"].theta).all()


def times_of(free: FreeMotion, level: float, until_s: float) -> list[float]:
    """When the driver passes an angle upwards."""
    time_s = np.linspace(0.0, until_s, 4001)
    off = free.law.at(time_s)[0] - level

    def after(t: float) -> float:
        return float(free.law.at(np.array([t]))[0][0]) - level

    found = np.flatnonzero((off[:-1] < 0.0) & (off[1:] >= 0.0))
    return [float(brentq(after, time_s[k], time_s[k + 1], xtol=1e-16)) for k in found]


SWINGS = "other swings, and that one takes as long as the last"


@pytest.mark.parametrize(
    ("swung", "until_s"),
    [
        (fourbar(), None),
        (slider_crank(), None),
        slowly(fourbar(), 4.0, reason=SWINGS),
        slowly(fourbar(start_deg=-85.0), 4.0, reason=SWINGS),
        slowly(fourbar(speed_rad_s=5.0), 4.0, reason=SWINGS),
        slowly(slider_crank(), 4.0, reason=SWINGS),
    ],
)
def test_swings_take_the_period_that_quadrature_has(swung: Scene, until_s: float | None) -> None:
    one = period(swung)
    assert one.swing_rad is not None
    until_s = until_s or 2.2 * one.time_s
    times = times_of(release(swung, until_s), 0.5 * sum(one.swing_rad), until_s)
    assert len(times) > 1
    assert np.abs(np.diff(times) - one.time_s).max() < 1e-12


@pytest.mark.parametrize("count", [3, slowly(5, reason="errors that grow with time")])
def test_turns_take_the_period_that_quadrature_has(count: int) -> None:
    turning = fourbar(speed_rad_s=40.0)
    one = period(turning)
    assert one.swing_rad is None
    times = one.time_s * np.arange(count)
    theta = release(turning, times[-1]).law.at(times)[0]
    assert np.abs(theta - theta[0] - math.tau * np.arange(count)).max() < 1e-11


CHAINS = [
    WindowChain(1),
    WindowChain(40),
    WindowChain(3, 0.5, 2.0, 3.0, -0.7),
    WindowChain(2, gravity_m_s2=0.0),
]


@pytest.mark.parametrize("count", [1, 2, 7, 40, 200])
def test_a_chain_has_as_many_rods_and_dyads_as_windows_want(count: int) -> None:
    scene = WindowChain(count).scene()
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
        WindowChain(**{"count": 2, **wrong})  # type: ignore[arg-type]


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
def test_closed_form_solves_the_reduced_equation_by_series_in_30_digits(chain: WindowChain) -> None:
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
def test_energy_over_all_bodies_is_that_of_the_closed_form_and_constant(chain: WindowChain) -> None:
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
    scene, turning = WindowChain(count).scene(), ChainMotion(WindowChain(count))
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
    turning, times = ChainMotion(WindowChain(2)), np.linspace(0.0, 0.5, 11)
    found = turning.motion(times)
    rocker = found.links["rocker0"]
    other = solve_driven(WindowChain(2).scene(), rocker.theta, rocker.omega, rocker.alpha)
    for name, point in found.points.items():
        for quantity, array in vars(point).items():
            assert array == pytest.approx(getattr(other.points[name], quantity), abs=1e-11)
    for name, link in found.links.items():
        assert link.alpha == pytest.approx(other.links[name].alpha, abs=1e-11)
        assert link.omega == pytest.approx(other.links[name].omega, abs=1e-12)


def test_a_period_is_a_whole_turn_against_the_sense_of_the_axes() -> None:
    turning = ChainMotion(WindowChain(40))
    theta, omega, alpha = turning.at(turning.period_s * np.array([0.0, 0.5, 1.0, 5.0]))
    assert theta == pytest.approx(UPRIGHT - math.tau * np.array([0.0, 0.5, 1.0, 5.0]), abs=1e-12)
    assert omega == pytest.approx([-1.0, -turning.fastest_rad_s, -1.0, -1.0], abs=1e-12)
    assert alpha == pytest.approx(np.zeros(4), abs=1e-11)
