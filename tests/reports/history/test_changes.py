"""What changed between versions: ratios, what stands out, and where it is shown and written."""

from __future__ import annotations

import csv
import io
import math
from pathlib import Path

import pytest
from packaging.version import Version
from rich.console import Console

from models.errors import CrankcheckError
from reports.history.changes import (
    Change,
    changes,
    headlines,
    other_settings,
    steps,
    turns,
)
from reports.history.document import page, table_text
from reports.history.environments import Wanted
from reports.history.measured import QUANTITIES, Found, Outcome, read
from reports.history.table import ranking, show

PIN_GAP = next(quantity for quantity in QUANTITIES if quantity.name == "pin gap")
ANGLE = next(quantity for quantity in QUANTITIES if quantity.name == "angle")
VELOCITY = next(quantity for quantity in QUANTITIES if quantity.name == "velocity")


def cell(
    scene: str = "fourbar",
    profile: str = "as-shipped",
    status: str = "ok",
    verdict: str = "out",
    settings: dict[str, object] | None = None,
    **errors: float,
) -> Found:
    named = {name.replace("_", " "): error for name, error in errors.items()}
    return Found(scene, profile, verdict, status, "why" * (status != "ok"), named, settings or {})


def outcome(version: str, *cells: Found, reason: str = "") -> Outcome:
    return Outcome(Wanted("mujoco", Version(version)), cells, reason)


def texts(before: Outcome, after: Outcome) -> list[str]:
    return [line.text for line in headlines(before, after)]


def test_a_smaller_error_is_better_by_its_ratio() -> None:
    change = Change("1", "2", "fourbar", "tuned", PIN_GAP, 2e-2, 1e-3)
    assert change.ratio == pytest.approx(20.0)
    assert (change.word, change.factor) == ("better", pytest.approx(20.0))
    back = Change("2", "1", "fourbar", "tuned", PIN_GAP, 1e-3, 2e-2)
    assert (back.word, back.factor) == ("worse", pytest.approx(20.0))


@pytest.mark.parametrize(("was", "now"), [(0.0, 0.0), (4e-16, 1e-17), (math.inf, math.inf)])
def test_what_rounding_explains_is_no_change(was: float, now: float) -> None:
    assert Change("1", "2", "fourbar", "tuned", PIN_GAP, was, now).ratio == 1.0


def test_an_error_that_is_no_number_any_more_is_infinitely_worse() -> None:
    change = Change("1", "2", "fourbar", "tuned", PIN_GAP, 1e-3, math.inf)
    assert (change.word, change.factor) == ("worse", math.inf)
    assert Change("1", "2", "fourbar", "tuned", PIN_GAP, math.inf, 1e-3).word == "better"


def test_the_largest_change_of_a_quantity_is_told_with_its_scene_and_its_numbers() -> None:
    before = outcome("3.6.0", cell(pin_gap=2e-2), cell("shaper", pin_gap=2.3e-2))
    after = outcome("3.7.0", cell(pin_gap=1e-3), cell("shaper", pin_gap=1.3e-2))
    assert texts(before, after) == [
        "3.7.0 is better than 3.6.0 by 20 times on the pin gap of fourbar as shipped "
        "(2.0e-02 to 1.0e-03 of L; by 2 or more in 1 of 2 scenes)"
    ]
    assert (
        "4.0.0 is worse than 3.7.0 by 20 times on the pin gap of fourbar as shipped"
        in (texts(outcome("3.7.0", cell(pin_gap=1e-3)), outcome("4.0.0", cell(pin_gap=2e-2)))[0])
    )


def test_pins_that_can_not_come_apart_are_not_counted() -> None:
    before = outcome("3.6.0", cell(pin_gap=2e-2), *[cell(n, pin_gap=0.0) for n in "abc"])
    after = outcome("3.7.0", cell(pin_gap=1e-3), *[cell(n, pin_gap=0.0) for n in "abc"])
    assert "scenes" not in texts(before, after)[0]


def test_what_became_worse_is_told_before_what_became_better() -> None:
    before = outcome("1", cell(angle=1.0, pin_gap=1e-3), cell("shaper", pin_gap=1e-3))
    after = outcome("2", cell(angle=1e-6, pin_gap=3e-3), cell("shaper", pin_gap=1e-8))
    words = [text.split()[2] for text in texts(before, after)]
    assert words == ["worse", "better", "better"]


def test_profile_as_shipped_is_told_before_tuned() -> None:
    before = outcome("1", cell(profile="tuned", angle=1.0), cell(angle=1.0))
    after = outcome("2", cell(profile="tuned", angle=1e-9), cell(angle=1e-2))
    first, second = texts(before, after)
    assert "as shipped" in first
    assert "with profile tuned" in second


def test_rates_are_told_only_where_no_place_tells_it() -> None:
    before = outcome("1", cell(angle=1e-2, velocity=1.0))
    both = texts(before, outcome("2", cell(angle=1e-3, velocity=1e-3)))
    assert len(both) == 1
    assert "on the angle of" in both[0]
    rate = texts(before, outcome("2", cell(angle=1e-2, velocity=1e-3)))
    assert "on the velocity of" in rate[0]


def test_versions_that_agree_are_said_to() -> None:
    before, after = outcome("3.7.0", cell(pin_gap=1e-3)), outcome("4.0.0", cell(pin_gap=1e-3))
    assert texts(before, after) == ["4.0.0 differs from 3.7.0 in no error"]
    near = outcome("4.0.0", cell(pin_gap=1.5e-3))
    assert texts(before, near) == ["4.0.0 differs from 3.7.0 by 1.5 times at most in any error"]
    none = outcome("4.0.0", cell(status="unsupported"))
    assert "have no error in common" in texts(outcome("3", cell(status="unsupported")), none)[0]


def test_a_run_that_ends_otherwise_stands_out() -> None:
    before = outcome("1", cell(angle=1e-3), cell("shaper", angle=1e-3))
    after = outcome("2", cell(status="diverged", angle=1e-3), cell("shaper", angle=1e-3))
    (text,) = texts(before, after)
    assert text == "2 ends as diverged, 1 as ok, in fourbar as shipped: why"
    (line,) = headlines(before, after)
    assert line.good is False
    assert [turn.good for turn in turns(after, before)] == [True]


def test_cells_that_come_within_tolerance_are_counted() -> None:
    before = outcome("1", cell(angle=1.0), cell("shaper", angle=1.0))
    after = outcome("2", *[cell(n, verdict="within", angle=0.9) for n in ("fourbar", "shaper")])
    assert texts(before, after) == [
        "2 is within tolerance where 1 was out of it: 2 scenes as shipped"
    ]
    assert texts(after, before) == [
        "1 is out of tolerance where 2 was within it: 2 scenes as shipped"
    ]


def test_settings_that_an_engine_holds_otherwise_are_named() -> None:
    before = outcome("1", cell(angle=1.0, settings={"iterations": 100, "close": "C"}))
    after = outcome("2", cell(angle=1.0, settings={"iterations": 50, "close": "C"}))
    assert other_settings(before, after) == ["iterations"]
    assert "2 holds other settings than 1: iterations" in texts(before, after)


def test_a_version_without_a_result_is_passed_over() -> None:
    one, two, three = outcome("1", cell(angle=1.0)), outcome("2", reason="no"), outcome("3", cell())
    assert steps([one, two, three]) == [(one, three)]


def test_scenes_that_became_worse_are_ranked_first_then_by_change_then_by_error() -> None:
    before = [("a", 1.0), ("b", 1.0), ("c", 1e-3), ("d", 2e-3), ("e", 1e-3)]
    after = [("a", 0.5), ("b", 0.1), ("c", 1e-3), ("d", 2e-3), ("e", 3e-3)]
    found = changes(
        outcome("1", *[cell(n, angle=x) for n, x in before]),
        outcome("2", *[cell(n, angle=x) for n, x in after]),
    )
    assert ranking("abcde", found) == ["e", "b", "a", "d", "c"]


HEAD = (
    "scene,profile,verdict,status,reason,settings,angle_pure,displacement_pure,position_pure,"
    "gap_pure,pin_gap_m,slider_gap_m,velocity_pure,acceleration_pure\n"
)


def written(folder: Path, *lines: str) -> Path:
    (folder / "verify.csv").write_text(HEAD + "\n".join(lines) + "\n", encoding="utf-8")
    return folder


def test_cells_are_read_from_the_folder_of_a_verification(tmp_path: Path) -> None:
    folder = written(
        tmp_path,
        'one,tuned,within,ok,,"{""dt"": 1.0}",1e-3,2e-3,1e-3,2e-2,1e-3,4e-3,1e-2,',
        "two,tuned,unsupported,unsupported,no such thing,,,,,,,,,",
    )
    first, second = read(folder)
    assert first.errors == pytest.approx(
        {"angle": 1e-3, "place": 2e-3, "pin gap": 5e-3, "slider gap": 2e-2, "velocity": 1e-2}
    )
    assert first.settings == {"dt": 1.0}
    assert (second.status, second.reason, second.errors) == ("unsupported", "no such thing", {})


def test_an_error_that_is_not_a_number_counts_as_endless(tmp_path: Path) -> None:
    folder = written(tmp_path, "one,tuned,out,diverged,,,nan,,inf,,,,,")
    assert read(folder)[0].errors == {"angle": math.inf, "place": math.inf}


def test_a_folder_without_a_result_is_refused(tmp_path: Path) -> None:
    with pytest.raises(CrankcheckError, match=r"not the result of a verification"):
        read(tmp_path)
    (tmp_path / "verify.csv").write_text("scene\nfourbar\n", encoding="utf-8")
    with pytest.raises(CrankcheckError, match=r"not the result of a verification"):
        read(tmp_path)


def test_an_engine_that_calls_itself_otherwise_is_told_of() -> None:
    def misnamed(version: str, told: str) -> bool:
        return Outcome(Wanted("pymunk", Version(version)), calls_itself=told).misnamed

    assert misnamed("7.0.0", "2.0.0")
    assert misnamed("7.0.0", "seven")
    assert not misnamed("2.3.1.post1", "2.3.1")
    assert not misnamed("3.6", "3.6.0")
    assert not misnamed("3.6", "")


@pytest.fixture
def history() -> list[Outcome]:
    """Many scenes in two versions, and a version that could not be installed."""
    names = [f"slider-crank-number-{n}" for n in range(10, 28)]
    both = [(name, profile) for name in names for profile in ("tuned", "as-shipped")]
    numbers = {"angle": 1e-2, "place": 2e-2, "velocity": 1.0, "acceleration": 1.0}
    return [
        outcome("3.6.0", *[cell(n, p, **numbers, pin_gap=2e-2) for n, p in both]),
        outcome("3.7.0", *[cell(n, p, **numbers, pin_gap=1e-3) for n, p in both]),
        outcome("4.0.0", reason="not installed: no network " + "and so on " * 12),
    ]


@pytest.mark.parametrize("width", [60, 80, 99, 100, 140])
def test_the_history_fits_the_terminal_with_nothing_clipped(
    history: list[Outcome], width: int
) -> None:
    stream = io.StringIO()
    show(Console(file=stream, width=width), history, "made by hand")
    lines = stream.getvalue().splitlines()
    assert max(len(line.rstrip()) for line in lines) <= width
    assert "\u2026" not in stream.getvalue()
    flat = " ".join(stream.getvalue().split())
    assert "3.7.0 is better than 3.6.0 by 20 times on the pin gap of slider-crank-number" in flat
    assert "20 x better" in flat
    assert "not installed: no" in flat
    if width >= 100:
        assert len(lines) <= 45


def test_the_file_holds_every_number_and_the_reason_of_a_version_without_any(
    history: list[Outcome],
) -> None:
    lines = list(csv.DictReader(io.StringIO(table_text(history))))
    assert len(lines) == 2 * 18 * 2 * 5 + 1
    gaps = [x for x in lines if x["quantity"] == "pin gap" and x["version"] == "3.7.0"]
    assert len(gaps) == 36
    for line in gaps:
        assert float(line["error"]) == 1e-3
        assert float(line["times_better"]) == pytest.approx(20.0)
        assert line["version_before"] == "3.6.0"
    assert lines[-1]["version"] == "4.0.0"
    assert lines[-1]["status"] == "not measured"
    assert lines[-1]["reason"].startswith("not installed: no network")


def test_the_page_shows_every_scene_and_what_stands_out(history: list[Outcome]) -> None:
    text = page(history, "crankcheck 1")
    assert text.startswith("# mujoco 3.6.0, 3.7.0, 4.0.0\n")
    assert "- 3.7.0 is better than 3.6.0 by 20 times on the pin gap of" in text
    assert text.count("| slider-crank-number-27 | 3.7.0 |") == 2
    assert "not installed: no network" in text
    assert text.rstrip().endswith("crankcheck 1")
