"""The engines on the common seam: the lecture's four-bar as near as each is known to come."""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
import pytest

from analytic.kinematics import solve
from models.files.reading import find_scene, load_scene, parse_scene, shipped
from reports.compare.free_truth import released_state
from reports.judge.cell import check
from reports.plan.requirements import chosen_engines
from sim.engine.settings import SettingError
from sim.registry import ENGINES, apart, available, engine
from sim.run import run
from tests.worlds.engines import HERE, SIMPLE
from tests.worlds.runs import massless, ran, rubbing, start_of, tuned
from tests.worlds.tiers import few, slow
from tests.worlds.turns import of_turns

INSTALLS_IN_A_MINUTE = [name for name in ("rapier", "box2d", "dart") if name in HERE]
LATER = "not installed by `make test`, or built in seconds"
WITHIN: Mapping[str, float] = {
    "simbody": 1e-9, "drake": 1e-4, "dart": 1e-4, "bullet": 1e-4, "rapier": 2e-5, "box2d": 2e-4,
}  # fmt: skip
"""Largest error of the rocker in a second at 1 ms, tuned [rad]."""


@pytest.mark.parametrize("name", few(SIMPLE, INSTALLS_IN_A_MINUTE, LATER))
def test_the_rocker_of_the_lectures_four_bar_is_where_it_has_to_be(name: str) -> None:
    scene = load_scene("fourbar-lecture-1")
    motion = ran(scene, name, dt_s=1e-3, steps=1000).motion
    true = solve(scene, motion.time_s).links["rocker"].theta
    assert np.abs(motion.links["rocker"].theta - true).max() < WITHIN[name]


@slow("18 scenes each")
@pytest.mark.parametrize("name", SIMPLE)
@pytest.mark.parametrize("scene", shipped())
def test_a_tuned_engine_is_within_tolerance_on_a_shipped_scene(name: str, scene: str) -> None:
    found = check(of_turns(scene, name, 720, turns=2))
    assert found.verdict == "within", found.failures


@pytest.mark.parametrize("name", few(SIMPLE, INSTALLS_IN_A_MINUTE, LATER))
def test_a_driven_block_without_mass_hands_the_drives_force_on_to_its_pin(name: str) -> None:
    scene = massless(load_scene("slider-crank-by-piston"))
    found = check(of_turns(scene, name, with_forces=True))
    assert found.verdict == "within", found.failures


@pytest.mark.parametrize("name", few(SIMPLE, INSTALLS_IN_A_MINUTE, LATER))
def test_friction_of_sliders_acts_and_is_shared_out(name: str) -> None:
    scene = rubbing(load_scene("shaper"), B=1.0, F=1.0)
    found = check(of_turns(scene, name, with_forces=True))
    assert found.verdict == "within", found.failures


@pytest.mark.parametrize("name", few(SIMPLE, INSTALLS_IN_A_MINUTE, LATER))
def test_a_prescribed_crank_needs_no_mass_and_a_rocker_does(name: str) -> None:
    scene = load_scene("fourbar-lecture-1")
    bare = {
        link: replace(scene.links[link], mass_kg=0.0, inertia_kg_m2=0.0, centre_m=(0.0, 0.0))
        for link in ("crank", "rocker")
    }
    driven, free = (
        replace(scene, links={**scene.links, link: body}) for link, body in bare.items()
    )
    assert ran(driven, name, dt_s=1e-3, steps=50).status == "ok"
    refused = run(free, start_of(free), name, dt_s=1e-3, steps=50)
    assert refused.status == "unsupported"
    assert refused.reason.startswith("fourbar-lecture-1: rocker: mass_kg 0")


@pytest.mark.skipif("drake" not in HERE, reason="drake is not installed")
def test_drake_refuses_what_would_end_the_process() -> None:
    scene = load_scene("fourbar-lecture-1")
    rocker = replace(scene.links["rocker"], inertia_kg_m2=0.0, centre_m=(0.0, 0.0))
    on_its_pin = replace(scene, links={**scene.links, "rocker": rocker})
    refused = run(on_its_pin, start_of(on_its_pin), "drake", dt_s=1e-3, steps=50)
    assert refused.status == "unsupported"
    assert "rocker: mass_kg 0.2, inertia_kg_m2 0" in refused.reason


@pytest.mark.parametrize("name", [each for each in ("box2d", "rapier") if each in HERE])
def test_no_turn_of_a_body_is_lost_between_samples(name: str) -> None:
    """The lower rod is six times as fast as anything at the start, for a while."""
    text = find_scene("double-pendulum").read_text()
    for shipped_one, other in {
        "length_m = 0.2": "length_m = 0.02",
        "start_deg = -50.0": "start_deg = 80.0",
        "lower = -70.0": "lower = 100.0",
    }.items():
        text = text.replace(shipped_one, other)
    scene = parse_scene(text, "short.toml")
    start = released_state(scene)
    ends = [
        run(scene, start, name, dt_s=2e-4, steps=3000, every=every, drive="free").motion
        for every in (1, 1500)
    ]
    often, seldom = (motion.links["lower"].theta for motion in ends)
    np.testing.assert_array_equal(often[::1500], seldom)


@pytest.mark.skipif("box2d" not in HERE, reason="box2d is not installed")
def test_swings_of_a_joint_are_none_or_enough() -> None:
    with pytest.raises(SettingError, match=r"joint_swings: found 1e-300; it takes 0, or 0\.001"):
        engine("box2d").check({**tuned("box2d"), "joint_swings": 1e-300})


def test_all_are_those_that_are_installed_and_the_others_are_named_with_their_command(
    capsys: pytest.CaptureFixture[str],
) -> None:
    assert chosen_engines("all") == HERE
    lines = capsys.readouterr().err.splitlines()
    lacking = [one for one in available() if not one.version]
    assert len(lines) == len(lacking)
    for line, one in zip(lines, lacking, strict=True):
        assert f"engine {one.name}: not installed; " in line
        assert one.install in line


def test_engines_that_may_end_their_process_run_in_one_of_their_own() -> None:
    assert not apart(["mujoco", "pymunk", "exudyn"])
    assert all(apart(["mujoco", name]) for name in ENGINES if name in WITHIN)
    assert apart(["an engine of a user"])
