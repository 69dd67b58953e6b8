"""The page of a judged log as a file, whole, escaped and small enough, also for odd logs; and in a
real browser, with the network off."""

import base64
import os
import re
import tomllib
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from playwright.sync_api import Page

from analytic.kinematics import solve
from models.files.reading import load_scene
from reports.causes.cause import Cause
from reports.judge.known import KnownFailure
from reports.logs.map_file import ChannelTable, Map
from reports.own_log.judged import JudgedLog
from reports.page.build import _plotly
from reports.page.log_curves import curves
from reports.page.log_motion import stretches
from reports.page.log_page import log_page, map_lines
from tests.reports.page.conftest import Write
from tests.reports.page.hostile import EVIL, Outline, embedded_in, stands_alone
from tests.reports.page.judged_logs import FACTS, SCENE, TURN_S, angles, judged, motion_of, points
from tests.reports.page.tab import Tab
from tests.worlds.tiers import few

MOTION = motion_of()
TIME_S = MOTION.time_s
SECTIONS = ["verdict", "channels", "motion", "made"]
ACTING = "\u202egnp\u2066 \x1b[2J \x9b31m \u2028 \x00"
ASIDE = "</script><i onload='hack()'>&amp;{{ 7 * 7 }}"
"""Names no body, nor a letter of one beside an axis."""
NASTY = f"{EVIL} %{{x}} $x^2$ \u0645\u0631 {ACTING}"


ONE = {"rocker_deg": angles(MOTION)["rocker_deg"]}


def page_of(*asked: object, **more: object) -> str:
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
    assert "✗ OUT rocker_deg angle of rocker 0.5 deg 0.00873 rad 0.001 --target 8.7" in told
    assert "angle of rocker (column rocker_deg) is off by +0.5 deg" in told
    assert "No known cause" not in told
    assert "[[channel]] column = &#34;rocker_deg&#34; offset = -0.5" in told
    assert "remark: it names no link, point or slider of the scene" in told
    assert "Not judged: gap of A, D, B, C" in told


def test_a_known_failure_is_told_with_its_reason(out: JudgedLog) -> None:
    known = KnownFailure(scene=SCENE.name, engine="log", reason="as agreed", rules=out.sizes)
    told = words(log_page(replace(out, known=known), FACTS))
    assert "KNOWN FAILURE: 1 of 6 errors" in told
    assert "known: as agreed" in told


def test_a_log_within_tolerance_needs_no_why_and_a_fitted_drive_is_told_with_its_doubt() -> None:
    told = words(page_of(TIME_S, angles(MOTION, rocker=1e-4)))
    assert "✓ WITHIN TOLERANCE: 3 errors" in told
    assert "Why" not in told
    told = words(page_of(TIME_S * 1.01, angles(MOTION), drive="fitted"))
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


def test_what_is_drawn_of_a_partial_log_is_said_and_that_rates_alone_have_no_drawing() -> None:
    found = page_of(TIME_S, {"rocker_rad_s": MOTION.links["rocker"].omega})
    assert Outline(found).sections() == ["verdict", "channels", "made"]
    assert "no mechanism to be drawn" in words(found)
    told = words(page_of(TIME_S, ONE))
    assert "rocker: its angle, about D" in told
    assert "Left out, as the log does not give their places: crank, coupler." in told


def test_text_of_the_file_stays_text_and_acts_on_nothing() -> None:
    hostile = ChannelTable(column=NASTY, of="rocker", kind="angle", unit="deg")
    columns = {NASTY: angles(MOTION, rocker=1.0)["rocker_deg"]}
    columns |= {ASIDE: TIME_S, "x" * 5000: TIME_S, "crank_deg \u202e": TIME_S}
    calm = ChannelTable(column="calm", of="rocker", kind="angle", unit="deg")
    one = judged(TIME_S, columns, mapped=Map(channel=[hostile]), require=["coupler"])
    no_text = os.fsdecode(b"\xff\xfe.csv")
    log = replace(one.log, source=f"{NASTY}/{NASTY}{no_text}", stamp=(NASTY, "s"))
    cause = Cause("zero", (NASTY,), f"{NASTY} is 0.5 deg off", {"offset": -0.5}, 0.0)
    one = replace(one, log=log, notes=(NASTY,), causes=(cause,))
    found = log_page(one, {**FACTS, "numpy": NASTY})
    plain = judged(TIME_S, {"calm": columns[NASTY], "a": TIME_S, "b": TIME_S, "crank_deg": TIME_S},
                   mapped=Map(channel=[calm]), require=["coupler"])  # fmt: skip
    cause = replace(cause, columns=("calm",), text="calm is 0.5 deg off")
    log = replace(plain.log, stamp=("t", "s"))
    plain = replace(plain, notes=("calm",), log=log, causes=(cause,))
    tags = [tag for tag, _ in Outline(found).elements]
    assert tags == [tag for tag, _ in Outline(log_page(plain, {**FACTS, "numpy": "1"})).elements]
    own = found.replace(_plotly(), "")
    assert "x" * 100 not in own
    assert not re.search("[\x00-\x08\x0e-\x1f\x7f-\x9f\u200e\u200f\u202a-\u202e\u2066-\u2069]", own)
    assert "\\u202e" in words(found)
    assert "offset = -0.5" in found
    assert "Why" in words(found)
    assert found.encode("utf-8")
    assert embedded_in(found, "channels")


def test_times_far_from_zero_keep_their_digits() -> None:
    late = 12345.678 + TIME_S
    found = page_of(late, angles(solve(SCENE, late)))
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


@pytest.mark.parametrize(
    "drive", few(["scene", "fitted", "logged"], ["fitted"], "the same sections")
)
def test_every_drive_and_a_moved_guide_have_a_page(drive: str) -> None:
    scene = load_scene("shaper")
    motion = motion_of(scene)
    columns = angles(motion, rod=0.1)
    columns["B_slider_displacement_mm"] = 1e3 * motion.sliders["B"].displacement
    columns["F_slider_speed_m_s"] = motion.sliders["F"].speed
    found = page_of(motion.time_s, columns, scene, drive=drive)
    assert Outline(found).sections() == SECTIONS


DRAWN = ("channels", "motion")
TWO_TURNS = motion_of(turns=2.0, samples=721)
TWO_S = TWO_TURNS.time_s
TRACE = """([name, axis]) => {
  const found = document.getElementById('channels-chart').data
    .find(each => each.name === name && (each.yaxis ?? 'y') === axis);
  return {x: [...found.x], y: [...found.y], visible: found.visible !== false, mode: found.mode};
}"""
LAYOUT = """() => {
  const {xaxis, yaxis, yaxis2, annotations} = document.getElementById('channels-chart').layout;
  return {x: xaxis.title.text, y: yaxis.title.text, error: yaxis2.title.text, kind: yaxis2.type,
    largest: annotations[0]?.text};
}"""


def trace(page: Page, name: str, axis: str = "y") -> dict[str, list[float]]:
    return page.evaluate(TRACE, [name, axis])


def channel(page: Page, column: str) -> None:
    options = page.locator("#channels-channel option", has_text=column)
    page.select_option("#channels-channel", options.first.get_attribute("value"))


@pytest.fixture(scope="module")
def log(written: Write) -> Path:
    """A rocker that is 2 degrees off, a crank that is wrapped, points that are right."""
    columns = angles(TWO_TURNS, rocker=2.0) | points(TWO_TURNS, "B", "C")
    columns["crank_deg"] = columns["crank_deg"] % 360.0
    columns["coupler_deg"] = columns["coupler_deg"] + 1e-4 * np.sin(TWO_S)
    columns["other"] = TWO_S
    return written(page_of(TWO_S, columns))


@pytest.fixture(scope="module")
def hostile(written: Write) -> Path:
    table = ChannelTable(column=NASTY, of="coupler", kind="angle", unit="deg")
    columns = {NASTY: angles(TWO_TURNS, coupler=1.0)["coupler_deg"]}
    columns |= {ASIDE: TWO_S, "x" * 5000: TWO_S}
    return written(page_of(TWO_S, columns, mapped=Map(channel=[table])))


@pytest.fixture
def opened(wide: Tab, log: Path) -> Tab:
    return wide.visit(log, *DRAWN)


def test_the_error_is_on_the_scale_that_shows_it_until_one_is_chosen(wide: Tab, log: Path) -> None:
    page = wide.open(log, *DRAWN).page  # nothing has been chosen
    assert page.evaluate(LAYOUT)["kind"] != "log"  # 2 deg with a limit of 0.06
    channel(page, "coupler_deg")
    assert page.evaluate(LAYOUT)["kind"] == "log"  # 1e-4 deg
    page.select_option("#channels-scale", "linear")
    channel(page, "C.x_mm")
    assert page.evaluate(LAYOUT)["kind"] != "log"


def test_a_whole_visit_has_no_error_and_no_request_and_every_control_a_name(opened: Tab) -> None:
    opened.no_error_and_no_request("#motion-visible")
    opened.every_control_has_a_name()


def test_the_worst_channel_is_shown_until_another_one_is_chosen(opened: Tab, page: Page) -> None:
    rocker = np.degrees(TWO_TURNS.links["rocker"].theta)
    assert "rocker_deg" in page.evaluate(LAYOUT)["y"]
    assert np.allclose(trace(page, "logged")["y"], rocker + 2.0, atol=1e-4)
    assert np.allclose(trace(page, "truth")["y"], rocker, atol=1e-3)
    assert np.allclose(trace(page, "logged", "y2")["y"], 2.0, atol=1e-3)
    assert trace(page, "limit", "y2")["y"] == pytest.approx([np.degrees(1e-3)] * 2)
    assert page.evaluate(LAYOUT)["largest"] == "largest 2"
    assert "Its largest error is 2 deg" in opened.text("#channels-told")
    page.locator("#verdict a", has_text="coupler_deg").click()
    assert page.evaluate(LAYOUT)["y"] == "coupler_deg [deg]"
    assert page.evaluate("() => document.activeElement.id") == "channels-channel"
    page.locator("#channels-legend [data-item='truth']").uncheck()
    assert not trace(page, "truth")["visible"]
    assert trace(page, "logged")["visible"]


def test_the_line_is_broken_at_the_seam_of_a_wrapped_angle_and_between_turns(page: Page) -> None:
    channel(page, "crank_deg")
    places = trace(page, "logged")
    assert len(places["y"]) == TWO_S.size + 2  # two turns from 90 degrees on
    assert [places[axis].count(None) for axis in "xy"] == [2, 2]
    channel(page, "rocker_deg")
    page.select_option("#channels-against", "phase")
    found = trace(page, "logged")["x"]
    known = [x for x in found if x is not None]
    assert 0.0 <= min(known) < 1.5
    assert 358.5 < max(known) <= 360.0
    assert found.count(None) == 2
    assert page.evaluate(LAYOUT)["x"] == "angle of crank [deg]"


def test_hostile_text_does_nothing_nor_runs_out_of_a_phone(phone: Tab, hostile: Path) -> None:
    phone.visit(hostile, *DRAWN).nothing_runs_out()
    page = phone.visit(hostile, *DRAWN).page
    assert page.locator("#motion-picture .reference .link").count() == 3
    assert page.locator("#motion-picture .run .link").count() == 1  # a coupler is all of the log
    page.evaluate("() => Plotly.Fx.hover('channels-chart', [{curveNumber: 1, pointNumber: 1}])")
    phone.hostile_text_does_nothing("#channels-told")
    assert "\u202e" not in phone.text("body")
    assert "\\u202e" in phone.text("#verdict")
