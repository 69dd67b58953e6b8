"""Loads in free motion: each stage of RK4 sees the load of its own instant, and a step in which the
slider of a stroke turns back has its share.
"""

import mujoco  # type: ignore[import-untyped]  # ships no stubs
import numpy as np
import pytest

from analytic.free.exact_motions import ChainMotion
from analytic.free.release import release
from models.array import Array
from models.files.reading import load_scene
from models.scene.characteristics import Characteristic, Pulse, Sine, Staircase
from models.scene.hard import WindowChain
from models.scene.loads import Load
from models.scene.tabulated import Tabulated
from sim.mujoco.engine import MujocoSession
from sim.mujoco.loading import LoadStages, forward_parts
from sim.run import run
from tests.analytic.multibody.scenes import SLIDER_CRANK
from tests.analytic.multibody.scenes import scene as scene_of
from tests.worlds.runs import acted_on, opened, ran

DT_S = 0.01
INERTIA = 1.0 / 3.0
"""Of the rod about its pivot [kg m^2]."""
SAW = Tabulated((0.0, 0.013), (0.0, 1.0), period=0.0271)
FOURBAR = load_scene("fourbar-lecture-1")


def rod(course: Characteristic, integrator: str = "RK4") -> MujocoSession:
    """A rod without weight, under a torque, from 1 rad/s on."""
    chain = WindowChain(0, gravity_m_s2=0.0)
    given = {"start": ChainMotion(chain).motion(np.zeros(1)).state(), "dt_s": DT_S, "drive": "free"}
    scene = acted_on(chain.scene(), Load("torque", "rocker0", None, course))
    return opened(scene, "mujoco", {"integrator": integrator}, **given)


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
        (Staircase((0.1, 0.15, 0.18), (1.0, -2.0, 0.0)), 1e-9),  # on the grid
        (Staircase((0.1037, 0.1551, 0.15512, 0.1821), (1.0, -2.0, 0.5, 0.0)), 1e-6),
        (SAW, 1e-6),
        (Pulse(1.0, 0.171, 0.033), 1e-5),
    ],
    ids=["jumps at samples", "jumps between them", "saw", "pulse"],
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


def test_other_integrators_are_given_the_load_of_each_step() -> None:
    session = rod(Sine(1.0, 0.3, 0.4), "implicitfast")
    omega = session.record(30, 1).poses.bodies["rocker0"].omega
    speed, _ = of_torque(Sine(1.0, 0.3, 0.4), DT_S * np.arange(31))
    assert np.abs(omega - omega[0] - speed).max() < 0.03


def test_stages_keep_the_order_that_a_load_of_a_step_loses() -> None:
    """With loops whose stiffness is not the step's; with one load a step it would be 2."""
    own = {"free_timeconst_steps": 0, "solref_timeconst_steps": 0, "solref_timeconst_s": 0.005}
    scene = acted_on(FOURBAR, Load("torque", "rocker", None, Sine(0.5, 0.3, 0.7)))
    rough, fine, exact = (
        ran(scene, "mujoco", dt_s=0.6 / n, steps=n, every=n, settings=own, drive="free")
        .motion.links["rocker"]
        .theta[-1]
        for n in (600, 1200, 4800)
    )
    assert np.log2((rough - exact) / (fine - exact)) == pytest.approx(4.0, abs=0.5)


TURNING = scene_of(
    SLIDER_CRANK.replace("mass_kg = 0.5", "mass_kg = 1.0")
    + "start_deg = -90.0\nspeed_rad_s = 2.0\n"
    '[springs.back]\nslider = "C"\nrate_n_m = 200.0\nfree_m = 0.28\n'
    '[loads.cut]\nblock = "C"\nslider = "C"\nstroke = "forward"\n'
    "direction_deg = 180.0\nforce_n = 1.0\n",
    0.0,
)


@pytest.mark.parametrize("speed", [2.0, -2.0])
@pytest.mark.parametrize("share", [0.1, 0.5, 0.9])
def test_a_step_that_turns_back_keeps_impulse_and_lever(speed: float, share: float) -> None:
    """As Simpson's rule adds the parts up, to what is forward of 1, of time and of its square."""
    parts = np.array(forward_parts(speed, -speed / share))
    stages, weights = np.array([0.0, 0.5, 1.0]), np.array([1.0, 4.0, 1.0]) / 6.0
    for k in range(3):
        until = share ** (k + 1) / (k + 1)
        forward = until if speed > 0.0 else 1.0 / (k + 1) - until
        assert weights @ (parts * stages**k) == pytest.approx(forward, abs=1e-15)


@pytest.mark.parametrize(
    ("speed", "change", "whole"),
    [(2.0, 1.0, 1.0), (-2.0, -1.0, 0.0), (0.0, 1.0, 1.0), (0.0, -1.0, 0.0), (0.0, 0.0, 0.0)],
)
def test_a_step_that_does_not_turn_back_is_whole(speed: float, change: float, whole: float) -> None:
    assert forward_parts(speed, change) == (whole, whole, whole)


def test_steps_keep_their_order_where_a_slider_turns_back() -> None:
    """Three times in 0.8 s; with stages that looked at their own speed the error was 2e-4 rad at
    1e-3 s, and of first order."""
    motion = release(TURNING, 0.8)
    start = motion.at(np.zeros(1)).state()
    off = []
    for dt_s in (2e-3, 5e-4):
        steps = round(0.8 / dt_s)
        done = run(TURNING, start, "mujoco", dt_s=dt_s, steps=steps, drive="free")
        true = motion.at(done.motion.time_s, bound=False).links["crank"].theta
        off.append(float(np.abs(done.motion.links["crank"].theta - true).max()))
    # Where in its step each turn comes is chance, so that the order shows in the bounds alone.
    assert off[0] < 2e-5
    assert off[1] < 1.25e-6
