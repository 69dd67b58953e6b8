"""Loads in MuJoCo: of every kind, at the right instant, and in the reactions that are read."""

from __future__ import annotations

from dataclasses import replace

import mujoco  # type: ignore[import-untyped]  # ships no stubs
import numpy as np
import pytest

from analytic.kinematics import solve
from models.characteristics import Constant, Sine
from models.errors import EngineError
from models.files import load_scene
from models.joints import block_name
from models.loads import Load
from models.mjcf import build
from models.scene import Scene
from models.tabulated import Tabulated
from sim.run import run
from tests.sim.mujoco.test_reactions import opened, worst_of
from tests.worlds.loading import loaded_mechanism

FOURBAR = load_scene("fourbar-lecture-1")
SETTLED = 40
"""Steps after which the closing springs bear what they have to."""


def with_loads(scene: Scene, *loads: Load) -> Scene:
    return replace(scene, loads={load.name: load for load in loads})


def off(scene: Scene, *, steps: int = 2000) -> float:
    """The largest error of a reaction or of the torque, as shares, in the first instants."""
    log = opened(scene, steps=steps).record_forces(SETTLED + 20, 1)
    return max(worst_of(scene, log.forces.stretch(slice(SETTLED, None))))


@pytest.mark.parametrize("number", [2, 6, 8, 10, 20, 26, 38, 68, 82, 126])
def test_random_mechanisms_under_random_loads_have_the_reactions_of_the_reference(
    number: int,
) -> None:
    scene, _ = loaded_mechanism(number)
    try:
        assert off(scene) < 1e-3
    except EngineError as error:
        assert "massless block cannot be held here" in str(error)  # noqa: PT017  # or it is right


@pytest.mark.parametrize("load", [
    Load("push", block_name(load_scene("slider-crank-excel-210").sliders["C"]), "C", Constant(30)),
    Load("tilt", "block C", "C", Constant(20.0), direction_rad=1.0, frame="body"),
    Load("twist", "block C", None, Constant(0.7)),
    Load("pulse", "block C", "C", Sine(20.0, 0.3, 0.4), direction_rad=2.0),
    Load("gas", "block C", "C", Sine(20.0, 0.1, 0.4), "displacement", "C", "forward"),
], ids=lambda load: load.name)  # fmt: skip
def test_loads_on_a_block_without_mass_go_where_they_belong(load: Load) -> None:
    scene = load_scene("slider-crank-excel-210")
    light = replace(scene.sliders["C"], mass_kg=0.0, inertia_kg_m2=0.0)
    assert off(with_loads(replace(scene, sliders={"C": light}), load)) < 2e-4


@pytest.mark.parametrize(("load", "works"), [
    (Load("push", "block B", "B", Constant(5.0), direction_rad=1.0), True),
    (Load("twist", "block B", None, Constant(0.7)), True),
    (Load("along", "block B", "B", Constant(5.0), frame="body"), False),
], ids=lambda given: getattr(given, "name", None))  # fmt: skip
def test_loads_on_a_block_without_mass_on_a_guide_that_moves(load: Load, works: bool) -> None:
    scene = with_loads(load_scene("slotted-lever"), load)
    if works:
        assert off(scene) < 2e-4
        return
    with pytest.raises(EngineError, match=r"loads.along: .* give sliders.B a mass_kg above 0"):
        opened(scene)


def test_a_load_of_the_crank_angle_is_one_whether_it_is_known_ahead_or_read() -> None:
    """Prescribed, the law says how large it is; under a servo the engine's own crank does."""
    places = tuple(np.linspace(0.0, 2.0 * np.pi, 13)[:-1])
    course = Tabulated(places, tuple(np.sin(places)), "pchip", 2.0 * np.pi)
    scene = with_loads(FOURBAR, Load("cam", "rocker", None, course, "angle"))
    found = [opened(scene, drive=d).record_forces(200, 1).forces for d in ("prescribed", "servo")]
    told, read = (forces.pins["D"]["rocker"][100:] for forces in found)
    assert np.abs(told - read).max() < 0.01 * np.abs(told).max()
    assert mujoco.get_mjcb_control() is None


def test_a_slider_past_the_end_of_a_table_feels_its_last_row_and_leaves_no_callback() -> None:
    scene = load_scene("slider-crank-central")
    state = solve(scene, np.zeros(1)).state()
    at = state.displacement["C"]
    ends = Tabulated((at - 0.01, at + 0.01), (2.0, 2.0))
    short = with_loads(scene, Load("gas", "block C", "C", ends, "displacement", "C"))
    always = with_loads(scene, Load("gas", "block C", "C", Constant(2.0)))
    done, plain = (run(each, state, "mujoco", dt_s=1e-3, steps=300) for each in (short, always))
    assert done.status == "ok"
    np.testing.assert_allclose(
        done.motion.sliders["C"].displacement, plain.motion.sliders["C"].displacement, atol=1e-12
    )
    assert mujoco.get_mjcb_control() is None


def test_loads_add_lines_to_the_text_and_change_none() -> None:
    state = solve(FOURBAR, np.zeros(1)).state()
    loads = (
        Load("pull", "rocker", "C", Constant(3.0), direction_rad=0.5),
        Load("own", "coupler", "C", Constant(4.0), direction_rad=0.5, frame="body"),
        Load("pulse", "coupler", None, Sine(1.0, 2.0, 0.5 * np.pi)),
    )
    bare, text = build(FOURBAR, state), build(with_loads(FOURBAR, *loads), state)
    key = next(line for line in bare.splitlines() if "<key " in line)
    assert key.replace("/>", ' ctrl="3.0 4.0 1.0"/>') in text
    rest = iter(text.splitlines())
    assert all(line in rest for line in bare.splitlines() if line != key)
    assert "pulse: its course over the time is not in this" in text
    assert "pull: its course" not in text
    assert "load it, as without it all controls are 0" in text
    model = mujoco.MjModel.from_xml_string(text)
    assert not mujoco.MjData(model).ctrl.any()
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, 0)
    mujoco.mj_forward(model, data)
    # Virtual work: the force at C by the speed of C, a turn of one hinge at a time.
    place = data.site_xpos[model.site("load pull").id] - data.xanchor[model.joint("rocker.D").id]
    turning = 3.0 * (place[0] * np.sin(0.5) - place[1] * np.cos(0.5))
    assert data.qfrc_actuator[model.joint("rocker.D").dofadr[0]] == pytest.approx(turning)
