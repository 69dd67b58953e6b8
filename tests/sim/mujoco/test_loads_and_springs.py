"""Loads and springs in MuJoCo: each stage of RK4 sees the load of its own instant, and a step in
which the slider of a stroke turns back has its share; what springs do to motion and reactions, and
what the file says of them.
"""

import itertools
from dataclasses import replace

import mujoco  # type: ignore[import-untyped]  # ships no stubs
import numpy as np
import pytest

from analytic.free.exact_motions import ChainMotion
from analytic.free.release import release
from models.array import Array
from models.errors import EngineError
from models.files.reading import load_scene, parse_scene
from models.mjcf.document import build
from models.scene import GROUND, Driver, Scene
from models.scene.characteristics import Characteristic, Polynomial, Pulse, Sine, Staircase
from models.scene.driver import Released
from models.scene.hard import WindowChain
from models.scene.loads import LineSpring, Load, PinSpring, SlideSpring, Spring
from models.scene.tabulated import Tabulated
from sim.mujoco.engine import MujocoSession
from sim.mujoco.loading import StageClock, forward_parts, stage_sizes
from sim.run import run
from sim.run.check import refuse_other_model
from tests.analytic.multibody.scenes import SLIDER_CRANK, start_state
from tests.analytic.multibody.scenes import scene as scene_of
from tests.worlds import runs
from tests.worlds.let_go import released
from tests.worlds.reported_forces import left_over
from tests.worlds.runs import acted_on, massless, opened, ran

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


def test_a_jump_is_at_its_step_with_the_acceleration_after_it_however_late() -> None:
    log = rod(Staircase((0.1, 0.2), (1.0, 0.0))).record(30, 1)
    alpha = log.poses.bodies["rocker0"].alpha * INERTIA
    expected = np.zeros(31)
    expected[10:20] = 1.0
    np.testing.assert_allclose(alpha, expected, atol=1e-12)
    # At 30 s the sum of steps of 0.1 ms is off by 1e-11 s.
    load = Load("on", "crank", None, Staircase((30.0,), (1.0,)))
    clock = float(np.cumsum(np.full(300_000, 1e-4))[-1])
    assert abs(clock - 30.0) > 1e-12
    stages, sizes = StageClock(1e-4, 299_999), stage_sizes(load, 0.0, 1e-4, 299_999, 2)
    seen = [sizes[stages.at(clock + 1e-4 * c)] for c in (-1.0, -0.5, -0.5, 0.0, 0.0, 0.5, 0.5, 1.0)]
    assert seen == [0.0] * 4 + [1.0] * 4


def test_stages_keep_the_order_that_the_one_load_of_a_step_loses() -> None:
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
    # Other integrators are given the load of each step.
    session = rod(Sine(1.0, 0.3, 0.4), "implicitfast")
    omega = session.record(30, 1).poses.bodies["rocker0"].omega
    speed, _ = of_torque(Sine(1.0, 0.3, 0.4), DT_S * np.arange(31))
    assert np.abs(omega - omega[0] - speed).max() < 0.03


TURNING = scene_of(
    SLIDER_CRANK.replace("mass_kg = 0.5", "mass_kg = 1.0")
    + "start_deg = -90.0\nspeed_rad_s = 2.0\n"
    '[springs.back]\nslider = "C"\nrate_n_m = 200.0\nfree_m = 0.28\n'
    '[loads.cut]\nblock = "C"\nslider = "C"\nstroke = "forward"\n'
    "direction_deg = 180.0\nforce_n = 1.0\n",
    0.0,
)


def test_a_step_that_turns_back_keeps_impulse_and_lever_and_any_other_is_whole() -> None:
    """As Simpson's rule adds the parts up, to what is forward of 1, of time and of its square."""
    stages, weights = np.array([0.0, 0.5, 1.0]), np.array([1.0, 4.0, 1.0]) / 6.0
    for speed, share, k in itertools.product((2.0, -2.0), (0.1, 0.5, 0.9), range(3)):
        parts = np.array(forward_parts(speed, -speed / share))
        until = share ** (k + 1) / (k + 1)
        forward = until if speed > 0.0 else 1.0 / (k + 1) - until
        assert weights @ (parts * stages**k) == pytest.approx(forward, abs=1e-15)
    for speed, change in ((2.0, 1.0), (0.0, 1.0)):
        assert forward_parts(speed, change) == (1.0, 1.0, 1.0)
    for speed, change in ((-2.0, -1.0), (0.0, -1.0), (0.0, 0.0)):
        assert forward_parts(speed, change) == (0.0, 0.0, 0.0)


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


FINE_S = 1e-4


def let_go(name: str, *springs: Spring) -> Scene:
    """A shipped scene, let go in some position of its own."""
    scene = load_scene(name)
    driver = Driver(scene.driver.link, Released(0.7, 3.0, 1.0))
    return acted_on(replace(scene, driver=driver), *springs)


BARS, CRANK = "fourbar-lecture-1", "slider-crank-excel-210"
SCENES = {
    "between points": let_go(BARS, LineSpring("l", 300.0, 4.0, 0.1, ("B", "D"))),
    "where a loop closes": let_go(
        BARS, PinSpring("p", 2.0, 0.1, 0.3, "C", ("coupler", "rocker"))),
    "seen from the other": let_go(
        BARS, PinSpring("p", 2.0, 0.1, -1, "C", ("rocker", "coupler"))),
    "of the crank": let_go(BARS, PinSpring("p", 2.0, 0.1, 5.0, "A", (GROUND, "crank"))),
    "at a pin": let_go(BARS, PinSpring("p", 2.0, 0.1, 0.3, "B", ("coupler", "crank"))),
    "from behind": let_go(CRANK, SlideSpring("s", 3e3, 30.0, -1.0, "C")),
    "of no mass": massless(let_go(CRANK, SlideSpring("s", 3e3, 30.0, 0.1, "C"))),
    "on a link": let_go("slotted-lever", SlideSpring("s", 3e2, 3.0, 0.1, "B")),
    "two of one": let_go(
        BARS, PinSpring("p", 2.0, 0.0, 0.3, "A", (GROUND, "crank")),
        PinSpring("q", 3.0, 0.1, 0.9, "A", ("crank", GROUND))),
    "all kinds": let_go(
        CRANK, SlideSpring("s", 3e3, 30.0, 0.1, "C"), LineSpring("l", 3e3, 4.0, 0.1, ("B", "C")),
        LineSpring("m", 3e3, 4.0, 0.1, ("A", "C")),
        PinSpring("p", 20.0, 0.1, 0.3, "B", ("crank", "rod"))),
}  # fmt: skip


def let_go_in(scene: Scene) -> MujocoSession:
    return runs.opened(scene, "mujoco", start=released(scene)[0], dt_s=FINE_S, drive="free")


@pytest.mark.parametrize("name", SCENES)
def test_springs_are_held_and_accelerate_as_the_machine_s_equation_and_bear_nothing(
    name: str,
) -> None:
    scene = SCENES[name]
    _, alpha = released(scene)
    _, without = released(replace(scene, springs={}))
    driver = let_go_in(scene).read().bodies[scene.driver.link]
    assert driver.alpha[0] == pytest.approx(alpha, abs=2e-3 * abs(alpha - without))
    undamped = {n: replace(one, damping=0.0) for n, one in scene.springs.items()}
    _, loose = released(replace(scene, springs=undamped))
    assert abs(loose - alpha) > 5e-3 * abs(alpha - without)  # dampers count
    state, _ = released(scene)
    session = let_go_in(scene)
    refuse_other_model(scene, state, session.facts(), FINE_S, "free")
    log = let_go_in(scene).record_forces(40, 1)
    assert max(left_over(scene, log)) < 1e-5  # springs are no reactions
    largest = max(np.abs(f).max() for by in log.forces.pins.values() for f in by.values())
    assert np.abs(log.forces.torque).max() < 5e-7 * largest * scene.longest_m
    session._model.tendon_stiffness[0] *= 1.001
    first = next(iter(scene.springs))
    with pytest.raises(EngineError, match=rf"springs\.{first} has rate"):
        refuse_other_model(scene, state, session.facts(), FINE_S, "free")


def test_springs_under_the_servo_s_integrator_have_the_iterations_that_they_need() -> None:
    """With two of them `discrete` gives the run up at its first step."""
    scene = replace(load_scene(BARS), springs=SCENES["where a loop closes"].springs)
    done = runs.ran(scene, "mujoco", steps=20, drive="servo")
    assert done.warnings == ()
    assert (done.settings["iterations"], done.settings["iterations_of_springs"]) == (2, 20)
    driven = runs.ran(scene, "mujoco", steps=20)
    assert "iterations_of_springs" not in driven.settings


def test_springs_add_lines_to_the_text_and_change_none() -> None:
    scene = SCENES["between points"]
    state, _ = released(scene)
    bare, text = build(replace(scene, springs={}), state), build(scene, state)
    rest = iter(text.splitlines())
    assert all(line in rest for line in bare.splitlines())
    assert "tendon" not in bare
    tendon = '<spatial name="spring l" stiffness="300.0" damping="4.0" springlength="0.1">'
    assert tendon in text
    assert "armature" not in text
    behind = build(SCENES["from behind"], released(SCENES["from behind"])[0])
    assert 'springlength="1.0"' in behind  # -1 says something else to MuJoCo
    assert 'coef="-1"' in behind


def test_springs_dampers_and_motors_are_followed_to_fourth_order() -> None:
    """That of the steps; with inverse weights as compiled the give of the loop makes it second."""
    scene = let_go(BARS, LineSpring("l", 30.0, 0.4, 0.1, ("B", "D")))
    motor = Load("motor", "crank", None, Polynomial((0.3, -0.05)), "omega")
    scene = acted_on(scene, motor, *scene.springs.values())
    true, state = release(scene, 0.3), released(scene)[0]
    errors = []
    for steps in (300, 600):
        done = run(scene, state, "mujoco", dt_s=0.3 / steps, steps=steps, drive="free")
        off = done.motion.links["crank"].theta - true.law.at(done.motion.time_s)[0]
        errors.append(np.abs(off).max())
    assert np.log2(errors[0] / errors[1]) == pytest.approx(4.0, abs=0.3)
    assert errors[1] < 1e-8


TABLES = """
name = "two-tables"
source = "made here: two tables on parallel lines, pinned at R, never turn against each other"
[ground]
points = { A = [0.0, 0.0] }
[links]
crank = { bar = ["A", "B"], length_m = 0.1 }
rod = { bar = ["B", "R"], length_m = 0.3 }
table = { points = { R = [0.0, 0.0], T = [0.1, 0.05] }, mass_kg = 1.0 }
second = { points = { R = [0.0, 0.0], U = [0.1, 0.05] }, mass_kg = 1.0 }
[sliders]
R = { on = "ground", link = "table" }
U = { on = "ground", link = "second", through_m = [0.0, 0.05] }
[driver]
link = "crank"
law = "free"
speed_rad_s = 5.0
[start]
angles_deg = { rod = 0.0, table = 0.0, second = 0.0 }
"""


def test_a_spring_between_bodies_that_never_turn_against_each_other_moves_nothing() -> None:
    scene = parse_scene(TABLES, "here")
    idle = PinSpring("idle", 2.0, 0.1, 0.2, "R", ("table", "second"))
    state = start_state(scene)
    model = mujoco.MjModel.from_xml_string(build(acted_on(scene, idle), state))
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    assert np.all(data.qfrc_passive == 0.0)
    pulled = model.tendon_stiffness[0] * (data.ten_length[0] - model.tendon_lengthspring[0, 0])
    assert abs(pulled) == pytest.approx(abs(idle.pull(0.0, 0.0)))
