"""The page in a real browser, from a file, with the network off."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

import pytest
from playwright.sync_api import Locator, Page

from tests.reports.page.conftest import chromium
from tests.reports.page.tab import Tab
from tests.worlds.tiers import slow

SECTIONS = ("precision", "convergence", "motion")
LINKS = "#motion-picture .reference .link"
TRACES = """id => document.getElementById(id).data.map(each => [each.name, each.visible !== false,
    each.x.filter(x => x !== null).length])"""


def traces(page: Page, chart: str) -> dict[str, bool]:
    """The traces of a diagram that have points, and whether they are shown."""
    found = page.evaluate(TRACES, chart)
    return {name: visible for name, visible, points in found if points}


def order(page: Page, table: str, column: int) -> list[float]:
    """The numbers of a column of a table, as its rows stand."""
    texts = page.locator(f"{table} tbody tr").evaluate_all(
        "(rows, n) => rows.map(row => row.cells[n].dataset.value)", column
    )
    return [float(text) for text in texts if text]


def corners(path: Locator) -> list[tuple[float, float]]:
    """The corners of a drawn path [pixel]."""
    numbers = [float(n) for n in re.findall(r"-?[\d.]+", path.get_attribute("d") or "")]
    return list(zip(numbers[::2], numbers[1::2], strict=True))


@pytest.fixture
def opened(wide: Tab, small_page: Path) -> Iterator[Tab]:
    """The page of the small store with all its diagrams drawn, as it was when it was opened."""
    yield wide.visit(small_page, *SECTIONS)
    assert wide.said == []


def test_without_a_browser_the_tests_are_skipped_and_fail_in_ci(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    ends = (pytest.skip.Exception, pytest.fail.Exception)
    monkeypatch.setenv("PATH", "/nowhere")
    for in_ci, end in zip(("", "true"), ends, strict=True):
        monkeypatch.setenv("CI", in_ci)
        with pytest.raises(ends, match="apt-get install chromium") as raised:
            chromium()
        assert raised.type is end


def test_printing_draws_what_was_not_scrolled_to(wide: Tab, small_page: Path) -> None:
    page = wide.open(small_page).page
    page.evaluate("window.dispatchEvent(new Event('beforeprint'))")
    page.wait_for_function(
        "() => [...document.querySelectorAll('.chart')].every(each => each.querySelector('svg'))"
    )


def test_no_error_and_no_request_in_a_whole_visit(opened: Tab) -> None:
    opened.no_error_and_no_request("#motion-visible")


def test_a_switch_of_the_legend_takes_a_trace_out_and_brings_it_back(opened: Tab) -> None:
    before = traces(opened.page, "precision-chart")
    assert all(before.values())
    assert {"mujoco tuned", "pymunk tuned", "front"} <= set(before)
    box = opened.page.locator("#precision-legend [data-item='1']")
    box.uncheck()
    after = traces(opened.page, "precision-chart")
    assert [name for name, shown in after.items() if not shown] == ["mujoco tuned"]
    box.check()
    assert traces(opened.page, "precision-chart") == before


@pytest.mark.parametrize("section", ["precision", "convergence"])
def test_an_engine_is_switched_as_a_whole(opened: Tab, section: str) -> None:
    engine = opened.page.locator(f"#{section}-legend [data-group='mujoco']")
    engine.uncheck()
    found = traces(opened.page, f"{section}-chart")
    assert {name.split()[0] for name, shown in found.items() if not shown} == {"mujoco"}
    assert any(shown for name, shown in found.items() if name.startswith("pymunk"))
    opened.page.locator(f"#{section}-legend [data-item='0']").check()
    assert engine.evaluate("each => each.indeterminate")


def test_a_marker_tells_its_settings(opened: Tab) -> None:
    opened.page.select_option("#precision-scene", "fourbar-lecture-1")
    opened.page.evaluate(
        "() => Plotly.Fx.hover('precision-chart', [{curveNumber: 3, pointNumber: 1}])"
    )
    label = opened.page.locator("#precision-chart .hovertext")
    label.wait_for()
    told = label.text_content() or ""
    assert "pymunk no bias" in told
    assert "180 steps a turn" in told
    assert "error_bias 0" in told
    assert "tolerance" in told


def test_the_diagram_shows_another_scene_and_another_cost(opened: Tab) -> None:
    x = "() => document.getElementById('precision-chart').data[1].x"
    over_all = opened.page.evaluate(x)
    opened.page.select_option("#precision-scene", "shaper")
    assert opened.page.evaluate(x) != over_all
    opened.page.select_option("#precision-cost", "steps")
    assert opened.page.evaluate(x) == [90, 180, 360]
    assert "front" in traces(opened.page, "precision-chart")
    assert not traces(opened.page, "precision-chart")["front"]


def test_convergence_has_fits_and_floors_and_the_table_follows(opened: Tab) -> None:
    assert "mujoco tuned fit" in traces(opened.page, "convergence-chart")
    assert "order 2.0" in opened.page.locator("#convergence-legend").inner_text()
    opened.page.select_option("#convergence-scene", "shaper")
    assert opened.page.locator("#fits tbody tr:visible").count() == 4
    assert "mujoco as-shipped floor" in traces(opened.page, "convergence-chart")
    opened.page.select_option("#convergence-quantity", "gap_pure")
    title = "() => document.getElementById('convergence-chart').layout.yaxis.title.text"
    assert "of longest link" in opened.page.evaluate(title)


def test_a_table_sorts_by_its_numbers_up_and_down(opened: Tab) -> None:
    table = "#recommendation table"
    head = opened.page.locator(f"{table} th").nth(5)
    head.locator("button").click()
    up = order(opened.page, table, 5)
    assert len(up) > 2
    assert up == sorted(up)
    assert head.get_attribute("aria-sort") == "ascending"
    head.locator("button").focus()
    opened.page.keyboard.press("Enter")
    assert order(opened.page, table, 5) == up[::-1]
    assert head.get_attribute("aria-sort") == "descending"
    last = opened.page.locator(f"{table} tbody tr").last
    assert last.locator("td").nth(4).get_attribute("data-value") == ""  # nothing goes last


def test_the_table_of_all_cells_is_filtered(opened: Tab) -> None:
    opened.page.locator("#provenance details", has_text="cells as a table").locator(
        "> summary"
    ).click()
    rows = opened.page.locator("#cells tbody tr:visible")
    assert rows.count() == 24
    opened.page.fill("#cells-filter", "shaper tuned 360")
    assert rows.count() == 2
    assert opened.page.locator("#cells-filter-told").inner_text() == "2 shown"


def test_the_drawing_moves_and_stops(opened: Tab) -> None:
    still = opened.drawn(LINKS)
    opened.elapse(150)
    assert opened.drawn(LINKS) == still  # reduced motion is wanted: it waits to be asked
    play = opened.page.locator("#motion-play")
    play.click()
    assert play.inner_text() == "Pause"
    opened.elapse(200)
    assert opened.drawn(LINKS) != still
    play.click()
    stopped = opened.drawn(LINKS)
    opened.elapse(150)
    assert opened.drawn(LINKS) == stopped


def test_the_drawing_moves_by_itself_where_motion_is_welcome(opened: Tab) -> None:
    page = opened.page
    page.emulate_media(reduced_motion="no-preference")
    page.locator("#precision").scroll_into_view_if_needed()
    page.wait_for_function(
        "() => document.getElementById('motion-picture').getBoundingClientRect().top > innerHeight"
    )
    page.locator("#motion-picture").scroll_into_view_if_needed()
    page.wait_for_function("() => document.getElementById('motion-play').textContent === 'Pause'")
    page.wait_for_function(
        "([links, before]) => document.querySelector(links).getAttribute('d') !== before",
        arg=[LINKS, opened.drawn(LINKS)[0]],
    )
    page.locator("#motion-play").click()


def test_the_crank_is_turned_by_the_keyboard(opened: Tab) -> None:
    slider = opened.page.locator("#motion-slider")
    slider.focus()
    opened.page.keyboard.press("Home")
    before = opened.drawn(LINKS)
    for _ in range(5):
        opened.page.keyboard.press("ArrowRight")
    assert opened.drawn(LINKS) != before
    assert opened.page.locator("#motion-angle").inner_text() == "110°"  # from 90, by 5 times 4
    assert slider.get_attribute("aria-valuetext") == "crank at 110 degrees"
    cursor = opened.page.locator("#motion-cursor")
    assert cursor.is_visible()
    place = cursor.bounding_box()
    opened.page.keyboard.press("End")
    assert cursor.bounding_box() != place


def test_an_error_is_magnified_by_the_factor(opened: Tab) -> None:
    opened.page.select_option("#motion-steps", "90")
    opened.page.locator("#motion-slider").focus()
    opened.page.keyboard.press("End")
    for box in opened.page.locator("#motion-legend [data-item]").all():
        box.set_checked(box.get_attribute("data-item") == "3")
    exact = corners(opened.page.locator(LINKS).nth(1))
    off = {}
    for factor in ("1", "10", "100", "100000"):
        opened.page.select_option("#motion-factor", factor)
        drawn = corners(opened.page.locator("#motion-picture .run .link").nth(1))
        off[factor] = max(
            ((a - c) ** 2 + (b - d) ** 2) ** 0.5
            for (a, b), (c, d) in zip(exact, drawn, strict=True)
        )
    assert off["100"] == pytest.approx(10 * off["10"], rel=0.2)  # two places of a pixel
    assert 1.0 < off["100"] < off["100000"]
    assert off["1"] < 0.2
    assert "cut off" in opened.page.locator("#motion-readout").inner_text()
    opened.page.locator("#motion-visible").click()
    assert opened.page.input_value("#motion-factor") in ("10", "100", "1000")


def test_the_parts_of_the_error_are_drawn_and_can_be_switched(opened: Tab) -> None:
    assert list(traces(opened.page, "motion-chart")) == [
        "total",
        "drive",
        "model floor",
        "discretisation",
        "closure: widest gap / L",
    ]
    opened.page.locator("#motion-parts [data-item='drive']").uncheck()
    assert not traces(opened.page, "motion-chart")["drive"]
    opened.page.select_option("#motion-scale", "linear")
    kind = "() => document.getElementById('motion-chart')._fullLayout.yaxis.type"
    assert opened.page.evaluate(kind) == "linear"
    sums = opened.page.evaluate(
        """() => {
          const [total, drive, floor, rest] = document.getElementById('motion-chart').data;
          const largest = Math.max(...total.y.map(Math.abs));
          return Math.max(...total.y.map((y, i) =>
            Math.abs(y - drive.y[i] - floor.y[i] - rest.y[i]))) / largest;
        }"""
    )
    assert sums < 1e-4


def test_every_control_has_a_name_and_is_reached_by_tab(opened: Tab) -> None:
    opened.every_control_has_a_name()
    opened.every_control_is_reached_by_tab()


def test_the_first_stop_of_tab_skips_to_the_verdict(opened: Tab) -> None:
    opened.page.locator("body").evaluate("each => { each.tabIndex = -1; each.focus(); }")
    opened.page.keyboard.press("Tab")
    assert opened.page.evaluate("() => document.activeElement.className") == "skip"
    opened.page.keyboard.press("Enter")
    assert opened.page.evaluate("() => document.activeElement.id") == "main"


def test_a_script_that_came_in_anyway_is_not_run(opened: Tab) -> None:
    opened.page.evaluate(
        """() => { const script = document.createElement('script');
          script.textContent = 'window.hacked = 1'; document.body.append(script); }"""
    )
    assert opened.page.evaluate("() => window.hacked") is None
    assert any("Content Security Policy" in text for text in opened.said)
    opened.said.clear()


def test_the_theme_is_the_systems_and_the_button_changes_it(opened: Tab) -> None:
    paper = "() => getComputedStyle(document.body).backgroundColor"
    ink = "() => document.getElementById('precision-chart')._fullLayout.font.color"

    def seen() -> tuple[str, str]:
        return opened.page.evaluate(paper), opened.page.evaluate(ink)

    light = seen()
    opened.page.emulate_media(color_scheme="dark")
    opened.page.wait_for_function(f"before => ({paper})() !== before", arg=light[0])
    opened.page.wait_for_function(f"before => ({ink})() !== before", arg=light[1])
    button = opened.page.locator("#theme")
    assert button.inner_text() == "Light theme"
    button.click()
    assert seen() == light
    opened.page.reload()
    assert opened.page.evaluate(paper) == light[0]  # it is remembered
    for _ in range(3):
        button.click()
    opened.page.emulate_media(color_scheme="light")
    assert opened.page.evaluate(paper) == light[0]  # and forgotten when it is the system's again
    opened.path = None  # no diagram is drawn


def test_hostile_text_does_nothing(wide: Tab, evil_page: Path) -> None:
    wide.open(evil_page, *SECTIONS)
    wide.page.evaluate(
        "() => Plotly.Fx.hover('precision-chart', [{curveNumber: 2, pointNumber: 1}])"
    )
    assert wide.page.evaluate("() => window.hacked") is None
    assert wide.page.locator("main img").count() == 0
    assert "{{ 7 * 7 }}" in wide.page.locator("#provenance").inner_text()
    assert wide.said == []


def test_nothing_runs_out_of_a_phone(phone: Tab, small_page: Path) -> None:
    phone.visit(small_page, *SECTIONS).nothing_runs_out()
    assert phone.said == []


@slow("the same scripts as on a computer: what a finger makes other is that nothing is zoomed")
def test_no_error_and_no_request_in_a_whole_visit_by_phone(phone: Tab, small_page: Path) -> None:
    phone.visit(small_page, *SECTIONS).no_error_and_no_request("#motion-visible")


@slow("a section that has less to show is read as text by `test_page`")
def test_a_page_without_times_and_with_one_scene_works(wide: Tab, tiny_page: Path) -> None:
    wide.open(tiny_page, *SECTIONS)
    assert not wide.page.locator("#precision-cost").is_visible()
    assert traces(wide.page, "precision-chart") == {"pymunk tuned": True}
    assert wide.said == []
