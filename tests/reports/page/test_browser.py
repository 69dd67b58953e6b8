"""The page in a real browser, from a file, with the network off."""

import re
from pathlib import Path

import numpy as np
import pytest
from playwright.sync_api import FloatRect, Locator, Page

from models.array import Array
from reports.store.reader import Stored
from tests.reports.page.tab import Tab
from tests.worlds.tiers import slow

SECTIONS = ("precision", "convergence", "motion")
LINKS = "#motion-picture .reference .link"
TRACES = """id => document.getElementById(id).data.map(each => [each.name, each.visible !== false,
    each.x.filter(x => x !== null).length])"""
HOVER = "at => Plotly.Fx.hover('precision-chart', [{curveNumber: at, pointNumber: 1}])"


def traces(page: Page, chart: str) -> dict[str, bool]:
    """The traces of a diagram that have points, and whether they are shown."""
    found = page.evaluate(TRACES, chart)
    return {name: visible for name, visible, points in found if points}


def order(page: Page, table: str, column: int) -> list[float]:
    values = "(rows, n) => rows.map(row => row.cells[n].dataset.value)"
    texts = page.locator(f"{table} tbody tr").evaluate_all(values, column)
    return [float(text) for text in texts if text]


def corners(path: Locator) -> Array:
    numbers = re.findall(r"-?[\d.]+", path.get_attribute("d") or "")
    return np.reshape(np.array(numbers, dtype=float), (-1, 2))


def box_of(place: Locator) -> FloatRect:
    box = place.bounding_box()
    assert box is not None
    return box


@pytest.fixture
def opened(wide: Tab, small_page: Path) -> Tab:
    """The page of the small store with all its diagrams drawn, as it was when it was opened."""
    return wide.visit(small_page, *SECTIONS)


@slow("a page printed whole: 2 s")
def test_printing_draws_what_was_not_scrolled_to(wide: Tab, small_page: Path) -> None:
    page = wide.open(small_page).page
    page.evaluate("window.dispatchEvent(new Event('beforeprint'))")
    charts = "[...document.querySelectorAll('.chart')]"
    page.wait_for_function(f"() => {charts}.every(each => each.querySelector('svg'))")


def test_a_whole_visit_has_no_error_and_no_request_and_every_control_a_name(opened: Tab) -> None:
    opened.no_error_and_no_request("#motion-visible")
    opened.every_control_has_a_name()


ANSWER = (".verdict", "#advice", "#answer-chart", "#answer-picture")
"""The parts of the first screen, in the order of a phone."""


def test_the_first_screen_has_verdict_settings_diagram_and_mechanism(
    opened: Tab, page: Page
) -> None:
    page.evaluate("() => scrollTo(0, 0)")
    ends = [box["y"] + box["height"] for box in map(box_of, map(page.locator, ANSWER))]
    assert max(ends) <= 900.0
    assert page.locator("#advice tbody tr:visible").count() == 2  # engines, for one target
    page.locator("#advice .copy:visible").first.click()
    page.wait_for_function("() => document.querySelector('#advice .copy').textContent !== ''")
    drawers = page.locator("#recommendation .snippet pre").all_text_contents()
    copied = page.evaluate("() => navigator.clipboard.readText().catch(() => '')")
    assert copied == "" or copied in drawers
    page.select_option("#advice-target", index=0)
    assert page.locator("#advice tbody tr:visible").count() == 2


def test_a_switch_of_the_legend_takes_a_trace_or_an_engine_out_and_back(page: Page) -> None:
    before = traces(page, "precision-chart")
    assert all(before.values())
    assert {"mujoco tuned", "pymunk tuned", "front"} <= set(before)
    box = page.locator("#precision-legend [data-item='1']")
    box.uncheck()
    after = traces(page, "precision-chart")
    assert [name for name, shown in after.items() if not shown] == ["mujoco tuned"]
    box.check()
    assert traces(page, "precision-chart") == before
    engine = page.locator("#precision-legend [data-group='mujoco']")
    engine.uncheck()
    found = traces(page, "precision-chart")
    assert {name.split()[0] for name, shown in found.items() if not shown} == {"mujoco"}
    assert any(shown for name, shown in found.items() if name.startswith("pymunk"))
    page.locator("#precision-legend [data-item='0']").check()
    assert engine.evaluate("each => each.indeterminate")


def test_a_marker_tells_its_settings_and_another_scene_and_cost_are_shown(page: Page) -> None:
    x = "() => document.getElementById('precision-chart').data[1].x"
    over_all = page.evaluate(x)
    page.select_option("#precision-scene", "fourbar-lecture-1")
    page.evaluate(HOVER, 3)
    label = page.locator("#precision-chart .hovertext")
    label.wait_for()
    told = label.text_content() or ""
    for words in ("pymunk no bias", "180 steps a turn", "error_bias 0", "tolerance"):
        assert words in told
    page.select_option("#precision-scene", "shaper")
    assert page.evaluate(x) != over_all
    page.select_option("#precision-cost", "steps")
    assert page.evaluate(x) == [90, 180, 360]
    assert traces(page, "precision-chart")["front"] is False


def test_markers_are_filled_by_tolerance_or_by_a_fixed_error(page: Page) -> None:
    page.select_option("#precision-scene", "fourbar-lecture-1")
    points = """() => document.getElementById('precision-chart').data.slice(1)
        .flatMap(line => line.y.map((y, i) => [y, !line.marker.symbol[i].endsWith('-open')]))"""
    for target in ("0.001", "0.0001", "1e-06"):
        page.select_option("#precision-filled", target)
        found = page.evaluate(points)
        assert [filled for _, filled in found] == [error <= float(target) for error, _ in found]
    page.select_option("#precision-filled", "")
    assert page.evaluate(points) != found


def test_convergence_has_fits_and_floors_and_the_table_follows(page: Page) -> None:
    assert "mujoco tuned fit" in traces(page, "convergence-chart")
    assert "order 2.0" in page.locator("#convergence-legend").inner_text()
    page.select_option("#convergence-scene", "shaper")
    assert page.locator("#fits tbody tr:visible").count() == 4
    assert "mujoco as-shipped floor" in traces(page, "convergence-chart")
    page.select_option("#convergence-quantity", "gap_pure")
    title = "() => document.getElementById('convergence-chart').layout.yaxis.title.text"
    assert "of longest link" in page.evaluate(title)


def test_a_cell_of_a_table_leads_to_what_is_known_of_it(
    opened: Tab, page: Page, small: Stored
) -> None:
    found = page.evaluate("() => document.querySelectorAll('main a.known').length")
    assert found > len(small.cells)  # beside every cell the rows of other tables
    page.locator("#provenance details", has_text="cells as a table").locator("> summary").click()
    rows = page.locator("#cells tr", has_text="fourbar-lecture-1")
    rows.locator("a", has_text="no bias").nth(1).click()
    page.evaluate("() => document.querySelectorAll('details').forEach(d => { d.open = false; })")
    assert page.input_value("#motion-scene") == "fourbar-lecture-1"
    assert page.input_value("#motion-steps") == "180"
    cells = small.cells
    own = cells[(cells["scene"] == "fourbar-lecture-1") & (cells["variant"] == "no bias")]
    (row,) = own[own["steps_per_turn"] == 180].to_dict("records")
    told = opened.text("#motion-known")
    assert all(rule in told for rule in str(row["failed_rules"]).split())
    for column in ("gap_pure", "gap_limit_pure", "velocity_pure"):
        assert f"{row[column]:.2e}".replace("e-0", "e-") in told
    command = opened.text("#motion-command")
    assert "--engine pymunk --profile as-shipped" in command
    assert "--set pymunk.error_bias=0" in command
    assert command.endswith("--steps-per-turn 180")
    bodies = page.locator("#motion-body option").all_text_contents()
    page.select_option("#motion-body", index=1)
    assert list(traces(page, "motion-chart")) == [bodies[1]]


def test_curves_that_coincide_are_counted(page: Page) -> None:
    """Nearly all of an error is of its discretisation, where the floor is small."""
    page.select_option("#motion-scale", "linear")
    page.select_option("#motion-settings", label="pymunk tuned")
    labels = "document.getElementById('motion-chart').layout.annotations.map(each => each.text)"
    assert page.evaluate(labels) == ["2 curves coincide"]
    page.locator("#motion-parts [data-item='discretisation']").uncheck()
    assert page.evaluate(labels) == []


def test_drawers_are_open_on_paper(page: Page) -> None:
    closed = "() => document.querySelectorAll('details:not([open])').length"
    before = page.evaluate(closed)
    width = "document.getElementById('precision-chart')._fullLayout.width"
    wide = page.evaluate(width)
    page.evaluate("() => dispatchEvent(new Event('beforeprint'))")
    page.wait_for_function(f"() => {width} < {wide}")
    assert page.evaluate(closed) == 0 < before
    page.evaluate("() => dispatchEvent(new Event('afterprint'))")
    assert page.evaluate(closed) == before
    assert page.evaluate(width) == wide


def test_tables_sort_by_their_numbers_up_and_down_and_are_filtered(page: Page) -> None:
    table = "#recommendation table"
    head = page.locator(f"{table} th").nth(5)
    head.locator("button").click()
    up = order(page, table, 5)
    assert len(up) > 2
    assert up == sorted(up)
    assert head.get_attribute("aria-sort") == "ascending"
    head.locator("button").focus()
    page.keyboard.press("Enter")
    assert order(page, table, 5) == up[::-1]
    assert head.get_attribute("aria-sort") == "descending"
    last = page.locator(f"{table} tbody tr").last
    assert last.locator("td").nth(4).get_attribute("data-value") == ""  # nothing goes last
    page.locator("#provenance details", has_text="cells as a table").locator("> summary").click()
    page.fill("#cells-filter", "shaper tuned 360")
    assert page.locator("#cells tbody tr:visible").count() == 2
    assert page.locator("#cells-filter-told").inner_text() == "2 shown"


def test_the_drawing_moves_by_itself_if_that_is_welcome_and_stops(opened: Tab, page: Page) -> None:
    page.emulate_media(reduced_motion="no-preference")
    page.locator("#precision").scroll_into_view_if_needed()
    top = "document.getElementById('motion-picture').getBoundingClientRect().top"
    page.wait_for_function(f"() => {top} > innerHeight")
    page.locator("#motion-picture").scroll_into_view_if_needed()
    page.wait_for_function("() => document.getElementById('motion-play').textContent === 'Pause'")
    moved = "([links, before]) => document.querySelector(links).getAttribute('d') !== before"
    page.wait_for_function(moved, arg=[LINKS, opened.drawn(LINKS)[0]])
    assert int(page.input_value("#motion-factor")) > 1  # so that the engines are seen apart
    page.select_option("#motion-scene", "shaper")
    opened.elapse(20_000)  # round after round, in another scene as well
    assert opened.text("#motion-play") == "Pause"
    page.locator("#motion-play").click()
    stopped = opened.drawn(LINKS)
    opened.elapse(150)
    assert opened.drawn(LINKS) == stopped


def test_the_keyboard_skips_to_the_verdict_and_turns_the_crank(opened: Tab, page: Page) -> None:
    page.locator("body").evaluate("each => { each.tabIndex = -1; each.focus(); }")
    page.keyboard.press("Tab")
    page.keyboard.press("Enter")
    assert page.evaluate("() => document.activeElement.id") == "main"
    slider = page.locator("#motion-slider")
    slider.focus()
    page.keyboard.press("Home")
    before = opened.drawn(LINKS)
    for _ in range(5):
        page.keyboard.press("ArrowRight")
    assert opened.drawn(LINKS) != before
    assert opened.text("#motion-angle") == "110°"  # from 90, by 5 times 4
    assert slider.get_attribute("aria-valuetext") == "crank at 110 degrees"
    cursor = page.locator("#motion-cursor")
    assert cursor.is_visible()
    place = cursor.bounding_box()
    page.keyboard.press("End")
    assert cursor.bounding_box() != place


def test_an_error_is_magnified_by_the_factor_and_has_its_parts(opened: Tab, page: Page) -> None:
    parts = ["total", "drive", "model floor", "discretisation", "closure: widest gap / L"]
    assert list(traces(page, "motion-chart")) == parts
    off = [name for name, shown in traces(page, "motion-chart").items() if not shown]
    assert off == ["drive"]  # at rounding
    page.select_option("#motion-steps", "90")
    page.locator("#motion-slider").focus()
    page.keyboard.press("End")
    for box in page.locator("#motion-legend [data-item]").all():
        box.set_checked(box.get_attribute("data-item") == "3")
    exact = corners(page.locator(LINKS).nth(1))
    off = {}
    for factor in ("1", "10", "100", "100000"):
        page.select_option("#motion-factor", factor)
        away = corners(page.locator("#motion-picture .run .link").nth(1)) - exact
        off[factor] = np.max(np.hypot(*away.T))
    assert off["100"] == pytest.approx(10 * off["10"], rel=0.2)  # two places of a pixel
    assert 1.0 < off["100"] < off["100000"]
    assert off["1"] < 0.2
    assert "cut off" in opened.text("#motion-readout")
    page.locator("#motion-visible").click()
    assert page.input_value("#motion-factor") in ("10", "100", "1000")


def test_a_script_that_came_in_anyway_is_not_run(opened: Tab) -> None:
    opened.page.evaluate(
        """() => { const script = document.createElement('script');
          script.textContent = 'window.hacked = 1'; document.body.append(script); }"""
    )
    assert opened.page.evaluate("() => window.hacked") is None
    assert any("Content Security Policy" in text for text in opened.said)
    opened.said.clear()


def test_the_theme_is_the_systems_and_the_button_changes_it(wide: Tab, tiny_page: Path) -> None:
    page = wide.open(tiny_page, "precision").page
    paper = "() => getComputedStyle(document.body).backgroundColor"
    ink = "() => document.getElementById('precision-chart')._fullLayout.font.color"
    light = [page.evaluate(each) for each in (paper, ink)]
    page.emulate_media(color_scheme="dark")
    for each, before in zip((paper, ink), light, strict=True):
        page.wait_for_function(f"before => ({each})() !== before", arg=before)
    button = page.locator("#theme")
    assert button.inner_text() == "Light theme"
    button.click()
    assert [page.evaluate(each) for each in (paper, ink)] == light
    page.reload()
    assert page.evaluate(paper) == light[0]  # it is remembered
    for _ in range(3):
        button.click()
    page.emulate_media(color_scheme="light")
    assert page.evaluate(paper) == light[0]  # and forgotten when it is the system's again
    wide.path = None  # no diagram is drawn


def test_hostile_text_does_nothing(wide: Tab, evil_page: Path) -> None:
    page = wide.open(evil_page, *SECTIONS).page
    page.evaluate(HOVER, 2)
    wide.hostile_text_does_nothing("#provenance")


def test_a_phone_has_the_first_screen_in_its_order(phone: Tab, small_page: Path) -> None:
    found = phone.visit(small_page, *SECTIONS).page
    tops = [box_of(found.locator(part))["y"] for part in ANSWER]
    assert tops == sorted(tops)
    assert tops[-1] < box_of(found.locator(".sentences"))["y"]


def test_nothing_runs_out_of_a_phone(phone: Tab, small_page: Path) -> None:
    phone.visit(small_page, *SECTIONS).nothing_runs_out()
