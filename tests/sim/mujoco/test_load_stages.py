"""Loads over time in free motion: each stage of RK4 sees the load of its own instant."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import mujoco  # type: ignore[import-untyped]  # ships no stubs
import numpy as np
import pytest

from analytic.free.window_chain import ChainMotion
from analytic.kinematics import solve
from models.array import Array
from models.characteristics import Characteristic, Polynomial, Sine
from models.files import load_scene
from models.loads import Load
from models.scene import Scene
from models.staircase import Staircase
from models.tabulated import Tabulated
from models.waves import Pulse
from models.window_chain import Chain
from sim.mujoco.load_stages import LoadStages, stage_sizes
from sim.mujoco.session import MujocoSession
from sim.registry import engine
from sim.settings import resolved

DT_S = 0.01
INERTIA = 1.0 / 3.0
"""Of the rod about its pivot [kg m^2]."""
SAW = Tabulated((0.0, 0.013), (0.0, 1.0), period=0.0271)
FOURBAR = load_scene("fourbar-lecture-1")


def with_torque(scene: Scene, link: str, course: Characteristic) -> Scene:
    return replace(scene, loads={"torque": Load("torque", link, None, course)})


def rod(course: Characteristic, integrator: str = "RK4") -> MujocoSession:
    """A rod without weight, under a torque, from 1 rad/s on."""
    chain = Chain(0, gravity_m_s2=0.0)
    settings = resolved(engine("mujoco").profiles["tuned"], {"integrator": integrator})
    state = ChainMotion(chain).motion(np.zeros(1)).state(0)
    scene = with_torque(chain.scene(), "rocker0", course)
    return MujocoSession(scene, state, settings, DT_S, "free")


def of_torque(course: Characteristic, time_s: Array) -> tuple[Array, Array]:
    """What a torque does to speed and angle of the rod at samples, by finer sums."""
    fine = 2000
    inner = DT_S / fine * (np.arange(fine * (len(time_s) - 1)) + 0.5)
    push = course.at(inner).reshape(-1, fine) / INERTIA * DT_S / fine
    left = DT_S * (1.0 - (np.arange(fine) + 0.5) / fine)
    gained, moved = push.sum(axis=1), push @ left
    speed = np.concatenate([[0.0], np.cumsum(gained)])
    return speed, np.concatenate([[0.0], np.cumsum(moved + DT_S * speed[:-1])])


@pytest.mark.parametrize(
    ("course", "within"),
    [
        (Polynomial((0.3, 2.0, -9.0)), 1e-9),
        (Staircase((0.1, 0.15, 0.18), (1.0, -2.0, 0.0)), 1e-9),  # on the grid
        (Staircase((0.1037, 0.1551, 0.15512, 0.1821), (1.0, -2.0, 0.5, 0.0)), 1e-6),
        (SAW, 1e-6),
        (Pulse(1.0, 0.171, 0.033), 1e-5),
        (Sine(1.0, 0.3, 0.4), 1e-6),
    ],
    ids=["polynomial", "jumps at samples", "jumps between them", "saw", "pulse", "sine"],
)
def test_a_rod_turns_as_its_torque_says(course: Characteristic, within: float) -> None:
    """Jumps and kinks between the samples are as exact as the sum that they are held to."""
    session = rod(course)
    first, second = session.record(7, 1).poses, session.record(23, 1).poses  # stretch by stretch
    one, two = first.bodies["rocker0"], second.bodies["rocker0"]
    time_s = DT_S * np.arange(31)
    speed, turned = of_torque(course, time_s)
    omega = np.concatenate([one.omega, two.omega[1:]])
    theta = np.concatenate([one.theta, two.theta[1:]])
    assert np.abs(omega - omega[0] - speed).max() < within
    assert np.abs(theta - theta[0] - omega[0] * time_s - turned).max() < within
    assert mujoco.get_mjcb_control() is None


def test_where_a_load_jumps_at_a_sample_the_acceleration_is_that_after_it() -> None:
    log = rod(Staircase((0.1, 0.2), (1.0, 0.0))).record(30, 1)
    alpha = log.poses.bodies["rocker0"].alpha * INERTIA
    expected = np.zeros(31)
    expected[10:20] = 1.0
    np.testing.assert_allclose(alpha, expected, atol=1e-12)


def test_a_jump_is_at_its_step_however_long_the_clock_has_added_up_rounding() -> None:
    """At 30 s the sum of steps of 0.1 ms is off by 1e-11 s."""
    load = Load("on", "crank", None, Staircase((30.0,), (1.0,)))
    clock = float(np.cumsum(np.full(300_000, 1e-4))[-1])
    assert abs(clock - 30.0) > 1e-12
    stages = LoadStages([load], 0.0, 1e-4, 299_999, 2)
    seen = [stages.at(clock + 1e-4 * c)[0] for c in (-1.0, -0.5, -0.5, 0.0, 0.0, 0.5, 0.5, 1.0)]
    assert seen == [0.0] * 4 + [1.0] * 4


def test_the_stages_of_a_step_with_a_jump_have_its_moments() -> None:
    """Of 1 from 0.3 of a step on, by Simpson's rule: 0.7 of speed, 0.7^2 / 2 of place."""
    load = Load("on", "crank", None, Staircase((0.3,), (1.0,)))
    ((start, middle, end),) = stage_sizes(load, 0.0, 1.0, 0, 1)
    assert (start + 4.0 * middle + end) / 6.0 == pytest.approx(0.7)
    assert (start + 2.0 * middle) / 6.0 == pytest.approx(0.5 * 0.7**2)


def test_other_integrators_are_given_the_load_of_each_step() -> None:
    session = rod(Sine(1.0, 0.3, 0.4), "implicitfast")
    omega = session.record(30, 1).poses.bodies["rocker0"].omega
    speed, _ = of_torque(Sine(1.0, 0.3, 0.4), DT_S * np.arange(31))
    assert np.abs(omega - omega[0] - speed).max() < 0.03


@cache
def ends(steps: int, stages: str) -> Array:
    """The angles of a four-bar after 0.6 s, with loops whose stiffness is not the step's."""
    own = {"free_timeconst_steps": 0, "solref_timeconst_steps": 0, "solref_timeconst_s": 0.005}
    settings = resolved(engine("mujoco").profiles["tuned"], own)
    scene = with_torque(FOURBAR, "rocker", Sine(0.5, 0.3, 0.7))
    dt_s, state = 0.6 / steps, solve(scene, np.zeros(1)).state()
    session = MujocoSession(scene, state, settings, dt_s, "free")
    if stages != "own":
        session._loading._of_time = []
    if stages == "at the start":
        at = session._loading.at_times
        session._loading.at_times = lambda time_s: at(time_s - 0.5 * dt_s)  # type: ignore[method-assign]
    poses = session.record(steps, steps).poses
    return np.array([poses.bodies[link].theta[-1] for link in scene.links])


@pytest.mark.parametrize(
    ("stages", "order"), [("own", 4.0), ("in the middle", 2.0), ("at the start", 1.0)]
)
def test_stages_keep_the_order_that_a_load_of_a_step_loses(stages: str, order: float) -> None:
    exact = ends(4800, "own")
    rough, fine = (np.abs(ends(n, stages) - exact).max() for n in (600, 1200))
    assert np.log2(rough / fine) == pytest.approx(order, abs=0.5)
