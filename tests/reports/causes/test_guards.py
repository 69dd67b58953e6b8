"""What keeps a cause from being told where it explains too little, or spoils what is right; and two
faults of one channel, both told where the first of them needs no fitted number."""

import math
from collections.abc import Mapping
from dataclasses import replace

import numpy as np
import pytest

from analytic.kinematics import solve
from models.array import Array
from models.scene import Scene
from reports.causes.account import Account, chosen
from reports.causes.find import causes
from reports.causes.world import World
from reports.logs.channel import Channel
from reports.logs.kinds import KINDS
from tests.worlds.sheets import SCENE, Sheet, angle, at, later, of, omega, only
from tests.worlds.tiers import few

PLAIN = of(angle("rocker"), angle("coupler"))
THREE = of(angle("rocker"), omega("rocker"), angle("coupler"))
FOUR = of(angle("rocker"), omega("rocker"), angle("coupler"), omega("coupler"))
ANGLE, COLUMN = PLAIN.values["rocker_a"], "rocker_a"
DEG = math.pi / 180.0
PLACES = {"x": KINDS["point", "x"], "y": KINDS["point", "y"]}


def point(name: str, axis: str) -> Channel:
    return Channel(f"{name}_{axis}", PLACES[axis], name, "m")


def bars(**lengths: float) -> Scene:
    """The four-bar with bars of other lengths [m]."""
    links = dict(SCENE.links)
    for name, length in lengths.items():
        first, second = links[name].points
        links[name] = replace(links[name], points={first: (0.0, 0.0), second: (length, 0.0)})
    return replace(SCENE, links=links)


def noise(sheet: Sheet, seed: int = 1) -> Array:
    return np.random.default_rng(seed).normal(size=sheet.time_s.size)


def test_no_length_is_told_that_would_move_a_channel_that_is_right() -> None:
    longer = solve(bars(coupler=0.2525), FOUR.time_s, bound=False)
    found = causes(FOUR.of(longer, ["rocker_a", "rocker_w"]).case)
    assert "length" not in {cause.name for cause in found}


def test_two_bars_of_other_lengths_are_not_a_scene_of_another_size() -> None:
    plain = of(point("B", "x"), point("B", "y"), point("C", "x"), angle("rocker"))
    both = plain.of(solve(bars(crank=0.11, coupler=0.24), plain.time_s, bound=False))
    assert "size" not in {cause.name for cause in causes(both.case)}


def test_what_one_fault_brings_within_its_limit_is_told_with_it_whatever_the_noise() -> None:
    plain = of(point("B", "x"), point("B", "y"), point("C", "x"), point("C", "y"))
    half = {c: 0.0125 * np.ptp(values) for c, values in plain.values.items()}
    limits = half | {"C_x": 1e-3 * half["C_x"]}
    rng = np.random.default_rng(1)
    noisy = {
        column: 1.03 * values + 0.9 * limits[column] * rng.uniform(-1.0, 1.0, values.size)
        for column, values in plain.values.items()
    }
    cause = only(replace(plain.put(noisy), limits=limits))
    assert cause.name == "size"
    assert len(cause.columns) == 4


RATE = Channel("B_vy", KINDS["point", "vy"], "B", "m/s")  # which is 0 at the start
RATES = (omega("rocker"), angle("coupler"))
NOISE = {
    "readings that are only brought nearer": ("rocker_w", 1e3, of(*RATES)),
    "a mean that lets nothing through": ("rocker_w", 1e-3, of(*RATES, rows=147, turns=20.0)),
    "what does not move, as if in nanoseconds": ("B_vy", 1e-4, of(RATE, omega("crank"))),
}


@pytest.mark.parametrize("case", NOISE)
def test_noise_has_no_cause_whatever_its_size(case: str) -> None:
    column, size, plain = NOISE[case]
    assert not causes(plain.put({column: size * noise(plain)}).case)


@pytest.mark.parametrize("share", [-0.45, 0.4])
def test_delays_of_up_to_half_a_turn_are_found(share: float) -> None:
    rate = Channel("rocker_w", KINDS["link", "angular acceleration"], "rocker", "rad/s^2")
    plain = of(rate, angle("coupler"))
    by_s = share * SCENE.driver.law.period_s
    late = at(plain, plain.time_s + by_s, "rocker_w")
    assert only(late).correction["delay_s"] == pytest.approx(by_s, rel=1e-6)


def test_a_gain_and_a_zero_do_not_explain_what_has_another_shape() -> None:
    higher = ANGLE.mean() + 1.2 * (ANGLE - ANGLE.mean())
    assert only(PLAIN.put({COLUMN: higher})).name == "scaled"
    bend = 0.008 * np.ptp(ANGLE) * np.sin(20.0 * PLAIN.time_s + 1.0)
    assert not causes(PLAIN.put({COLUMN: higher + bend}).case)


def test_a_delay_that_the_last_digit_may_have_made_is_not_told() -> None:
    plain = of(angle("rocker"), angle("coupler"), rows=2401)
    late = later(plain, 0.2, COLUMN)
    assert causes(late.case)
    assert not causes(late.put({COLUMN: np.round(late.values[COLUMN], 4)}).case)


def test_a_drift_of_turns_is_followed_from_the_beginning() -> None:
    plain = of(angle("rocker"), angle("coupler"), rows=6001, turns=200.0)
    drifted = at(plain, 1.01 * plain.time_s)
    rng = np.random.default_rng(1)
    noisy = {c: v + 0.03 * rng.normal(size=v.size) for c, v in drifted.values.items()}
    cause = only(replace(drifted.put(noisy), limits=dict.fromkeys(plain.limits, 0.2)))
    assert cause.name == "drift"
    assert "(10.1 rad/s, not 10 rad/s)" in cause.text


def test_a_channel_with_another_fault_does_not_bend_the_length_that_is_told() -> None:
    longer = FOUR.of(solve(bars(coupler=0.2525), FOUR.time_s, bound=False))
    wrong = longer.put({"rocker_w": 1.3 * longer.values["rocker_w"]})
    found = {cause.name: cause for cause in causes(wrong.case)}
    assert "length BC of coupler is 0.2525 m in the log" in found["length"].text
    assert found["length"].left < 1e-5
    assert "reads 1.3 times as much" in found["scaled"].text


def test_shaken_times_are_told_though_their_line_is_not_quite_that_of_the_samples() -> None:
    plain = of(angle("rocker"), omega("rocker"), rows=60)
    rng = np.random.default_rng(2)
    shaken = plain.time_s + 0.3 * plain.step_s * rng.uniform(-1.0, 1.0, 60)
    tight = dict.fromkeys(plain.limits, 1e-6)
    assert only(replace(plain, time_s=shaken, limits=tight)).name == "time stamps"


def test_the_top_of_an_error_that_grows_and_falls_is_no_spike() -> None:
    wrong = PLAIN.put({COLUMN: ANGLE + 1.005e-3 * np.exp(-(((PLAIN.time_s - 0.5) / 0.05) ** 2))})
    assert 0 < np.sum(np.abs(wrong.case.excerpts[COLUMN].error) > wrong.limits[COLUMN]) < 4
    assert not causes(wrong.case)


def test_the_world_that_explains_most_is_told_and_no_single_channel_of_it_as_well() -> None:
    world = World(SCENE)
    lefts = {"a": 0.0, "b": 0.0, "c": 0.0}
    whole = Account("branch", 0.5, {"a": 1e-5, "b": 1e-5}, lefts, "", world=world, order=9)
    single = Account("delay", 1.5, {"b": 1e-5, "c": 1e-5}, lefts, "{who}", order=5)
    told = {account.name: account.columns for account in chosen([single, whole], ["a", "b", "c"])}
    assert told == {"branch": ("a", "b"), "delay": ("c",)}
    one = Account("start", 1.5, {"a": 1e-5, "b": 1e-5}, lefts, "", world=world)
    two = Account("drift", 2.5, dict.fromkeys("abc", 1e-5), lefts, "", world=world)
    assert [account.name for account in chosen([one, two], "abc")] == ["drift"]


def test_one_more_number_has_to_leave_ten_times_less() -> None:
    lefts = {"a": 0.0}
    plain = Account("offset", 1.5, {"a": 0.05}, lefts, "{who}")
    for rest, name in ((0.02, "offset"), (0.001, "scaled")):
        free = Account("scaled", 2.5, {"a": rest}, lefts, "{who}")
        assert [account.name for account in chosen([plain, free], ["a"])] == [name]


def test_a_channel_that_stays_is_read_in_another_unit_before_it_has_another_zero() -> None:
    plain = of(omega("crank", "rpm"), angle("rocker"))
    cause = only(plain.put({"crank_w": plain.values["crank_w"] * math.tau / 60.0}))
    assert cause.correction == {"unit": "rad/s"}
    assert only(plain.put({"crank_w": plain.values["crank_w"] + 0.3})).name == "offset"


def smoothed(values: Array, share: float) -> Array:
    after = values.copy()
    for row in range(1, values.size):
        after[row] = after[row - 1] + share * (values[row] - after[row - 1])
    return after


def test_a_mean_that_is_merely_like_what_there_is_is_not_told() -> None:
    late = later(PLAIN, -2.5)
    after = PLAIN.put({COLUMN: smoothed(late.values[COLUMN], 0.15)})
    assert "mean" not in {cause.name for cause in causes(after.case)}


def test_nothing_is_smoothed_over_less_than_a_sample() -> None:
    plain = of(omega("rocker"), angle("coupler"))
    both = [later(plain, side, "rocker_w").values["rocker_w"] for side in (-0.25, 0.25)]
    wrong = replace(plain.put({"rocker_w": 0.5 * (both[0] + both[1])}), limits={"rocker_w": 1e-5})
    assert wrong.case.out
    assert not causes(wrong.case)


def test_an_angle_that_is_off_by_half_a_turn_is_not_folded() -> None:
    assert only(PLAIN.put({COLUMN: ANGLE + math.pi})).name == "offset"


def test_numbers_of_one_channel_are_doubted_where_all_the_others_have_no_cause() -> None:
    plain = of(angle("rocker"), angle("coupler"), omega("rocker"), omega("coupler"))
    rng = np.random.default_rng(3)
    noisy = {
        c: v + 30.0 * plain.limits[c] * rng.normal(size=v.size) for c, v in plain.values.items()
    }
    gain = {COLUMN: ANGLE * 1.01}
    assert [cause.name for cause in causes(plain.put(gain).case)] == ["scaled"]
    assert not causes(plain.put(noisy | gain).case)


def test_a_driver_that_turns_the_other_way_may_have_a_speed_without_sign() -> None:
    plain = of(angle("rocker"), angle("crank"), omega("crank"))
    cause = only(at(plain, -plain.time_s, "rocker_a", "crank_a"))
    assert cause.name == "reversed"
    assert cause.columns == ("rocker_a", "crank_a")


def test_a_delay_is_not_told_of_a_channel_that_would_not_show_it() -> None:
    plain = of(point("B", "x"), omega("crank"), omega("rocker"))
    late = later(plain, -2.5, "B_x")
    end = 1e-13 * (np.arange(plain.time_s.size) < 2)
    assert only(late.put({"crank_w": late.values["crank_w"] + end})).columns == ("B_x",)


def stuck(values: Array) -> Array:
    return np.concatenate([values[:50], [values[49]] * 4, values[54:]])


def spiked(values: Array) -> Array:
    return values + 0.4 * (np.arange(values.size) == 90)


def short_of_a_turn(values: Array) -> Array:
    return values - math.tau * (np.arange(values.size) >= 100)


LATE = later(PLAIN, -2.5).values[COLUMN]
TWO: Mapping[str, tuple[Array, tuple[str, str]]] = {
    "sign, late": (-LATE, ("has the wrong sign", "2.50 samples")),
    "unit, late": (LATE / DEG, ("is in deg, not in rad", "2.50 samples")),
    "unit, turn": (short_of_a_turn(ANGLE) / DEG, ("in deg", "turns: -1")),
    "unit, filter": (smoothed(ANGLE, 0.2) / DEG, ("in deg", "low-pass")),
    "late, stuck": (stuck(LATE), ("samples 50 to 53", "2.50 samples")),
    "zero, spike": (spiked(ANGLE + 0.1), ("sample 90", "off by +0.1 rad")),
}
QUICK = {"unit, late", "unit, filter", "late, stuck"}


@pytest.mark.parametrize("name", few(TWO, QUICK, "a second; other pairs"))
def test_both_are_told_of_their_channel(name: str) -> None:
    values, words = TWO[name]
    cause = only(THREE.put({COLUMN: values}))
    assert cause.columns == (COLUMN,)
    assert all(word in cause.text for word in words), cause.text
    assert "and beside that" in cause.text
    assert cause.left < 0.02


def test_what_is_to_be_written_in_the_map_is_told_of_both() -> None:
    cause = only(PLAIN.put({COLUMN: -LATE / DEG}))
    delay_s = pytest.approx(-2.5 * PLAIN.step_s, rel=1e-6)
    assert cause.correction == {"unit": "deg", "sign": -1, "delay_s": delay_s}


def test_a_channel_that_one_fault_explains_has_no_second() -> None:
    for values in (-ANGLE, LATE, spiked(ANGLE)):
        assert "beside" not in only(THREE.put({COLUMN: values})).text


def test_two_faults_are_not_made_of_noise_nor_of_what_is_nearly_another_unit() -> None:
    bent = ANGLE * (1.0 + 0.2 * np.sin(3.3 * PLAIN.time_s)) / DEG
    for values in (*(ANGLE + size * noise(THREE) for size in (0.05, 1.0, 60.0)), bent):
        assert not causes(THREE.put({COLUMN: values}).case)
