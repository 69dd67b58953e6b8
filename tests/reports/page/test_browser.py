"""The page in a real browser, from a file, with the network off."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path

import pytest
from playwright.sync_api import Locator, Page

from reports.page.build import page
from reports.store.reader import Stored
from tests.reports.page.conftest import Opened, chromium
from tests.reports.page.test_page import evil

Open = Callable[..., Opened]
SECTIONS = ("precision", "convergence", "motion")
TRACES = """id => document.getElementById(id).data.map(each => [each.name, each.visible !== false,
    each.x.filter(x => x !== null).length])"""


VISIT = """() => {
  for (const choice of document.querySelectorAll('select')) {
    for (const option of [...choice.options]) {
      choice.value = option.value;
      choice.dispatchEvent(new Event('change'));
    }
  }
  for (const each of document.querySelectorAll('[data-item], [data-group], th button')) {
    each.click();
  }
  document.querySelectorAll('details').forEach(each => { each.open = true; });
  document.querySelectorAll('details:not(.run)').forEach(each => { each.open = false; });
}"""
SHIFTED = """() => new Promise(done => {
  new PerformanceObserver(list => done(
    list.getEntries().reduce((sum, each) => sum + (each.hadRecentInput ? 0 : each.value), 0)
  )).observe({type: 'layout-shift', buffered: true});
  setTimeout(() => done(0), 200);
})"""
OUT = """() => [...document.querySelectorAll('body *')].filter(each => {
  const box = each.getBoundingClientRect();
  const frame = each.closest('.scroll, pre, .skip, svg');
  return box.width && (!frame || frame === each) && !each.matches('.skip, #js-plotly-tester')
    && (box.right > 390.5 || box.left < -0.5);
}).map(each => `${each.tagName} ${each.id} ${each.textContent.slice(0, 40)}`)"""
CONTROLS = "button, input, select, summary, .scroll"
NAMELESS = """controls => [...document.querySelectorAll(`${controls}, [role=img]`)].filter(
  each => !(each.getAttribute('aria-label') || each.textContent.trim()
    || [...(each.labels ?? [])].some(label => label.textContent.trim()))
).map(each => each.outerHTML)"""
UNREACHED = """controls => [...document.querySelectorAll(`${controls}, a`)].filter(
  each => each.tabIndex < 0 && !each.closest('.chart')).map(each => each.outerHTML)"""


def drawn(page: Page, chart: str) -> dict[str, bool]:
    """The traces of a diagram that have points, and whether they are shown."""
    found = page.evaluate(TRACES, chart)
    return {name: visible for name, visible, points in found if points}


def order(page: Page, table: str, column: int) -> list[float]:
    """The numbers of a column of a table, as its rows stand."""
    cells = page.locator(f"{table} tbody tr").all()
    texts = [row.locator("th, td").nth(column).get_attribute("data-value") for row in cells]
    return [float(text) for text in texts if text]


def bar(page: Page) -> str:
    """How the links of the reference are drawn at the moment."""
    paths = page.locator("#motion-picture .reference .link").all()
    return " ".join(path.get_attribute("d") or "" for path in paths)


def corners(path: Locator) -> list[tuple[float, float]]:
    """The corners of a drawn path [pixel]."""
    numbers = [float(n) for n in re.findall(r"-?[\d.]+", path.get_attribute("d") or "")]
    return list(zip(numbers[::2], numbers[1::2], strict=True))


@pytest.fixture(scope="module")
def desktop(open_page: Open, small_page: Path) -> Opened:
    """The page of the small store with all its diagrams drawn."""
    found = open_page(small_page)
    for section in SECTIONS:
        found.show(section)
    return found


@pytest.fixture(scope="module")
def phone(open_page: Open, small_page: Path) -> Opened:
    """The same on a phone."""
    found = open_page(small_page, phone=True)
    for section in SECTIONS:
        found.show(section)
    return found


@pytest.fixture
def opened(desktop: Opened) -> Opened:
    """The page as it was when it was opened."""
    desktop.restore()
    return desktop


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


@pytest.mark.parametrize("name", ["desktop", "phone"])
def test_no_error_and_no_request_in_a_whole_visit(
    name: str, request: pytest.FixtureRequest
) -> None:
    opened: Opened = request.getfixturevalue(name)
    opened.restore()
    shifted = opened.page.evaluate(SHIFTED)
    opened.page.evaluate(VISIT)
    opened.page.locator("#motion-visible").click()
    opened.restore()
    assert opened.said == []
    assert [url for url in opened.asked if not url.startswith(("file:", "data:", "blob:"))] == []
    assert shifted < 0.05, "what is read should stay where it is"


def test_a_switch_of_the_legend_takes_a_trace_out_and_brings_it_back(opened: Opened) -> None:
    before = drawn(opened.page, "precision-chart")
    assert all(before.values())
    assert {"mujoco tuned", "pymunk tuned", "front"} <= set(before)
    box = opened.page.locator("#precision-legend [data-item='1']")
    box.uncheck()
    after = drawn(opened.page, "precision-chart")
    assert [name for name, shown in after.items() if not shown] == ["mujoco tuned"]
    box.check()
    assert drawn(opened.page, "precision-chart") == before


@pytest.mark.parametrize("section", ["precision", "convergence"])
def test_an_engine_is_switched_as_a_whole(opened: Opened, section: str) -> None:
    engine = opened.page.locator(f"#{section}-legend [data-group='mujoco']")
    engine.uncheck()
    found = drawn(opened.page, f"{section}-chart")
    assert {name.split()[0] for name, shown in found.items() if not shown} == {"mujoco"}
    assert any(shown for name, shown in found.items() if name.startswith("pymunk"))
    opened.page.locator(f"#{section}-legend [data-item='0']").check()
    assert engine.evaluate("each => each.indeterminate")


def test_a_marker_tells_its_settings(opened: Opened) -> None:
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


def test_the_diagram_shows_another_scene_and_another_cost(opened: Opened) -> None:
    x = "() => document.getElementById('precision-chart').data[1].x"
    over_all = opened.page.evaluate(x)
    opened.page.select_option("#precision-scene", "shaper")
    assert opened.page.evaluate(x) != over_all
    opened.page.select_option("#precision-cost", "steps")
    assert opened.page.evaluate(x) == [90, 180, 360]
    assert "front" in drawn(opened.page, "precision-chart")
    assert not drawn(opened.page, "precision-chart")["front"]


def test_convergence_has_fits_and_floors_and_the_table_follows(opened: Opened) -> None:
    found = drawn(opened.page, "convergence-chart")
    assert "mujoco tuned fit" in found
    assert "order 2.0" in opened.page.locator("#convergence-legend").inner_text()
    opened.page.select_option("#convergence-scene", "shaper")
    rows = opened.page.locator("#fits tbody tr:visible")
    assert rows.count() == 4
    assert "mujoco as-shipped floor" in drawn(opened.page, "convergence-chart")
    opened.page.select_option("#convergence-quantity", "gap_pure")
    title = "() => document.getElementById('convergence-chart').layout.yaxis.title.text"
    assert "of longest link" in opened.page.evaluate(title)


def test_a_table_sorts_by_its_numbers_up_and_down(opened: Opened) -> None:
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


def test_the_table_of_all_cells_is_filtered(opened: Opened) -> None:
    opened.page.locator("#provenance details", has_text="cells as a table").locator(
        "> summary"
    ).click()
    rows = opened.page.locator("#cells tbody tr:visible")
    assert rows.count() == 24
    opened.page.fill("#cells-filter", "shaper tuned 360")
    assert rows.count() == 2
    assert opened.page.locator("#cells-filter-told").inner_text() == "2 shown"


def test_the_drawing_moves_and_stops(opened: Opened) -> None:
    still = bar(opened.page)
    opened.page.wait_for_timeout(150)
    assert bar(opened.page) == still  # reduced motion is wanted: it waits to be asked
    play = opened.page.locator("#motion-play")
    play.click()
    assert play.inner_text() == "Pause"
    opened.page.wait_for_timeout(200)
    assert bar(opened.page) != still
    play.click()
    stopped = bar(opened.page)
    opened.page.wait_for_timeout(150)
    assert bar(opened.page) == stopped


def test_the_drawing_moves_by_itself_where_motion_is_welcome(opened: Opened) -> None:
    opened.page.emulate_media(reduced_motion="no-preference")
    opened.page.locator("#precision").scroll_into_view_if_needed()
    opened.page.wait_for_timeout(50)
    opened.page.locator("#motion-picture").scroll_into_view_if_needed()
    opened.page.wait_for_function(
        "() => document.getElementById('motion-play').textContent === 'Pause'"
    )
    before = bar(opened.page)
    opened.page.wait_for_timeout(200)
    assert bar(opened.page) != before
    opened.page.locator("#motion-play").click()
    opened.page.emulate_media(reduced_motion="reduce")


def test_the_crank_is_turned_by_the_keyboard(opened: Opened) -> None:
    slider = opened.page.locator("#motion-slider")
    slider.focus()
    opened.page.keyboard.press("Home")
    before = bar(opened.page)
    for _ in range(5):
        opened.page.keyboard.press("ArrowRight")
    assert bar(opened.page) != before
    assert opened.page.locator("#motion-angle").inner_text() == "110°"  # from 90, by 5 times 4
    assert slider.get_attribute("aria-valuetext") == "crank at 110 degrees"
    cursor = opened.page.locator("#motion-cursor")
    assert cursor.is_visible()
    place = cursor.bounding_box()
    opened.page.keyboard.press("End")
    assert cursor.bounding_box() != place


def test_an_error_is_magnified_by_the_factor(opened: Opened) -> None:
    opened.page.select_option("#motion-steps", "90")
    opened.page.locator("#motion-slider").focus()
    opened.page.keyboard.press("End")
    for box in opened.page.locator("#motion-legend [data-item]").all():
        box.set_checked(box.get_attribute("data-item") == "3")
    exact = corners(opened.page.locator("#motion-picture .reference .link").nth(1))
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


def test_the_parts_of_the_error_are_drawn_and_can_be_switched(opened: Opened) -> None:
    found = drawn(opened.page, "motion-chart")
    assert list(found) == [
        "total",
        "drive",
        "model floor",
        "discretisation",
        "closure: widest gap / L",
    ]
    opened.page.locator("#motion-parts [data-item='drive']").uncheck()
    assert not drawn(opened.page, "motion-chart")["drive"]
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


@pytest.mark.parametrize("opened_up", [False, True])
def test_nothing_runs_out_of_a_phone(phone: Opened, opened_up: bool) -> None:
    phone.restore()
    phone.page.evaluate(
        "open => document.querySelectorAll('details').forEach(each => { each.open = open; })",
        opened_up,
    )
    assert phone.page.evaluate(OUT) == []
    assert phone.page.evaluate("() => document.documentElement.scrollWidth") <= 390


def test_the_theme_is_the_systems_and_the_button_changes_it(opened: Opened) -> None:
    paper = "() => getComputedStyle(document.body).backgroundColor"
    ink = "() => document.getElementById('precision-chart')._fullLayout.font.color"

    def seen() -> tuple[str, str]:
        return opened.page.evaluate(paper), opened.page.evaluate(ink)

    light = seen()
    opened.page.emulate_media(color_scheme="dark")
    opened.page.wait_for_timeout(50)
    dark = seen()
    assert dark[0] != light[0]
    assert dark[1] != light[1]
    button = opened.page.locator("#theme")
    assert button.inner_text() == "Light theme"
    button.click()
    assert seen() == light
    opened.page.reload()
    assert opened.page.evaluate(paper) == light[0]  # it is remembered
    button.click()
    button.click()
    button.click()
    opened.page.emulate_media(color_scheme="light")
    assert opened.page.evaluate(paper) == light[0]  # and forgotten when it is the system's again
    for section in SECTIONS:
        opened.show(section)


def test_every_control_has_a_name_and_is_reached_by_tab(opened: Opened) -> None:
    opened.page.evaluate("() => { document.activeElement.blur(); scrollTo(0, 0); }")
    assert opened.page.evaluate(NAMELESS, CONTROLS) == []
    assert opened.page.evaluate(UNREACHED, CONTROLS) == []


def test_the_first_stop_of_tab_skips_to_the_verdict(opened: Opened) -> None:
    opened.page.locator("body").evaluate("each => { each.tabIndex = -1; each.focus(); }")
    opened.page.keyboard.press("Tab")
    assert opened.page.evaluate("() => document.activeElement.className") == "skip"
    opened.page.keyboard.press("Enter")
    assert opened.page.evaluate("() => document.activeElement.id") == "main"


def test_hostile_text_does_nothing(open_page: Open, small: Stored, tmp_path: Path) -> None:
    path = tmp_path / "evil.html"
    path.write_text(page(evil(small)), encoding="utf-8")
    opened = open_page(path)
    for section in SECTIONS:
        opened.show(section)
    opened.page.evaluate(
        "() => Plotly.Fx.hover('precision-chart', [{curveNumber: 2, pointNumber: 1}])"
    )
    assert opened.page.evaluate("() => window.hacked") is None
    assert opened.page.locator("main img").count() == 0
    assert "{{ 7 * 7 }}" in opened.page.locator("#provenance").inner_text()
    assert opened.said == []


def test_a_script_that_came_in_anyway_is_not_run(opened: Opened) -> None:
    opened.page.evaluate(
        """() => { const script = document.createElement('script');
          script.textContent = 'window.hacked = 1'; document.body.append(script); }"""
    )
    assert opened.page.evaluate("() => window.hacked") is None
    assert any("Content Security Policy" in text for text in opened.said)
    opened.said.clear()


def test_a_page_without_times_and_with_one_scene_works(
    open_page: Open, small: Stored, tmp_path: Path
) -> None:
    cells = small.cells[(small.cells["scene"] == "shaper") & (small.cells["engine"] == "pymunk")]
    times = [c for c in cells if c.startswith("us_per_step") or c == "s_per_turn"]
    untimed = cells.assign(**dict.fromkeys(times, float("nan"))).reset_index(drop=True)
    found = Stored(small.folder, small.manifest, untimed, small.timings)
    path = tmp_path / "small.html"
    path.write_text(page(found), encoding="utf-8")
    opened = open_page(path)
    for section in SECTIONS:
        opened.show(section)
    assert not opened.page.locator("#precision-cost").is_visible()
    assert drawn(opened.page, "precision-chart") == {"pymunk tuned": True}
    assert opened.said == []


def test_printing_draws_what_was_not_scrolled_to(open_page: Open, small_page: Path) -> None:
    found = open_page(small_page).page
    found.evaluate("window.dispatchEvent(new Event('beforeprint'))")
    found.wait_for_function(
        "() => [...document.querySelectorAll('.chart')].every(each => each.querySelector('svg'))"
    )
