"""Springs in MuJoCo: what they do to the motion, also of a double pendulum, to the reactions, and
what its file says.
"""

from dataclasses import replace

import mujoco  # type: ignore[import-untyped]  # ships no stubs
import numpy as np
import pytest

from analytic.free.release import release
from models.errors import EngineError
from models.files.reading import load_scene, parse_scene
from models.mjcf.document import build
from models.scene import GROUND, Driver, Scene
from models.scene.characteristics import Polynomial
from models.scene.driver import Released
from models.scene.loads import LineSpring, Load, PinSpring, SlideSpring, Spring
from sim.mujoco.engine import MujocoSession
from sim.run import run
from sim.run.check import refuse_other_model
from tests.analytic.multibody.scenes import start_state
from tests.worlds import runs
from tests.worlds.let_go import released
from tests.worlds.reported_forces import left_over
from tests.worlds.runs import acted_on, massless

DT_S = 1e-4


def let_go(name: str, *springs: Spring) -> Scene:
    """A shipped scene, let go in some position of its own."""
    scene = load_scene(name)
    driver = Driver(scene.driver.link, Released(0.7, 3.0, 1.0))
    return acted_on(replace(scene, driver=driver), *springs)


FOURBAR, CRANK = "fourbar-lecture-1", "slider-crank-excel-210"
SCENES = {
    "between points": let_go(FOURBAR, LineSpring("l", 300.0, 4.0, 0.1, ("B", "D"))),
    "where a loop closes": let_go(
        FOURBAR, PinSpring("p", 2.0, 0.1, 0.3, "C", ("coupler", "rocker"))),
    "seen from the other": let_go(
        FOURBAR, PinSpring("p", 2.0, 0.1, -1, "C", ("rocker", "coupler"))),
    "of the crank": let_go(FOURBAR, PinSpring("p", 2.0, 0.1, 5.0, "A", (GROUND, "crank"))),
    "at a pin": let_go(FOURBAR, PinSpring("p", 2.0, 0.1, 0.3, "B", ("coupler", "crank"))),
    "from behind": let_go(CRANK, SlideSpring("s", 3e3, 30.0, -1.0, "C")),
    "of no mass": massless(let_go(CRANK, SlideSpring("s", 3e3, 30.0, 0.1, "C"))),
    "on a link": let_go("slotted-lever", SlideSpring("s", 3e2, 3.0, 0.1, "B")),
    "two of one": let_go(
        FOURBAR, PinSpring("p", 2.0, 0.0, 0.3, "A", (GROUND, "crank")),
        PinSpring("q", 3.0, 0.1, 0.9, "A", ("crank", GROUND))),
    "all kinds": let_go(
        CRANK, SlideSpring("s", 3e3, 30.0, 0.1, "C"), LineSpring("l", 3e3, 4.0, 0.1, ("B", "C")),
        LineSpring("m", 3e3, 4.0, 0.1, ("A", "C")),
        PinSpring("p", 20.0, 0.1, 0.3, "B", ("crank", "rod"))),
}  # fmt: skip


def opened(scene: Scene) -> MujocoSession:
    return runs.opened(scene, "mujoco", start=released(scene)[0], dt_s=DT_S, drive="free")


@pytest.mark.parametrize("name", SCENES)
def test_springs_are_held_and_accelerate_as_in_the_equation_of_the_machine(name: str) -> None:
    scene = SCENES[name]
    _, alpha = released(scene)
    _, without = released(replace(scene, springs={}))
    driver = opened(scene).read().bodies[scene.driver.link]
    assert driver.alpha[0] == pytest.approx(alpha, abs=2e-3 * abs(alpha - without))
    undamped = {n: replace(one, damping=0.0) for n, one in scene.springs.items()}
    _, loose = released(replace(scene, springs=undamped))
    assert abs(loose - alpha) > 5e-3 * abs(alpha - without)  # dampers count
    state, _ = released(scene)
    session = opened(scene)
    refuse_other_model(scene, state, session.facts(), DT_S, "free")
    session._model.tendon_stiffness[0] *= 1.001
    first = next(iter(scene.springs))
    with pytest.raises(EngineError, match=rf"springs\.{first} has rate"):
        refuse_other_model(scene, state, session.facts(), DT_S, "free")


@pytest.mark.parametrize("name", SCENES)
def test_springs_are_no_reactions_and_nothing_drives_the_crank(name: str) -> None:
    """Dampers by differences, which are good to the second order of the step; the torque to the
    rounding of loops that do not give way."""
    scene = SCENES[name]
    log = opened(scene).record_forces(40, 1)
    assert max(left_over(scene, log)) < 1e-5
    forces = log.forces
    largest = max(float(np.abs(f).max()) for by in forces.pins.values() for f in by.values())
    assert np.abs(forces.torque).max() < 5e-7 * largest * scene.longest_m


def test_springs_under_the_servo_s_integrator_have_the_iterations_that_they_need() -> None:
    """With two of them `discrete` gives the run up at its first step."""
    scene = replace(load_scene(FOURBAR), springs=SCENES["where a loop closes"].springs)
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
    scene = let_go(FOURBAR, LineSpring("l", 30.0, 0.4, 0.1, ("B", "D")))
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
