"""What a page shows of a log: its channels in the user's units, beside the truth, worst first; and
what of the mechanism is drawn from a log that holds a part of it, and where."""

import math
from collections.abc import Mapping

import numpy as np
import pytest

from models.array import Array
from models.files.reading import load_scene
from models.motion import Motion
from models.scene import Scene
from reports.logs.map_file import ChannelTable, Map
from reports.page.log_curves import DrawnChannel, curves, extreme_rows, turn_s
from reports.page.log_motion import LoggedBodies, LogPlacement, logged_bodies, truth_of_all
from tests.reports.page.judged_logs import SCENE, TURN_S, angles, judged, motion_of, points

MOTION = motion_of()
TIME_S = MOTION.time_s
AT = TIME_S[::36]
EVERY = angles(MOTION)
ROCKER = EVERY["rocker_deg"]
ROOM = 2_000_000
SIX = load_scene("sixbar-stephenson")
TENTH = np.radians(0.1)


def only(columns: dict[str, object], motion: Motion = MOTION, *scene: Scene) -> DrawnChannel:
    (curve,) = curves(judged(motion.time_s, columns, *scene), ROOM)
    return curve


def mapped(**table: object) -> dict[str, Map]:
    return {"mapped": Map(channel=[ChannelTable(kind="angle", unit="deg", **table)])}


def test_a_channel_is_drawn_in_the_numbers_of_its_column() -> None:
    curve = only({"rocker_deg": ROCKER + 0.2})
    assert np.allclose(curve.whole.logged, ROCKER + 0.2)
    assert np.allclose(curve.whole.error, 0.2)
    assert (curve.unit, curve.turns, curve.turn, curve.near) == ("deg", 0, None, None)
    column = -(ROCKER + 0.2) - 7.0  # sign and offset of the map leave it as it is
    odd = mapped(column="s", of="rocker", sign=-1, offset=7.0)
    (curve,) = curves(judged(TIME_S, {"s": column}, **odd), ROOM)
    assert np.allclose(curve.whole.logged, column)
    assert np.allclose(curve.whole.error, -0.2)  # as seen in the column, which is turned about
    assert curve.limit == pytest.approx(math.degrees(1e-3))


def test_whole_turns_are_no_error_and_are_counted() -> None:
    curve = only({"rocker_deg": ROCKER - 720.0})
    assert np.allclose(curve.whole.error, 0.0, atol=1e-9)
    assert curve.turns == -2
    assert np.allclose(curve.whole.logged, ROCKER - 720.0)
    wrapped = only({"crank_deg": EVERY["crank_deg"] % 360.0})
    assert wrapped.turn == pytest.approx(360.0)
    assert np.allclose(wrapped.whole.error, 0.0, atol=1e-9)


def test_the_worst_channel_is_the_first_and_what_is_not_judged_the_last() -> None:
    columns = angles(MOTION, rocker=0.02, coupler=0.05) | points(MOTION, "C")
    columns["coupler_rad_s"] = MOTION.links["coupler"].omega + 1.0
    columns["C.y_mm"] = columns["C.y_mm"] + 0.01
    found = curves(judged(TIME_S, columns, drive="logged"), ROOM)
    names = [curve.column for curve in found]
    assert names[:4] == ["coupler_deg", "rocker_deg", "C.y_mm", "C.x_mm"]
    assert set(names[4:]) == {"crank_deg", "coupler_rad_s"}
    assert (found[-1].limit, found[-1].taken) == (None, -1.0)
    assert found[2].judged == found[3].judged  # both are of one place


@pytest.mark.parametrize(
    ("name", "turns", "phases"),
    [
        ("fourbar-lecture-1", 2.0, [90.0, 270.0, 90.0, 270.0, 90.0]),
        ("fourbar-double-crank", 7.0, [0.0] * 8),  # back at zero it begins anew
        ("fourbar-double-rocker", 2.0, [0, 25, 50, 75, 0, 25, 50, 75, 0]),
    ],
)
def test_the_phase_is_of_the_crank_or_period(name: str, turns: float, phases: list[float]) -> None:
    scene = load_scene(name)
    motion = motion_of(scene, turns, len(phases))
    phase = only({"rocker": motion.links["rocker"].theta}, motion, scene).whole.phase
    if name == "fourbar-double-rocker":
        phase = np.mod(phase + 1e-9, 100.0)
    assert phase == pytest.approx(phases, abs=1e-6)


def test_rates_are_drawn_at_their_own_times_and_a_gap_from_zero_with_its_limit() -> None:
    rates = {"rocker_rad_s": MOTION.links["rocker"].omega, "velocity_time_s": TIME_S + 1e-3}
    found = curves(judged(TIME_S, {"rocker_deg": ROCKER, **rates}), ROOM)
    starts = {curve.column: float(curve.whole.time_s[0]) for curve in found}
    assert starts == {"rocker_deg": 0.0, "rocker_rad_s": 1e-3}
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
    curve = curves(judged(motion.time_s, angles(motion, rocker=off)), 16_000 * 3)[0]
    assert curve.whole.is_thinned
    assert curve.whole.error.size < 1_100
    assert curve.largest == pytest.approx(0.5)
    assert curve.near.error[curve.near.worst] == pytest.approx(0.5)
    assert curve.near.is_thinned  # a turn has a thousand rows
    assert turn_s(judged(2.0 * TIME_S, EVERY, drive="logged")) == pytest.approx(2.0 * TURN_S)
    span = curve.near.time_s[[0, -1]] - motion.time_s[31_234]
    assert span == pytest.approx([-TURN_S / 2, TURN_S / 2], rel=0.01)


@pytest.mark.parametrize("number", [101, 99_991])
def test_a_spike_of_one_row_stays_in_either_series(number: int) -> None:
    for row, sign in ((0, 1.0), (1, -1.0), (77, 1.0), (-1, -1.0)):
        calm, spiked = np.sin(0.01 * np.arange(number)), np.zeros(number)
        spiked[row] = sign
        rows = extreme_rows((calm, spiked), 100)
        assert rows.size <= 110
        assert row % number in rows
        assert (rows[0], rows[-1]) == (0, number - 1)
        assert np.all(np.diff(rows) > 0)
        assert np.max(calm[rows]) == np.max(calm)
        assert np.min(calm[rows]) == np.min(calm)
    short = np.sin(np.arange(100.0))
    assert extreme_rows((short, -short), 100).tolist() == list(range(100))
    series = np.zeros(1000)
    series[100:300] = np.nan
    series[250], series[700] = 3.0, -np.inf
    assert {250, 700} <= set(extreme_rows((series,), 50).tolist())


def log_of(
    columns: Mapping[str, object], scene: Scene = SCENE, at: Array = AT, **asked: object
) -> LoggedBodies:
    time_s = motion_of(scene).time_s
    one = judged(time_s, columns, scene, **asked)
    return logged_bodies(one, truth_of_all(one), at if scene is SCENE else time_s[::36])


def far(piece: LogPlacement, point: str) -> Array:
    return np.linalg.norm(piece.off[point], axis=1)


WHOLE, TWO = ("crank", "coupler", "rocker"), np.radians(2.0)
BOTH_POINTS = points(MOTION, "B", "C")
PLACED = {
    "a rocker alone is drawn about its pin": (
        {"rocker_deg": ROCKER + 0.1}, [("rocker",)], ["crank", "coupler"],
        {"rocker": "its angle, about D"}, {(0, "C"): 0.2 * TENTH},
    ),
    "a free link hangs on the truth": (
        {"coupler_deg": EVERY["coupler_deg"] + 0.1}, [("coupler", "apart")], ["crank", "rocker"],
        {"coupler": "its angle, about B of the reference"}, {},
    ),
    "angles that contradict each other come apart": (
        angles(MOTION, coupler=0.1), [("crank", "coupler"), ("rocker", "apart")], [],
        {"rocker": "its angle, about D"}, {(0, "B"): 0.0, (0, "C"): 0.25 * TENTH, (1, "C"): 0.0},
    ),
    "a link between two that are logged lies between their ends": (
        {"crank_deg": EVERY["crank_deg"], "rocker_deg": ROCKER}, [WHOLE], [],
        {"coupler": "between B and C"}, {},
    ),
    "an angle out of tolerance is drawn beside points that are right": (
        BOTH_POINTS | {"rocker_deg": ROCKER + 2.0}, [WHOLE, ("rocker", "apart")], [],
        {}, {(1, "C"): 0.2 * TWO},
    ),
    "an angle within tolerance is not": (
        BOTH_POINTS | {"rocker_deg": ROCKER + 0.01}, [WHOLE], [], {}, {},
    ),
}  # fmt: skip
"""What is logged; the links of each piece that is drawn, and which are left out; where something
comes from, and how far points are off [m]."""


@pytest.mark.parametrize("case", PLACED)
def test_what_a_log_says_is_drawn_and_the_rest_left_out(case: str) -> None:
    columns, pieces, left_out, origins, off = PLACED[case]
    found = log_of(columns)
    named = [{*piece.links, *(["apart"] if piece.apart else [])} for piece in found.pieces]
    assert named == [set(each) for each in pieces]
    assert found.left_out == left_out
    assert origins.items() <= found.origins.items()
    for (number, point), distance in off.items():
        off_m = far(found.pieces[number], point)
        assert off_m == pytest.approx(np.full(AT.size, distance), rel=1e-3, abs=1e-12)


def test_an_angle_that_is_relative_to_another_has_that_ones_error_as_well() -> None:
    crank, coupler = (angles(MOTION, crank=0.1)[f"{name}_deg"] for name in ("crank", "coupler"))
    sensor = mapped(column="joint", of="coupler", relative_to="crank")
    found = log_of({"crank_deg": crank, "joint": coupler - crank}, **sensor)
    assert np.allclose(found.turned["crank"], TENTH)
    assert np.allclose(found.turned["coupler"], 0.0, atol=1e-9)


def test_a_point_of_one_coordinate_stands_at_the_other_of_the_truth() -> None:
    found = log_of({"C.x_mm": points(MOTION, "C")["C.x_mm"] + 1.0})
    (piece,) = found.pieces
    assert piece.links == ("rocker",)  # from D, which stands still
    assert np.allclose(piece.off["C"], [1e-3, 0.0])
    assert found.origins["C"] == "x; the other is the reference's"


def slid(name: str, point: str, *links: str) -> tuple[LoggedBodies, Motion]:
    """A log of a slider that is a millimetre ahead, and of some links."""
    scene = load_scene(name)
    motion = motion_of(scene)
    columns = {f"{link}_deg": angles(motion)[f"{link}_deg"] for link in links}
    columns[f"{point}_displacement_mm"] = 1e3 * motion.sliders[point].displacement + 1.0
    return log_of(columns, scene), motion


def test_a_slider_goes_along_its_guide_and_takes_its_links_with_it() -> None:
    (piece,) = slid("slider-crank-central", "C", "crank")[0].pieces
    assert set(piece.links) == {"crank", "rod"}
    assert piece.blocks == ("C",)
    assert np.allclose(piece.off["C"], [1e-3, 0.0])
    found, motion = slid("shaper", "B")  # along a lever that turns
    lever = motion.links["lever"].theta[::36]
    along = 1e-3 * np.column_stack([np.cos(lever), np.sin(lever)])
    assert np.allclose(found.pieces[0].off["B"], along, atol=1e-12)
    assert found.pieces[0].links == ("crank",)
    found, _ = slid("scotch-yoke", "Y")  # a link that slides
    (piece,) = found.pieces
    assert piece.links == ("yoke",)
    assert found.origins["yoke"] == "its guide, about Y"
    assert np.allclose(piece.off["T"], [1e-3, 0.0])


def test_whole_turns_that_were_lost_on_the_way_turn_nothing_in_the_drawing() -> None:
    scene = load_scene("shaper")
    motion = motion_of(scene)
    column = np.degrees(motion.links["lever"].theta) + 360.0 * (motion.time_s > 0.3)
    one = judged(motion.time_s, {"lever_deg": column}, scene)
    last = motion.time_s[motion.time_s <= 0.3][-1]
    for time_s in (np.array([0.4, 0.5]), last + np.array([0.0, 1e-3])):  # after it, and across
        turned = logged_bodies(one, truth_of_all(one), time_s).turned["lever"]
        assert np.allclose(turned, 0.0, atol=1e-9)


def test_a_plate_of_which_two_points_are_logged_takes_the_third_with_it() -> None:
    motion = motion_of(SIX)
    columns = points(motion, "B", "C")
    columns["C.x_mm"] = columns["C.x_mm"] + 1.0
    found = log_of(columns, SIX)
    (piece,) = found.pieces
    assert set(piece.links) == {"crank", "coupler", "rocker"}
    assert found.left_out == ["rod", "lever"]
    there = [motion.points[n].position[::36] + piece.off[n] for n in ("B", "E")]
    assert np.linalg.norm(there[1] - there[0], axis=1) == pytest.approx(np.hypot(0.12, 0.1))
    assert np.max(far(piece, "E")) > 1e-4


def test_nothing_is_drawn_beyond_the_instants_of_a_channel_and_what_came_apart_is_cut_off() -> None:
    late = mapped(column="rocker", of="rocker", delay_s=0.1)
    off = log_of({"rocker": ROCKER}, **late).pieces[0].off["C"][:, 0]
    assert np.array_equal(np.isnan(off), AT < 0.1 - 1e-12)
    found = log_of({"C.x_m": np.full(TIME_S.size, 1e9), "C.y_m": np.zeros(TIME_S.size)})
    scales = found.embedded(AT.size)[0]["rows"]["scales"]
    assert np.max(scales) * 32767 == pytest.approx(20.0 * SCENE.longest_m)
