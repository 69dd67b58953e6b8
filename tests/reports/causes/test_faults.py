"""Every fault is named with its channels, and nothing else is; healthy logs have no cause, nor have
logs of which nothing can be said, of other mechanisms, of parts of what may be logged, or sampled
otherwise. A cause with the name of another fault is true as well where it leaves no more than the
noise of the log: a line through the crank's pin that is turned, and a lever whose zero is, are
one."""

from collections import Counter
from itertools import cycle, product

import numpy as np
import pytest

import crankcheck
from analytic.kinematics import solve, solve_driven
from models.files.reading import load_scene
from reports.causes.cause import Cause
from reports.causes.find import causes
from tests.reports.causes.infected_sheets import CLEAR, FAULTS, SCENES, diagnosed, infected
from tests.worlds import other_kinds
from tests.worlds.other_kinds import KINDS, PARTS, SAMPLING
from tests.worlds.plantings import PLANTINGS
from tests.worlds.sheets import Sheet
from tests.worlds.tiers import few, slow, slowly

NONE = [name for name, each in PLANTINGS.items() if not each.names]
MANY = 4
"""Plantings of each fault in each scene."""
MISSED = 0.02
"""The part of them that chance may make two faults of: a mean and a delay in noise, say."""


IN_TOLD = {"drift", "start", "offset", "time unit", "length", "turned", "scaled"}
"""Causes that `test_told.py` has with their numbers."""
OF_EACH = {PLANTINGS[fault].names: fault for fault in reversed(FAULTS)}
"""The first fault of each cause."""
DEAR = {"two_swapped": "rate_and_place_swapped", "rounded_times": "shaken_times"}
"""A second; the other one is of the same cause."""
QUICK = [DEAR.get(fault, fault) for names, fault in OF_EACH.items() if not {*names} <= IN_TOLD]


@pytest.mark.parametrize(
    "fault", few(FAULTS, QUICK, "another fault of its cause is planted, or its numbers are told")
)
def test_a_fault_is_named_with_its_channels(fault: str) -> None:
    planted, columns, found = diagnosed(fault)
    out = {reading.channel.column for reading in planted.case.out}
    assert {cause.name for cause in found} <= set(PLANTINGS[fault].names)
    told = {column for cause in found for column in cause.columns}
    assert out <= told
    assert told <= (set(columns) or set(planted.channels))
    for cause in found:
        assert "{" not in cause.text
        assert 0.0 <= cause.left <= 0.4


@pytest.mark.parametrize(
    ("fault", "scene"),
    [
        slowly(*case, reason="as another one") if number else case
        for number, case in enumerate(zip(NONE, cycle(SCENES), strict=False))
    ],
)
def test_nothing_is_made_up(fault: str, scene: str) -> None:
    planted, _ = infected(fault, scene, rows=300, most=5)
    assert not causes(planted.case)


@slow("only here are sizes of faults, lengths of logs, limits and noise at random")
@pytest.mark.parametrize("scene", SCENES)
def test_the_names_of_faults_at_random_are_not_mistaken(scene: str) -> None:
    right: Counter[bool] = Counter()
    for fault, planting in PLANTINGS.items():
        for seed in range(MANY):
            rng = np.random.default_rng([seed, *fault.encode()])
            options = {
                "rows": int(rng.choice([200, 600, 2500])),
                "turns": float(rng.choice([1.5, 2.5, 12.0])),
                "limit": float(10.0 ** rng.uniform(-4.0, -2.5)),
                "noise": float(rng.choice([0.0, 0.05, 0.5])),
            }
            try:
                planted, _ = infected(fault, scene, seed + 1, **options)
            except LookupError:  # few angles to swap, or too small a fault beside the limits
                continue
            case, found = planted.case, causes(planted.case)
            told = {column: cause.name for cause in found for column in cause.columns}
            shares = {c: each.worst / each.limit for c, each in case.excerpts.items()}
            clear = [column for column, share in shares.items() if share > CLEAR]
            if planting.names:
                right[all(told.get(column) in planting.names for column in clear)] += 1
            else:
                assert not found
    assert sum(right.values()) > 140
    assert right[False] <= MISSED * right[True]


TEN = ("two_swapped", "another_unit", "another_sign", "one_late", "slow_clock", "another_assembly",
       "another_length", "stuck_sample", "lost_turn", "low_passed")  # fmt: skip
NOISE = 0.2
"""What a cause may leave, over the limit, to be as good as the fault that was planted."""
LIMIT = 1e-3
ALSO = {"low_passed": ("smoothed",)}
"""What a fault may be called as well."""
TURN_ABOUT = list(zip(product(KINDS, ("healthy", *TEN)), cycle(PARTS), strict=False))
"""Each fault in each kind, of the parts in turn; of these a fifth: each in one kind or two."""


def false(planted: Sheet, fault: str) -> list[str]:
    """The causes that are told of a log, and are not so."""

    def as_good(cause: Cause) -> bool:
        of_cause = [planted.case.excerpts[column] for column in cause.columns]
        return all(cause.left * np.max(np.abs(e.error)) <= NOISE * e.limit for e in of_cause)

    names = (*PLANTINGS[fault].names, *ALSO.get(fault, ()))
    found = causes(planted.case)
    return [each.text for each in found if each.name not in names and not as_good(each)]


@pytest.mark.parametrize("at", few(TURN_ABOUT, TURN_ABOUT[::14], "the same fault in other kinds"))
def test_nothing_false_is_told(at: tuple[tuple[str, str], str]) -> None:
    (kind, fault), part = at
    planted = other_kinds.infected(kind, fault, part, "plain", LIMIT)
    if planted is None:
        return  # no turn to be lost in a log of lengths, say
    assert not false(planted, fault)
    assert fault != "healthy" or not planted.case.out


@slow("only here is each fault planted at coarse and at few samples")
@pytest.mark.parametrize("sampling", [name for name in SAMPLING if name != "plain"])
@pytest.mark.parametrize("kind", KINDS)
def test_nor_with_other_samples_and_other_limits(kind: str, sampling: str) -> None:
    told, limits = [], cycle((1e-4, 1e-2))
    faults = ("healthy", "noise", "wandering", *TEN)
    each = product(faults, ("all", "without the crank"))
    for (fault, part), limit in zip(each, limits, strict=False):
        planted = other_kinds.infected(kind, fault, part, sampling, limit)
        if planted is not None:
            told += [f"{fault}, {part}, {limit}: {one}" for one in false(planted, fault)]
    assert not told


TIME_S = np.linspace(0.0, 0.6, 301)
FOURBAR = "fourbar-lecture-1"
ROCKER = solve(load_scene(FOURBAR), TIME_S).links["rocker"].theta


def judged(column: str, values: object, scene: str = FOURBAR) -> crankcheck.LogVerdict:
    return crankcheck.judge(scene, {"time_s": TIME_S[: len(values)], column: values}, target=1e-3)  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("scene", "column"),
    [
        (FOURBAR, "crank_deg"),
        ("tangent", "sleeve_slider_speed_m_s"),
        ("slotted-lever", "lever_alpha_rad_s2"),
    ],
)
@pytest.mark.parametrize("value", [slowly(0.0, reason="as without power; its mean is 0"), 37.3])
def test_a_sensor_that_stands_still_is_said_to_stand(scene: str, column: str, value: float) -> None:
    one = judged(column, np.full(TIME_S.size, value), scene)
    assert one.verdict == "out"
    assert [cause.name for cause in one.causes] == ["stuck"]


NOTHING = {
    "three rows": ("rocker_deg", np.random.default_rng(3).normal(size=3)),
    "a gap": ("C_gap_mm", np.full(TIME_S.size, 5.0)),
    "noise": ("rocker_rad", ROCKER + 0.01 * np.random.default_rng(1).normal(size=TIME_S.size)),
}


@pytest.mark.parametrize("case", NOTHING)
def test_of_a_gap_of_a_few_rows_and_of_noise_nothing_is_said(case: str) -> None:
    one = judged(*NOTHING[case])
    assert (one.verdict, one.causes) == ("out", ())


def test_another_start_and_another_speed_are_both_told() -> None:
    crank = 10.05 * TIME_S + 0.3
    rocker = solve_driven(load_scene(FOURBAR), crank, 10.05, 0.0).links["rocker"].theta
    log = {"time_s": TIME_S, "crank_rad": crank, "rocker_rad": rocker}
    (cause,) = crankcheck.judge(FOURBAR, log, target=1e-3).causes
    assert "10.05 rad/s, not 10 rad/s" in cause.text
    assert cause.left < 1e-6


@pytest.mark.parametrize(("shift", "ends"), [(12, "held"), (-12, "from the other end")])
def test_a_delay_is_one_whatever_stands_where_it_had_no_readings(shift: int, ends: str) -> None:
    places = np.arange(TIME_S.size) - shift
    late = ROCKER[np.clip(places, 0, TIME_S.size - 1) if ends == "held" else places % TIME_S.size]
    (cause,) = judged("rocker_rad", late).causes
    assert cause.name == "delay"
    assert "12.00 samples" in cause.text or " 12.0 samples" in cause.text
    assert ("earlier" if shift > 0 else "later") in cause.text
