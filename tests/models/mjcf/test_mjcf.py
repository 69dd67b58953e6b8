"""The MJCF text: what it holds, that it loads in a bare MuJoCo, what it refuses, where it closes
loops, and the files in models/canonical/, which are what the builder writes (`make models`).
"""

import re
from dataclasses import replace
from pathlib import Path

import mujoco  # type: ignore[import-untyped]  # ships no stubs
import numpy as np
import pytest

import models
from models.errors import EngineError
from models.files.reading import load_scene, shipped
from models.mjcf.document import build
from models.mjcf.options import Writing
from models.mjcf.tree import closings, plan
from models.scene import Scene
from tests.worlds.runs import start_of


def assembled(text: str) -> tuple[mujoco.MjModel, mujoco.MjData]:
    model = mujoco.MjModel.from_xml_string(text)
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, 0)
    mujoco.mj_forward(model, data)
    return model, data


def apart(model: mujoco.MjModel, data: mujoco.MjData) -> float:
    """How far the loops are open."""
    pairs = zip(model.eq_obj1id, model.eq_obj2id, strict=True)
    return max(float(np.abs(data.site_xpos[a] - data.site_xpos[b]).max()) for a, b in pairs)


@pytest.mark.parametrize("time_s", [0.0, 0.123])
@pytest.mark.parametrize("name", sorted(shipped()))
def test_every_scene_loads_closed_with_the_velocities_of_the_state_and_its_masses(
    name: str, time_s: float
) -> None:
    scene = load_scene(name)
    state = start_of(scene, time_s)
    model, data = assembled(build(scene, state))
    assert model.key(0).name == "assembled"
    assert model.neq >= 1
    assert apart(model, data) < 1e-12
    jacobian = data.efc_J.reshape(-1, model.nv)
    peak = max(abs(w) for w in state.omega.values()) * scene.longest_m
    assert np.abs(jacobian @ data.qvel).max() < 1e-12 * max(peak, 1.0)
    np.testing.assert_array_equal(data.qpos, model.qpos0)
    assert model.nbody == 1 + len(scene.links) + sum(s.mass_kg > 0 for s in scene.sliders.values())
    for link in scene.links.values():
        body = model.body(link.name)
        assert body.mass[0] == link.mass_kg
        np.testing.assert_array_equal(body.inertia, [link.inertia_kg_m2] * 3)
        np.testing.assert_array_equal(body.ipos, [*link.centre_m, 0.0])
    np.testing.assert_array_equal(model.opt.gravity, [*scene.gravity_m_s2, 0.0])
    assert not model.geom_contype.any()
    assert not model.geom_conaffinity.any()


@pytest.mark.parametrize("name", ["slider-crank-offset", "shaper"])
def test_the_text_alone_runs_a_turn_in_a_bare_mujoco(name: str) -> None:
    scene = load_scene(name)
    model, data = assembled(build(scene, start_of(scene)))
    mujoco.mj_step(model, data, 1000)
    mujoco.mj_forward(model, data)
    wanted = start_of(scene, scene.driver.law.period_s)
    assert apart(model, data) < 1e-5 * scene.longest_m
    for link, theta in wanted.theta.items():
        turn = data.xmat[model.body(link).id].reshape(3, 3)
        assert turn[1, 0] == pytest.approx(np.sin(theta), abs=1e-5)


def test_a_massless_block_is_a_slide_and_a_hinge_of_the_link_it_holds() -> None:
    scene = load_scene("slotted-lever")
    state = start_of(scene)
    model, data = assembled(build(scene, state))
    joints = [model.joint(i).name for i in range(model.njnt)]
    assert joints == ["crank.A", "lever.B", "lever.B.slide"]
    assert data.qpos[2] == pytest.approx(state.displacement["B"], abs=1e-15)
    assert data.qvel[2] == pytest.approx(state.speed["B"], rel=1e-12)


def test_three_links_at_one_pin_are_tied_twice() -> None:
    scene = load_scene("sixbar-watt")
    rocker, rod = scene.links["rocker"], scene.links["rod"]
    bar = {p: xy for p, xy in rocker.points.items() if p != "E"}
    at_c = {p.replace("E", "C"): xy for p, xy in rod.points.items()}
    links = {**scene.links, "rocker": replace(rocker, points=bar), "rod": replace(rod, points=at_c)}
    scene = replace(scene, links=links, ground={**scene.ground, "G": (0.5, 0.2)})
    planned = plan(scene, start_of(scene))
    ties = [c for c in planned.closures if c.point == "C"]
    freedoms = [f.name for limb in planned.limbs for f in limb.freedoms]
    assert len(ties) + sum(name.endswith(".C") for name in freedoms) == len(planned.closures) == 2
    assert apart(*assembled(build(scene, start_of(scene)))) < 1e-12


def test_a_law_other_than_constant_speed_brings_a_motor_and_a_servo_a_velocity_actuator() -> None:
    scene = load_scene("fourbar-lecture-1")
    assert "<actuator>" not in build(scene, start_of(scene))
    servo = build(scene, start_of(scene), Writing(servo_gain=5.0))
    assert '<velocity name="drive" joint="crank.A" kv="5.0"/>' in servo
    assert "armature" not in servo
    rocking = load_scene("fourbar-double-rocker")
    text = build(rocking, start_of(rocking))
    assert "<motor" in text
    model, data = assembled(text)
    law_alpha = rocking.driver.law.at(np.array([0.0]))[2][0]
    assert data.ctrl[0] == pytest.approx(law_alpha, abs=1e-12)
    crank = model.joint(f"{rocking.driver.link}.{rocking.driver_pivot}").dofadr[0]
    assert data.qacc[crank] == pytest.approx(law_alpha, abs=1e-6)
    # The flywheel weighs the same against a scene of any size.
    model, _ = assembled(build(scene, start_of(scene)))
    armature = model.dof_armature[model.joint("crank.A").dofadr[0]]
    scale = sum(k.mass_kg * 0.25**2 + k.inertia_kg_m2 for k in scene.links.values())
    assert armature == pytest.approx(1e12 * scale, rel=1e-12)


def test_a_link_too_light_for_mujoco_or_that_hangs_on_nothing_is_named() -> None:
    scene = load_scene("fourbar-lecture-1")
    for mass, inertia in ((0.0, 0.0), (1.0, 0.0), (1e-16, 1.0)):
        light = replace(scene.links["coupler"], mass_kg=mass, inertia_kg_m2=inertia)
        with pytest.raises(EngineError, match=r"coupler: mass_kg .* give both"):
            build(replace(scene, links={**scene.links, "coupler": light}), start_of(scene))
    state = start_of(scene)
    loose = replace(scene.links["rocker"], name="loose", points={"X": (0.0, 0.0), "Y": (1.0, 0.0)})
    scene = replace(scene, links={**scene.links, "loose": loose})
    angles = {key: {**getattr(state, key), "loose": 0.0} for key in ("theta", "omega", "alpha")}
    still = {"X": (0.0, 0.0), "Y": (0.0, 0.0)}
    rates = {key: {**getattr(state, key), **still} for key in ("velocity", "acceleration")}
    state = replace(state, position={**state.position, **loose.points}, **angles, **rates)
    with pytest.raises(EngineError, match="loose is pinned to nothing"):
        build(scene, state)


FOLDER = Path(models.__file__).parent / "canonical"
NUMBER = re.compile(r"-?\d+\.\d+(?:e-?\d+)?")


def same(kept: str, new: str) -> bool:
    """The same text; numbers may differ in their last digits, as processors' sines do."""
    if NUMBER.split(kept) != NUMBER.split(new):
        return False
    pairs = [np.array(NUMBER.findall(text), dtype=float) for text in (kept, new)]
    return bool(np.allclose(*pairs, rtol=1e-13, atol=1e-15))


@pytest.mark.parametrize("name", ["fourbar-lecture-1", "slider-crank-central"])
def test_kept_file_is_what_the_builder_writes(name: str) -> None:
    scene, kept = load_scene(name), (FOLDER / f"{name}.xml").read_text(encoding="utf-8")
    assert same(kept, build(scene, start_of(scene)))


def weighed(name: str, **masses: float) -> Scene:
    """A scene with some of its links and blocks of other masses [kg]."""
    scene = load_scene(name)
    links = {n: replace(x, mass_kg=masses.get(n, x.mass_kg)) for n, x in scene.links.items()}
    sliders = {n: replace(x, mass_kg=masses.get(n, x.mass_kg)) for n, x in scene.sliders.items()}
    return replace(scene, links=links, sliders=sliders)


def closed(scene: Scene, *close: str) -> list[str]:
    return [closure.point for closure in plan(scene, start_of(scene), close).closures]


@pytest.mark.parametrize(("name", "masses", "points"), [
    ("slider-crank-offset", {}, ["C"]),
    ("slotted-lever", {}, ["C"]),
    ("scotch-yoke", {}, ["B"]),
    ("tangent", {}, ["P"]),
    ("fourbar-lecture-1", {}, ["C"]),
    ("sixbar-stephenson", {}, ["C", "F"]),
    ("slider-crank-offset", {"rod": 1e3}, ["B"]),  # between the crank, which is driven, and it
    ("slider-crank-offset", {"C": 1e3}, ["B"]),
    ("fourbar-lecture-1", {"rocker": 1e3}, ["D"]),
    ("fourbar-lecture-1", {"coupler": 1e3}, ["B"]),
    ("fourbar-lecture-1", {"coupler": 1e3, "rocker": 1e4}, ["D"]),
])  # fmt: skip
def test_loops_close_where_the_documented_rule_says_and_at_the_heaviest_bodies(
    name: str, masses: dict[str, float], points: list[str]
) -> None:
    assert closed(weighed(name, **masses)) == points


def test_the_other_closings_are_each_another_and_none_is_the_default() -> None:
    fourbar, sixbar = load_scene("fourbar-lecture-1"), load_scene("sixbar-watt")
    assert set(closings(fourbar, start_of(fourbar))) == {("B",), ("D",)}
    assert closed(weighed("slider-crank-offset", rod=1e3), "C") == ["C"]  # whatever the masses
    found = [frozenset(closed(sixbar, *close)) for close in closings(sixbar, start_of(sixbar))]
    assert len(set(found)) == len(found) > 2
    assert frozenset(closed(sixbar)) not in found
