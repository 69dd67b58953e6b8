"""A mechanism that is let go in exudyn, with springs, motors and jumps: all of second order."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from functools import cache
from itertools import pairwise

import numpy as np
import pytest
from scipy.integrate import solve_ivp  # type: ignore[import-untyped]  # ships no stubs

from analytic.free.machine import Machine
from models.array import Array
from models.characteristics import Characteristic, Polynomial
from models.files import load_scene
from models.loads import Load, Over
from models.released import Released
from models.scene import GROUND, Driver, Scene
from models.springs import LineSpring, PinSpring, SlideSpring, Spring
from models.staircase import Staircase
from models.waves import Pulse
from sim.engine import Run, Settings
from sim.exudyn.engine import ENGINE
from sim.exudyn.jumps import StepMeans
from tests.worlds import runs
from tests.worlds.let_go import released
from tests.worlds.runs import acted_on
from tests.worlds.tiers import few

UNTIL_S = 0.4


def let_go(name: str, start_rad: float, speed_rad_s: float = 0.0, *acting: Spring | Load) -> Scene:
    """A shipped scene with its driver free, in gravity, with what acts on it."""
    scene = load_scene(name)
    driver = Driver(scene.driver.link, Released(start_rad, speed_rad_s, UNTIL_S))
    return acted_on(replace(scene, driver=driver, gravity_m_s2=(0.0, -9.81)), *acting)


def torque(characteristic: Characteristic, over: Over = "time") -> Load:
    return Load("torque", "crank", None, characteristic, over)


SCENES = {
    "gravity": let_go("fourbar-lecture-1", 0.3),
    "springs": let_go(
        "fourbar-lecture-1", 0.3, 2.0, LineSpring("line", 50.0, 0.5, 0.1, ("B", "D")),
        LineSpring("slack at nothing", 20.0, 0.1, 0.0, ("A", "C")),
        PinSpring("knee", 0.3, 0.01, 0.5, "C", ("coupler", "rocker")),
        PinSpring("wound", 0.1, 0.0, 7.0, "A", (GROUND, "crank"))),
    "spring of a block": let_go(
        "slider-crank-offset", 1.0, 0.0, SlideSpring("line", 900.0, 5.0, 0.3, "C")),
    "spring of a block without mass": let_go(
        "slider-crank-excel-210", 0.5, 1.0, SlideSpring("line", 300.0, 5.0, 2.0, "C")),
    "spring of a moving line": let_go(
        "slotted-lever", 0.5, 1.0, SlideSpring("line", 300.0, 5.0, 0.2, "B")),
    "pulse": let_go("fourbar-lecture-1", 0.3, 0.0, torque(Pulse(2.0, 0.1, 0.05))),
    "jumps": let_go(
        "fourbar-lecture-1", -1.2, 0.0,
        torque(Staircase((-1.0, 0.0, 0.05, 0.0503, 0.25), (0.1, 0.3, 0.8, -0.5, 0.0)))),
    "motor": let_go("fourbar-lecture-1", 0.3, 1.0, torque(Polynomial((2.0, -0.2)), "omega")),
    "steep motor": let_go(
        "fourbar-lecture-1", 0.3, 10.0, torque(Polynomial((30.0, -3.0)), "omega")),
    "drag": let_go(
        "slider-crank-offset", 1.0, 4.0,
        Load("drag", "block C", "C", Polynomial((0.0, -2.0, 0.0, -0.5)), "speed", "C")),
}  # fmt: skip


@cache
def exact(name: str) -> tuple[Array, Array]:
    """Instants, and the driver's angle at them, integrated from jump to jump."""
    scene = SCENES[name]
    machine, law = Machine(scene), scene.driver.law

    def rates(time_s: float, state: Array) -> Sequence[float]:
        now = np.array([time_s])
        return state[1], machine.acceleration(now, state[:1], state[1:])[0]

    kinks = {k for load in scene.loads.values() for k in load.characteristic.kinks}
    edges = sorted({0.0, UNTIL_S} | {k for k in kinks if 0.0 < k < UNTIL_S})
    state, samples = np.array([law.start_rad, law.speed_rad_s]), np.linspace(0.0, UNTIL_S, 41)
    angles = np.empty(41)
    for low, high in pairwise(edges):
        # A staircase has its new value in the edge itself.
        span = low, high - 1e-15
        done = solve_ivp(rates, span, state, "LSODA", dense_output=True, rtol=1e-10, atol=1e-11)
        within = (samples >= low) & (samples <= high)
        angles[within], state = done.sol(samples[within])[0], done.y[:, -1]
    return samples, angles


def ran(scene: Scene, dt_s: float, settings: Settings | None = None) -> Run:
    steps = round(UNTIL_S / dt_s)
    given = {"dt_s": dt_s, "steps": steps, "every": steps // 40, "settings": settings}
    return runs.ran(scene, ENGINE, start=released(scene)[0], drive="free", **given)


def off(name: str, dt_s: float) -> float:
    done = ran(SCENES[name], dt_s)
    return float(np.abs(done.motion.links[SCENES[name].driver.link].theta - exact(name)[1]).max())


@pytest.mark.parametrize(
    "name",
    few(
        SCENES,
        {"spring of a moving line", "jumps", "motor"},
        "the others' parts act by themselves in tests of the contract",
    ),
)
def test_whatever_acts_the_motion_is_of_second_order(name: str) -> None:
    coarse, fine = off(name, 2e-3), off(name, 5e-4)
    assert fine < 5e-3
    assert 11.0 < coarse / fine < 22.0


def test_the_start_has_the_accelerations_of_what_acts() -> None:
    for name in ("springs", "steep motor", "spring of a block without mass"):
        scene = SCENES[name]
        done = ran(scene, 2e-3)
        for link, alpha in released(scene)[0].alpha.items():
            scale = max(abs(each) for each in released(scene)[0].alpha.values())
            assert done.motion.links[link].alpha[0] == pytest.approx(alpha, abs=1e-6 * scale)


def test_what_damps_is_less_where_nothing_drives_and_loses_less_energy() -> None:
    scene, lost = SCENES["gravity"], []
    for radius in (0.9, 0.4):
        done = ran(scene, 1e-3, {"free_spectral_radius": radius})
        assert done.settings["spectral_radius"] == radius
        swing = np.ptp(done.energy.potential_j)
        lost.append(abs(done.energy.total_j[-1] - done.energy.total_j[0]) / swing)
    assert ENGINE.profiles["tuned"].settings["free_spectral_radius"].value == 0.9
    assert lost[0] < 0.2 * lost[1] < 1e-3


def test_a_steep_motor_alone_shows_in_the_settings() -> None:
    assert "loads_jacobian_used" not in ran(SCENES["springs"], 2e-3).settings
    assert ran(SCENES["steep motor"], 2e-3).settings["loads_jacobian_used"] == "enable"


def test_the_spring_of_a_block_without_mass_goes_to_its_pin() -> None:
    scene = SCENES["spring of a block without mass"]
    given = {"dt_s": 1e-3, "steps": 60, "drive": "free", "with_forces": True}
    done = runs.ran(scene, ENGINE, start=released(scene)[0], **given)
    forces, slid = done.motion.forces, done.motion.sliders["C"]
    (line,) = (one for one in scene.springs.values() if isinstance(one, SlideSpring))
    pull = line.rate * (slid.displacement - line.free) + line.damping * slid.speed
    angle = scene.sliders["C"].direction_rad
    along, across = np.array(
        [[math.cos(angle), math.sin(angle)], [-math.sin(angle), math.cos(angle)]]
    )
    left = forces.pins["C"]["block C"] + forces.sliders["C"].normal[:, None] * across
    np.testing.assert_allclose(left, pull[:, None] * along, atol=1e-9 * np.abs(pull).max())


def test_jumps_have_their_impulse_and_its_instant_wherever_they_are_in_a_step() -> None:
    dt_s = 1e-2
    ends = dt_s * np.arange(9)
    for place in (0.003, 0.03, 0.0412, 0.0499999):
        stairs = Staircase((place,), (2.0,))
        felt = np.array([StepMeans(stairs, 0.0, dt_s).at(end) for end in ends])
        impulse = dt_s * (felt.sum() - 0.5 * (felt[0] + felt[-1]))
        assert impulse == pytest.approx(2.0 * (ends[-1] - place))
        if place > dt_s:
            moment = dt_s * ((felt * ends).sum() - 0.5 * felt[-1] * ends[-1])
            assert moment == pytest.approx(ends[-1] ** 2 - place**2, abs=2e-5)
    early = StepMeans(Staircase((-0.2, 0.0), (1.0, 3.0)), 0.0, dt_s)
    assert (early.at(0.0), early.at(dt_s)) == (3.0, 3.0)
