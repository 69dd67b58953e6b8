"""Profile as-shipped is what a bare engine does, settings out of range never reach one, those in
seconds are told, and remedies are settings.
"""

from collections.abc import Iterator, Mapping
from dataclasses import replace
from typing import Any

import exudyn as exu
import mujoco  # type: ignore[import-untyped]  # ships no stubs
import numpy as np
import pymunk
import pytest

from models.files.reading import load_scene
from sim.engine import Facts, SettingValue
from sim.engine.settings import SettingError, resolved
from sim.exudyn.engine import ENGINE
from sim.exudyn.solver import simulation
from sim.registry import engine, offering
from sim.registry.offers import remedies
from tests.worlds import runs
from tests.worlds.runs import driven_by, ran, start_of, tuned

SCENE = load_scene("fourbar-lecture-1")
OF_A_RUN = {
    "solution.file.write",
    "solution.sensors.writePeriod",
    "timeIntegration.endTime",
    "timeIntegration.numberOfSteps",
}
"""What has to do with the length of a run, and with what is kept of it."""
BARE = """
<mujoco>
  <worldbody>
    <body name="a"><joint/><inertial pos="0 0 0" mass="1" diaginertia="1 1 1"/></body>
    <body name="b"><joint/><inertial pos="0 0 0" mass="1" diaginertia="1 1 1"/></body>
  </worldbody>
  <equality><connect body1="a" body2="b" anchor="0 0 0"/></equality>
</mujoco>
"""


def opened(name: str, profile: str, settings: Mapping[str, SettingValue] | None = None) -> Any:
    return runs.opened(SCENE, name, settings, profile=profile, dt_s=1e-3)


def facts(name: str, settings: Mapping[str, SettingValue]) -> Facts:
    return opened(name, "tuned", settings).facts()


def test_mujoco_as_shipped_differs_from_a_bare_model_by_the_drive_alone() -> None:
    bare = mujoco.MjModel.from_xml_string(BARE)
    session = opened("mujoco", "as-shipped")
    held = session._model
    own = {"timestep", "gravity", "tolerance"}  # of the run, of the scene, over the flywheel
    for name in (n for n in dir(bare.opt) if not n.startswith("_") and n not in own):
        np.testing.assert_array_equal(getattr(held.opt, name), getattr(bare.opt, name), name)
    ratio = session.facts().settings["flywheel_ratio"]
    assert held.opt.tolerance * float(ratio) == pytest.approx(bare.opt.tolerance, rel=1e-12)
    np.testing.assert_array_equal(held.eq_solref[0], bare.eq_solref[0])
    np.testing.assert_array_equal(held.eq_solimp[0], bare.eq_solimp[0])


def test_pymunk_as_shipped_is_a_bare_space() -> None:
    bare, body = pymunk.Space(), pymunk.Body(1.0, 1.0)
    joint = pymunk.PivotJoint(bare.static_body, body, (0.0, 0.0))
    session = opened("pymunk", "as-shipped")
    of_space = ("iterations", "damping", "collision_bias", "collision_slop", "idle_speed_threshold")
    for name in of_space:
        assert getattr(session._space, name) == getattr(bare, name), name
    for held in session._space.constraints:
        for name in ("error_bias", "max_bias", "max_force"):
            assert getattr(held, name) == getattr(joint, name), name


def leaves(values: Mapping[str, Any], path: str = "") -> Iterator[tuple[str, Any]]:
    for name, value in values.items():
        if isinstance(value, dict):
            yield from leaves(value, f"{path}{name}.")
        else:
            yield f"{path}{name}", value


def test_exudyn_as_shipped_differs_from_a_bare_simulation_by_what_a_run_is_asked_for() -> None:
    asked = simulation(resolved(ENGINE.profiles["as-shipped"], None), 1e-4)
    own, bare = (dict(leaves(each.GetDictionary())) for each in (asked, exu.SimulationSettings()))
    assert len(bare) > 100
    assert {name for name in bare if str(own[name]) != str(bare[name])} == OF_A_RUN
    assert exu.SimulationSettings().timeIntegration.solverType.name == "GeneralizedAlpha"


TAKEN: dict[str, dict[str, SettingValue]] = {
    "mujoco": {
        "integrator": "implicitfast", "solver": "CG", "iterations": 7, "solref_dampratio": 1.5,
        "solimp_dmin": 0.91, "solimp_dmax": 0.96, "solimp_width": 0.002},
    "pymunk": {"iterations": 7, "damping": 0.75, "error_bias": 0.25},
    "exudyn": {
        "integrator": "TrapezoidalIndex2", "spectral_radius": 0.75, "relative_tolerance": 1e-6,
        "absolute_tolerance": 1e-7, "iterations": 17, "jacobian": "as-needed", "residual": "forces",
        "adaptive_step": "disable", "ignore_singular": "disable", "linear_solver": "EigenSparse"},
}  # fmt: skip
REFUSED: dict[str, list[tuple[str, SettingValue]]] = {
    "mujoco": [
        ("tolerance", -1.0), ("solref_dampratio", 0.0), ("solimp_dmin", 5.0),
        ("flywheel_ratio", 0.0)],
    "pymunk": [("iterations", 0), ("damping", -1.0), ("error_bias", -1.0)],
    "exudyn": [("spectral_radius", 1.5), ("relative_tolerance", -1.0), ("jacobian", "never")],
}  # fmt: skip


@pytest.mark.parametrize("name", TAKEN)
def test_settings_reach_the_engine(name: str) -> None:
    held, usual = facts(name, TAKEN[name]).settings, facts(name, {}).settings
    for setting, value in TAKEN[name].items():
        assert held[setting] == value != usual[setting], setting
    assert held.get("linear_solver_used", "EigenSparse") == "EigenSparse"
    assert held.get("residual_used", "forces") == "forces"


@pytest.mark.parametrize("name", REFUSED)
def test_a_value_that_an_engine_does_not_take_is_refused(name: str) -> None:
    for setting, value in REFUSED[name]:
        with pytest.raises(SettingError, match=f"setting {setting}: found"):
            opened(name, "tuned", {setting: value})


IN_SECONDS = {
    "mujoco": {"solref_timeconst_s": 0.03, "solref_timeconst_steps": 0.0},
    "pymunk": {"error_bias": 0.3, "damping": 0.5},
}
"""By engine, values that are times, or losses in a second, of their own."""


@pytest.mark.parametrize(
    ("name", "setting"), [(name, each) for name, values in IN_SECONDS.items() for each in values]
)
def test_each_that_is_named_does(name: str, setting: str) -> None:
    settings = tuned(name) | {setting: IN_SECONDS[name][setting]}
    if setting == "solref_timeconst_s":
        assert engine(name).in_seconds(settings) == ()  # it is not in force
        settings |= {"solref_timeconst_steps": 0.0}
        named: tuple[str, ...] = ("solref_timeconst_s",)
    elif setting == "solref_timeconst_steps":
        named = ("solref_timeconst_s",)
    else:
        settings |= {"iterations": 3}  # joints that are held take no notice of a damping
        named = (setting,)
    assert engine(name).in_seconds(settings) == named
    angles = []  # of all links, over a turn
    for speed in (1.0, 10.0):
        scene = driven_by(replace(SCENE.driver.law, speed_rad_s=speed))
        links = ran(scene, name, per_turn=120, settings=settings, well=False).motion.links
        angles.append([link.theta for link in links.values()])
    assert np.abs(np.subtract(*angles)).max() > 1e-7


def test_an_engine_that_has_such_has_them_as_shipped() -> None:
    for name in IN_SECONDS:
        assert engine(name).in_seconds(resolved(engine(name).profiles["as-shipped"], None))


@pytest.mark.parametrize("name", offering("remedies"))
@pytest.mark.parametrize("scene_name", ["sixbar-watt", "shaper"])
def test_every_remedy_opens_and_none_is_what_tuned_has(name: str, scene_name: str) -> None:
    scene = load_scene(scene_name)
    held, offered = [], remedies(name, scene, start_of(scene), tuned(name))
    for remedy in ({}, *offered):
        left = remedies(name, scene, start_of(scene), tuned(name, remedy))
        assert remedy not in left
        assert len(left) < len(offered) or not remedy
        settings = runs.opened(scene, name, remedy, dt_s=1e-3).facts().settings
        assert settings not in held
        held.append(settings)
    assert len(held) > 2


def test_several_pins_are_named_with_plus_or_comma_between() -> None:
    for text in ("B+G", "B,G", " B , G "):
        session = runs.opened(load_scene("sixbar-watt"), "mujoco", {"close": text}, dt_s=1e-3)
        assert set(str(session.facts().settings["close"]).split(", ")) == {"B", "G"}
