"""The shipped scenes of free motion: a second method, the multibody form, energy, periods by
quadrature and what a kink costs; and the chain of windows."""

import math
from functools import partialmethod
from unittest.mock import Mock

import mpmath
import numpy as np
import pytest
from scipy.integrate import solve_ivp

from analytic.free.exact_motions import Amplitude, ChainMotion
from analytic.free.integration import Integration
from analytic.free.machine import Machine
from analytic.free.release import release
from analytic.free.solved_motion import MachineMotion
from analytic.kinematics import solve_driven
from analytic.prepared import Prepared
from analytic.structure.mobility import analyse
from models.array import Array
from models.errors import CrankcheckError
from models.files.reading import load_scene, shipped
from models.scene import Scene
from models.scene.hard import WindowChain
from models.scene.joints import centre_of, mass_of
from tests.analytic.free.mechanisms import released
from tests.analytic.multibody.scenes import by_bodies
from tests.second_opinions.period import period
from tests.worlds.tiers import slowly

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
    late = "errors that grow over many swings"
    return [
        *((name, SHORT_S.get(name, 0.12)) for name in quick),
        *(slowly(name, AT_MOST.get(name, 10.0), reason=late) for name in NAMES),
    ]


def steady(name: str, until_s: float) -> tuple[MachineMotion, Array]:
    """A shipped scene that is free, and instants up to where its sensitivity is too large."""
    free = released(load_scene(name), until_s)
    assert isinstance(free, MachineMotion)
    looks = np.linspace(0.0, until_s, 2001)
    known = looks[free.sensitivity(looks) < STEADY]
    return free, SHARES * known[-1]


@pytest.mark.parametrize(
    ("name", "until_s"),
    [
        slowly("fourbar-swing", 0.12, reason="the multibody form is stepped by such a method"),
        slowly("fourbar-swing", 10.0, reason="errors that grow over many swings"),
        slowly("slider-crank-spring", 10.0, reason="errors that grow over many swings"),
    ],
)
def test_a_method_by_steps_of_order_8_agrees(name: str, until_s: float) -> None:
    """In steps of at most 0.06 rad: left to itself it takes longer ones, and misses its tolerance
    by a thousand."""
    free, time_s = steady(name, until_s)
    ((chart, _, _),) = free.history.legs()
    machine, wound = Machine(free.scene, chart), dict(free.history.windows[0].wound)

    def rates(t: float, y: Array) -> tuple[float, float]:
        return float(y[1]), float(machine.acceleration(np.array([t]), y[:1], y[1:], wound)[0])

    start = [float(row[0]) for row in free.history.state(np.zeros(1))[:2]]
    most, kept = 0.06 / max(free.peak_speed_rad_s, 1.0), {"rtol": 3e-14, "atol": 1e-15}
    done = solve_ivp(rates, (0.0, time_s[-1]), start, "DOP853", time_s, max_step=most, **kept)
    theta, slope, _ = chart.driver(done.y[0])
    allowed = np.where(time_s <= 1.0, 1e-11, 1e-9) * np.maximum(1.0, np.abs(theta))
    found = free.law.at(time_s)
    assert np.all(np.abs(found[0] - theta) <= allowed)
    assert np.all(np.abs(found[1] - slope * done.y[1]) <= allowed * max(1.0, free.peak_speed_rad_s))
    assert np.all(free.error_rad(time_s) <= allowed)


@pytest.mark.parametrize(
    ("name", "until_s"),
    brief_and_long("slider-crank-spring"),
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


@pytest.mark.parametrize(("name", "until_s"), brief_and_long(*NAMES[::2]))
def test_energy_balances_at_any_time(name: str, until_s: float) -> None:
    energy = released(load_scene(name), until_s).energy(np.linspace(0.0, until_s, 1999))
    off = np.abs(energy.balance - energy.balance[0])
    assert off.max() <= 1e-11 * energy.kinetic.max()


@pytest.mark.parametrize("until_s", [0.5, slowly(10.0, reason="many turns")])
def test_the_chain_goes_as_its_closed_form_says(until_s: float) -> None:
    free, time_s = released(load_scene("fourbar-chain"), until_s), np.linspace(0.0, until_s, 333)
    exact = ChainMotion(WindowChain(2))
    off, rate, push = np.abs(np.subtract(free.law.at(time_s), exact.at(time_s)))
    assert off.max() <= (1e-11 if until_s <= 1.0 else 1e-9)
    assert np.all(off <= free.error_rad(time_s) + 1e-13)
    assert max(rate.max(), push.max()) <= 1e-8
    one = period(free.scene)
    assert one.swing_rad is None
    assert one.time_s == pytest.approx(exact.period_s, abs=1e-12)


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
    chunk, run, windows = Prepared.chunk, Integration.run, list[int]()

    def followed(self: Integration) -> object:
        with monkeypatch.context() as patched:
            asked = Mock(side_effect=chunk)
            patched.setattr(Prepared, "chunk", partialmethod(asked))
            found = run(self)
        windows.append(len(found.windows))
        assert asked.call_count < 3 * len(found.windows)
        return found

    monkeypatch.setattr(Integration, "run", followed)
    release(load_scene("engine-flywheel"), 0.03001)
    assert min(windows) > 35


CHAINS = [
    WindowChain(1),
    WindowChain(40),
    WindowChain(3, 0.5, 2.0, 3.0, -0.7),
    WindowChain(2, gravity_m_s2=0.0),
]


@pytest.mark.parametrize("count", [1, 2, 40])
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
