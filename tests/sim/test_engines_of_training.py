"""The engines in which robots are trained: each profile on the lecture's four-bar, and a loop that
one solver leaves open."""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
import pytest

from analytic.kinematics import solve
from models.files.reading import load_scene
from reports.judge.cell import check
from reports.judge.rules import BATCHES
from sim.registry import engine
from sim.run import run
from tests.worlds.engines import HERE
from tests.worlds.runs import ran, start_of
from tests.worlds.tiers import slow
from tests.worlds.turns import of_turns

FOURBAR = load_scene("fourbar-lecture-1")
STEPS = 90
WITHIN: Mapping[tuple[str, str], float] = {
    ("mjx", "tuned"): 3e-3, ("mjx", "float32"): 3e-3, ("mujoco-warp", "tuned"): 2e-3,
    ("newton", "tuned"): 5e-5, ("newton", "kamino"): 3e-3, ("newton", "mujoco"): 4e-3,
}  # fmt: skip
"""Largest error of the rocker in half a turn of 90 steps a turn [rad], by engine and profile."""
INSTALLED = [each for each in WITHIN if each[0] in HERE]
PORTED = [name for name in ("mjx", "mujoco-warp") if name in HERE]
COMPILES = "they compile for minutes, and are not installed by `make test`"


@slow(COMPILES)
@pytest.mark.parametrize(("name", "profile"), INSTALLED)
def test_the_rocker_is_where_it_has_to_be(name: str, profile: str) -> None:
    motion = ran(FOURBAR, name, profile, per_turn=STEPS, turns=0.5).motion
    true = solve(FOURBAR, motion.time_s).links["rocker"].theta
    off = np.abs(motion.links["rocker"].theta - true).max()
    assert 1e-9 < off < WITHIN[name, profile]


@slow(COMPILES)
@pytest.mark.parametrize("profile", ["featherstone", "tuned"] if "newton" in HERE else [])
def test_a_solver_that_leaves_out_the_joints_of_loops_is_found_by_their_gap(profile: str) -> None:
    found = check(of_turns(FOURBAR, "newton", STEPS, profile=profile))
    told = [finding.text for finding in found.findings if finding.rule == "CC135"]
    if profile == "tuned":
        assert (found.verdict, told) == ("within", [])
    else:
        assert found.verdict == "out"
        assert told[0].startswith("loop not enforced: pin C open by up to")
        assert "2 freedoms more" in told[0]


@slow(COMPILES)
@pytest.mark.parametrize(("name", "profile"), INSTALLED)
def test_worlds_of_a_batch_move_as_alone(name: str, profile: str) -> None:
    cell = replace(of_turns(FOURBAR, name, STEPS, profile=profile), converge=False)
    found = check(replace(cell, steps=10, worlds=3))
    if profile == "mujoco":
        assert found.status == "unsupported"
        assert "newton: crankcheck runs batches of Kamino and XPBD" in found.reason
        return
    own = {one.rule: one.level for one in found.findings if one.rule in BATCHES}
    assert own == dict.fromkeys(BATCHES, "pass")
    assert found.batch.exact or name == "mjx"


@slow(COMPILES)
@pytest.mark.parametrize("name", PORTED)
def test_loads_that_depend_on_the_motion_are_refused(name: str) -> None:
    scene = load_scene("compressor")
    refused = run(scene, start_of(scene), name, dt_s=1e-3, steps=10)
    assert refused.status == "unsupported"
    assert f"{name} takes loads of time alone; run mujoco" in refused.reason


@slow(COMPILES)
@pytest.mark.parametrize("name", sorted({name for name, _ in INSTALLED}))
def test_a_version_names_the_mujoco_beside_it(name: str) -> None:
    version = engine(name).version()
    assert version.endswith(")")
    assert " (mujoco " in version
