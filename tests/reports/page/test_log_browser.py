"""The page of a judged log in a real browser, from a file, with the network off."""

from pathlib import Path

import numpy as np
import pytest
from playwright.sync_api import Page

from analytic.kinematics import solve
from reports.logs.map_file import ChannelTable, Map
from tests.reports.page.conftest import Write
from tests.reports.page.judged_logs import SCENE, TURN_S, angles, motion_of, points
from tests.reports.page.tab import Tab
from tests.reports.page.test_browser import corners
from tests.reports.page.test_log_page import NASTY
from tests.reports.page.test_log_page import page as log_page_of
from tests.worlds.tiers import slow

DRAWN = ("channels", "motion")
MOTION = motion_of(turns=2.0, samples=721)
TIME_S = MOTION.time_s
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
    columns = angles(MOTION, rocker=2.0) | points(MOTION, "B", "C")
    columns["crank_deg"] = columns["crank_deg"] % 360.0
    columns["coupler_deg"] = columns["coupler_deg"] + 1e-4 * np.sin(TIME_S)
    columns["other"] = TIME_S
    return written(log_page_of(TIME_S, columns))


@pytest.fixture(scope="module")
def hostile(written: Write) -> Path:
    table = ChannelTable(column=NASTY, of="coupler", kind="angle", unit="deg")
    columns = {NASTY: angles(MOTION, coupler=1.0)["coupler_deg"]}
    columns |= {f"{NASTY} 2": TIME_S, "x" * 5000: TIME_S}
    return written(log_page_of(TIME_S, columns, mapped=Map(channel=[table])))


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


def test_errors_are_magnified_at_once_and_the_mechanism_moves(opened: Tab, page: Page) -> None:
    """Through the last turn, to its end."""
    assert page.input_value("#motion-factor") == "10"
    names = page.locator("#motion-stretch option").all_inner_texts()
    assert ["the last turn" in name for name in names] == [False, True]
    page.select_option("#motion-stretch", "1")
    page.locator("#motion-slider").focus()
    page.keyboard.press("Home")
    first = opened.text("#motion-time")
    page.keyboard.press("End")
    last = opened.text("#motion-time")
    assert float(last.split()[2]) == pytest.approx(2.0 * TURN_S, rel=1e-4)
    opened.elapse(0)
    page.locator("#motion-play").click()
    opened.elapse(100)
    assert opened.text("#motion-time") not in (first, last)
    page.locator("#motion-play").click()


def test_a_whole_visit_has_no_error_and_no_request_and_every_control_a_name(opened: Tab) -> None:
    opened.no_error_and_no_request("#motion-visible")
    opened.every_control_has_a_name()


def test_the_worst_channel_is_shown_over_the_truth_with_its_limit(opened: Tab, page: Page) -> None:
    rocker = np.degrees(MOTION.links["rocker"].theta)
    assert "rocker_deg" in page.evaluate(LAYOUT)["y"]
    assert np.allclose(trace(page, "logged")["y"], rocker + 2.0, atol=1e-4)
    assert np.allclose(trace(page, "truth")["y"], rocker, atol=1e-3)
    assert np.allclose(trace(page, "logged", "y2")["y"], 2.0, atol=1e-3)
    assert trace(page, "limit", "y2")["y"] == pytest.approx([np.degrees(1e-3)] * 2)
    assert page.evaluate(LAYOUT)["largest"] == "largest 2"
    assert "Its largest error is 2 deg" in opened.text("#channels-told")


def test_another_channel_or_line_is_chosen(page: Page) -> None:
    channel(page, "C.x_mm")
    assert page.evaluate(LAYOUT)["y"] == "C.x_mm [mm]"
    page.locator("#verdict a", has_text="coupler_deg").click()
    assert page.evaluate(LAYOUT)["y"] == "coupler_deg [deg]"
    assert page.evaluate("() => document.activeElement.id") == "channels-channel"
    box = page.locator("#channels-legend [data-item='truth']")
    for shown in (False, True):
        box.set_checked(shown)
        assert trace(page, "truth")["visible"] == shown
        assert trace(page, "logged")["visible"]


def test_the_line_is_broken_at_the_seam_of_a_wrapped_angle_and_between_turns(page: Page) -> None:
    channel(page, "crank_deg")
    places = trace(page, "logged")
    assert len(places["y"]) == TIME_S.size + 2  # two turns from 90 degrees on
    assert [places[axis].count(None) for axis in "xy"] == [2, 2]
    channel(page, "rocker_deg")
    page.select_option("#channels-against", "phase")
    found = trace(page, "logged")["x"]
    known = [x for x in found if x is not None]
    assert 0.0 <= min(known) < 1.5
    assert 358.5 < max(known) <= 360.0
    assert found.count(None) == 2
    assert page.evaluate(LAYOUT)["x"] == "angle of crank [deg]"


def test_points_and_a_rocker_of_another_angle_are_drawn_apart(opened: Tab, page: Page) -> None:
    page.select_option("#motion-factor", "1")
    runs = page.locator("#motion-picture .run")
    assert runs.count() == 2
    assert runs.nth(0).locator(".link").count() == 3
    assert runs.nth(1).locator(".link").count() == 1
    assert "apart" in (runs.nth(1).get_attribute("class") or "")
    assert "rocker by its angle 7.0e-3 m" in opened.text("#motion-readout")  # 0.2 m by 2 deg
    exact = corners(page.locator("#motion-picture .reference .link").nth(2))
    logged = corners(runs.nth(0).locator(".link").nth(2))
    turned = corners(runs.nth(1).locator(".link"))
    assert np.allclose(exact, logged, atol=0.02)
    assert np.max(np.abs(exact - turned)) > 1.0


def test_the_dark_theme_reaches_the_diagram(page: Page) -> None:
    chart = "document.getElementById('channels-chart')"
    colours = f"() => [{chart}._fullLayout.font.color, {chart}.data[1].line.color]"
    light = page.evaluate(colours)
    page.locator("#theme").click()
    dark = page.evaluate(colours)
    page.locator("#theme").click()
    assert all(a != b for a, b in zip(light, dark, strict=True))


@slow("`test_log_page` reads the instants that the page carries")
def test_times_far_from_zero_keep_their_digits(wide: Tab, written: Write) -> None:
    turn = motion_of(samples=91)
    late = 12345.678 + turn.time_s
    page = wide.open(written(log_page_of(late, angles(solve(SCENE, late)))), "channels").page
    assert np.allclose(trace(page, "logged")["x"], late, atol=1e-6)
    page.locator("#motion-slider").focus()
    page.keyboard.press("End")
    told = wide.text("#motion-time").split()
    assert float(told[2]) == pytest.approx(late[-1], abs=1e-4)


@slow("`test_log_page` reads the spike that the page carries, `test_log_sections` how it thins")
def test_the_spike_of_a_long_log_is_seen_and_looked_at_closely(wide: Tab, written: Write) -> None:
    motion = motion_of(turns=40.0, samples=40_001)
    off = np.zeros(40_001)
    off[17_000] = 0.5
    path = written(log_page_of(motion.time_s, angles(motion, rocker=off)))
    page = wide.open(path, "channels").page
    whole = trace(page, "logged", "y2")
    assert len(whole["y"]) < 10_000
    assert max(whole["y"]) == pytest.approx(0.5, rel=1e-3)
    page.select_option("#channels-part", "near")
    near = trace(page, "logged", "y2")
    assert max(near["y"]) == pytest.approx(0.5, rel=1e-3)
    assert near["x"][-1] - near["x"][0] == pytest.approx(TURN_S, rel=0.01)
    page.select_option("#channels-part", "whole")
    page.select_option("#channels-against", "phase")
    assert trace(page, "logged")["mode"] == "markers"  # lines would join other turns


def test_hostile_text_does_nothing_nor_runs_out_of_a_phone(phone: Tab, hostile: Path) -> None:
    phone.visit(hostile, *DRAWN).nothing_runs_out()
    page = phone.visit(hostile, *DRAWN).page
    page.evaluate("() => Plotly.Fx.hover('channels-chart', [{curveNumber: 1, pointNumber: 1}])")
    phone.hostile_text_does_nothing("#channels-told")
    assert "\u202e" not in phone.text("body")
    assert "\\u202e" in phone.text("#verdict")


def test_what_the_log_has_not_is_not_drawn_over_the_truth(phone: Tab, hostile: Path) -> None:
    page = phone.visit(hostile, *DRAWN).page
    assert page.locator("#motion-picture .reference .link").count() == 3
    assert page.locator("#motion-picture .run .link").count() == 1
    assert "crank, rocker" in page.locator("#motion p", has_text="Left out").inner_text()
