"""Engines on elastic links that are let go, or that a controller drives."""

from dataclasses import replace
from functools import cache

import pytest

from models.files.reading import load_scene
from models.scene import Scene
from reports.compare.errors import DRIVEN
from reports.compare.released_truth import ReleasedElasticTruth
from reports.judge.cell import Cell, Checked, check, examined
from reports.judge.rows import cell_row
from reports.judge.tolerance import limits
from reports.plan.requirements import counted_released, few_swings_s, shortened_note, under_control
from reports.protocol.way import way_of
from reports.requests.compare import compare
from reports.requests.judge import judge
from reports.requests.run import run as simulated
from reports.selftest.elastic_changes import in_given
from reports.selftest.elastic_faults import springs, stiffer
from reports.verify.table import footer
from tests.worlds.facts import with_facts
from tests.worlds.tiers import slow, slowly

PULSE, CONTROLLED = "fourbar-elastic-pulse", "fourbar-elastic-controlled"
SEGMENTS = 4
LASTS_S = {PULSE: 0.15, CONTROLLED: 0.1}
"""What starts straight rings with all that it has, and takes longer."""
ENGINES = "runs at three steps; the truth is one for all engines, and what drives is loads"


@cache
def scene(name: str) -> Scene:
    return under_control(load_scene(name))


def cell(name: str = PULSE, engine: str = "mujoco", **changes: object) -> Cell:
    dt_s, steps = counted_released(scene(name), None, LASTS_S[name], SEGMENTS, "plain")
    given = {"drive": "free", "converge": False, "segments": SEGMENTS, **changes}
    return replace(Cell(scene(name), engine, "tuned", dt_s, steps), **given)  # type: ignore[arg-type]


def worst(checked: Checked, quantity: str, kind: str = "total") -> float:
    return checked.errors.worst(quantity, kind=kind).pure


@pytest.mark.parametrize(
    ("name", "engine", "most"),
    [
        (PULSE, "mujoco", 1e-5),
        slowly(PULSE, "exudyn", 1e-3, reason=ENGINES),
        slowly(CONTROLLED, "pymunk", 1e-3, reason=ENGINES),
    ],
)
def test_engines_are_off_the_chain_by_the_step_squared(name: str, engine: str, most: float) -> None:
    found = check(cell(name, engine, converge=True))
    assert found.verdict == "within", [finding.text for finding in found.failures]
    assert worst(found, "segments") < most
    assert found.convergence.order > 1.8  # MuJoCo's springs ring with the fourth


@pytest.fixture(scope="module")
def checked() -> Checked:
    return check(cell())


def test_the_segments_are_told_of_the_engine_and_the_phase_is_the_beams(checked: Checked) -> None:
    facts, raw = checked.errors.of_links, worst(checked, "phase", "raw")
    assert facts.chain == pytest.approx(worst(checked, "deflection"), rel=0.01)
    assert facts.chain == pytest.approx(0.05, rel=0.1)  # 0.80/n^2
    assert facts.doubt < 1e-5
    assert raw == pytest.approx(facts.apart["phase"], rel=0.01)
    assert worst(checked, "phase") < raw  # over how a small change of the start has grown
    assert worst(checked, "energy") < 1e-6
    (told,) = (finding.text for finding in checked.findings if finding.rule == "CC134")
    assert "the segments limit the accuracy" in told
    assert checked.errors.worst("geometry") is None
    assert "no geometry: the driver's angle" in " ".join(checked.errors.notes)
    row = cell_row(checked)
    assert row["place_pure"] == row["deflection_pure"]
    limits_of = ("phase_limit_pure", "energy_limit_pure", "segments_limit_pure", "sensitivity")
    assert all(isinstance(row[name], float) for name in limits_of)
    assert (row["drive"], row["segments"], row["left_out"]) == ("free", 4.0, 0)


def test_the_footer_says_what_stands_under_its_heads(checked: Checked) -> None:
    told = footer([checked], {})
    assert told.startswith("Elastic links: ")
    for part in (
        "engine: against the exact chain of as many segments instead",
        "angles, places and rates are over G",
        "Given as 4 segments, plain springs.",
        f"{PULSE}, mujoco: the segments limit the accuracy",
        "s over 0.15 s; G up to",
    ):
        assert part in told
    assert not [part for part in ("geometry at", "Classes") if part in told]
    as_beam = footer([replace(checked, cell=replace(checked.cell, springs="beam"))], {})
    assert "a beam of the engine's own has no exact chain" in as_beam
    assert "engine: against" not in as_beam
    assert "Given as 4 elements of a beam." in as_beam
    driven = replace(checked.errors.of_links, springs="beam").compared_with(DRIVEN, "")
    assert not [part for part in ("chain", "let go") if part in driven]


def test_springs_that_are_a_part_in_a_hundred_too_stiff_are_out() -> None:
    found, _ = examined(cell(), in_given(springs(stiffer))(0.01))
    assert "CC132" in {finding.rule for finding in found.failures}


@slow("a search of steps: 2 s")
def test_a_step_that_the_springs_do_not_hold_says_which_would() -> None:
    found = check(cell(segments=8, dt_s=3e-3, steps=100))
    assert found.status == "diverged"
    assert "take a step of 0.00117 s, or fewer segments" in found.reason


def test_the_velocities_of_half_a_step_before_the_start_have_a_truth() -> None:
    """As MuJoCo ships it is half a step off, before the start and before the end."""
    found = check(cell(profile="as-shipped"))
    assert [error.finite for error in found.errors.rows] == [True] * len(found.errors.rows)


def test_a_truth_that_is_in_doubt_ends() -> None:
    doubted = cell(tolerance={"phase": 1e-11})
    assert isinstance(doubted.truth, ReleasedElasticTruth)
    assert 0.0 < doubted.truth.known_s < LASTS_S[PULSE]
    found = check(doubted)
    assert found.errors.of_motion.left_out > 0
    assert "the reference ends" in " ".join(found.errors.notes)


@pytest.mark.parametrize(("name", "lasts_s"), [(PULSE, LASTS_S[PULSE]), (CONTROLLED, 0.01)])
def test_a_run_is_compared_with_the_beam_that_it_was_let_go_from(name: str, lasts_s: float) -> None:
    done = simulated(name, duration_s=lasts_s, segments=SEGMENTS)
    assert done.drive == "free"
    assert set(done.motion.links) == {"crank", "coupler", "rocker"}
    assert compare(name, done).worst("segments").pure < 1e-5
    assert judge(name, done).verdict == "within"


def test_what_rings_is_let_go_for_a_few_swings_of_it_unless_more_is_asked_for() -> None:
    own = scene(PULSE)
    assert few_swings_s(own) == pytest.approx(1.0)
    dt_s, steps = counted_released(own, None, None, 16, "plain")
    assert dt_s * steps == pytest.approx(1.0)
    assert "free motion for 1 s of its 5 s, 5 swings" in shortened_note(own, dt_s * steps)
    assert counted_released(own, 1e-4, 2.0, 16, "plain") == (1e-4, 20_000)
    assert shortened_note(own, 2.0) == shortened_note(own, 0.3) == ""
    rigid = load_scene("fourbar-pulse")
    assert way_of(rigid).shortened(rigid, 1.0) == ""


def test_what_starts_straight_is_off_by_its_fast_waves_too(checked: Checked) -> None:
    def limit(step: float, *, straight: bool, of: str = "segments") -> float:
        facts = replace(checked.errors.of_links, straight=straight, segments=16, slender=0.0)
        errors = with_facts(checked.errors, step_rad=step, of_links=facts)
        return limits(scene(PULSE), errors, {})[of].number

    even = limit(1e-3, straight=False)
    assert even / limit(5e-4, straight=False) == pytest.approx(4.0)
    assert limit(1e-3, straight=True) > 3.0 * even
    assert limit(1e-3, straight=True, of="gap") == limit(1e-3, straight=False, of="gap")
    # The power 4/3 of the step, up to the waves that so many segments have.
    assert limit(1e-3, straight=True) / limit(5e-4, straight=True) == pytest.approx(2.5, abs=0.5)
