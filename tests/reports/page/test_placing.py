"""What of a mechanism is drawn from a log that holds a part of it, and where."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import pytest

from models.array import Array
from models.files import load_scene
from reports.logs.map_file import ChannelTable, Map
from reports.own_log.judged import JudgedLog
from reports.page.log_sections.bodies import LoggedBodies, logged_bodies, truth_of_all
from reports.page.log_sections.placing import PlacedBodies
from tests.reports.page.judged_logs import angles, judged, motion_of, points

MOTION = motion_of()
TIME_S = MOTION.time_s
AT = TIME_S[::36]
SIX = load_scene("sixbar-stephenson")
TENTH = np.radians(0.1)


def drawn(one: JudgedLog) -> LoggedBodies:
    return logged_bodies(one, truth_of_all(one), AT)


def log_of(columns: Mapping[str, object]) -> LoggedBodies:
    return drawn(judged(TIME_S, columns))


def far(piece: PlacedBodies, point: str) -> Array:
    return np.linalg.norm(piece.off[point], axis=1)


def test_a_rocker_alone_is_drawn_about_its_pin_and_the_rest_left_out() -> None:
    found = log_of({"rocker_deg": angles(MOTION, rocker=0.1)["rocker_deg"]})
    (piece,) = found.pieces
    assert piece.links == ("rocker",)
    assert found.left_out == ["crank", "coupler"]
    assert found.origins == {"rocker": "its angle, about D"}
    assert far(piece, "C") == pytest.approx(0.2 * TENTH, rel=1e-3)


def test_a_link_that_is_turned_the_wrong_way_lies_where_its_angle_says() -> None:
    found = log_of({"rocker_deg": -angles(MOTION)["rocker_deg"]})
    there = MOTION.points["C"].position[::36] + found.pieces[0].off["C"]
    arm = there - MOTION.points["D"].position[::36]
    theta = -MOTION.links["rocker"].theta[::36]
    right = 0.2 * np.column_stack([np.cos(theta), np.sin(theta)])
    assert np.allclose(arm, right, atol=1e-12)


def test_angles_that_contradict_each_other_come_apart() -> None:
    found = log_of(angles(MOTION, coupler=0.1))
    joined, apart = found.pieces
    assert joined.links == ("crank", "coupler")
    assert (apart.links, apart.apart) == (("rocker",), True)
    assert np.allclose(far(joined, "B"), 0.0, atol=1e-12)
    assert far(joined, "C") == pytest.approx(0.25 * TENTH, rel=1e-3)
    assert np.allclose(far(apart, "C"), 0.0, atol=1e-12)
    assert found.left_out == []


def test_a_link_between_two_that_are_logged_lies_between_their_ends() -> None:
    every = angles(MOTION)
    found = log_of({name: every[name] for name in ("crank_deg", "rocker_deg")})
    (piece,) = found.pieces
    assert set(piece.links) == {"crank", "coupler", "rocker"}
    assert found.origins["coupler"] == "between B and C"


def test_an_angle_that_is_relative_to_another_has_that_ones_error_as_well() -> None:
    every = angles(MOTION, crank=0.1)
    columns = {"crank_deg": every["crank_deg"], "joint": every["coupler_deg"] - every["crank_deg"]}
    sensor = ChannelTable(
        column="joint", of="coupler", kind="angle", unit="deg", relative_to="crank"
    )
    found = drawn(judged(TIME_S, columns, mapped=Map(channel=[sensor])))
    assert np.allclose(found.turned["crank"], TENTH)
    assert np.allclose(found.turned["coupler"], 0.0, atol=1e-9)


def test_a_point_of_one_coordinate_stands_at_the_other_of_the_truth() -> None:
    column = points(MOTION, "C")["C.x_mm"] + 1.0
    (piece,) = log_of({"C.x_mm": column}).pieces
    assert piece.links == ("rocker",)  # from D, which stands still
    assert np.allclose(piece.off["C"], [1e-3, 0.0])
    found = log_of({"C.x_mm": column})
    assert found.origins["C"] == "x; the other is that of the truth"


def test_a_point_that_no_link_can_be_drawn_to_is_marked() -> None:
    motion = motion_of(SIX)
    found = drawn(judged(motion.time_s, points(motion, "E"), SIX))
    (piece,) = found.pieces
    assert (piece.links, piece.marks) == ((), ("E",))
    assert found.left_out == list(SIX.links)


def test_an_angle_out_of_tolerance_is_drawn_beside_points_that_are_right() -> None:
    columns = points(MOTION, "B", "C") | {"rocker_deg": angles(MOTION, rocker=2.0)["rocker_deg"]}
    joined, apart = log_of(columns).pieces
    assert set(joined.links) == {"crank", "coupler", "rocker"}
    assert apart.links == ("rocker",)
    assert far(apart, "C") == pytest.approx(0.2 * np.radians(2.0), rel=1e-3)
    columns["rocker_deg"] = angles(MOTION, rocker=0.01)["rocker_deg"]
    assert len(log_of(columns).pieces) == 1


def test_a_free_link_hangs_on_the_truth_and_says_so() -> None:
    found = log_of({"coupler_deg": angles(MOTION, coupler=0.1)["coupler_deg"]})
    (piece,) = found.pieces
    assert piece.apart
    assert found.origins["coupler"] == "its angle, about B of the truth"
    assert found.left_out == ["crank", "rocker"]


def test_a_slider_goes_along_its_guide_and_takes_its_rod_with_it() -> None:
    scene = load_scene("slider-crank-central")
    motion = motion_of(scene)
    columns = {
        "crank_deg": np.degrees(motion.links["crank"].theta),
        "C_slider_displacement_mm": 1e3 * motion.sliders["C"].displacement + 1.0,
    }
    (piece,) = drawn(judged(motion.time_s, columns, scene)).pieces
    assert set(piece.links) == {"crank", "rod"}
    assert piece.blocks == ("C",)
    assert np.allclose(piece.off["C"], [1e-3, 0.0])


def test_a_slider_on_a_lever_goes_along_the_lever() -> None:
    scene = load_scene("shaper")
    motion = motion_of(scene)
    columns = {"B_displacement_mm": 1e3 * motion.sliders["B"].displacement + 1.0}
    found = drawn(judged(motion.time_s, columns, scene))
    lever = motion.links["lever"].theta[::36]
    along = 1e-3 * np.column_stack([np.cos(lever), np.sin(lever)])
    assert np.allclose(found.pieces[0].off["B"], along, atol=1e-12)
    assert found.pieces[0].links == ("crank",)


def test_whole_turns_that_were_lost_on_the_way_turn_nothing_in_the_drawing() -> None:
    scene = load_scene("shaper")
    motion = motion_of(scene)
    column = np.degrees(motion.links["lever"].theta) + 360.0 * (motion.time_s > 0.3)
    one = judged(motion.time_s, {"lever_deg": column}, scene)
    last = motion.time_s[motion.time_s <= 0.3][-1]
    for time_s in (np.array([0.4, 0.5]), last + np.array([0.0, 1e-3])):  # after it, and across
        turned = logged_bodies(one, truth_of_all(one), time_s).turned["lever"]
        assert np.allclose(turned, 0.0, atol=1e-9)


def test_a_link_that_slides_is_drawn_along_with_its_point() -> None:
    scene = load_scene("scotch-yoke")
    motion = motion_of(scene)
    columns = {"Y_displacement_mm": 1e3 * motion.sliders["Y"].displacement + 1.0}
    found = drawn(judged(motion.time_s, columns, scene))
    (piece,) = found.pieces
    assert piece.links == ("yoke",)
    assert found.origins["yoke"] == "its guide, about Y"
    assert np.allclose(piece.off["T"], [1e-3, 0.0])


def test_a_plate_of_which_two_points_are_logged_takes_the_third_with_it() -> None:
    motion = motion_of(SIX)
    columns = points(motion, "B", "C")
    columns["C.x_mm"] = columns["C.x_mm"] + 1.0
    found = drawn(judged(motion.time_s, columns, SIX))
    (piece,) = found.pieces
    assert set(piece.links) == {"crank", "coupler", "rocker"}
    assert found.left_out == ["rod", "lever"]
    there = [motion.points[n].position[::36] + piece.off[n] for n in ("B", "E")]
    assert np.linalg.norm(there[1] - there[0], axis=1) == pytest.approx(np.hypot(0.12, 0.1))
    assert np.max(far(piece, "E")) > 1e-4


def test_beyond_the_instants_of_a_channel_nothing_is_drawn() -> None:
    late = ChannelTable(column="rocker", of="rocker", kind="angle", unit="deg", delay_s=0.1)
    columns = {"rocker": angles(MOTION)["rocker_deg"]}
    found = drawn(judged(TIME_S, columns, mapped=Map(channel=[late])))
    off = found.pieces[0].off["C"][:, 0]
    assert np.array_equal(np.isnan(off), AT < 0.1 - 1e-12)


def test_what_came_apart_altogether_is_cut_off() -> None:
    columns = {"C.x_m": np.full(TIME_S.size, 1e9), "C.y_m": np.zeros(TIME_S.size)}
    one = judged(TIME_S, columns)
    rows = drawn(one).embedded(AT.size)[0]["rows"]
    assert isinstance(rows, dict)
    assert np.max(rows["scales"]) * 32767 == pytest.approx(20.0 * one.scene.longest_m)
