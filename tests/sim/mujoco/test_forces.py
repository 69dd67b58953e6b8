"""The forces that MuJoCo reports, each body in equilibrium, against the reference: with loads of
every kind at the right instant, with constant friction in its joints; and what the viewer plays.
"""

from collections.abc import Mapping
from dataclasses import replace
from functools import partial
from typing import Any

import mujoco  # type: ignore[import-untyped]  # ships no stubs
import numpy as np
import pytest

from analytic.forces import kinetostatics
from analytic.free.exact_motions import ChainMotion
from models.errors import EngineError
from models.files.reading import load_scene
from models.mjcf.document import build
from models.scene import Scene
from models.scene.characteristics import Constant, Sine
from models.scene.hard import WindowChain
from models.scene.loads import ConstantFriction, CoulombFriction, Load
from models.scene.tabulated import Tabulated
from sim.mujoco import viewer as mujoco_viewer
from sim.run import run
from tests.worlds import runs
from tests.worlds.reported_forces import left_over, worst_of
from tests.worlds.runs import acted_on, massless, ran, rubbing, start_of

STEPS = 720
WITHIN: Mapping[str, float] = {
    "scotch-yoke": 4e-4,
    "shaper": 8e-4,
}
"""Of the largest reaction, and torque of the largest torque, where it is not 1e-4."""

KINDS = ("sixbar-watt", "slider-crank-excel-210", "shaper", "scotch-yoke", "slotted-lever")
opened = partial(runs.opened, own="mujoco", steps=STEPS)


@pytest.mark.parametrize("name", KINDS)
def test_forces_are_those_of_the_reference_and_of_each_bodys_equilibrium(name: str) -> None:
    scene = load_scene(name)
    log = opened(scene).record_forces(STEPS, 1)
    for by_body in log.forces.pins.values():
        assert np.abs(sum(by_body.values())).max() == pytest.approx(0.0, abs=1e-12)
    force, moment = left_over(scene, log)
    assert max(force, moment / scene.longest_m) < 1e-9
    assert worst_of(scene, log.forces) < WITHIN.get(name, 1e-4)


@pytest.mark.parametrize("close", ["B", "D"])
def test_forces_do_not_depend_on_where_the_loop_is_closed(close: str) -> None:
    scene = FOURBAR
    log = opened(scene, settings={"close": close}).record_forces(STEPS, 4)
    force, moment = left_over(scene, log)
    assert max(force, moment / scene.longest_m) < 1e-9
    assert worst_of(scene, log.forces) < 1e-4


FOURBAR = load_scene("fourbar-lecture-1")
SETTLED = 40
"""Steps after which the closing springs bear what they have to."""


def off(scene: Scene, *, steps: int = 2000) -> float:
    """The largest error of a reaction or of the torque, as shares, in the first instants."""
    log = opened(scene, steps=steps).record_forces(SETTLED + 20, 1)
    return worst_of(scene, log.forces, SETTLED)


@pytest.mark.parametrize("load", [
    Load("tilt", "block C", "C", Constant(20.0), direction_rad=1.0, frame="body"),
    Load("twist", "block C", None, Constant(0.7)),
    Load("gas", "block C", "C", Sine(20.0, 0.1, 0.4), "displacement", "C", "forward"),
    Load("push", "block B", "B", Constant(5.0), direction_rad=1.0),
    Load("turn", "block B", None, Constant(0.7)),
], ids=lambda load: load.name)  # fmt: skip
def test_loads_on_a_block_without_mass_go_where_they_belong(load: Load) -> None:
    """On a guide that is the ground, and on one that moves."""
    name = "slider-crank-excel-210" if load.body == "block C" else "slotted-lever"
    assert off(acted_on(massless(load_scene(name)), load)) < 2e-4


def test_what_the_text_has_no_words_for_is_refused() -> None:
    load = Load("along", "block B", "B", Constant(5.0), frame="body")
    with pytest.raises(EngineError, match=r"loads.along: .* give sliders.B a mass_kg above 0"):
        opened(acted_on(load_scene("slotted-lever"), load))
    scene = replace(FOURBAR, friction={"B": CoulombFriction("B", 0.1, 0.01)})
    with pytest.raises(EngineError, match=r"friction.B: .*only constant friction"):
        build(scene, start_of(FOURBAR))


def test_a_slider_past_the_end_of_a_table_feels_its_last_row_and_leaves_no_callback() -> None:
    scene = load_scene("slider-crank-central")
    state = start_of(scene)
    at = state.displacement["C"]
    ends = Tabulated((at - 0.01, at + 0.01), (2.0, 2.0))
    short = acted_on(scene, Load("gas", "block C", "C", ends, "displacement", "C"))
    always = acted_on(scene, Load("gas", "block C", "C", Constant(2.0)))
    done, plain = (ran(each, "mujoco", dt_s=1e-3, steps=300) for each in (short, always))
    found, wanted = (one.motion.sliders["C"].displacement for one in (done, plain))
    np.testing.assert_allclose(found, wanted, atol=1e-12)
    assert mujoco.get_mjcb_control() is None


def test_loads_add_lines_to_the_text_and_change_none() -> None:
    state = start_of(FOURBAR)
    loads = (
        Load("pull", "rocker", "C", Constant(3.0), direction_rad=0.5),
        Load("own", "coupler", "C", Constant(4.0), direction_rad=0.5, frame="body"),
        Load("pulse", "coupler", None, Sine(1.0, 2.0, 0.5 * np.pi)),
    )
    bare, text = build(FOURBAR, state), build(acted_on(FOURBAR, *loads), state)
    key = next(line for line in bare.splitlines() if "<key " in line)
    assert key.replace("/>", ' ctrl="3.0 4.0 1.0"/>') in text
    rest = iter(text.splitlines())
    assert all(line in rest for line in bare.splitlines() if line != key)
    assert "pulse: its course over the time is not in this" in text
    model = mujoco.MjModel.from_xml_string(text)
    assert not mujoco.MjData(model).ctrl.any()
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, 0)
    mujoco.mj_forward(model, data)
    # Virtual work: the force at C by the speed of C, a turn of one hinge at a time.
    place = data.site_xpos[model.site("load pull").id] - data.xanchor[model.joint("rocker.D").id]
    turning = 3.0 * (place[0] * np.sin(0.5) - place[1] * np.cos(0.5))
    assert data.qfrc_actuator[model.joint("rocker.D").dofadr[0]] == pytest.approx(turning)


@pytest.mark.parametrize(("name", "sizes"), [
    ("fourbar-lecture-1", {"A": 0.05}),
    ("fourbar-lecture-1", {"C": 0.05, "B": 0.03}),
    ("slider-crank-offset", {"C": 10.0}),
    ("slotted-lever", {"B": 1.0}),
])  # fmt: skip
def test_friction_costs_the_torque_of_the_reference(name: str, sizes: dict[str, float]) -> None:
    """At 720 steps a turn, but for the samples about a turning point: there friction goes from one
    side to the other, in MuJoCo over some steps."""
    scene = rubbing(load_scene(name), **sizes)
    found = opened(scene).record_forces(STEPS, 1).forces.stretch(slice(5, None))
    true = kinetostatics.forces(scene, found.time_s, bound=False)
    turning = np.zeros(len(found.time_s), dtype=bool)
    for joint, size in sizes.items():
        off = np.abs(found.friction[joint] - true.friction[joint])
        assert np.abs(found.friction[joint]).max() == pytest.approx(size, rel=1e-9)
        turning |= off > 1e-3 * size
    assert turning.mean() < 0.015
    error = np.abs(found.torque - true.torque)[~turning]
    assert error.max() < 0.01 * np.abs(true.torque).max()
    assert np.quantile(error, 0.98) < 1e-4 * np.abs(true.torque).max()
    bare = kinetostatics.forces(load_scene(name), found.time_s, bound=False)
    assert np.abs(true.torque - bare.torque).max() > 0.02 * np.abs(true.torque).max()


def test_loops_close_at_a_pin_that_does_not_rub_or_the_scene_is_not_held() -> None:
    at_c = rubbing(FOURBAR, C=0.05)
    assert opened(at_c).facts().settings["close"] == "D"
    state = start_of(FOURBAR)
    assert 'frictionloss="0.05"' in build(at_c, state)
    assert "frictionloss" not in build(FOURBAR, state)
    done = run(rubbing(FOURBAR, B=0.1, C=0.1, D=0.1), state, "mujoco", dt_s=1e-3, steps=10)
    assert done.status == "unsupported"
    assert "friction.C requires it; leave a pin of that loop without" in done.reason


def test_a_free_rod_slows_down_at_its_rate_and_then_stands() -> None:
    """1 N m on 1/3 kg m^2: from 1 rad/s it takes a third of a second, and a sixth of a radian."""
    chain = WindowChain(0, gravity_m_s2=0.0)
    scene = rubbing(chain.scene(), A0=1.0)
    state = ChainMotion(chain).motion(np.zeros(1)).state(0)
    done = run(scene, state, "mujoco", dt_s=2e-3, steps=300, drive="free")
    rod, time_s = done.motion.links["rocker0"], done.motion.time_s
    sliding = time_s < 0.33
    turned = np.abs(rod.theta - rod.theta[0])
    np.testing.assert_allclose(turned[sliding], (time_s - 1.5 * time_s**2)[sliding], atol=1e-12)
    assert turned[-1] == pytest.approx(1.0 / 6.0, abs=5e-5)  # but for the step in which it stops
    assert abs(rod.omega[-1]) < 1e-12


def turned(scene: Scene) -> Scene:
    """The same driver, with the two links of its pin in the other order."""
    driver = scene.driver
    law = replace(driver.law, start_rad=-driver.law.start_rad, speed_rad_s=-driver.law.speed_rad_s)  # type: ignore[attr-defined, call-arg]  # of constant speed
    return replace(scene, driver=replace(driver, link=driver.base, base=driver.link, law=law))


@pytest.mark.parametrize(("scene", "joint", "size"), [
    (load_scene("slider-crank-by-piston"), "C", 0.5),
    (load_scene("fourbar-by-coupler"), "B", 0.02),
    (turned(load_scene("fourbar-by-coupler")), "B", 0.02),
    (load_scene("fourbar-lecture-1"), "A", 0.02),
], ids=["slider", "pin", "pin, links in the other order", "crank"])  # fmt: skip
def test_friction_of_the_driven_joint_is_not_taken_for_the_drive(
    scene: Scene, joint: str, size: float
) -> None:
    """What rubs in the driven joint itself is no part of what the drive exerts."""
    scene = rubbing(scene, **{joint: size})
    found = ran(scene, "mujoco", steps=120, with_forces=True).motion.forces
    drive = kinetostatics.forces(scene, found.time_s[20:], skip_dead_points=True).torque
    assert np.nanmax(np.abs(found.torque[20:] - drive)) < 0.02 * size


def test_it_stays_together_keeps_to_its_law_and_has_its_loads_and_friction(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """A load over the angle keeps its size up to date; the motor of the crank is another."""
    cam = Load("cam", "rocker", None, Sine(2.0, 2.0 * np.pi), "angle")
    scene = acted_on(load_scene("fourbar-double-rocker"), cam, ConstantFriction("C", 0.01))
    law, seen = scene.driver.law, []

    def play(model: Any, data: Any) -> None:
        mujoco.mj_step(model, data, round(0.9 * law.period_s / model.opt.timestep))
        mujoco.mj_forward(model, data)
        seen.extend([model, data])

    monkeypatch.setattr(mujoco.viewer, "launch", play)
    mujoco_viewer.show(scene, start_of(scene))
    model, data = seen
    gap = data.site_xpos[model.eq_obj1id[0]] - data.site_xpos[model.eq_obj2id[0]]
    assert np.linalg.norm(gap) < 1e-5 * scene.longest_m
    assert data.qpos[0] == pytest.approx(law.at(np.array([0.9 * law.period_s]))[0][0], abs=1e-3)
    assert data.ctrl[1] == pytest.approx(2.0 * np.sin(data.qpos[0]))
    assert abs(data.ctrl[1]) > 0.1
    assert mujoco.get_mjcb_control() is None
