"""The page of a judged log in a real browser, from a file, with the network off."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import pytest
from playwright.sync_api import Page

from analytic.kinematics import solve
from reports.logs.map_file import ChannelTable, Map
from reports.own_log.judged import JudgedLog
from reports.page.log_page import log_page
from tests.reports.page.judged_logs import FACTS, SCENE, TURN_S, angles, judged, motion_of, points
from tests.reports.page.tab import Tab
from tests.reports.page.test_browser import corners
from tests.reports.page.test_log_page import NASTY
from tests.worlds.tiers import slow

Write = Callable[[str], Path]
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


def log_file(written: Write, one: JudgedLog) -> Path:
    return written(log_page(one, FACTS))


def trace(page: Page, name: str, axis: str = "y") -> dict[str, list[float]]:
    return page.evaluate(TRACE, [name, axis])


def layout(page: Page) -> dict[str, str]:
    return page.evaluate(LAYOUT)


def channel(page: Page, column: str) -> None:
    """Choose a channel by its column."""
    options = page.locator("#channels-channel option", has_text=column)
    page.select_option("#channels-channel", options.first.get_attribute("value"))


@pytest.fixture(scope="module")
def log(written: Write) -> Path:
    """A rocker that is 2 degrees off, a crank that is wrapped, points that are right."""
    columns = angles(MOTION, rocker=2.0) | points(MOTION, "B", "C")
    columns["crank_deg"] = columns["crank_deg"] % 360.0
    columns["coupler_deg"] = columns["coupler_deg"] + 1e-4 * np.sin(TIME_S)
    columns["other"] = TIME_S
    return log_file(written, judged(TIME_S, columns))


@pytest.fixture(scope="module")
def hostile(written: Write) -> Path:
    """A log of the coupler alone with hostile and long names."""
    table = ChannelTable(column=NASTY, of="coupler", kind="angle", unit="deg")
    columns = {NASTY: angles(MOTION, coupler=1.0)["coupler_deg"]}
    columns |= {f"{NASTY} 2": TIME_S, "x" * 5000: TIME_S}
    return log_file(written, judged(TIME_S, columns, mapped=Map(channel=[table])))


@pytest.fixture
def opened(wide: Tab, log: Path) -> Iterator[Tab]:
    """The page as it was when it was opened."""
    yield wide.visit(log, *DRAWN)
    assert wide.said == []


def test_the_error_is_on_the_scale_that_shows_it_until_one_is_chosen(wide: Tab, log: Path) -> None:
    page = wide.open(log, *DRAWN).page  # nothing has been chosen
    assert layout(page)["kind"] != "log"  # 2 deg with a limit of 0.06
    channel(page, "coupler_deg")
    assert layout(page)["kind"] == "log"  # 1e-4 deg
    page.select_option("#channels-scale", "linear")
    channel(page, "C.x_mm")
    assert layout(page)["kind"] != "log"


def test_errors_are_magnified_as_the_page_opens_and_the_mechanism_moves(opened: Tab) -> None:
    assert opened.page.input_value("#motion-factor") == "10"
    opened.page.locator("#motion-slider").focus()
    opened.page.keyboard.press("Home")
    time = opened.page.locator("#motion-time")
    first = time.inner_text()
    opened.page.keyboard.press("End")
    assert time.inner_text() != first
    opened.elapse(0)
    opened.page.locator("#motion-play").click()
    opened.elapse(100)
    assert time.inner_text() != first
    opened.page.locator("#motion-play").click()


def test_no_error_and_no_request_in_a_whole_visit(opened: Tab) -> None:
    opened.no_error_and_no_request("#motion-visible")


def test_the_worst_channel_is_shown_over_the_truth_with_its_limit(opened: Tab) -> None:
    rocker = np.degrees(MOTION.links["rocker"].theta)
    assert "rocker_deg" in layout(opened.page)["y"]
    assert np.allclose(trace(opened.page, "logged")["y"], rocker + 2.0, atol=1e-4)
    assert np.allclose(trace(opened.page, "truth")["y"], rocker, atol=1e-3)
    assert np.allclose(trace(opened.page, "logged", "y2")["y"], 2.0, atol=1e-3)
    assert trace(opened.page, "limit", "y2")["y"] == pytest.approx([np.degrees(1e-3)] * 2)
    assert layout(opened.page)["largest"] == "largest 2"
    assert "Its largest error is 2 deg" in opened.page.locator("#channels-told").inner_text()


def test_another_channel_is_chosen_in_the_list_or_in_the_table(opened: Tab) -> None:
    channel(opened.page, "C.x_mm")
    assert layout(opened.page)["y"] == "C.x_mm [mm]"
    opened.page.locator("#verdict a", has_text="coupler_deg").click()
    assert layout(opened.page)["y"] == "coupler_deg [deg]"
    assert opened.page.evaluate("() => document.activeElement.id") == "channels-channel"


def test_an_angle_that_is_wrapped_is_broken_at_its_seam(opened: Tab) -> None:
    channel(opened.page, "crank_deg")
    places = trace(opened.page, "logged")
    assert len(places["y"]) == TIME_S.size + 2  # two turns from 90 degrees on
    assert places["y"].count(None) == 2
    assert places["x"].count(None) == 2


def test_the_log_is_shown_against_the_crank_angle_turn_on_turn(opened: Tab) -> None:
    opened.page.select_option("#channels-against", "phase")
    found = trace(opened.page, "logged")
    known = [x for x in found["x"] if x is not None]
    assert 0.0 <= min(known) < 1.5
    assert 358.5 < max(known) <= 360.0
    assert found["x"].count(None) == 2
    assert layout(opened.page)["x"] == "angle of crank [deg]"


def test_a_line_is_switched_off_and_on(opened: Tab) -> None:
    box = opened.page.locator("#channels-legend [data-item='truth']")
    box.uncheck()
    assert not trace(opened.page, "truth")["visible"]
    assert trace(opened.page, "logged")["visible"]
    box.check()
    assert trace(opened.page, "truth")["visible"]


def test_points_and_a_rocker_of_another_angle_are_drawn_apart(opened: Tab) -> None:
    opened.page.select_option("#motion-factor", "1")
    runs = opened.page.locator("#motion-picture .run")
    assert runs.count() == 2
    assert runs.nth(0).locator(".link").count() == 3
    assert runs.nth(1).locator(".link").count() == 1
    assert "apart" in (runs.nth(1).get_attribute("class") or "")
    told = opened.page.locator("#motion-readout").inner_text()
    assert "rocker by its angle 7.0e-3 m" in told  # 0.2 m by 2 deg
    exact = corners(opened.page.locator("#motion-picture .reference .link").nth(2))
    logged = corners(runs.nth(0).locator(".link").nth(2))
    turned = corners(runs.nth(1).locator(".link"))
    assert np.allclose(exact, logged, atol=0.02)
    assert np.max(np.abs(np.array(exact) - turned)) > 1.0


def test_the_first_and_the_last_turn_are_chosen(opened: Tab) -> None:
    choice = opened.page.locator("#motion-stretch option")
    names = [each.inner_text() for each in choice.all()]
    assert len(names) == 2
    last = next(n for n, name in enumerate(names) if "the last turn" in name)
    opened.page.select_option("#motion-stretch", str(last))
    opened.page.locator("#motion-slider").focus()
    opened.page.keyboard.press("End")
    told = opened.page.locator("#motion-time").inner_text()
    assert float(told.split()[2]) == pytest.approx(2.0 * TURN_S, rel=1e-4)


def test_every_control_has_a_name_and_is_reached_by_tab(opened: Tab) -> None:
    opened.every_control_has_a_name()
    opened.every_control_is_reached_by_tab()


def test_the_dark_theme_reaches_the_diagram(opened: Tab) -> None:
    ink = "() => document.getElementById('channels-chart')._fullLayout.font.color"
    log = "() => document.getElementById('channels-chart').data[1].line.color"
    light = opened.page.evaluate(ink), opened.page.evaluate(log)
    opened.page.locator("#theme").click()
    dark = opened.page.evaluate(ink), opened.page.evaluate(log)
    opened.page.locator("#theme").click()
    assert light[0] != dark[0]
    assert light[1] != dark[1]


@slow("`test_log_page` reads the instants that the page carries")
def test_times_far_from_zero_keep_their_digits(wide: Tab, written: Write) -> None:
    turn = motion_of(samples=91)
    late = 12345.678 + turn.time_s
    columns = angles(solve(SCENE, late))
    page = wide.open(log_file(written, judged(late, columns)), "channels").page
    assert np.allclose(trace(page, "logged")["x"], late, atol=1e-6)
    page.locator("#motion-slider").focus()
    page.keyboard.press("End")
    told = page.locator("#motion-time").inner_text()
    assert float(told.split()[2]) == pytest.approx(late[-1], abs=1e-4)


@slow("`test_log_page` reads the spike that the page carries, `test_log_curves` how it is thinned")
def test_the_spike_of_a_long_log_is_seen_and_looked_at_closely(wide: Tab, written: Write) -> None:
    motion = motion_of(turns=40.0, samples=40_001)
    off = np.zeros(40_001)
    off[17_000] = 0.5
    long = judged(motion.time_s, angles(motion, rocker=off))
    page = wide.open(log_file(written, long), "channels").page
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
    assert wide.said == []


def test_nothing_runs_out_of_a_phone(phone: Tab, hostile: Path) -> None:
    phone.visit(hostile, *DRAWN).nothing_runs_out()


def test_hostile_text_does_nothing(phone: Tab, hostile: Path) -> None:
    page = phone.visit(hostile, *DRAWN).page
    page.evaluate("() => Plotly.Fx.hover('channels-chart', [{curveNumber: 1, pointNumber: 1}])")
    assert page.evaluate("() => window.hacked") is None
    assert page.locator("main img").count() == 0
    assert "{{ 7 * 7 }}" in page.locator("#channels-told").inner_text()
    assert "\u202e" not in page.locator("body").inner_text()
    assert "\\u202e" in page.locator("#verdict").inner_text()
    assert phone.said == []


def test_what_the_log_has_not_is_not_drawn_over_the_truth(phone: Tab, hostile: Path) -> None:
    page = phone.visit(hostile, *DRAWN).page
    assert page.locator("#motion-picture .reference .link").count() == 3
    assert page.locator("#motion-picture .run .link").count() == 1
    assert "crank, rocker" in page.locator("#motion p", has_text="Left out").inner_text()
