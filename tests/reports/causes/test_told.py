"""What a cause says: the words, the numbers and the correction of each."""

import math
import re
import sys
from collections.abc import Iterable, Mapping
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from analytic import prepared
from analytic.kinematics import solve
from models.array import Array
from models.files.reading import load_scene
from models.motion import Motion
from reports.causes.account import change
from reports.causes.cause import Cause, LogCase
from reports.causes.find import causes
from reports.causes.world import LogFrame
from reports.compare.compare import Truth
from reports.logs.channel import Channel, OwnLog, Reading
from reports.logs.kinds import KINDS, UNITS
from reports.logs.log_beside import AtCrank, beside_truth
from tests.reports.causes.infected_sheets import diagnosed
from tests.worlds.sheets import SCENE, Sheet, angle, at, later, of, omega, only, sheet
from tests.worlds.tiers import few, slow, slowly

PLAIN = of(angle("rocker"), angle("coupler"))
ANGLE = PLAIN.values["rocker_a"]
FOUR = of(angle("rocker"), angle("coupler"), omega("rocker"), omega("coupler"))


def mended(case: LogCase, column: str, correction: Mapping[str, object]) -> float:
    """The largest error of a column over its limit, where its map says what a correction says."""
    reading = next(each for each in case.readings if each.channel.column == column)
    old = reading.channel
    number = old.sign * reading.values / UNITS[old.kind.dimension][old.unit] - old.offset
    told = dict(correction)
    if kind := told.pop("kind", None):
        bodies = case.log.scene.links, case.log.scene.pins, case.log.scene.sliders
        body = str(told.get("of", old.of))
        kinds = [
            KINDS[name, str(kind)]  # type: ignore[index]
            for name, bodies in zip(("link", "point", "slider"), bodies, strict=True)
            if body in bodies and (name, kind) in KINDS
        ]
        told["kind"] = next((k for k in kinds if k.body_kind == old.kind.body_kind), kinds[0])
    new = replace(old, **told)
    values = new.sign * (number + new.offset) * UNITS[new.kind.dimension][new.unit]
    expected = new.expected(case.truth.at(reading.instants + new.delay_s - old.delay_s))
    return float(np.max(np.abs(new.error(values, expected)))) / case.limits[column]


MENDED = (
    "two_swapped", "three_swapped", "rate_and_place_swapped", "of_another_link", "of_a_joint",
    "another_kind", "another_unit", "another_sign", "another_zero", "another_sign_and_zero",
    "one_late", "one_very_late", "rates_half_a_sample_late", "all_late", "from_behind",
    "wrapped_angle",
)  # fmt: skip


ALSO = {
    "two_swapped",
    "three_swapped",
    "another_sign_and_zero",
    "one_very_late",
    "rates_half_a_sample_late",
}
"""Of these another fault of the same cause is mended."""


@pytest.mark.parametrize("fault", few(MENDED, {*MENDED} - ALSO, "as another one of its cause"))
def test_what_is_to_be_written_in_the_map_mends_the_log(fault: str) -> None:
    planted, _, found = diagnosed(fault)
    for cause in found:
        for column in cause.columns:
            correction = cause.of_column.get(column, cause.correction)
            assert correction, cause.text
            assert mended(planted.case, column, correction) < 10.0


def test_a_delay_comes_on_top_of_the_one_that_the_map_says() -> None:
    plain = of(omega("rocker", delay_s=0.01), angle("coupler"))
    late = at(plain, plain.time_s + 0.004, "rocker_w")
    assert only(late).correction["delay_s"] == pytest.approx(0.014, rel=1e-6)


def test_a_late_channel_within_its_limit_is_told_of_too() -> None:
    plain = of(angle("rocker"), omega("rocker"), omega("coupler"))
    late = later(plain, -0.5, "rocker_w")
    wide = replace(late, limits=dict.fromkeys(late.limits, 10.0))
    assert not wide.case.out
    assert only(wide).columns == ("rocker_w",)
    assert "0.50 samples" in only(wide).text


def test_readings_that_are_off_by_a_part_of_the_last_digit_are_rounded_all_the_same() -> None:
    off = 2.5e-5 * np.sin(1e3 * PLAIN.time_s)
    rounded = PLAIN.put({"rocker_a": np.round(ANGLE + off, 4)})
    cause = only(replace(rounded, limits=dict.fromkeys(rounded.limits, 3e-5)))
    assert "(column rocker_a) is rounded to 4 decimals (rad)" in cause.text


BAR = SCENE.links["coupler"]
LONGER = replace(BAR, points={**BAR.points, "C": (0.2525, 0.0)})
OTHER = replace(SCENE, links={**SCENE.links, "coupler": LONGER})
MORE = of(angle("rocker"), angle("coupler"), omega("rocker"))
FLOAT = PLAIN.put({"rocker_a": ANGLE.astype(np.float32).astype(float)})
RATES = of(omega("rocker"), omega("coupler"), omega("crank"))
TWO = of(angle("crank"), angle("rocker"))
AXES = {"x": "m", "y": "m", "vx": "m/s", "vy": "m/s"}
POINTS = (Channel(f"{p}_{a}", KINDS["point", a], p, AXES[a]) for p in "BC" for a in AXES)
BC = of(*POINTS, angle("rocker"))


def framed(order: int, **frame: Any) -> Sheet:
    """Places or rates of points in another frame."""
    seen = LogFrame(**frame).seen(solve(SCENE, BC.time_s, bound=False))
    return BC.of(seen, BC.columns(lambda c: c.unit == ("m", "m/s")[order]))


NUMBERS = {
    "start": (
        later(of(angle("rocker"), angle("crank"), omega("rocker")), 0.01 / TWO.step_s),
        r".*or the driver starts at 95\.73 deg, not at 90 deg.*",
    ),
    "offset": (
        TWO.put({"crank_a": TWO.values["crank_a"] - 0.05}),
        r".*is off by -0\.05 rad all along, as if it belonged 0\.95 samples \(5\.00 ms\) earlier.*",
    ),
    "time unit": (
        replace(MORE, time_s=1000.0 * MORE.time_s, stamp=("tick", "s")),
        r'the times \(column tick\) are in ms, not in s: unit = "ms" under \[time\] of the map',
    ),
    "length": (
        MORE.of(solve(OTHER, MORE.time_s, bound=False)),
        r"length BC of coupler is 0\.2525 m in the log, 0\.25 m in the scene \(\+1 %\)",
    ),
    "turned: places": (
        framed(0, turn_rad=0.05), "the x-axis of the places of the points lies at -2.865 deg of "
        "the scene, not that of the angles and the velocities",
    ),
    "turned: rates": (
        framed(1, turn_rad=0.05), "the x-axis of the velocities of the points lies at -2.865 deg "
        "of the scene, not that of the angles and the places",
    ),
    "turned: seen from behind": (
        framed(0, mirrored=True), "the places of the points have another frame than the angles and "
        "the velocities, their y-axis to the other side",
    ),
    "scaled": (
        RATES.put({c: 1.01 * v for c, v in RATES.values.items()}), "all channels .* read 1.01 .*"
    ),
    "float32": (replace(FLOAT, limits={"rocker_a": 1e-9, "coupler_a": 1e-9}), ".*"),
}  # fmt: skip


@pytest.mark.parametrize(
    "name",
    few(NUMBERS, NUMBERS.keys() - {"turned: rates", "turned: seen from behind"}, "as places"),
)
def test_a_cause_is_told_with_its_numbers(name: str) -> None:
    planted, words = NUMBERS[name]
    cause = only(planted)
    assert cause.name == name.partition(":")[0]
    assert re.fullmatch(words, cause.text), cause.text


def test_rates_tell_a_slow_clock_from_a_fast_driver() -> None:
    plain = of(angle("rocker"), angle("crank"), omega("rocker"), omega("crank"))
    slow = at(plain, 1.002 * plain.time_s)
    assert "the clock of the log runs 0.2 % slow; the rates say" in only(slow).text
    law = replace(SCENE.driver.law, speed_rad_s=10.02)
    fast = replace(SCENE, driver=replace(SCENE.driver, law=law))
    driver = only(plain.of(solve(fast, plain.time_s, bound=False)))
    assert driver.text.startswith("the driver turns 0.2 % fast (10.02 rad/s, not 10 rad/s), or")
    alone = {c: slow.channels[c] for c in ("rocker_a", "crank_a")}
    both = only(replace(slow, channels=alone, limits=dict.fromkeys(alone, 0.001)))
    assert "clock of the log runs 0.2 % slow, or the driver turns 0.2 % fast" in both.text


PLANTED = "its log is made and planted in test_faults.py, where it is slow as well"


@pytest.mark.parametrize(
    ("fault", "words"),
    [
        ("backwards_driver", "the driver turns the other way"),
        slowly(
            "rounded_times",
            r"the times \(column t\) are rounded to \d decimals \(s\)",
            reason=PLANTED,
        ),
        ("shaken_times", "the samples are even"),
        ("all_lengths", "every length is"),
        ("from_behind", "seen from behind"),
        slowly(
            "stuck_stretch",
            r"samples \d+ to \d+ \(t = .* s\) repeat the one before",
            reason=PLANTED,
        ),
        ("slow_sensor", "is updated at every"),
        ("spikes", "is off at single samples: sample"),
        ("arc_tangent", "folded into half a turn"),
        ("magnitude", "has no sign"),
        ("few_decimals", "is rounded to"),
        ("few_steps_a_turn", "is quantised to steps of"),
        slowly("rate_of_counts", r"a turn \(\d+ bits\) counted over one interval", reason=PLANTED),
        ("half_precision", r"is rounded to half precision \(float16\)"),
        ("low_passed_forth_and_back", r"low-pass of order \d forth and back, cutoff .* Hz"),
        ("rows_lost", r"lack rows, with .* closed up: \d+ before sample \d+ \(t = "),
        slowly("points_of_a_tilted_camera", "the x-axis of the points lies at", reason=PLANTED),
        slowly("mean_of_the_last", r"is a mean over \d+ samples, the last ones", reason=PLANTED),
        ("mean_of_both_sides", r"is a mean over \d+ samples, \d+ on both sides"),
    ],
)
def test_the_words_of_a_cause(fault: str, words: str) -> None:
    assert any(re.search(words, cause.text) for cause in diagnosed(fault)[-1])


@pytest.mark.parametrize(("now", "words"), [(0.999, "-0.1 %"), (1.00012, "+120 ppm")])
def test_a_change_is_told_in_percent_or_in_parts_of_a_million(now: float, words: str) -> None:
    assert change(now, 1.0) == words


@slow("a second; another assembly is planted in test_faults.py")
def test_a_log_that_goes_over_to_the_other_assembly_says_when() -> None:
    plain = of(angle("rocker"), angle("coupler"), omega("rocker"))
    other = plain.of(solve(replace(SCENE, branch={"C": -1}), plain.time_s, bound=False))
    later = plain.time_s >= 0.5
    over = {c: np.where(later, other.values[c], plain.values[c]) for c in plain.values}
    cause = only(plain.put(over))
    assert cause.name == "branch"
    assert "from t = 0.5" in cause.text


def by_name(found: Iterable[Cause]) -> dict[str, tuple[str, ...]]:
    return {cause.name: cause.columns for cause in found}


def test_two_faults_in_different_channels_are_each_named() -> None:
    rng = np.random.default_rng(4)
    plain = sheet(load_scene("sixbar-watt"), rng, rows=300)
    first, second = plain.moving(lambda c: c.kind.order == 1)[:2]
    stuck = plain.values[second].copy()
    stuck[100:130] = stuck[99]
    found = causes(plain.put({first: -plain.values[first], second: stuck}).case)
    assert by_name(found) == {"sign": (first,), "stuck": (second,)}


def test_causes_are_found_of_the_geometry_at_the_logged_crank() -> None:
    plain = of(angle("crank"), angle("rocker"), angle("coupler"))
    crank = plain.values["crank_a"] + 0.2 * np.sin(plain.time_s)
    truth = AtCrank(SCENE, time_s=plain.time_s, crank_rad=crank)
    motion = truth.at(plain.time_s)
    wrong = {"crank_a": crank, "rocker_a": motion.links["coupler"].theta}
    (cause,) = causes(replace(plain.of(motion).put(wrong).case, truth=truth))
    assert (cause.name, cause.columns) == ("misnamed", ("rocker_a",))


def test_of_a_long_log_some_instants_stand_for_the_whole_mechanism(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    beside = beside_truth(PLAIN.case.log, Truth(SCENE, links=("rocker", "coupler")))
    most = PLAIN.time_s.size // 3
    monkeypatch.setattr(sys.modules[type(beside).__module__], "MANY", most)
    assert np.array_equal(beside.whole.time_s, PLAIN.time_s[::4])
    assert set(beside.whole.links) == set(SCENE.links)


def test_a_channel_without_a_limit_is_not_judged() -> None:
    wrong = PLAIN.put({"rocker_a": -ANGLE})
    for limits in ({"coupler_a": 1e-3}, {"coupler_a": 1e-3, "rocker_a": math.inf}):
        assert not causes(replace(wrong, limits=limits).case)


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("rows", [2, 7])
def test_what_is_no_log_of_anything_raises_nothing(rows: int) -> None:
    plain = of(angle("rocker"), omega("rocker"), angle("crank"), rows=rows)
    rng = np.random.default_rng(rows)
    for values in (np.zeros(rows), rng.normal(size=rows) * 1e300, np.full(rows, math.nan)):
        for columns in (["rocker_a"], plain.values):
            wrong = plain.put(dict.fromkeys(columns, values))
            causes(wrong.case)
            causes(replace(wrong, limits=dict.fromkeys(wrong.limits, 0.0)).case)


def solved(rows: int, monkeypatch: pytest.MonkeyPatch) -> list[int]:
    """The instants of each solution of the reference that causes of a late channel take in a log
    of so many rows."""
    plain = of(angle("rocker"), omega("rocker"), omega("coupler"), rows=rows, turns=rows / 2000.0)
    case = at(plain, plain.time_s - 1e-4, "rocker_w").case
    for reading in case.readings:
        reading.expected(case.truth)  # which has been compared with already
    counts: list[int] = []
    motion = prepared.Prepared.motion

    def counted(ready: Any, names: Any, time_s: Array, *args: Any, **bound: bool) -> Motion:
        counts.append(len(time_s))
        return motion(ready, names, time_s, *args, **bound)

    with monkeypatch.context() as patched:
        patched.setattr(prepared.Prepared, "motion", counted)
        assert [cause.columns for cause in causes(case)] == [("rocker_w",)]
    return counts


@pytest.mark.parametrize("rows", [40_000, slowly(1_000_000, reason="as long as logs may be")])
def test_hypotheses_look_at_part_of_a_long_log(rows: int, monkeypatch: pytest.MonkeyPatch) -> None:
    short, long = (solved(each, monkeypatch) for each in (2000, rows))
    assert max(long) < 2000
    assert sum(long) < 2 * sum(short)


def test_readings_of_copies_are_looked_at_where_they_have_limits() -> None:
    time_s = np.linspace(0.0, 1.0, 200)
    motion = solve(SCENE, time_s, bound=False)
    channel = Channel("C2_x", KINDS["point", "x"], "C", "m", on="rocker")
    copy = Reading(channel, 1000.0 * channel.expected(motion), time_s)
    log = OwnLog("copied", SCENE, time_s, (), copies=(copy,))
    (cause,) = causes(LogCase(log, Truth(SCENE), {"C2_x": 1e-3}))
    assert cause.correction == {"unit": "mm"}
