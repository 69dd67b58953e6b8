"""The page of a judged log as a file: whole, escaped, small enough, also for odd logs."""

import base64
import os
import re
import tomllib
from dataclasses import replace

import numpy as np
import pytest

from analytic.kinematics import solve
from models.files.reading import load_scene
from reports.causes.cause import Cause
from reports.logs.map_file import ChannelTable, Map
from reports.own_log.judged import JudgedLog
from reports.page.build import _plotly
from reports.page.log_curves import curves
from reports.page.log_motion import stretches
from reports.page.log_page import log_page, map_lines
from tests.reports.page.hostile import EVIL, Outline, embedded_in, stands_alone
from tests.reports.page.judged_logs import FACTS, SCENE, TURN_S, angles, judged, motion_of, points

MOTION = motion_of()
TIME_S = MOTION.time_s
SECTIONS = ["verdict", "channels", "motion", "made"]
ACTING = "\u202egnp\u2066 \x1b[2J \x9b31m \u2028 \x00"
NASTY = f"{EVIL} %{{x}} $x^2$ \u0645\u0631 {ACTING}"
MEGABYTES_3 = 3_000_000


ONE = {"rocker_deg": angles(MOTION)["rocker_deg"]}


def page(*asked: object, **more: object) -> str:
    return log_page(judged(*asked, **more), FACTS)


def words(text: str) -> str:
    """The page without its scripts, styles and tags, on one line."""
    bare = re.sub(r"<(script|style)\b.*?</\1>", "", text, flags=re.DOTALL)
    told = " ".join(re.sub(r"<[^>]*>", " ", bare).split())
    return re.sub(r" ([.,:;])", r"\1", told)


@pytest.fixture(scope="module")
def out() -> JudgedLog:
    """A log with a rocker that is off, of points and rates as well."""
    columns = angles(MOTION, rocker=0.5) | points(MOTION, "B", "C")
    columns["coupler_rpm"] = MOTION.links["coupler"].omega * 30.0 / np.pi
    columns["remark"] = np.zeros(TIME_S.size)
    return judged(TIME_S, columns)


@pytest.fixture(scope="module")
def text(out: JudgedLog) -> str:
    return log_page(out, FACTS)


def test_the_verdict_is_told_with_the_errors_in_the_units_of_the_columns(text: str) -> None:
    stands_alone(text, SECTIONS)
    told = words(text)
    assert "✗ OUT OF TOLERANCE: 1 of 6 errors over 361 samples of fourbar-lecture-1" in told
    assert "✗ OUT rocker_deg angle of rocker 0.5 deg 0.00873 rad 0.001 --target 873%" in told
    assert "angle of rocker (column rocker_deg) is off by +0.5 deg" in told
    assert "[[channel]] column = &#34;rocker_deg&#34; offset = -0.5" in told
    assert "remark: it names no link, point or slider of the scene" in told
    assert "Not judged, as the log has none: gap of A, D, B, C" in told


def test_a_column_leads_to_its_curve_and_columns_share_their_instants(text: str) -> None:
    carried = embedded_in(text, "channels")
    channels = carried["channels"]
    assert len(carried["axes"]) == 1
    links = [each for each in Outline(text).named("a") if "data-channel" in each]
    assert len(links) == len(channels) == 8
    (rocker,) = re.findall(r'data-channel="(\d+)"><bdi>rocker_deg<', text)
    assert channels[int(rocker)]["label"] == "rocker_deg"
    assert rocker == "0"  # the worst is the first


def test_a_log_within_tolerance_needs_no_why_and_a_fitted_drive_is_told_with_its_doubt() -> None:
    told = words(page(TIME_S, angles(MOTION, rocker=1e-4)))
    assert "✓ WITHIN TOLERANCE: 3 errors" in told
    assert "Why" not in told
    told = words(page(TIME_S * 1.01, angles(MOTION), drive="fitted"))
    assert "Drive fitted to 361 angles of the crank: speed 9.9009901 rad/s (within" in told


def test_what_to_write_in_the_map_is_told_by_column_and_is_toml() -> None:
    cause = Cause("sign", ("rocker_deg", f'"{ACTING}\U000e0001'), "turned about", {"sign": -1}, 0.0,
                  {"rocker_deg": {"delay_s": 1e-3, "unit": "rad"}})  # fmt: skip
    lines = map_lines(cause)
    assert lines.replace("\n", "").isprintable()
    assert tomllib.loads(lines)["channel"] == [
        {"column": "rocker_deg", "sign": -1, "delay_s": 1e-3, "unit": "rad"},
        {"column": f'"{ACTING}\U000e0001', "sign": -1},
    ]
    assert map_lines(replace(cause, correction={}, of_column={})) == ""


def test_causes_are_told_with_their_lines(out: JudgedLog) -> None:
    cause = Cause("zero", ("rocker_deg",), f"{NASTY} is 0.5 deg off", {"offset": -0.5}, 0.0)
    told = log_page(replace(out, causes=(cause,)), FACTS)
    assert "offset = -0.5" in told
    assert "Why" in words(told)
    assert "No cause that is known" not in words(told)
    assert [tag for tag, _ in Outline(told).elements].count("img") == 0


def test_what_is_drawn_of_a_partial_log_is_said_and_that_rates_alone_have_no_drawing() -> None:
    found = page(TIME_S, {"rocker_rad_s": MOTION.links["rocker"].omega})
    assert Outline(found).sections() == ["verdict", "channels", "made"]
    assert "no mechanism to be drawn" in words(found)
    told = words(page(TIME_S, ONE))
    assert "rocker: its angle, about D" in told
    assert "Left out, as the log does not say where they are: crank, coupler." in told


def test_text_of_the_file_stays_text_and_acts_on_nothing() -> None:
    hostile = ChannelTable(column=NASTY, of="rocker", kind="angle", unit="deg")
    columns = {NASTY: angles(MOTION, rocker=1.0)["rocker_deg"]}
    columns |= {f"{NASTY} 2": TIME_S, f"t {NASTY}": TIME_S, "crank_deg \u202e": TIME_S}
    calm = ChannelTable(column="calm", of="rocker", kind="angle", unit="deg")
    one = judged(TIME_S, columns, mapped=Map(channel=[hostile]), require=["coupler"])
    one = replace(one, log=replace(one.log, source=f"{NASTY}/{NASTY}", stamp=(NASTY, "s")),
                  notes=(NASTY,))  # fmt: skip
    found = log_page(one, {**FACTS, "numpy": NASTY})
    plain = judged(TIME_S, {"calm": columns[NASTY], "a": TIME_S, "b": TIME_S, "crank_deg": TIME_S},
                   mapped=Map(channel=[calm]), require=["coupler"])  # fmt: skip
    plain = replace(plain, notes=("calm",), log=replace(plain.log, stamp=("t", "s")))
    tags = [tag for tag, _ in Outline(found).elements]
    assert tags == [tag for tag, _ in Outline(log_page(plain, {**FACTS, "numpy": "1"})).elements]
    own = found.replace(_plotly(), "")
    assert not re.search("[\x00-\x08\x0e-\x1f\x7f-\x9f\u200e\u200f\u202a-\u202e\u2066-\u2069]", own)
    assert "\\u202e" in words(found)
    assert embedded_in(found, "channels")


def test_a_file_whose_name_is_no_text_has_a_page_and_a_long_name_is_cut() -> None:
    one = judged(TIME_S, {**ONE, "x" * 5000: TIME_S})
    one = replace(one, log=replace(one.log, source=os.fsdecode(b"\xff\xfe.csv")))
    text = log_page(one, FACTS)
    assert text.encode("utf-8")
    assert "x" * 100 not in text.replace(_plotly(), "")


def test_a_long_log_of_many_channels_stays_small_with_its_spike() -> None:
    scene = load_scene("sixbar-stephenson")
    motion = motion_of(scene, turns=40.0, samples=40_001)
    columns = angles(motion) | points(motion, "B", "C", "E", "F")
    columns |= {f"{n}_rad_s": each.omega for n, each in motion.links.items()}
    columns["lever_deg"] = columns["lever_deg"].copy()
    columns["lever_deg"][17_000] += 3.0
    found = page(motion.time_s, columns, scene)
    assert len(found.encode()) - len(_plotly().encode()) < MEGABYTES_3
    first = embedded_in(found, "channels")["channels"][0]
    assert first["label"] == "lever_deg"
    scale = first["whole"]["error"]["scales"][0]
    assert 32767 * scale == pytest.approx(3.0, rel=1e-3)
    assert "the smallest and the largest of each stretch" in " ".join(first["told"])


def test_times_far_from_zero_keep_their_digits() -> None:
    late = 12345.678 + TIME_S
    found = page(late, angles(solve(SCENE, late)))
    (axis,) = embedded_in(found, "channels")["axes"]
    after = np.frombuffer(base64.b64decode(axis["time"]["singles"]), "<f4").astype(float)
    assert np.allclose(float(axis["start"]) + after, late, rtol=0, atol=1e-6)
    (turn,) = embedded_in(found, "motion")["stretches"]
    ends = [float(turn[each]) for each in ("start", "end")]
    assert ends == pytest.approx(late[[0, -1]], rel=1e-12)


def test_of_many_turns_the_first_the_last_and_the_worst_are_drawn() -> None:
    motion = motion_of(turns=6.0, samples=601)
    for row, names in (
        (300, ["the turn of the largest error", "the first turn", "the last turn"]),
        (70, ["the turn of the largest error, the first turn", "the last turn"]),
    ):
        one = judged(motion.time_s, angles(motion, rocker=np.eye(601)[row]))
        found = stretches(one, curves(one, 100_000))
        assert [each.name for each in found] == names
    # 0.7 of a turn: its own turn begins at 0.2
    assert found[0].start_s == pytest.approx(0.2 * TURN_S)
    assert found[1].end_s == pytest.approx(motion.time_s[-1])


@pytest.mark.parametrize("drive", ["scene", "fitted", "logged"])
def test_every_drive_and_a_moved_guide_have_a_page(drive: str) -> None:
    scene = load_scene("shaper")
    motion = motion_of(scene)
    columns = angles(motion, rod=0.1)
    columns["B_slider_displacement_mm"] = 1e3 * motion.sliders["B"].displacement
    columns["F_slider_speed_m_s"] = motion.sliders["F"].speed
    found = page(motion.time_s, columns, scene, drive=drive)
    assert Outline(found).sections() == SECTIONS
