"""Engines on elastic links, as segments or as beams: each error is told from the others, and held
to what explains it."""

import math
from dataclasses import replace
from typing import Any

import pytest

from models.files.reading import load_scene
from models.scene import Scene
from reports.judge.cell import Cell, Checked, check, examined
from reports.judge.rows import cell_row
from reports.plan.requirements import held_steps
from reports.selftest.elastic_changes import in_beam, in_given, stiffer_beam
from reports.selftest.elastic_faults import springs, stiffer
from tests.worlds.tiers import few, slow
from tests.worlds.turns import of_turns

USUAL = 720
"""Steps of a turn where nothing is asked for; four segments take no more."""
SHIPPED = ("fourbar-elastic", "slider-crank-elastic", "sixbar-elastic")
SCENE = load_scene(SHIPPED[0])


def cell(scene: Scene = SCENE, engine: str = "mujoco", steps: int = USUAL, **changes: Any) -> Cell:
    """A turn with four segments."""
    return of_turns(scene, engine, steps, **{"segments": 4, **changes})


def beam(scene: Scene = SCENE, elements: int = 8, steps: int = 2 * USUAL, **changes: Any) -> Cell:
    return of_turns(scene, "exudyn", steps, segments=elements, springs="beam", **changes)


def with_coupler(**changed: float) -> Scene:
    return replace(SCENE, elastic={"coupler": replace(SCENE.elastic["coupler"], **changed)})


def off(checked: Checked, quantity: str = "deflection") -> float:
    assert checked.status == "ok", checked.reason
    return checked.errors.worst(quantity).pure


def within(cell: Cell) -> Checked:
    found = check(cell)
    assert found.verdict == "within", [finding.text for finding in found.failures]
    return found


def test_the_engine_and_the_segments_are_told_apart(slider_crank: Scene) -> None:
    checked = within(cell())
    facts, deflection = checked.errors.of_links, off(checked)
    assert off(checked, "segments") < 1e-4
    assert deflection == pytest.approx(0.05, rel=0.1)  # 0.80/n^2
    assert facts.chain == pytest.approx(deflection, rel=0.01)
    assert facts.doubt < 1e-3 < facts.linear < 0.02
    (said,) = (finding for finding in checked.findings if finding.rule == "CC134")
    assert "the segments limit the accuracy" in said.text
    assert said.level == "pass"
    row = cell_row(checked)
    assert (row["segments"], row["springs"]) == (4.0, "plain")
    assert row["deflection_limit_pure"] is not None
    rigid = cell_row(check(cell(slider_crank)))
    assert not {"segments", "springs", "deflection_pure", "deflection_error_m"} & set(rigid)


def test_springs_that_are_a_part_in_a_hundred_too_stiff_are_out() -> None:
    found, _ = examined(cell(steps=4 * USUAL), in_given(springs(stiffer))(0.01))
    assert {finding.rule for finding in found.failures} == {"CC132"}


NO_BEAMS = "are not offered by crankcheck, but in exudyn"


@pytest.mark.parametrize(
    ("asked", "status", "told"),
    [
        (cell(segments=8), "diverged", "use 1833 steps a turn, or fewer segments"),
        (cell(with_coupler(axial_n=6.3e6)), "unsupported", "elastic.coupler stretches"),
        (cell(springs="beam"), "unsupported", f"beams (coupler) in mujoco {NO_BEAMS}"),
        (
            cell(with_coupler(axial_n=8e4), springs="beam"),
            "unsupported",
            f"{NO_BEAMS}; links that do not stretch can be",
        ),
    ],
)
def test_what_does_not_run_says_what_would(asked: Cell, status: str, told: str) -> None:
    found = check(asked)
    assert (found.status, found.verdict) == (status, "out" if status == "diverged" else status)
    assert told in found.reason


def test_corrected_springs_have_the_sag_of_the_beam_and_plain_ones_its_forces() -> None:
    assert off(within(cell(springs="corrected"))) < 3e-3
    found = within(cell(engine="pymunk", with_forces=True))
    assert max(off(found, "reaction"), off(found, "torque")) < 0.01


@pytest.fixture(scope="module")
def eight() -> Checked:
    return within(beam(with_forces=True))


def test_eight_elements_are_within_a_thousandth_of_the_beam(eight: Checked) -> None:
    assert max(off(eight), off(eight, "reaction"), off(eight, "torque")) < 1e-4
    facts = eight.errors.of_links
    slope = math.pi * 1.051e-3 / 0.75  # of a half-wave as high as its largest deflection
    assert facts.doubt == pytest.approx(slope**2, rel=2e-3)
    # They are given next to nothing for their start.
    assert facts.pushed == pytest.approx(2.6e-4, rel=0.05)
    # Nothing is compared with a chain of segments.
    assert eight.errors.worst("segments") is None
    kinds = {row.kind for row in eight.errors.rows}
    assert {"total", "start"} <= kinds
    assert "chain" not in kinds
    row = cell_row(eight)
    assert (row["segments"], row["springs"]) == (8.0, "beam")
    (said,) = (finding.text for finding in eight.findings if finding.rule == "CC134")
    assert "8 elements" in said


@slow("two seconds: a truth that stretches")
def test_a_beam_stretches_and_is_damped(eight: Checked) -> None:
    found = within(beam(with_coupler(axial_n=8e4, damping_s=1e-3)))
    assert off(found) < 1e-4
    assert off(found, "extension") < 3e-8 < 0.2 * off(eight, "extension")


@pytest.mark.parametrize("name", few(SHIPPED, {SHIPPED[0]}, "two to six seconds for the truth"))
def test_a_modulus_half_a_per_cent_off_is_seen_where_shipped_links_take_a_third(name: str) -> None:
    usual = beam(load_scene(name), steps=USUAL)
    found = within(usual)
    assert 3.0 * off(found) < found.limits["deflection"].number
    for share in (5e-3, -5e-3):
        found, _ = examined(usual, runner=in_beam(stiffer_beam)(share))
        assert [finding.rule for finding in found.failures] == ["CC131"]


@pytest.mark.parametrize("elements", [2, 4])
def test_what_few_elements_lock_by_is_no_fault_of_the_engine(elements: int) -> None:
    """They start off pushed apart: the rocker by 0.13 of the speed squared with 2."""
    found = within(beam(elements=elements, steps=USUAL, with_forces=True))
    rows = [row for row in found.errors.rows if row.kind == "start"]
    pushed = max(row.pure for row in rows if row.quantity == "acceleration")
    assert pushed == pytest.approx(2.15 / elements**4, rel=0.1)


def test_a_beam_needs_no_short_step() -> None:
    assert held_steps(SCENE, 16, "beam") == USUAL < held_steps(SCENE, 16, "plain")
