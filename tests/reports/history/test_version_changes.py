"""What changed between versions: ratios, what stands out, and where it is shown and written."""

import csv
import io
import math
from pathlib import Path

import pytest
from packaging.version import Version
from rich.console import Console

from models.errors import CrankcheckError
from reports.history.environments import EngineVersion
from reports.history.table import page, ranking, show, table_text
from reports.history.verification import VersionResult, errors_of, overview, read_version
from reports.history.version_changes import FollowedChange, headlines, steps
from reports.results.runs import CellName, StoredCell, StoredRun


def named(scene: str, profile: str = "as-shipped") -> CellName:
    return CellName(scene, "mujoco", profile, "prescribed", 720.0, 2.0)


def cell(
    scene: str = "fourbar",
    profile: str = "as-shipped",
    status: str = "ok",
    verdict: str = "out",
    settings: dict[str, object] | None = None,
    **errors: float,
) -> StoredCell:
    errors = {name.replace("_", " "): error for name, error in errors.items()}
    reason = "why" * (status != "ok")
    name = named(scene, profile)
    return StoredCell(name, "1", status, reason, errors, settings or {}, verdict=verdict)


def result(version: str, *cells: StoredCell, reason: str = "") -> VersionResult:
    run = StoredRun(version, {each.name: each for each in cells})
    return VersionResult(EngineVersion("mujoco", Version(version)), run, reason)


def change(old: float, new: float) -> FollowedChange:
    return FollowedChange("pin gap", old, new, 1e-11, named("fourbar", "tuned"), "1", "2")


def told(before: list[StoredCell], after: list[StoredCell]) -> list[str]:
    (step,) = steps([result("1", *before), result("2", *after)])
    return [line.text for line in headlines(step)]


def test_a_smaller_error_is_better_by_its_ratio_and_no_number_infinitely_worse() -> None:
    for old, new, word, factor, times in (
        *((2e-2, 1e-3, "better", 20.0, 20.0), (math.inf, 1e-3, "better", math.inf, math.inf)),
        *((1e-3, 2e-2, "worse", 20.0, 0.05), (1e-3, math.inf, "worse", math.inf, 0.0)),
    ):
        found = change(old, new)
        assert found.word() == word
        assert (found.factor, found.times_better) == pytest.approx((factor, times), 1e-6, 0.0)
    for was, now in ((0.0, 9e-12), (math.inf, math.inf), (1e-3, 1.09e-3)):  # rounding, or a tenth
        for each in (change(was, now), change(now, was)):
            assert not each.changed
            assert not each.stands_out


def test_the_largest_change_of_a_quantity_is_told_with_its_scene_and_its_numbers() -> None:
    soft = [cell(pin_gap=2e-2), cell("shaper", pin_gap=2.3e-2)]
    (better,) = told(soft, [cell(pin_gap=1e-3), cell("shaper", pin_gap=1.3e-2)])
    where, of = "by 20 times on the pin gap of fourbar as shipped", "by 2 or more in 1 of 2 scenes"
    assert better == f"2 is better than 1 {where} (2.0e-02 to 1.0e-03 of L; {of})"
    (worse,) = told([cell(pin_gap=1e-3)], [cell(pin_gap=2e-2)])
    assert f"2 is worse than 1 {where}" in worse
    rigid = [cell(name, pin_gap=0.0) for name in "abc"]  # not counted
    assert "scenes" not in told([cell(pin_gap=2e-2), *rigid], [cell(pin_gap=1e-3), *rigid])[0]


def test_worse_is_told_before_better_as_shipped_before_tuned_and_places_for_rates() -> None:
    before = [cell(angle=1.0, pin_gap=1e-3), cell("shaper", pin_gap=1e-3)]
    lines = told(before, [cell(angle=1e-6, pin_gap=3e-3), cell("shaper", pin_gap=1e-8)])
    assert [line.split()[2] for line in lines] == ["worse", "better", "better"]
    before = [cell(profile="tuned", angle=1.0), cell(angle=1.0)]
    first, second = told(before, [cell(profile="tuned", angle=1e-9), cell(angle=1e-2)])
    assert "as shipped" in first
    assert "with profile tuned" in second
    before = [cell(angle=1e-2, velocity=1.0)]  # and rates only where no place tells it
    (both,) = told(before, [cell(angle=1e-3, velocity=1e-3)])
    assert "on the angle of" in both
    assert "on the velocity of" in told(before, [cell(angle=1e-2, velocity=1e-3)])[0]


def test_versions_that_agree_are_said_to_and_cells_that_come_within_tolerance_counted() -> None:
    for gap, words in (
        (1.08e-3, "no error of 2 differs from that of 1 by more than a tenth"),
        (1.5e-3, "errors of 2 differ from those of 1 by 1.5 times at most"),
    ):
        assert told([cell(pin_gap=1e-3)], [cell(pin_gap=gap)]) == [words]
    out = [cell(angle=1.0), cell("shaper", angle=1.0)]
    within = [cell(name, verdict="within", angle=0.9) for name in ("fourbar", "shaper")]
    better, worse = told(out, within), told(within, out)
    assert better == ["2 is within tolerance where 1 was out of it: 2 scenes as shipped"]
    assert worse == ["2 is out of tolerance where 1 was within it: 2 scenes as shipped"]
    known = [cell(name, verdict="known", angle=0.95) for name in ("fourbar", "shaper")]
    calm = ["no error of 2 differs from that of 1 by more than a tenth"]
    assert told(known, within) == told(within, known) == calm
    _, (row,) = overview([result("1", known[0], within[1])])
    assert row[:2] == ["1", "1 of 2, 1 known"]


def test_a_run_that_ends_otherwise_stands_out_and_its_errors_are_not_compared() -> None:
    cells = [[cell(status=s, angle=1e-3), cell("shaper", angle=1e-3)] for s in ("ok", "diverged")]
    assert told(*cells) == ["2 ends as diverged, 1 as ok, in fourbar as shipped: why"]
    for ends, good in ((cells, False), (cells[::-1], True)):
        (step,) = steps([result("1", *ends[0]), result("2", *ends[1])])
        assert [line.good for line in headlines(step)] == [good]
    for status in ("diverged", "unsupported"):
        lost = told([cell(status=status, angle=1.0)], [cell(status=status, angle=9.0)])
        assert lost == ["2 and 1 have no error in common to compare"]


def test_other_settings_are_named_and_a_version_without_a_result_passed_over() -> None:
    cells = [[cell(angle=1.0, settings={"iterations": n, "close": "C"})] for n in (100, 50)]
    assert "2 holds other settings than 1: iterations" in told(*cells)
    never = [[cell(status="unsupported", settings={"a": n})] for n in "12"]
    assert not [text for text in told(*never) if "settings" in text], "it holds what it was given"
    one, two, three = result("1", cell(angle=1.0)), result("2", reason="no"), result("3", cell())
    assert [(step.before, step.after) for step in steps([one, two, three])] == [(one, three)]


def test_scenes_that_became_worse_are_ranked_first_then_by_change_then_by_error() -> None:
    before, after = (1.0, 1.0, 1e-3, 2e-3, 1e-3), (0.5, 0.1, 1e-3, 2e-3, 3e-3)
    both = [
        result(version, *[cell(n, angle=x) for n, x in zip("abcde", errors, strict=True)])
        for version, errors in (("1", before), ("2", after))
    ]
    ranked = ranking([named(scene) for scene in "abcde"], steps(both)[0].changes)
    assert [name.scene for name in ranked] == ["e", "b", "a", "d", "c"]


COLUMNS = (
    "scene,engine,version,profile,drive,steps_per_turn,turns,verdict,status,reason,settings,"
    "angle_pure,displacement_pure,position_pure,gap_pure,pin_gap_m,slider_gap_m,velocity_pure,"
    "acceleration_pure\n"
)


def test_cells_are_read_from_a_verification_and_one_without_is_refused(tmp_path: Path) -> None:
    rows = (
        'one,{},within,ok,,"{""dt"": 1.0}",1e-3,2e-3,1e-3,2e-2,1e-3,4e-3,1e-2,\n'
        "two,{},unsupported,unsupported,no such thing,,,,,,,,,\n"
        "three,{},out,diverged,,,nan,,inf,,,,,\n"  # errors that are no numbers
    ).replace("{}", "mujoco,1,tuned,prescribed,720,2")
    (tmp_path / "verify.csv").write_text(COLUMNS + rows, encoding="utf-8")
    first, second, third = read_version(tmp_path).cells.values()
    assert errors_of(first) == pytest.approx(
        {"angle": 1e-3, "place": 2e-3, "pin gap": 5e-3, "slider gap": 2e-2, "velocity": 1e-2}
    )
    assert (first.settings, first.verdict) == ({"dt": 1.0}, "within")
    assert (second.status, second.reason) == ("unsupported", "no such thing")
    assert errors_of(second) == errors_of(third) == {}
    (tmp_path / "verify.csv").write_text("scene\nfourbar\n", encoding="utf-8")
    for lacking in (tmp_path, tmp_path / "nowhere"):
        with pytest.raises(CrankcheckError, match=r"not the result of a verification.*--again"):
            read_version(lacking)


def test_an_engine_that_calls_itself_otherwise_is_told_of() -> None:
    for version, told, misnamed in (
        *(("7.0.0", "2.0.0", True), ("7.0.0", "seven", True), ("3.6", "", False)),
        *(("2.3.1.post1", "2.3.1", False), ("3.6", "3.6.0", False)),
    ):
        run = StoredRun("x", {}, {"pymunk": told})
        assert VersionResult(EngineVersion("pymunk", Version(version)), run).misnamed is misnamed


@pytest.fixture
def history() -> list[VersionResult]:
    """Many scenes in two versions, and a version that could not be installed."""
    names = [f"slider-crank-number-{n}" for n in range(10, 28)]
    both = [(name, profile) for name in names for profile in ("tuned", "as-shipped")]
    numbers = {"angle": 1e-2, "position": 2e-2, "velocity": 1.0, "acceleration": 1.0}
    return [
        result("3.6.0", *[cell(n, p, **numbers, pin_gap=2e-2) for n, p in both]),
        result("3.7.0", *[cell(n, p, **numbers, pin_gap=1e-3) for n, p in both]),
        result("4.0.0", reason="not installed: no network " + "and so on " * 12),
    ]


def test_outputs_hold_every_number_or_the_reason_for_none(history: list[VersionResult]) -> None:
    stream = io.StringIO()
    show(Console(file=stream, width=60), history, "made by hand")
    assert max(len(line.rstrip()) for line in stream.getvalue().splitlines()) <= 60
    assert "\u2026" not in stream.getvalue()
    text = " ".join(stream.getvalue().split())
    assert "3.7.0 is better than 3.6.0 by 20 times on the pin gap of slider-crank-number" in text
    assert "20 x better" in text
    assert "not installed: no" in text
    lines = list(csv.DictReader(io.StringIO(table_text(history))))
    assert len(lines) == 2 * 18 * 2 * 5 + 1
    gaps = [x for x in lines if x["quantity"] == "pin gap" and x["version"] == "3.7.0"]
    assert len(gaps) == 36
    for line in gaps:
        assert (float(line["error"]), line["version_before"]) == (1e-3, "3.6.0")
        assert float(line["times_better"]) == pytest.approx(20.0)
    assert (lines[-1]["version"], lines[-1]["status"]) == ("4.0.0", "not measured")
    assert lines[-1]["reason"].startswith("not installed: no network")
    text = page(history, "crankcheck 1")
    assert text.startswith("# mujoco 3.6.0, 3.7.0, 4.0.0\n")
    assert "- 3.7.0 is better than 3.6.0 by 20 times on the pin gap of" in text
    assert text.count("| slider-crank-number-27 | 3.7.0 |") == 2
    assert "not installed: no network" in text
    assert text.rstrip().endswith("crankcheck 1")
