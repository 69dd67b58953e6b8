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
from tests.worlds.tiers import few, slow

PLAIN = of(angle("rocker"), angle("coupler"))
THREE = of(angle("rocker"), omega("rocker"), angle("coupler"))
FOUR = of(angle("rocker"), omega("rocker"), angle("coupler"), omega("coupler"))
ANGLE, COLUMN = PLAIN.values["rocker_a"], "rocker_a"
DEG = math.pi / 180.0
PLACES = {"x": KINDS["point", "x"], "y": KINDS["point", "y"]}


def point(name: str, axis: str) -> Channel:
    return Channel(f"{name}_{axis}", PLACES[axis], name, "m")


def bars(**lengths: float) -> Scene:
    links = dict(SCENE.links)
    for name, length in lengths.items():
        first, second = links[name].points
        links[name] = replace(links[name], points={first: (0.0, 0.0), second: (length, 0.0)})
    return replace(SCENE, links=links)


def noise(sheet: Sheet, seed: int = 1) -> Array:
    return np.random.default_rng(seed).normal(size=sheet.time_s.size)


@slow("half a second; lengths are told in test_told.py")
def test_no_length_is_told_that_would_move_a_channel_that_is_right() -> None:
    longer = solve(bars(coupler=0.2525), FOUR.time_s, bound=False)
    found = causes(FOUR.of(longer, ["rocker_a", "rocker_w"]).case)
    assert "length" not in {cause.name for cause in found}


@slow("a second; that a size is told where all lengths are, `test_faults.py` has")
def test_two_bars_of_other_lengths_are_not_a_scene_of_another_size() -> None:
    plain = of(point("B", "x"), point("B", "y"), point("C", "x"), angle("rocker"))
    both = plain.of(solve(bars(crank=0.11, coupler=0.24), plain.time_s, bound=False))
    assert "size" not in {cause.name for cause in causes(both.case)}


@slow("half a second: rare, channels within their limits in much noise")
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


def noisy(plain: Sheet, column: str, size: float) -> Sheet:
    return plain.put({column: size * noise(plain)})


def with_angle(values: Array, plain: Sheet = PLAIN) -> Sheet:
    return plain.put({COLUMN: values})


RATES = (omega("rocker"), angle("coupler"))
RATE = Channel("B_vy", KINDS["point", "vy"], "B", "m/s")  # which is 0 at the start
HIGHER = ANGLE.mean() + 1.2 * (ANGLE - ANGLE.mean())
BEND = 0.008 * np.ptp(ANGLE) * np.sin(20.0 * PLAIN.time_s + 1.0)
DELAYED = later(of(angle("rocker"), angle("coupler"), rows=2401), 0.2, COLUMN)
BUMP = 1.005e-3 * np.exp(-(((PLAIN.time_s - 0.5) / 0.05) ** 2))
SIDES = [later(of(*RATES), side, "rocker_w").values["rocker_w"] for side in (-0.25, 0.25)]
UNSURE = {
    c: v + 30.0 * FOUR.limits[c] * noise(FOUR, 3 + n)
    for n, (c, v) in enumerate(FOUR.values.items())
}
LIKE_ANOTHER = {
    "two faults in much noise", "a mean that lets nothing through", "nearly another unit",
    "a gain where all others have no cause", "what does not move, in nanoseconds",
}  # fmt: skip
"""Guards that need many hypotheses, up to half a second each, beside others of the same kind."""
NOT_TOLD = {
    "readings that are only brought nearer": noisy(of(*RATES), "rocker_w", 1e3),
    "a mean that lets nothing through": noisy(of(*RATES, rows=147, turns=20.0), "rocker_w", 1e-3),
    "what does not move, in nanoseconds": noisy(of(RATE, omega("crank")), "B_vy", 1e-4),
    "a gain of another shape": with_angle(HIGHER + BEND),
    "a delay that the last digit may have made": with_angle(
        np.round(DELAYED.values[COLUMN], 4), DELAYED
    ),
    "a spike that grows and falls": with_angle(ANGLE + BUMP),
    "a mean over less than a sample": replace(
        of(*RATES).put({"rocker_w": 0.5 * (SIDES[0] + SIDES[1])}), limits={"rocker_w": 1e-5}
    ),
    "a gain where all others have no cause": FOUR.put(UNSURE | {COLUMN: ANGLE * 1.01}),
    "two faults in little noise": with_angle(ANGLE + 0.05 * noise(THREE), THREE),
    "two faults in much noise": with_angle(ANGLE + 60.0 * noise(THREE), THREE),
    "nearly another unit": with_angle(
        ANGLE * (1.0 + 0.2 * np.sin(3.3 * PLAIN.time_s)) / DEG, THREE
    ),
}  # fmt: skip


@pytest.mark.parametrize(
    "case", few(NOT_TOLD, NOT_TOLD.keys() - LIKE_ANOTHER, "up to half a second: another is near it")
)
def test_what_is_no_cause_is_not_told(case: str) -> None:
    assert NOT_TOLD[case].case.out or case.startswith("a delay")
    assert not causes(NOT_TOLD[case].case)


SHORT = of(angle("rocker"), omega("rocker"), rows=60)
SHAKEN = SHORT.time_s + 0.3 * SHORT.step_s * np.random.default_rng(2).uniform(-1.0, 1.0, 60)
BACKWARDS = of(angle("rocker"), angle("crank"), omega("crank"))
SPEED = of(omega("crank", "rpm"), angle("rocker"))
CRANK = SPEED.values["crank_w"]
PIN = later(of(point("B", "x"), omega("crank"), omega("rocker")), -2.5, "B_x")
END = 1e-13 * (np.arange(PIN.time_s.size) < 2)
SHORTEST = ANGLE.astype(np.float16).astype(str).astype(float)
STEP = math.tau / 2**12
TOLD: Mapping[str, tuple[Sheet, str, tuple[str, ...]]] = {
    "a gain, where a bend is none": (with_angle(HIGHER), "scaled", (COLUMN,)),
    "a gain, where noise is none": (with_angle(ANGLE * 1.01, FOUR), "scaled", (COLUMN,)),
    "a delay that no digit has made": (DELAYED, "delay", (COLUMN,)),
    "half a turn, which is not folded": (with_angle(ANGLE + math.pi), "offset", (COLUMN,)),
    "points of the crank that are turned, or late": (
        later(of(point("B", "x"), point("B", "y"), angle("rocker")), 0.5, "B_x", "B_y"), "turned",
        ("B_x", "B_y"),
    ),
    "twelve bits, of which four decimals were written": (
        replace(with_angle(np.round(STEP * np.floor(ANGLE / STEP), 4)), limits={COLUMN: 1e-5}),
        "quantised", (COLUMN,),
    ),
    "half precision, in the shortest decimals that say it": (
        replace(with_angle(SHORTEST), limits={COLUMN: 1e-4}), "float16", (COLUMN,)
    ),
    "shaken times, whose line is not quite that of the samples": (
        replace(SHORT, time_s=SHAKEN, limits=dict.fromkeys(SHORT.limits, 1e-6)), "time stamps",
        ("rocker_a", "rocker_w"),
    ),
    "the other way, with a speed without sign": (
        at(BACKWARDS, -BACKWARDS.time_s, "rocker_a", "crank_a"), "reversed", ("rocker_a", "crank_a")
    ),
    "another unit of what stays": (SPEED.put({"crank_w": CRANK * math.tau / 60.0}), "unit",
                                   ("crank_w",)),
    "another zero of what stays": (SPEED.put({"crank_w": CRANK + 0.3}), "offset", ("crank_w",)),
    "a delay, but of no channel that would not show it": (
        PIN.put({"crank_w": PIN.values["crank_w"] + END}), "delay", ("B_x",)
    ),
}  # fmt: skip


@pytest.mark.parametrize("case", few(TOLD, list(TOLD)[::2], "up to 0.3 s: another is near it"))
def test_one_cause_is_told_where_another_is_near(case: str) -> None:
    planted, name, columns = TOLD[case]
    cause = only(planted)
    assert (cause.name, cause.columns) == (name, columns)


@pytest.mark.parametrize("share", [-0.45, 0.4])
def test_delays_of_up_to_half_a_turn_are_found(share: float) -> None:
    rate = Channel("rocker_w", KINDS["link", "angular acceleration"], "rocker", "rad/s^2")
    plain = of(rate, angle("coupler"))
    by_s = share * SCENE.driver.law.period_s
    late = at(plain, plain.time_s + by_s, "rocker_w")
    assert only(late).correction["delay_s"] == pytest.approx(by_s, rel=1e-6)


@slow("half a second: a drift over two hundred turns")
def test_a_drift_of_turns_is_followed_from_the_beginning() -> None:
    plain = of(angle("rocker"), angle("coupler"), rows=6001, turns=200.0)
    drifted = at(plain, 1.01 * plain.time_s)
    rng = np.random.default_rng(1)
    noisy = {c: v + 0.03 * rng.normal(size=v.size) for c, v in drifted.values.items()}
    cause = only(replace(drifted.put(noisy), limits=dict.fromkeys(plain.limits, 0.2)))
    assert cause.name == "drift"
    assert "(10.1 rad/s, not 10 rad/s)" in cause.text


@slow("0.7 s: two faults in different channels, as in test_told.py")
def test_a_channel_with_another_fault_does_not_bend_the_length_that_is_told() -> None:
    longer = FOUR.of(solve(bars(coupler=0.2525), FOUR.time_s, bound=False))
    wrong = longer.put({"rocker_w": 1.3 * longer.values["rocker_w"]})
    found = {cause.name: cause for cause in causes(wrong.case)}
    assert "length BC of coupler is 0.2525 m in the log" in found["length"].text
    assert found["length"].left < 1e-5
    assert "reads 1.3 times as much" in found["scaled"].text


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


def smoothed(values: Array, share: float) -> Array:
    after = values.copy()
    for row in range(1, values.size):
        after[row] = after[row - 1] + share * (values[row] - after[row - 1])
    return after


def test_a_mean_that_is_merely_like_what_there_is_is_not_told() -> None:
    late = later(PLAIN, -2.5)
    after = PLAIN.put({COLUMN: smoothed(late.values[COLUMN], 0.15)})
    assert "mean" not in {cause.name for cause in causes(after.case)}


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
QUICK = {"late, stuck"}


@pytest.mark.parametrize("name", few(TWO, QUICK, "other pairs; unit and delay are below"))
def test_both_are_told_of_their_channel(name: str) -> None:
    values, words = TWO[name]
    cause = only(THREE.put({COLUMN: values}))
    assert cause.columns == (COLUMN,)
    assert all(word in cause.text for word in words), cause.text
    assert "and beside that" in cause.text
    assert cause.left < 0.02


@slow("0.6 s: two faults are told above, corrections mend logs in test_told.py")
def test_what_is_to_be_written_in_the_map_is_told_of_both() -> None:
    cause = only(PLAIN.put({COLUMN: -LATE / DEG}))
    delay_s = pytest.approx(-2.5 * PLAIN.step_s, rel=1e-6)
    assert cause.correction == {"unit": "deg", "sign": -1, "delay_s": delay_s}


def test_a_channel_that_one_fault_explains_has_no_second() -> None:
    for values in (-ANGLE, LATE, spiked(ANGLE)):
        assert "beside" not in only(THREE.put({COLUMN: values})).text
