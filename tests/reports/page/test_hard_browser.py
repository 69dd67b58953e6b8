"""The page of hard cases in a real browser, from a file, with the network off."""

import copy
import math
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from playwright.sync_api import Locator, Page

from models.array import Array
from reports.drawing.moving import packed
from reports.page.build import stability_page
from reports.stability.matrix import Matrix
from tests.reports.page.conftest import Write
from tests.reports.page.tab import OUT, Tab
from tests.reports.page.test_hard import evil, one_case
from tests.reports.page.test_style import contrast
from tests.worlds.tiers import slow

TRUTH, RUN = "#hard-picture .reference .link", "#hard-picture .overlays .link"
WIDTHS = "each => [each.scrollWidth, each.clientWidth]"
STEPPED = """() => {
  const [choice, row, after] = ['failures', 'row', 'after'].map(
    each => document.getElementById(`hard-${each}`));
  const seen = [];
  const note = () => seen.push([choice.value, row.getBoundingClientRect().top]);
  for (note(); !after.disabled; note()) after.click();
  return seen;
}"""
COLOURS = """all => all.map(each => [getComputedStyle(each).color,
  getComputedStyle(each.closest('.cell')).backgroundColor])"""


def parts(colour: str) -> Array:
    """Red, green and blue of a colour as a browser tells it."""
    numbers = np.array([float(each) for each in re.findall(r"[\d.]+", colour)[:3]])
    return numbers / 255 if colour.startswith("rgb") else numbers


def cell(page: Page, number: int) -> Locator:
    return page.locator(f"#hard-map button[data-run='{number}']")


def as_opened(tab: Tab, path: Path) -> Tab:
    """The page as it was when it was opened: its first failure is shown."""
    tab.visit(path)
    tab.page.evaluate("() => scrollTo(0, 0)")
    tab.page.select_option("#hard-failures", index=1)
    tab.page.select_option("#hard-factor", "1")
    return tab


@pytest.fixture
def opened(wide: Tab, hard_page: Path) -> Tab:
    return as_opened(wide, hard_page)


def worst(matrix: Matrix) -> int:
    """The run of the grid that is farthest off."""
    return max(range(len(matrix.runs)), key=lambda number: matrix.runs[number].error)


def test_a_whole_visit_has_no_error_and_every_control_a_name(wide: Tab, hard_page: Path) -> None:
    wide.open(hard_page).no_error_and_no_request()
    wide.every_control_has_a_name(is_reached_by_tab=False)


def test_the_map_is_one_stop_of_tab_and_arrows_go_from_cell_to_cell(page: Page) -> None:
    here = "() => document.activeElement.dataset.run"
    cell(page, 0).focus()
    visited = []
    for key in ("ArrowRight", "ArrowRight", "ArrowDown", "End", "ArrowUp", "Home", "ArrowLeft"):
        page.keyboard.press(key)
        visited.append(int(page.evaluate(here)))
    # Five runs a line, of which the last is no cell; twenty a case.
    assert visited == [1, 2, 22, 38, 18, 0, 0]
    stops = "all => all.filter(each => each.tabIndex === 0).length"
    assert page.locator("#hard-map [data-run]").evaluate_all(stops) == 1


def test_a_cell_shows_its_run_and_gets_the_focus_back(opened: Tab, matrix: Matrix) -> None:
    number = worst(matrix)
    run = matrix.runs[number]
    opened.page.locator("#hard-close").click()
    assert not opened.page.locator("#hard-panel").is_visible()
    cell(opened.page, number).focus()
    opened.page.keyboard.press("Enter")
    told = opened.text("#hard-panel")
    assert cell(opened.page, number).get_attribute("aria-expanded") == "true"
    error, gap = f"{run.error:.1e}".replace("e+00", "e0"), f"{run.gap:.1e}".replace("e-01", "e-1")
    assert f"Shaper: a heavy ram on a slotted lever: {run.outcome}" in told
    assert "pymunk as-shipped, steps in a turn = 12" in told
    place = f"{run.at_s:.4g} s, crank at {math.degrees(run.at_driver_rad):.1f}°"
    for words in (run.reason, error, gap, place, " 24 steps"):
        assert words in told, words
    for words in ("crankcheck stability shaper-steps", "--engine pymunk", "--at 12"):
        assert words in told, words
    row = opened.page.locator("#hard-row")
    above = "each => each.previousElementSibling.cells[0].textContent"
    assert row.evaluate(above).startswith("Shaper")
    opened.page.locator("#hard-play").focus()
    opened.page.keyboard.press("Escape")
    assert not row.is_visible()
    assert opened.page.evaluate("() => document.activeElement.dataset.run") == str(number)
    assert opened.page.locator("[aria-expanded=true]").count() == 0


def test_a_run_that_holds_has_no_picture_and_is_closed_by_its_cell(opened: Tab, page: Page) -> None:
    cell(page, 0).click()
    assert page.locator("#hard-row").is_visible()
    assert page.locator("#hard-numbers").is_visible()
    assert not page.locator("#hard-figure").is_visible()
    assert "of failures only" in opened.text("#hard-note")
    cell(page, 0).click()
    assert not page.locator("#hard-row").is_visible()


def test_a_cell_stays_under_the_finger_that_chose_it(opened: Tab) -> None:
    # Not all browsers hold a page in place by themselves where something above it goes away.
    opened.page.add_style_tag(content="html { overflow-anchor: none; padding-bottom: 60rem; }")
    target = cell(opened.page, 22)  # below the row that is opened
    target.evaluate("each => scrollBy(0, each.getBoundingClientRect().top - 100)")
    before = target.bounding_box()
    target.click()
    assert target.bounding_box() == pytest.approx(before, abs=1.5)


def test_what_was_opened_is_brought_into_the_window(opened: Tab, matrix: Matrix) -> None:
    target = cell(opened.page, worst(matrix))
    target.evaluate("each => scrollBy(0, each.getBoundingClientRect().bottom - innerHeight + 20)")
    target.click()
    shown, row = target.bounding_box(), opened.page.locator("#hard-row").bounding_box()
    assert shown["y"] >= 0
    assert row["y"] + row["height"] <= 900


def test_the_failures_are_gone_through_one_by_one(opened: Tab, matrix: Matrix) -> None:
    failed = [str(n) for n, run in enumerate(matrix.runs) if run.outcome != "ok"]
    before, after = opened.page.locator("#hard-before"), opened.page.locator("#hard-after")
    assert before.is_disabled()
    after.scroll_into_view_if_needed()
    seen, tops = zip(*opened.page.evaluate(STEPPED), strict=True)
    assert list(seen) == failed
    assert after.is_disabled()
    assert max(tops) - min(tops) <= 2  # the map moves, and what is looked at stays
    before.click()
    assert opened.page.input_value("#hard-failures") == failed[-2]


def test_what_a_bisection_looked_at_is_chosen_in_the_panel(opened: Tab, matrix: Matrix) -> None:
    number = next(n for n, run in enumerate(matrix.runs) if not run.grid)
    chip = opened.page.locator(f"#hard-between [data-near='{number}']")
    chip.click()
    assert "steps in a turn = 60" in opened.text("#hard-told")
    assert chip.get_attribute("aria-pressed") == "true"
    assert opened.page.evaluate("() => document.activeElement.dataset.near") == str(number)


def test_the_picture_moves_beside_the_truth_and_its_error_can_be_magnified(
    opened: Tab, page: Page, matrix: Matrix
) -> None:
    """How it stops again is the same stage's in `test_browser`."""
    page.select_option("#hard-failures", str(worst(matrix)))
    still, truth = opened.drawn(RUN), opened.drawn(TRUTH)
    assert still
    assert truth != still
    opened.elapse(150)
    assert opened.drawn(RUN) == still  # reduced motion is wanted: it waits
    page.locator("#hard-play").click()
    opened.elapse(250)
    assert opened.drawn(RUN) != still
    assert opened.drawn(TRUTH) != truth
    assert page.locator("#hard-picture .trail").count() > 0
    page.select_option("#hard-failures", "1")
    assert page.input_value("#hard-factor") == "1"
    true = opened.drawn(RUN)
    page.select_option("#hard-factor", "10")
    assert opened.drawn(RUN) != true
    assert "m." in opened.text("#hard-readout")


def test_it_moves_by_itself_where_motion_is_welcome(
    opened: Tab, page: Page, matrix: Matrix
) -> None:
    page.emulate_media(reduced_motion="no-preference")
    opened.elapse(0)
    cell(page, worst(matrix)).click()
    assert opened.text("#hard-play") == "Pause"
    before = opened.drawn(RUN)
    opened.elapse(200)
    assert opened.drawn(RUN) != before
    cell(page, 0).click()
    assert page.locator("#hard-play").text_content() == "Play"


def test_the_command_is_copied(opened: Tab) -> None:
    opened.page.context.grant_permissions(["clipboard-read", "clipboard-write"])
    opened.page.locator(".repeat .copy").click()
    opened.page.locator(".repeat .copy", has_text="Copied").wait_for()
    copied = opened.page.evaluate("() => navigator.clipboard.readText()")
    asked = "--engine mujoco --profile as-shipped --at 90"
    assert copied == f"crankcheck stability fourbar-lecture-1-steps {asked}"


def test_all_can_be_read_in_both_themes_without_scrolling_aside(opened: Tab, page: Page) -> None:
    opened.needs_no_scrolling_aside()
    inner, outer = page.locator("#hard .map").evaluate(WIDTHS)
    assert inner <= outer
    for scheme in ("light", "dark"):
        page.emulate_media(color_scheme=scheme)
        found = page.locator("button.cell :is(b, .at)").evaluate_all(COLOURS)
        assert len(found) > 90
        assert min(contrast(parts(ink), parts(ground)) for ink, ground in found) >= 4.5


def test_hostile_text_does_nothing(wide: Tab, matrix: Matrix, written: Write) -> None:
    page = wide.open(written(stability_page(evil(matrix)))).page
    page.locator("#hard-map button").evaluate_all("all => all.forEach(each => each.click())")
    page.select_option("#hard-failures", index=1)
    wide.hostile_text_does_nothing("#hard-told")


def test_a_run_and_a_truth_with_missing_samples_are_drawn_as_far_as_they_go(
    wide: Tab, matrix: Matrix, written: Write
) -> None:
    picture = copy.deepcopy(matrix.pictures[0])
    samples = len(np.asarray(picture.drawing["told"]["at"]))
    rows = np.full((4, samples), 1e-3)
    rows[:, samples // 2 :] = np.nan
    exact = np.ones((4, samples)) * np.linspace(0.0, 0.1, samples)
    exact[:, samples - 5 :] = np.nan
    drawing = {**picture.drawing, "places": packed(exact)}
    broken = replace(picture, drawing=drawing, rows=packed(rows))
    wide.open(written(stability_page(replace(matrix, pictures=(broken,)))))
    wide.page.locator("#hard-slider").focus()
    for key, count in (("Home", 3), ("End", 0)):
        wide.page.keyboard.press(key)
        assert [wide.page.locator(each).count() for each in (TRUTH, RUN)] == [count, count]


@slow("each section has scripts of its own, which `test_browser` and this file run apart")
def test_hard_cases_work_in_the_report_beside_its_other_sections(
    wide: Tab, both_page: Path, matrix: Matrix
) -> None:
    wide.open(both_page, "motion")
    cell(wide.page, worst(matrix)).click()
    wide.elapse(0)
    wide.page.locator("#hard-play").click()
    wide.elapse(100)
    assert wide.text("#motion-play") == "Play"
    assert "Shaper" in wide.text("#hard-told")


def test_nothing_runs_out_of_a_phone(phone: Tab, hard_page: Path) -> None:
    as_opened(phone, hard_page).nothing_runs_out()
    cases, panel = phone.page.locator("#hard .map"), phone.page.locator("#hard-panel")
    inner, outer = cases.evaluate(WIDTHS)
    assert inner > outer  # the map scrolls in its own box
    assert panel.evaluate("each => each.getBoundingClientRect().right") <= 390
    cases.evaluate("each => { each.scrollLeft = 200; }")
    assert panel.evaluate("each => each.getBoundingClientRect().left") >= 0
    cases.evaluate("each => { each.scrollLeft = 0; }")


def test_a_page_without_pictures_and_with_what_is_not_known_works(
    phone: Tab, matrix: Matrix, written: Write
) -> None:
    lost = dict.fromkeys(("error", "gap", "drive", "sine", "dt_s", "wall_s"), float("nan"))
    one = one_case(matrix, outcome="exploded", reason="bang " * 400, **lost)
    phone.open(written(stability_page(one)))
    cell(phone.page, 0).click()
    assert "exploded" in phone.text("#hard-told")
    assert "no moving picture" in phone.text("#hard-note")
    assert phone.page.evaluate(OUT) == []
