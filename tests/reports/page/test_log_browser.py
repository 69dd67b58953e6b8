"""The page of a judged log in a real browser, from a file, with the network off."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from playwright.sync_api import Page

from analytic.kinematics import solve
from reports.logs.map_file import ChannelTable, Map
from reports.own_log.judged import JudgedLog
from reports.page.log_page import log_page
from tests.reports.page.conftest import Opened
from tests.reports.page.judged_logs import FACTS, SCENE, TURN_S, angles, judged, motion_of, points
from tests.reports.page.test_browser import (
    CONTROLS,
    NAMELESS,
    OUT,
    SHIFTED,
    UNREACHED,
    VISIT,
    corners,
)
from tests.reports.page.test_log_page import NASTY

Open = Callable[..., Opened]
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


def written(one: JudgedLog, folder: Path) -> Path:
    path = folder / "log.html"
    path.write_text(log_page(one, FACTS), encoding="utf-8")
    return path


def trace(page: Page, name: str, axis: str = "y") -> dict[str, list[float]]:
    return page.evaluate(TRACE, [name, axis])


def layout(page: Page) -> dict[str, str]:
    return page.evaluate(LAYOUT)


def channel(page: Page, column: str) -> None:
    """Choose a channel by its column."""
    options = page.locator("#channels-channel option", has_text=column)
    page.select_option("#channels-channel", options.first.get_attribute("value"))


@pytest.fixture(scope="module")
def log(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A rocker that is 2 degrees off, a crank that is wrapped, points that are right."""
    columns = angles(MOTION, rocker=2.0) | points(MOTION, "B", "C")
    columns["crank_deg"] = columns["crank_deg"] % 360.0
    columns["coupler_deg"] = columns["coupler_deg"] + 1e-4 * np.sin(TIME_S)
    columns["other"] = TIME_S
    return written(judged(TIME_S, columns), tmp_path_factory.mktemp("log"))


@pytest.fixture(scope="module")
def desktop(open_page: Open, log: Path) -> Opened:
    found = open_page(log)
    found.page.set_default_timeout(5000)
    found.show("channels")
    found.show("motion")
    return found


@pytest.fixture(scope="module")
def phone(open_page: Open, tmp_path_factory: pytest.TempPathFactory) -> Opened:
    """A log of the coupler alone with hostile and long names, on a phone."""
    hostile = ChannelTable(column=NASTY, of="coupler", kind="angle", unit="deg")
    columns = {NASTY: angles(MOTION, coupler=1.0)["coupler_deg"]}
    columns |= {f"{NASTY} 2": TIME_S, "x" * 5000: TIME_S}
    one = judged(TIME_S, columns, mapped=Map(channel=[hostile]))
    found = open_page(written(one, tmp_path_factory.mktemp("hostile")), phone=True)
    found.page.set_default_timeout(5000)
    found.show("channels")
    found.show("motion")
    return found


@pytest.fixture
def opened(desktop: Opened) -> Opened:
    """The page as it was when it was opened."""
    desktop.restore()
    return desktop


def test_no_error_and_no_request_in_a_whole_visit(opened: Opened) -> None:
    shifted = opened.page.evaluate(SHIFTED)
    opened.page.evaluate(VISIT)
    opened.page.locator("#motion-visible").click()
    opened.restore()
    assert opened.said == []
    assert [url for url in opened.asked if not url.startswith(("file:", "data:", "blob:"))] == []
    assert shifted < 0.05, "what is read should stay where it is"


def test_the_worst_channel_is_shown_over_the_truth_with_its_limit(opened: Opened) -> None:
    rocker = np.degrees(MOTION.links["rocker"].theta)
    assert "rocker_deg" in layout(opened.page)["y"]
    assert np.allclose(trace(opened.page, "logged")["y"], rocker + 2.0, atol=1e-4)
    assert np.allclose(trace(opened.page, "truth")["y"], rocker, atol=1e-3)
    assert np.allclose(trace(opened.page, "logged", "y2")["y"], 2.0, atol=1e-3)
    assert trace(opened.page, "limit", "y2")["y"] == pytest.approx([np.degrees(1e-3)] * 2)
    assert layout(opened.page)["largest"] == "largest 2"
    assert "Its largest error is 2 deg" in opened.page.locator("#channels-told").inner_text()


def test_another_channel_is_chosen_in_the_list_or_in_the_table(opened: Opened) -> None:
    channel(opened.page, "C.x_mm")
    assert layout(opened.page)["y"] == "C.x_mm [mm]"
    opened.page.locator("#verdict a", has_text="coupler_deg").click()
    assert layout(opened.page)["y"] == "coupler_deg [deg]"
    assert opened.page.evaluate("() => document.activeElement.id") == "channels-channel"


def test_the_error_is_on_the_scale_that_shows_it_until_one_is_chosen(opened: Opened) -> None:
    opened.page.reload()  # nothing has been chosen
    opened.show("channels")
    assert layout(opened.page)["kind"] != "log"  # 2 deg with a limit of 0.06
    channel(opened.page, "coupler_deg")
    assert layout(opened.page)["kind"] == "log"  # 1e-4 deg
    opened.page.select_option("#channels-scale", "linear")
    channel(opened.page, "C.x_mm")
    assert layout(opened.page)["kind"] != "log"


def test_an_angle_that_is_wrapped_is_broken_at_its_seam(opened: Opened) -> None:
    channel(opened.page, "crank_deg")
    places = trace(opened.page, "logged")
    assert len(places["y"]) == TIME_S.size + 2  # two turns from 90 degrees on
    assert places["y"].count(None) == 2
    assert places["x"].count(None) == 2


def test_the_log_is_shown_against_the_crank_angle_turn_on_turn(opened: Opened) -> None:
    opened.page.select_option("#channels-against", "phase")
    found = trace(opened.page, "logged")
    known = [x for x in found["x"] if x is not None]
    assert 0.0 <= min(known) < 1.5
    assert 358.5 < max(known) <= 360.0
    assert found["x"].count(None) == 2
    assert layout(opened.page)["x"] == "angle of crank [deg]"


def test_a_line_is_switched_off_and_on(opened: Opened) -> None:
    box = opened.page.locator("#channels-legend [data-item='truth']")
    box.uncheck()
    assert not trace(opened.page, "truth")["visible"]
    assert trace(opened.page, "logged")["visible"]
    box.check()
    assert trace(opened.page, "truth")["visible"]


def test_points_and_a_rocker_of_another_angle_are_drawn_apart(opened: Opened) -> None:
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


def test_errors_are_magnified_as_the_page_opens_and_the_mechanism_moves(opened: Opened) -> None:
    opened.page.reload()
    opened.page.locator("#motion").scroll_into_view_if_needed()
    assert opened.page.input_value("#motion-factor") == "10"
    slider = opened.page.locator("#motion-slider")
    slider.focus()
    opened.page.keyboard.press("Home")
    time = opened.page.locator("#motion-time")
    first = time.inner_text()
    opened.page.keyboard.press("End")
    assert time.inner_text() != first
    opened.page.locator("#motion-play").click()
    opened.page.wait_for_function(
        "first => document.getElementById('motion-time').textContent !== first", arg=first
    )
    opened.page.locator("#motion-play").click()
    opened.show("channels")


def test_the_first_and_the_last_turn_are_chosen(opened: Opened) -> None:
    choice = opened.page.locator("#motion-stretch option")
    names = [each.inner_text() for each in choice.all()]
    assert len(names) == 2
    last = next(n for n, name in enumerate(names) if "the last turn" in name)
    opened.page.select_option("#motion-stretch", str(last))
    opened.page.locator("#motion-slider").focus()
    opened.page.keyboard.press("End")
    told = opened.page.locator("#motion-time").inner_text()
    assert float(told.split()[2]) == pytest.approx(2.0 * TURN_S, rel=1e-4)


@pytest.mark.parametrize("opened_up", [False, True])
def test_nothing_runs_out_of_a_phone(phone: Opened, opened_up: bool) -> None:
    phone.page.evaluate(
        "open => document.querySelectorAll('details').forEach(each => { each.open = open; })",
        opened_up,
    )
    assert phone.page.evaluate(OUT) == []
    assert phone.page.evaluate("() => document.documentElement.scrollWidth") <= 390


def test_every_control_has_a_name_and_is_reached_by_tab(opened: Opened) -> None:
    assert opened.page.evaluate(NAMELESS, CONTROLS) == []
    assert opened.page.evaluate(UNREACHED, CONTROLS) == []


def test_the_dark_theme_reaches_the_diagram(opened: Opened) -> None:
    ink = "() => document.getElementById('channels-chart')._fullLayout.font.color"
    log = "() => document.getElementById('channels-chart').data[1].line.color"
    light = opened.page.evaluate(ink), opened.page.evaluate(log)
    opened.page.locator("#theme").click()
    dark = opened.page.evaluate(ink), opened.page.evaluate(log)
    opened.page.locator("#theme").click()
    assert light[0] != dark[0]
    assert light[1] != dark[1]


def test_hostile_text_does_nothing(phone: Opened) -> None:
    page = phone.page
    page.evaluate("() => Plotly.Fx.hover('channels-chart', [{curveNumber: 1, pointNumber: 1}])")
    assert page.evaluate("() => window.hacked") is None
    assert page.locator("main img").count() == 0
    assert "{{ 7 * 7 }}" in page.locator("#channels-told").inner_text()
    assert "\u202e" not in page.locator("body").inner_text()
    assert "\\u202e" in page.locator("#verdict").inner_text()
    assert phone.said == []


def test_times_far_from_zero_keep_their_digits(open_page: Open, tmp_path: Path) -> None:
    turn = motion_of(samples=91)
    late = 12345.678 + turn.time_s
    columns = angles(solve(SCENE, late))
    opened = open_page(written(judged(late, columns), tmp_path))
    opened.show("channels")
    assert np.allclose(trace(opened.page, "logged")["x"], late, atol=1e-6)
    opened.page.locator("#motion-slider").focus()
    opened.page.keyboard.press("End")
    told = opened.page.locator("#motion-time").inner_text()
    assert float(told.split()[2]) == pytest.approx(late[-1], abs=1e-4)


def test_what_the_log_has_not_is_not_drawn_over_the_truth(phone: Opened) -> None:
    assert phone.page.locator("#motion-picture .reference .link").count() == 3
    assert phone.page.locator("#motion-picture .run .link").count() == 1
    assert "crank, rocker" in phone.page.locator("#motion p", has_text="Left out").inner_text()


def test_the_spike_of_a_long_log_is_seen_and_looked_at_closely(
    open_page: Open, tmp_path: Path
) -> None:
    motion = motion_of(turns=40.0, samples=40_001)
    off = np.zeros(40_001)
    off[17_000] = 0.5
    opened = open_page(written(judged(motion.time_s, angles(motion, rocker=off)), tmp_path))
    opened.show("channels")
    whole = trace(opened.page, "logged", "y2")
    assert len(whole["y"]) < 10_000
    assert max(whole["y"]) == pytest.approx(0.5, rel=1e-3)
    opened.page.select_option("#channels-part", "near")
    near = trace(opened.page, "logged", "y2")
    assert max(near["y"]) == pytest.approx(0.5, rel=1e-3)
    assert near["x"][-1] - near["x"][0] == pytest.approx(TURN_S, rel=0.01)
    opened.page.select_option("#channels-part", "whole")
    opened.page.select_option("#channels-against", "phase")
    assert trace(opened.page, "logged")["mode"] == "markers"  # lines would join other turns
    assert opened.said == []
