"""Engines on elastic links: each error is told from the others, and held to what explains it."""

from __future__ import annotations

from dataclasses import replace

import pytest

from models.files import load_scene
from models.scene import Scene
from reports.judge.cell import Cell, Checked, check, examined
from reports.judge.rows import cell_row
from reports.selftest.segment_changes import in_chain, springs, stiffer

STEPS = 720
"""Of a turn; four segments take no more."""


@pytest.fixture(scope="module")
def scene() -> Scene:
    return load_scene("fourbar-elastic")


def cell(scene: Scene, engine: str = "mujoco", **changes: object) -> Cell:
    """A turn with four segments."""
    dt_s = scene.driver.law.period_s / STEPS
    asked = Cell(scene, engine, "tuned", dt_s, STEPS, converge=False, segments=4)
    return replace(asked, **changes)  # type: ignore[arg-type]


@pytest.fixture(scope="module")
def checked(scene: Scene) -> Checked:
    return check(cell(scene))


def test_the_engine_and_the_segments_are_told_apart(checked: Checked) -> None:
    assert checked.verdict == "within"
    errors = checked.errors
    engine, beam = errors.worst("segments"), errors.worst("deflection")
    assert engine.pure < 1e-4
    assert beam.pure == pytest.approx(0.05, rel=0.1)  # 0.80/n^2
    assert errors.elastic.chain == pytest.approx(beam.pure, rel=0.01)
    assert errors.elastic.doubt < 1e-3 < errors.elastic.linear < 0.02


def test_the_verdict_says_where_the_truth_ends(checked: Checked) -> None:
    said = [finding for finding in checked.findings if finding.rule == "CC134"]
    assert len(said) == 1
    assert "the segments end before the engine does" in said[0].text
    assert said[0].level == "pass"


def test_a_cell_says_what_its_links_were_given_as(checked: Checked, slider_crank: Scene) -> None:
    row = cell_row(checked)
    assert (row["segments"], row["springs"]) == (4.0, "plain")
    assert row["deflection_limit_pure"] is not None
    rigid = cell_row(check(cell(slider_crank)))
    assert not {"segments", "springs", "deflection_pure", "deflection_error_m"} & set(rigid)


def test_springs_that_are_a_part_in_a_hundred_too_stiff_are_out(scene: Scene) -> None:
    asked = cell(scene, dt_s=scene.driver.law.period_s / 2880, steps=2880)
    found, _ = examined(asked, in_chain(springs(stiffer))(0.01))
    assert {finding.rule for finding in found.failures} == {"CC132"}


def test_a_step_that_the_springs_do_not_hold_says_which_would(scene: Scene) -> None:
    found = check(cell(scene, segments=8))
    assert found.status == "diverged"
    assert "take 1833 steps a turn, or fewer segments" in found.reason


def test_corrected_springs_have_the_sag_of_the_beam(scene: Scene) -> None:
    found = check(cell(scene, springs="corrected"))
    assert found.verdict == "within"
    beam = found.errors.worst("deflection")
    assert beam.pure < 3e-3


@pytest.mark.parametrize("engine", ["mujoco", "pymunk"])
def test_reactions_and_torque_are_those_of_the_beam(scene: Scene, engine: str) -> None:
    found = check(cell(scene, engine, with_forces=True))
    assert found.verdict == "within", [finding.text for finding in found.failures]
    reaction, torque = found.errors.worst("reaction"), found.errors.worst("torque")
    assert max(reaction.pure, torque.pure) < 0.01


def test_a_link_that_stretches_is_no_chain(scene: Scene) -> None:
    coupler = replace(scene.elastic["coupler"], axial_n=6.3e6)
    found = check(cell(replace(scene, elastic={"coupler": coupler})))
    assert found.verdict == "unsupported"
    assert "elastic.coupler stretches" in found.reason
