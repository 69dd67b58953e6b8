"""Engines that are given beams: what is compared, what is not there, and who has none."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest

from analytic.elastic.any_speed import at_speed
from analytic.elastic.natural import lowest_rad_s
from models.files import load_scene
from models.scene import Scene
from reports.judge.cell import Cell, Checked, check, examined
from reports.judge.rows import cell_row
from reports.plan.elastic import held_steps
from reports.selftest.beam_changes import in_beam, stiffer
from tests.worlds.tiers import few, slow, slowly

STEPS = 1440
USUAL = 720
"""Steps of a turn where nothing is asked for."""


@pytest.fixture(scope="module")
def scene() -> Scene:
    return load_scene("fourbar-elastic")


def cell(
    scene: Scene, elements: int = 8, engine: str = "exudyn", steps: int = STEPS, **changes: object
) -> Cell:
    """A turn."""
    dt_s = scene.driver.law.period_s / steps
    asked = Cell(scene, engine, "tuned", dt_s, steps, converge=False)
    return replace(asked, segments=elements, springs="beam", **changes)  # type: ignore[arg-type]


def off(checked: Checked, quantity: str = "deflection") -> float:
    assert checked.status == "ok", checked.reason
    worst = checked.errors.worst(quantity)
    return worst.pure


@pytest.fixture(scope="module")
def checked(scene: Scene) -> Checked:
    return check(cell(scene, with_forces=True))


def test_eight_elements_are_within_a_thousandth_of_the_beam(checked: Checked) -> None:
    assert checked.verdict == "within", [finding.text for finding in checked.failures]
    assert off(checked) < 1e-4
    assert max(off(checked, "reaction"), off(checked, "torque")) < 1e-4
    facts = checked.errors.elastic
    slope = math.pi * 1.051e-3 / 0.75  # of a half-wave as high as its largest deflection
    assert facts.doubt == pytest.approx(slope**2, rel=2e-3)
    # They are given next to nothing for their start.
    assert facts.pushed == pytest.approx(2.6e-4, rel=0.05)


def test_nothing_is_compared_with_a_chain_of_segments(checked: Checked) -> None:
    assert checked.errors.worst("segments") is None
    assert {row.kind for row in checked.errors.rows} == {"total", "start"} | {
        row.kind for row in checked.errors.rows if row.kind != "chain"
    }
    row = cell_row(checked)
    assert (row["segments"], row["springs"]) == (8.0, "beam")
    said = [finding.text for finding in checked.findings if finding.rule == "CC134"]
    assert "8 elements" in said[0]


@slow("a motion of its own: the square of its slopes, which is small elsewhere")
def test_a_beam_near_its_frequency_is_as_far_off_as_the_theory_of_small_slopes(
    scene: Scene,
) -> None:
    """Bent by a half of a per cent of its length: slopes of 0.017, whose square is left out."""
    found = check(cell(at_speed(scene, lowest_rad_s(scene) / 5.5)))
    assert found.errors.elastic.doubt == pytest.approx(2.8e-4, rel=0.1)
    assert off(found) < found.errors.elastic.doubt


def test_elements_come_to_the_beam_with_more_than_their_fourth_power(scene: Scene) -> None:
    coarse = check(cell(scene, 2))
    least, more = off(coarse), off(check(cell(scene, 4)))
    assert least > 16.0 * more
    assert coarse.errors.elastic.chain == pytest.approx(least, rel=0.3)  # what they lock by


@pytest.mark.parametrize(
    ("axial_n", "damping_s"),
    [
        (8e4, 1e-3),
        slowly(8e4, 0.0, reason="both at once show it"),
        slowly(math.inf, 1e-3, reason="both at once show it"),
    ],
)
def test_a_link_that_stretches_or_is_damped_is_a_beam(
    scene: Scene, checked: Checked, axial_n: float, damping_s: float
) -> None:
    own = replace(scene.elastic["coupler"], axial_n=axial_n, damping_s=damping_s)
    found = check(cell(replace(scene, elastic={"coupler": own})))
    assert found.verdict == "within", [finding.text for finding in found.failures]
    if damping_s:
        assert off(found) < 1e-4
    if own.stretches:
        assert off(found, "extension") < 3e-8 < 0.2 * off(checked, "extension")


@pytest.mark.parametrize("engine", ["mujoco", "pymunk"])
def test_an_engine_without_beams_says_so(scene: Scene, engine: str) -> None:
    found = check(cell(scene, engine=engine))
    assert found.verdict == "unsupported"
    assert f"{engine} has no beams (coupler), and exudyn has" in found.reason


def test_a_link_that_stretches_is_sent_to_an_engine_and_not_back_to_segments(scene: Scene) -> None:
    own = replace(scene.elastic["coupler"], axial_n=8e4)
    found = check(cell(replace(scene, elastic={"coupler": own}), engine="mujoco"))
    assert "exudyn has" in found.reason
    assert "links that do not stretch" in found.reason


@pytest.fixture(
    scope="module",
    params=few(
        ["fourbar-elastic", "slider-crank-elastic", "sixbar-elastic"],
        {"fourbar-elastic"},
        "two to six seconds for the truth; the limit is one for all",
    ),
)
def bent(request: pytest.FixtureRequest) -> Scene:
    """Each of the shipped ones in turn for all that follows: the truth of one is found once."""
    return load_scene(request.param)


@pytest.mark.parametrize("share", [5e-3, -5e-3])
def test_a_modulus_half_a_per_cent_off_is_seen_at_the_usual_step(bent: Scene, share: float) -> None:
    found, _ = examined(cell(bent, steps=USUAL), runner=in_beam(stiffer)(share))
    assert [finding.rule for finding in found.failures] == ["CC131"]


@pytest.mark.parametrize("elements", [8, 16])
def test_shipped_links_take_a_third_of_their_limit(bent: Scene, elements: int) -> None:
    found = check(cell(bent, elements, steps=USUAL))
    assert found.verdict == "within"
    assert 3.0 * off(found) < found.limits["deflection"].number


@pytest.mark.parametrize("steps", few([USUAL, 4 * USUAL], {USUAL}, "what locks needs no steps"))
@pytest.mark.parametrize("elements", [2, 3, 4])
def test_what_few_elements_lock_by_is_no_fault_of_the_engine(
    scene: Scene, elements: int, steps: int
) -> None:
    """They start off pushed apart: the rocker by 0.13 of the speed squared with 2."""
    found = check(cell(scene, elements, steps=steps, with_forces=True))
    assert found.verdict == "within", [finding.text for finding in found.failures]
    rows = [row for row in found.errors.rows if row.kind == "start"]
    pushed = max(row.pure for row in rows if row.quantity == "acceleration")
    assert pushed == pytest.approx(2.15 / elements**4, rel=0.1)


def test_a_beam_needs_no_short_step(scene: Scene) -> None:
    assert held_steps(scene, 16, "beam") == 720 < held_steps(scene, 16, "plain")
