"""The channels of a log as they are drawn: in the user's units, beside the truth, worst first."""

from __future__ import annotations

import math

import numpy as np
import pytest

from models.files import load_scene
from reports.logs.map_file import ChannelTable, Map
from reports.page.extremes import extreme_rows
from reports.page.log_sections.curves import DrawnChannel, curves, turn_s
from tests.reports.page.judged_logs import TURN_S, angles, judged, motion_of, points

MOTION = motion_of()
TIME_S = MOTION.time_s
ROCKER = angles(MOTION)["rocker_deg"]
ROOM = 2_000_000


def only(columns: dict[str, object], **asked: object) -> DrawnChannel:
    (curve,) = curves(judged(TIME_S, columns, **asked), ROOM)  # type: ignore[arg-type]
    return curve


def test_a_channel_is_drawn_in_the_numbers_of_its_column() -> None:
    curve = only({"rocker_deg": ROCKER + 0.2})
    assert np.allclose(curve.whole.logged, ROCKER + 0.2)
    assert np.allclose(curve.whole.error, 0.2)
    assert curve.limit == pytest.approx(math.degrees(1e-3))
    assert (curve.unit, curve.turns, curve.turn, curve.near) == ("deg", 0, None, None)


def test_sign_and_offset_of_the_map_leave_the_column_as_it_is() -> None:
    odd = ChannelTable(column="s", of="rocker", kind="angle", unit="deg", sign=-1, offset=7.0)
    column = -(ROCKER + 0.2) - 7.0
    curve = only({"s": column}, mapped=Map(channel=[odd]))
    assert np.allclose(curve.whole.logged, column)
    assert np.allclose(curve.whole.error, -0.2)  # as seen in the column, which is turned about
    assert curve.limit == pytest.approx(math.degrees(1e-3))


def test_whole_turns_are_no_error_and_are_counted() -> None:
    curve = only({"rocker_deg": ROCKER - 720.0})
    assert np.allclose(curve.whole.error, 0.0, atol=1e-9)
    assert curve.turns == -2
    assert np.allclose(curve.whole.logged, ROCKER - 720.0)


def test_an_angle_that_is_wrapped_has_a_turn_in_its_unit() -> None:
    curve = only({"crank_deg": angles(MOTION)["crank_deg"] % 360.0})
    assert curve.turn == pytest.approx(360.0)
    assert np.allclose(curve.whole.error, 0.0, atol=1e-9)


def test_the_worst_channel_is_the_first_and_what_is_not_judged_the_last() -> None:
    columns = angles(MOTION, rocker=0.02, coupler=0.05) | {
        "coupler_rad_s": MOTION.links["coupler"].omega + 1.0
    }
    columns |= points(MOTION, "C")
    columns["C.y_mm"] = columns["C.y_mm"] + 0.01
    found = curves(judged(TIME_S, columns, drive="logged"), ROOM)
    names = [curve.column for curve in found]
    assert names[:4] == ["coupler_deg", "rocker_deg", "C.y_mm", "C.x_mm"]
    assert set(names[4:]) == {"crank_deg", "coupler_rad_s"}
    assert (found[-1].limit, found[-1].taken) == (None, -1.0)
    assert found[2].judged == found[3].judged  # both are of one place


def test_the_phase_is_the_angle_of_the_crank_within_a_turn() -> None:
    motion = motion_of(turns=2.0, samples=5)
    (curve,) = curves(judged(motion.time_s, {"rocker": motion.links["rocker"].theta}), ROOM)
    assert curve.whole.phase == pytest.approx([90.0, 270.0, 90.0, 270.0, 90.0], abs=1e-6)


def test_a_crank_that_is_back_at_zero_begins_anew() -> None:
    scene = load_scene("fourbar-double-crank")
    motion = motion_of(scene, turns=7.0, samples=8)
    (curve,) = curves(
        judged(motion.time_s, {"rocker_deg": angles(motion)["rocker_deg"]}, scene), ROOM
    )
    assert curve.whole.phase == pytest.approx(np.zeros(8), abs=1e-6)


def test_the_phase_of_a_crank_that_swings_is_the_part_of_its_period() -> None:
    scene = load_scene("fourbar-double-rocker")
    motion = motion_of(scene, turns=2.0, samples=9)
    one = judged(motion.time_s, {"rocker": motion.links["rocker"].theta}, scene)
    (curve,) = curves(one, ROOM)
    part = np.mod(curve.whole.phase + 1e-9, 100.0)
    assert part == pytest.approx([0, 25, 50, 75, 0, 25, 50, 75, 0], abs=1e-6)
    assert turn_s(one) == scene.driver.law.period_s


def test_a_turn_is_that_of_the_logged_crank_where_it_moves_the_truth() -> None:
    slow = motion_of(turns=1.0)
    one = judged(2.0 * slow.time_s, angles(slow), drive="logged")
    assert turn_s(one) == pytest.approx(2.0 * TURN_S)


def test_rates_are_drawn_at_their_own_times() -> None:
    late = MOTION.time_s + 1e-3
    omega = motion_of(samples=361).links["rocker"].omega
    columns = {"rocker_deg": ROCKER, "rocker_rad_s": omega, "velocity_time_s": late}
    found = curves(judged(TIME_S, columns), ROOM)
    assert {curve.column: float(curve.whole.time_s[0]) for curve in found} == {
        "rocker_deg": 0.0,
        "rocker_rad_s": 1e-3,
    }


def test_a_gap_is_drawn_from_zero_with_its_limit() -> None:
    own = points(MOTION, "C")
    copies = own | {f"rocker.{name}": column for name, column in own.items()}
    copies["rocker.C.x_mm"] = own["C.x_mm"] + 1.0
    gap = curves(judged(TIME_S, copies), ROOM)[0]
    assert (gap.column, gap.unit, gap.reading) == ("gap of C", "m", None)
    assert np.allclose(gap.whole.error, 1e-3)
    assert gap.limit == pytest.approx(0.25e-3)


def test_a_long_log_is_thinned_and_the_turn_of_its_spike_is_drawn_by_itself() -> None:
    motion = motion_of(turns=50.0, samples=50_001)
    off = np.zeros(50_001)
    off[31_234] = 0.5
    (curve,) = curves(judged(motion.time_s, angles(motion, rocker=off) | {}), 16_000 * 3)[:1]
    assert curve.whole.is_thinned
    assert curve.whole.error.size < 1_100
    assert curve.largest == pytest.approx(0.5)
    assert curve.near.error[curve.near.worst] == pytest.approx(0.5)
    span = curve.near.time_s[[0, -1]] - motion.time_s[31_234]
    assert span == pytest.approx([-TURN_S / 2, TURN_S / 2], rel=0.01)


def test_a_short_log_is_drawn_whole() -> None:
    series = np.sin(np.arange(100.0))
    assert extreme_rows((series, -series), 100).tolist() == list(range(100))


@pytest.mark.parametrize("number", [101, 1000, 99_991])
@pytest.mark.parametrize("row", [0, 1, 77, -1])
def test_a_spike_of_one_row_stays_in_either_series(number: int, row: int) -> None:
    for sign in (-1.0, 1.0):
        calm, spiked = np.sin(0.01 * np.arange(number)), np.zeros(number)
        spiked[row] = sign
        rows = extreme_rows((calm, spiked), 100)
        assert rows.size <= 110
        assert row % number in rows
        assert (rows[0], rows[-1]) == (0, number - 1)
        assert np.all(np.diff(rows) > 0)
        assert np.max(calm[rows]) == np.max(calm)
        assert np.min(calm[rows]) == np.min(calm)


def test_missing_samples_hide_no_spike_and_what_is_infinite_is_drawn() -> None:
    series = np.zeros(1000)
    series[100:300] = np.nan
    series[250], series[700] = 3.0, -np.inf
    rows = extreme_rows((series,), 50)
    assert {250, 700} <= set(rows.tolist())
