"""Columns become readings, by their names, as people write them, and by a map."""

from collections.abc import Callable, Mapping
from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from analytic.kinematics import solve
from models.errors import CrankcheckError
from models.files.reading import load_scene
from models.scene import Scene
from reports.compare.compare import Truth
from reports.describe.free_motion import motion_frame
from reports.logs.channel import OwnLog
from reports.logs.columns import columns_of, read_columns
from reports.logs.instants import time_of
from reports.logs.kinds import KINDS, Meaning
from reports.logs.map_file import FileTable, map_of, read_map
from reports.logs.meanings import columns_worth, map_text, understood
from reports.logs.names import SceneNames, is_named, meaning
from tests.worlds.headers import FOREIGN

SCENE = load_scene("fourbar-lecture-1")
TIME_S = np.linspace(0.0, 1.2, 400)
MOTION = solve(SCENE, TIME_S)
CRANK, COUPLER, ROCKER = (MOTION.links[name] for name in ("crank", "coupler", "rocker"))
CRANK_DEG = np.degrees(CRANK.theta)
TRUTH = Truth(SCENE)


def log_of(columns: Mapping[str, object], **told: object) -> OwnLog:
    return understood(columns_of(pd.DataFrame(columns)), SCENE, map_of(told, "the map"))


def worst(log: OwnLog) -> float:
    return max(float(np.max(np.abs(each.error(TRUTH)))) for each in log.readings)


def test_degrees_millimetres_milliseconds_and_angles_between_links_are_read() -> None:
    log = log_of({
        "t [ms]": 1e3 * TIME_S,
        "rocker_deg": np.degrees(ROCKER.theta),
        "C.x_mm": 1e3 * MOTION.points["C"].position[:, 0],
        "crank [rpm]": CRANK.omega * 60 / (2 * np.pi),
        "rocker_rel_coupler_rad": ROCKER.theta - COUPLER.theta,
    })  # fmt: skip
    columns = ["rocker_deg", "C.x_mm", "crank [rpm]", "rocker_rel_coupler_rad"]
    assert [each.channel.column for each in log.readings] == columns
    assert worst(log) < 1e-12


def test_a_lost_turn_is_an_error_and_no_wrapping_though_the_rest_is_within_one_turn() -> None:
    lost = CRANK.theta - 2 * np.pi * (TIME_S > 0.9)
    log = log_of({"t": TIME_S, "crank": lost})
    assert not log.readings[0].channel.wrapped
    assert worst(log) == pytest.approx(2 * np.pi)
    early = CRANK.theta - 2 * np.pi * (CRANK.theta > CRANK.theta[0] + 4.0)
    short = CRANK.theta < CRANK.theta[0] + 9.0
    assert np.ptp(early[short]) <= 2 * np.pi
    log = log_of({"t": TIME_S[short], "crank": early[short]})
    assert not log.readings[0].channel.wrapped


ANGLE = {"of": "rocker", "kind": "angle"}
LATE: dict[str, object] = {
    "time_s": TIME_S, "rocker_rad_s": solve(SCENE, TIME_S + 0.002).links["rocker"].omega,
}  # fmt: skip
READ: dict[str, tuple[dict[str, object], dict[str, object]]] = {
    "wrapped from -180": ({"t": TIME_S, "crank_deg": (CRANK_DEG + 180) % 360 - 180}, {}),
    "wrapped from 0": ({"t": TIME_S, "crank_deg": CRANK_DEG % 360}, {}),
    "what the name does not say": (
        {"t": TIME_S, "s3": -np.degrees(ROCKER.theta - COUPLER.theta) - 5.0},
        {"channel": [{"column": "s3", **ANGLE, "unit": "deg", "sign": -1, "offset": 5.0,
                      "relative_to": "coupler"}]},
    ),
    "a delay": (LATE, {"channel": [{"column": "rocker_rad_s", "delay_s": 0.002}]}),
    "a clock of its own": (
        {"clock_us": 1e6 * TIME_S, "rocker_rad_s": LATE["rocker_rad_s"],
         "time_imu [ms]": 1e3 * (TIME_S + 0.002)},
        {"time": {"column": "clock_us"},
         "channel": [{"column": "rocker_rad_s", "time": "time_imu [ms]"}]},
    ),
    "times of velocities": ({**LATE, "velocity_time_s": TIME_S + 0.002}, {}),
    "a clock of which the map says the unit": (
        {"time_ms [s]": TIME_S, "rocker": ROCKER.theta}, {"time": {"unit": "s"}},
    ),
    "a column called as times are": (
        {"clock": TIME_S, "t": ROCKER.theta},
        {"time": {"column": "clock"}, "channel": [{"column": "t", **ANGLE, "unit": "rad"}]},
    ),
}  # fmt: skip


@pytest.mark.parametrize("case", READ)
def test_what_names_do_not_say_is_seen_or_told_by_a_map(case: str) -> None:
    columns, told = READ[case]
    log = log_of(columns, **told)
    assert log.readings[0].channel.wrapped == case.startswith("wrapped")
    assert worst(log) < (1e-9 if columns.keys() & LATE.keys() - {"time_s"} else 1e-12)


def test_the_map_that_is_written_is_the_log_that_was_read(tmp_path: Path) -> None:
    columns = {
        "t [ms]": 1e3 * TIME_S,
        'odd "name" \\ of crank': CRANK.theta % (2 * np.pi),
        "rocker_rel_coupler_deg": np.degrees(ROCKER.theta - COUPLER.theta),
        "temperature": TIME_S,
    }
    told = {"of": "crank", "kind": "angle", "unit": "rad", "delay_s": 1e-4}
    log = log_of(columns, channel=[{"column": 'odd "name" \\ of crank', **told}])
    (tmp_path / "map.toml").write_text(map_text(log, FileTable()), encoding="utf-8")
    again = understood(columns_of(pd.DataFrame(columns)), SCENE, read_map(tmp_path / "map.toml"))
    assert [each.channel for each in again.readings] == [each.channel for each in log.readings]
    assert np.array_equal(again.time_s, log.time_s)


def test_times_may_count_from_the_first_row_and_a_hole_may_be_meant() -> None:
    columns = {"t": TIME_S + 1.7e9, "rocker": ROCKER.theta}
    assert worst(log_of(columns, time={"zero": "first"})) < 1e-5  # digits of such a clock
    time_s = np.delete(np.arange(401) / 400, 77)
    log = log_of({"t": time_s, "rocker": time_s, "junk": "x"}, file={"holes": "meant"},
                 channel=[{"column": "junk", "ignore": True}])  # fmt: skip
    assert log.time_s.size == 400
    assert log.unused == (("junk", "the map leaves it out"),)


COUNTS_NS = 1606383274123456789 + (np.arange(60) * 8726646).astype(np.int64)
"""Nanoseconds since 1970: a float has every 256th of them."""
CLOCKS: dict[str, tuple[str, Callable[[int], str], str]] = {
    "ns": ("ns", str, "."),
    "s": ("s", lambda ns: f"{ns // 10**9}.{ns % 10**9:09}", "."),
    "ms, with commas": ("ms", lambda ns: f"{ns // 10**6},{ns % 10**6:06}", ","),
    "s, words below": ("s", lambda ns: f"{ns // 10**9}.{ns % 10**9:09}", "."),
}


@pytest.mark.parametrize("case", [*CLOCKS, "frame", "unsigned", "cells", "parquet", "xlsx"])
def test_times_of_a_clock_are_subtracted_before_they_are_rounded(case: str, tmp_path: Path) -> None:
    unit, shown, decimal = CLOCKS.get(case, ("ns", str, "."))
    rates = {"rocker_rad_s": np.arange(60), "velocity_time_ns": COUNTS_NS + 7}
    if case in ("frame", "unsigned", "cells"):
        of = {"frame": "int64", "unsigned": "uint64", "cells": object}[case]
        columns = columns_of(pd.DataFrame({"clock": COUNTS_NS.astype(of), **rates}))
    else:
        path = tmp_path / f"log.{case if case in ('parquet', 'xlsx') else 'csv'}"
        frame = pd.DataFrame({"clock": [shown(int(ns)) for ns in COUNTS_NS], **rates})
        if case == "parquet":
            frame.assign(clock=COUNTS_NS).to_parquet(path)
        elif case == "xlsx":
            frame.astype(str).to_excel(path, index=False)
        else:
            note = {"crank_rad": ["1", *["-"] * 59]} if "words" in case else {}
            frame.assign(**note).to_csv(path, sep=";", index=False)
        columns = read_columns(path, FileTable(decimal=decimal))
    told = {
        "time": {"column": "clock", "unit": unit, "zero": "first"},
        "channel": [{"column": c, "ignore": True} for c in columns.raw if c == "crank_rad"],
    }
    log = understood(columns, SCENE, map_of(told, "the map"))
    after_s = (COUNTS_NS - COUNTS_NS[0]) * 1e-9
    assert np.allclose(log.time_s, after_s, rtol=1e-15, atol=0.0)
    assert np.allclose(log.readings[0].instants, after_s + 7e-9, rtol=1e-15, atol=0.0)
    assert log.zero_s == pytest.approx(1606383274.123456789, abs=1e-6)


HUGE = np.full(400, 1e300)
ALONE, VELOCITY, ACCELERATION = {"rocker": ROCKER.theta}, "velocity_time_s", "acceleration_time_s"
REFUSED: list[tuple[dict[str, object], dict[str, object], str]] = [
    ({"a": TIME_S}, {"column": "a"}, "add of, kind and unit"),
    ({"a": TIME_S}, {"column": "a", "of": "C", "kind": "angle"},
     "'angle' is not a kind of reading of point C; use x, y"),
    ({}, {"column": "t", **ANGLE}, r"'t': it is the column of times; describe it, .* in \[time\]"),
    ({"t": TIME_S + 1.7e9, "rocker": ROCKER.theta}, {},
     r"turns of crank after the start; .* zero = 'first'"),
    ({"time_ms [s]": TIME_S, "rocker": ROCKER.theta}, {}, "ms and s"),
    ({"rocker_deg": HUGE}, {}, r"row 0, column 'rocker_deg': found 1e\+300 deg; .* 1e\+07 turns"),
    ({"C.x_mm": HUGE * 1e-281}, {}, r"row 0, column 'C.x_mm': found 1e\+19 mm; .* 1e\+15 m"),
    ({"rocker [rev]": HUGE * 1e8}, {}, r"found 1e\+308 rev"),
    ({**ALONE, "C_x": np.where(np.arange(400) % 4, np.nan, 0.1)}, {},
     "column 'C_x': found nan .300 such cells.; if it has another rate or clock than the rest, "
     "write a file for each"),
    ({"t": np.repeat(TIME_S[::2], 2), **ALONE}, {}, "stands still.* of two rates, write a file"),
    ({**ALONE, "timestamp": TIME_S}, {}, r"or set time in the \[\[channel\]\] .* write a file for"),
    ({**ALONE, VELOCITY: TIME_S[::-1]}, {}, "row 1, .*velocity_time_s.: time goes back"),
    ({**ALONE, ACCELERATION: 0 * TIME_S}, {}, "row 1, .*acceleration_time_s.: time stands still"),
    ({**ALONE, VELOCITY: TIME_S * 1e30}, {}, "velocity_time_s.: t = .* turns of crank after"),
]  # fmt: skip


@pytest.mark.parametrize(("columns", "told", "words"), REFUSED)
def test_what_can_not_be_understood_or_is_beyond_all_sense_is_refused(
    columns: dict[str, object], told: dict[str, object], words: str
) -> None:
    with pytest.raises(CrankcheckError, match=words):
        log_of({"t": TIME_S, **columns}, channel=[told] if told else [])


FOURBAR = SceneNames(SCENE)
SLIDER_CRANK = SceneNames(load_scene("slider-crank-central"))


SAID: dict[tuple[str, str, str], list[str]] = {
    ("rocker", "angle", "rad"): [
        "rocker_theta_rad", "theta_rocker", "rocker", "theta(t) of rocker", "rocker-1@Assem1",
        ".MODEL_1.rocker.ANGLE", "rocker.rotation.z",
    ],
    ("rocker", "angle", "deg"): [
        "rocker_deg", "Rocker (°)", "RockerAngle(deg)", "rocker angle in degrees", "rocker/deg",
        "rocker angular displacement [deg]", "rockerdeg",
    ],
    ("rocker", "angular velocity", "rad/s"): [
        "rocker.omega_rad_s", "omega(rocker)", "rocker_rad_s", "rocker.angular_velocity.z",
        "rocker.angle.velocity.z", "rocker omega/rad/s",
    ],
    ("rocker", "angular velocity", "rpm"): [
        "Rocker Velocity [rpm]", "ROCKERRPM", "rocker (tr/min)", "rocker min^-1",
    ],
    ("rocker", "angle", "gon"): ["rocker (gon)"],
    ("C", "vx", "km/h"): ["C vx [km/h]"],
    ("C", "ax", "g"): ["C ax (g)"],
    ("C", "y", "um"): ["C.y [micron]"],
    ("C", "y", "dm"): ["C.y_dm"],
    ("rocker", "angular velocity", "deg/s"): ["rocker angular velocity (deg/s)"],
    ("rocker", "angular acceleration", "rad/s^2"): [
        "rocker_alpha_rad_s2", "rocker acceleration [rad/s²]", "theta_dd_rocker",
        "ddtheta_rocker",
    ],
    ("C", "x", "mm"): ["C.x_mm", "xC [mm]", "C_x_mm on coupler", "C.x(t) [mm]", "c_x_mm"],
    ("C", "y", "in"): ["C pos y [in]"],
    ("C", "vx", "m/s"): ["C.vx_m_s", "C_xd", "C.GetPosDt().x", "vx_c"],
    ("C", "vx", "mm/s"): ["C x velocity [mm/s]"],
    ("C", "ay", "m/s^2"): ["C_ay_m_s2"],
    ("crank", "angle", "deg"): ["driver_deg"],
    ("C", "x", "m"): ["Cx", "x_C(t)", "xc", "point_c.x", "/tf/C/translation/x"],
    ("C", "vy", "m/s"): ["vyC"],
    ("C", "v", "m/s"): ["C_v_m_s", "vC(t)", "VM(C)"],
}  # fmt: skip


OF_SLIDER = {
    "displacement": ["C_slider_displacement_m", "C_mm", "C.s", "C stroke [mm]"],
    "speed": ["C.speed_mm_s"],
    "acceleration": ["C_slider_acceleration_m_s2"],
    "x": ["C_x_m"],
}
"""Of a slider-crank whose slider and point have the same name."""
NAMES: list[tuple[str, SceneNames, dict[str, object]]] = [
    *((column, FOURBAR, {"of": of, "kind": KINDS["point" if of == "C" else "link", kind],
                         "unit": unit})
      for (of, kind, unit), columns in SAID.items() for column in columns),
    *((column, SLIDER_CRANK, {"kind": KINDS["point" if kind == "x" else "slider", kind]})
      for kind, columns in OF_SLIDER.items() for column in columns),
    ("rocker_rel_coupler_deg", FOURBAR, {"of": "rocker", "relative_to": "coupler"}),
    ("coupler.C.x_m", FOURBAR, {"of": "C", "on": "coupler"}),
    ("C_gap_mm", FOURBAR, {"of": "C", "gap": True, "unit": "mm"}),
]  # fmt: skip


@pytest.mark.parametrize(("column", "named", "said"), NAMES)
def test_a_name_tells_body_kind_unit_and_more(
    column: str, named: SceneNames, said: dict[str, object]
) -> None:
    found = meaning(column, named)
    assert isinstance(found, Meaning)
    assert {name: getattr(found, name) for name in said} == said


NOTHING = ["rocker.z", "rocker_displacement_mm", "temperature", "C_deg", "rocker_deg_filtered",
           "a", "coupler_rocker_deg"]  # fmt: skip


@pytest.mark.parametrize("column", NOTHING)
def test_nothing_is_made_of_what_a_name_does_not_say(column: str) -> None:
    assert isinstance(meaning(column, FOURBAR), str)


@pytest.mark.parametrize(
    ("column", "words"),
    [
        ("rocker_deg [rad]", "deg and rad"),
        ("rocker_omega_rad", "rad is a unit of angle"),
        ("C_gap_rad", "rad is a unit of angle"),
    ],
)
def test_units_that_contradict_are_refused(column: str, words: str) -> None:
    with pytest.raises(CrankcheckError, match=words):
        meaning(column, FOURBAR)


TIMES = {
    "s": ["time_s", "t", "Time (sec)", "simTime", "SimTime_s", "time in s", "t in s",
          "elapsed_time", "time/s"],
    "ms": ["time_ms", "t [ms]", "time in ms"],
}  # fmt: skip
LIKELY = {"s": ["tout", "Zeit", "sec", "Analysis Time", "Time_1", "X-Axis (s)", "header.stamp"],
          "ms": ["millis", "ms", "uptime_ms"], "us": ["micros"]}  # fmt: skip
"""Names of times where there is no better one."""


def test_a_column_of_times_has_its_unit_and_may_be_that_of_velocities() -> None:
    for unit, columns in TIMES.items():
        assert {time_of(column) for column in columns} == {("time", unit)}
        assert time_of(f"velocity_time_{unit}") == ("velocity time", unit)
    for unit, columns in LIKELY.items():
        assert {time_of(column) for column in columns} == {("likely time", unit)}
    assert log_of({"tout": 2.0 * TIME_S, "t": TIME_S, **ALONE}).stamp == ("t", "s")
    assert log_of({"tout": TIME_S, **ALONE}).stamp == ("tout", "s")


NAMED = ("C_x_i", "C x count", "current angle (deg)", "omega_i (rad/s)", "theta_t", "phi(t) [rad]",
         "b_x", "dx", "pc_x", "Cx1", "C1_x", "PointC.x", "rCspeed", "OC_x", "r_OC_x", "rocker1",
         "rockerw", "Body_rockerdegs", "myrocker.2", "xrockerangle", "T (N m)", "FB", "F_B(t)",
         "F12x", "Fx", "RAx", "load u (N)", "b_fx_n", "fx_a (N)", "newton-mm")  # fmt: skip
NOT_NAMED = (*FOREIGN, "i (A)", "iB", "T [C]", "dt", "mass (g)", "vec_x", "x temperature")


def test_no_column_that_names_a_body_a_quantity_or_a_force_is_passed_over() -> None:
    assert [name for name in NAMED if not is_named(name, FOURBAR)] == []
    assert [name for name in NOT_NAMED if is_named(name, FOURBAR)] == []
    assert isinstance(meaning("rocker angle (V)", FOURBAR), str)


def test_a_clock_that_a_channel_names_is_read_and_one_without_a_name_is_asked_about(
    tmp_path: Path,
) -> None:
    path, rocker = tmp_path / "log.csv", "rocker_rad"
    columns = {"time_s": TIME_S, rocker: ROCKER.theta, "t2_ms": 1e3 * TIME_S}
    pd.DataFrame(columns).to_csv(path, index=False)
    map_ = map_of({"channel": [{"column": rocker, "time": "t2_ms"}]}, "the map")
    assert worst(understood(columns_worth(path, SCENE, map_), SCENE, map_)) < 1e-9
    for name in ("frame", "pulse"):
        table = {name: TIME_S, "crank_rad": CRANK.theta, rocker: ROCKER.theta}
        pd.DataFrame(table).to_csv(path, index=False)
        read = columns_worth(path, SCENE, map_of({}, "the map"))
        if name == "frame":
            assert not understood(read, SCENE).timed
            continue
        with pytest.raises(CrankcheckError, match="'pulse' may be it; if not, set ignore = true"):
            understood(read, SCENE)


def of_links(names: tuple[str, ...]) -> Scene:
    """The lecture's four-bar with other names of crank, coupler and rocker."""
    told = dict(zip(("crank", "coupler", "rocker"), names, strict=True))
    links = {told[name]: replace(link, name=told[name]) for name, link in SCENE.links.items()}
    return replace(SCENE, links=links, driver=replace(SCENE.driver, link=told[SCENE.driver.link]))


@pytest.mark.parametrize(
    "names",
    [
        ("t", "time", "s"),
        ("Rocker", "rocker", "ROCKER"),
        ("gap", "deg", "rel"),
        ("velocity_time_s", "time_s", "theta"),
        ("A_x", "x", "A_x_m"),
    ],
)
def test_our_own_names_are_understood_whatever_bodies_are_called(names: tuple[str, ...]) -> None:
    scene = of_links(names)
    named = SceneNames(scene)
    motion = solve(scene, np.linspace(0.0, 0.1, 3))
    alone = replace(motion, links={}, points={}, sliders={}, bound=None)
    parts = [(body, replace(alone, links={body: one})) for body, one in motion.links.items()]
    parts += [(body, replace(alone, points={body: one})) for body, one in motion.points.items()]
    for body, part in parts:
        for column in (*motion_frame(part).columns[1:], f"{body}_gap_m"):
            _is_of(body, column, named)
            _is_of(body, f"{body}.{column[len(body) + 1 :]}", named)


def _is_of(body: str, column: str, named: SceneNames) -> None:
    """Fail where a column of ours is not understood to be of that body."""
    assert time_of(column) is None
    found = meaning(column, named)
    if not column.endswith("gap_m") or body in named.points:
        assert isinstance(found, Meaning)
        assert (found.of, found.gap) == (body, column.endswith("gap_m"))


def test_no_other_case_of_a_name_is_one_of_bodies_that_their_case_tells_apart() -> None:
    named = SceneNames(of_links(("Rocker", "rocker", "ROCKER")))
    assert isinstance(meaning("rOcKer_deg", named), str)
