"""Constraint equations and their derivatives, against differences; the start of a motion: what is
named, what is found, and what is refused; motions that are known by hand; what Baumgarte's terms
let decay, cost, and where they fail; and what comes to an infinite speed in a finite time."""

import math
import re
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from analytic.free.free_motion import FreeMotion
from analytic.free.release import release
from analytic.kinematics import solve
from analytic.multibody.assembly import Assembly
from analytic.multibody.bodies import Configuration
from analytic.multibody.multibody_motion import Baumgarte, MultibodyMotion
from analytic.multibody.release_multibody import release_multibody
from models.array import Array
from models.errors import CrankcheckError
from models.files.reading import load_scene, shipped
from models.scene import Scene
from models.scene.driver import let_go
from models.scene.loads import ConstantFriction, Load
from models.scene.tabulated import Tabulated
from tests.analytic.chain import coordinates
from tests.analytic.multibody.scenes import (
    DOUBLE_PENDULUM,
    PARALLELOGRAM,
    ROTOR,
    ROTOR_J,
    SLIDER_CRANK,
    THESIS,
    G,
    by_bodies,
    scene,
    start_state,
)
from tests.second_opinions.baumgarte_table import STABLE, baumgarte_table
from tests.worlds.loading import loaded_mechanism, massless


@pytest.mark.parametrize("name", [*shipped(), *shipped("forces")])
def test_derivatives_are_those_of_the_equations(name: str) -> None:
    mechanism = load_scene(name)
    assembly, step = Assembly(mechanism), 1e-6
    at = 0.3 * mechanism.driver.law.period_s
    q = np.array(coordinates(mechanism, solve(mechanism, np.array([at]), bound=False), 0))
    rates = np.cos(np.arange(len(q)))  # no rates that joints allow: what they are open counts too
    sides = [assembly.at_rates((q + e * rates)[None], rates[None]) for e in (step, -step)]
    now, joints = assembly.at_rates(q[None], rates[None]), assembly.joints

    def slope(of: Callable[[Configuration], Array]) -> Array:
        return np.subtract(*map(of, sides)) / (2 * step)

    assert np.abs(joints.gaps(now)).max() < 1e-13
    assert slope(joints.gaps)[0] == pytest.approx(joints.jacobian(now)[0] @ rates, abs=1e-8)
    # d/dt (Phi_q q') = Phi_q q'' - gamma, and here q'' is 0.
    flow = slope(lambda side: joints.jacobian(side)[0] @ rates)
    assert flow == pytest.approx(-joints.gamma(now)[0], abs=1e-7)
    assert slope(lambda side: side.place) == pytest.approx(now.velocity, abs=1e-8)
    assert slope(lambda side: side.velocity) == pytest.approx(now.drift, abs=1e-8)


def test_angles_off_a_drawing_and_one_that_leads_to_the_others_give_the_assembly() -> None:
    theta = start_state(scene(THESIS)).theta
    told = [math.degrees(theta[name]) for name in ("coupler", "rocker", "crank")]
    assert told[:2] == pytest.approx([39.083, 123.855], abs=1e-3)
    assert told[2] == pytest.approx(90.0, abs=1e-12)
    whole, named = (scene(THESIS.replace(cut, "")) for cut in ("", ", rocker = 124.0"))
    assert start_state(named).theta == pytest.approx(start_state(whole).theta, abs=1e-12)
    slid = SLIDER_CRANK + "start_deg = 30.0\n[start]\ndisplacements_m = { C = 0.383 }\n"
    bare = scene(SLIDER_CRANK + "start_deg = 30.0\n")
    near = solve(bare, np.zeros(1), bound=False).state()
    assert start_state(scene(slid)).theta == pytest.approx(near.theta, abs=1e-12)
    assert start_state(bare, near).displacement["C"] == pytest.approx(near.displacement["C"])


def test_beside_a_limit_a_slow_driver_moves_the_others_fast() -> None:
    """What they are off by is rounding of their own rates, and not of the driver's."""
    slow = let_go(loaded_mechanism(81)[0], 1.0)
    law = replace(slow.driver.law, speed_rad_s=-0.056)  # type: ignore[call-arg]
    slow = replace(slow, driver=replace(slow.driver, law=law))
    start = start_state(slow, solve(slow, np.zeros(1), bound=False).state())
    assert max(abs(omega) for omega in start.omega.values()) > 1.0
    assert start.omega[slow.driver.link] == pytest.approx(-0.056, rel=1e-6)


FLAT = THESIS.replace("0.15", "0.25").replace("90.0", "0.0")
for bar, length_m in (('"D", "C"', 0.25), ('"B", "C"', 1.0)):
    FLAT = FLAT.replace(f"[{bar}], length_m = 0.75", f"[{bar}], length_m = {length_m}")
REFUSED = {
    "change point": (
        FLAT.replace("39.0", "0.0").replace("124.0", "0.0"),
        "starts in a change point",
    ),
    "rigid": (
        ROTOR.replace("[0.0, 0.0] }", "[0.0, 0.0], B = [0.5, 0.0] }"),
        "nothing can move",
    ),
    "far": (
        THESIS.replace("39.0", "50.0"),
        r"coupler is 50 deg.* open there by 10\.9 deg: with dr",
    ),
    "open": (THESIS.replace("[1.0, 0.0]", "[3.0, 0.0]"), r"cannot be assembled.* open by 1\.5\d m"),
    "unnamed": (THESIS.split("[start]")[0], "the start of coupler, rocker is not named"),
    "speeds": (
        THESIS + "rates_rad_s = { rocker = 1.0 }\n",
        "contradict each other.* is 1, and 0.8",
    ),
    "pendulum": (DOUBLE_PENDULUM.split("rates")[0], "1 of its freedoms have no speed"),
    "slid too far": (
        SLIDER_CRANK + "start_deg = 30.0\n[start]\ndisplacements_m = { C = 0.5 }\n",
        r"start\.displacements_m\.C is 0\.5 m, and the joints are open there by 0\.118 m",
    ),
}


@pytest.mark.parametrize(("text", "said"), REFUSED.values(), ids=REFUSED)
def test_a_start_that_is_none_is_refused(text: str, said: str) -> None:
    with pytest.raises(CrankcheckError, match=said):
        start_state(scene(text))


def test_a_freedom_without_mass_and_friction_are_refused() -> None:
    text = SLIDER_CRANK + "[start]\nangles_deg = { rod = 0.0 }\n"
    with pytest.raises(CrankcheckError, match="1 of its 1 freedoms moves nothing that has a mass"):
        start_state(massless(scene(text)))  # no file says so
    rubbing = replace(load_scene("fourbar-swing"), friction={"B": ConstantFriction("B", 0.1)})
    with pytest.raises(CrankcheckError, match="friction in B"):
        by_bodies(rubbing, 1.0)


def test_a_rotor_turns_as_its_torque_is_integrated() -> None:
    """Over time with jumps in it; not heavy."""
    load = 'link = "rod"\nlaw = "steps"\nat_s = [0.25, 0.6]\ntorque_n_m = [0.3, -0.1]\n'
    free, t = (
        release_multibody(scene(f"{ROTOR}[loads.m]\n{load}", 0.0), 1.0),
        np.linspace(0.0, 1.0, 21),
    )
    twice = 0.3 * np.maximum(t - 0.25, 0.0) ** 2 - 0.4 * np.maximum(t - 0.6, 0.0) ** 2
    assert free.at(t).links["rod"].theta == pytest.approx(0.5 * twice / ROTOR_J, abs=2e-11)
    assert np.ptp(free.energy(t).balance) < 1e-12


def test_a_double_pendulum_starts_as_its_two_equations_say() -> None:
    """Slender rods, angles from the horizontal: 2 x 2 equations of Lagrange."""
    m1, l1, m2, l2 = 0.3, 0.3, 0.2, 0.2
    a, b, u, v = math.radians(10.0), math.radians(-40.0), 1.0, 2.0
    mix = 0.5 * m2 * l1 * l2
    both = mix * math.cos(a - b)
    matrix = [[(m1 / 3 + m2) * l1**2, both], [both, m2 * l2**2 / 3]]
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
    crank = motion.links["crank"]
    rise = 0.3 * (crank.alpha * np.cos(crank.theta) - crank.omega**2 * np.sin(crank.theta))
    assert -held == pytest.approx(3.5 * G + (2.0 + 0.75) * rise, abs=1e-9)


SWING = scene(THESIS.replace("start_deg", "speed_rad_s = 6.0\nstart_deg"))


def test_the_table_shows_the_order_the_best_and_where_it_fails() -> None:
    """Numbers that let nothing decay are refused."""
    for wrong in ((-1.0, 0.0, None), (1.0, 1.0, 0.0), (math.nan, 0.0, 1e-3)):
        with pytest.raises(CrankcheckError, match=r"give rates .* of 0 or more, and a step"):
            Baumgarte(*wrong)
    step_s = 4e-3
    rows = baumgarte_table(SWING, 0.3, (0.0, 20.0, 800.0), (2 * step_s, step_s))
    errors = {(row.alpha, row.step_s): row.error for row in rows}
    assert 10.0 < errors[0.0, 2 * step_s] / errors[0.0, step_s] < 26.0  # order 4
    gaps = {(row.alpha, row.step_s): row.gap for row in rows}
    assert gaps[20.0, step_s] < 0.5 * gaps[0.0, step_s]
    for row in rows:
        assert row.stable == (row.alpha * row.step_s <= STABLE)
        assert math.isinf(row.error) == (not row.stable)


SQUARE = (
    "start_deg = 60.0\nspeed_rad_s = 5.0\n"
    '[loads.motor]\nlink = "{}"\nlaw = "polynomial"\nover = "omega"\ntorque_n_m = [0.0, 0.0, {}]\n'
)
CUBE = SQUARE.replace("[0.0", "[0.0, 0.0")
ROTOR_LOST_S = 0.2
"""omega' = c omega^2 has 1 / omega = 1 / 5 - c t, here with c = 1; omega' = c omega^3 has
1 / omega^2 = 1 / 25 - 2 c t, here with c = 0.1."""
LetGo = Callable[[Scene, float], FreeMotion | MultibodyMotion]


@pytest.mark.parametrize(
    ("let_go", "load"),
    [
        (by_bodies, SQUARE.format("rod", ROTOR_J)),
        (release, CUBE.format("rod", 0.1 * ROTOR_J)),
    ],
)
def test_one_that_runs_away_is_told_until_when(
    let_go: LetGo, load: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("analytic.multibody.steps.CROWD", 50)
    with pytest.raises(CrankcheckError, match=r"loads\.motor over omega drives it") as told:
        let_go(scene(ROTOR + load, 0.0), 2.0).at(np.array([2.0]))
    lost_s = re.search(r"runs away: at about (\S+) s", str(told.value))
    assert float(lost_s[1]) == pytest.approx(ROTOR_LOST_S, rel=1e-3)
    assert "give a time of 0.18 s or less" in str(told.value)


def test_one_that_turns_ever_faster_is_refused_soon(monkeypatch: pytest.MonkeyPatch) -> None:
    """By a load that grows with the angle its turns never end, in less and less time."""
    monkeypatch.setattr("analytic.free.integration.MOST_WINDOWS", 1_000)
    monkeypatch.setattr("analytic.free.integration.FIRST_WINDOWS", 150)
    steep = CUBE.replace('"omega"', '"angle"')
    with pytest.raises(CrankcheckError, match=r"loads\.motor over angle drives it"):
        release(scene(SLIDER_CRANK + steep.format("crank", 1.0)), 2.0).at(np.array([2.0]))


def test_what_has_turned_back_does_not_run_away(monkeypatch: pytest.MonkeyPatch) -> None:
    """Many rows of a table, of next to nothing, in a tenth of a millisecond make many windows, and
    what turns back is slow for a while."""
    monkeypatch.setattr("analytic.free.integration.FIRST_WINDOWS", 60)
    raised = ROTOR + "start_deg = 40.0\n"
    looks = np.linspace(0.1, 1.0, 1000)
    omega = release(scene(raised), 1.0).at(looks).links["rod"].omega
    reversal_s = float(looks[np.argmax((omega > 0.0) != (omega[0] > 0.0))])
    at_s = [0.0, *(reversal_s / 0.9 + 5e-5 * np.linspace(-1.0, 1.0, 100)).tolist(), 20.0]
    rattle = Tabulated(tuple(at_s), (0.0, *(1e-6 * (np.arange(100) % 2)).tolist(), 0.0))
    loads = {"rattle": Load("rattle", "rod", None, rattle)}
    release(replace(scene(raised), loads=loads), 1.0).at(np.array([1.0]))
