"""The page of hard cases as a file, what its map says, also of odd matrices; and in a real browser,
with the network off."""

import copy
import math
import re
from collections import Counter
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from playwright.sync_api import Locator, Page

from reports.drawing.moving import embedded, packed
from reports.page import build
from reports.page.build import page, stability_page
from reports.page.sections import SECTIONS
from reports.page.sections.hard import SIGNS, hard, heat, same, shade
from reports.page.sections.section import fitting
from reports.stability.grades import MEANINGS
from reports.stability.matrix import FILE, OUTCOMES, Matrix, read_matrix, to_json
from reports.stability.running import command
from reports.store.reader import Stored
from tests.reports.page.conftest import Write
from tests.reports.page.hostile import EVIL, Outline, embedded_in, shown_and_not_read, stands_alone
from tests.reports.page.tab import Tab


@pytest.fixture(scope="module")
def text(hard_page: Path) -> str:
    return hard_page.read_text(encoding="utf-8")


def buttons(text: str) -> dict[int, dict[str, str | None]]:
    """The cells of the map by the number of their run."""
    cells = [each for each in Outline(text).named("button") if "data-run" in each]
    return {int(each["data-run"]): each for each in cells}


def one_case(matrix: Matrix, **run: object) -> Matrix:
    """The first run of a matrix alone, changed, with its case of one value."""
    first = replace(matrix.runs[0], **run)
    case = replace(matrix.cases[0], values=(first.value,), labels=(first.label,))
    return Matrix(matrix.facts, (case,), (first,), ())


def test_the_page_stands_alone_with_every_sign(text: str, matrix: Matrix, tmp_path: Path) -> None:
    assert set(SIGNS) == set(MEANINGS) == set(OUTCOMES)
    assert len(set(SIGNS.values())) == len(OUTCOMES)
    stands_alone(text, ["hard"])
    assert "3 cases, 60 runs" in text
    assert all(value in text for value in matrix.facts.values())
    assert len(text) < 500_000  # without Plotly
    (tmp_path / FILE).write_text(to_json(matrix))
    assert stability_page(read_matrix(tmp_path)) == text


def test_there_is_a_cell_for_each_run_and_it_says_how_it_went(text: str, matrix: Matrix) -> None:
    found = buttons(text)
    grid = {number for number, run in enumerate(matrix.runs) if run.grid}
    assert set(found) == grid
    assert len(grid) < len(matrix.runs)
    for number in grid:
        run, cell = matrix.runs[number], found[number]
        words, classes = cell["aria-label"] or "", (cell["class"] or "").split()
        assert f"{run.value:g}, {run.engine} {run.profile}: {run.outcome}" in words
        assert ("(holds)" in words) == (run.outcome == "ok") == ("held" in classes)
        assert f"error {run.error:.1e}".replace("e-0", "e-").replace("e+00", "e0") in words
        assert run.reason in words
        assert f"s{shade(run.error)}" in classes
        assert f"o-{run.outcome}" in classes
        assert ("pictured" in classes) == (run.outcome != "ok")


def test_the_map_is_a_table_of_cases_by_engine_and_profile(text: str, matrix: Matrix) -> None:
    scopes = Counter(each.get("scope") for each in Outline(text).named("th"))
    counts = [scopes[each] for each in ("row", "rowgroup", "colgroup", "col")]
    assert counts == [len(matrix.cases), 2, 2, 1 + 4]
    found = heat(matrix)
    assert [column.name for column in found.columns][:2] == ["mujoco as-shipped", "mujoco tuned"]
    assert found.columns[1].words == "holds 3 of 3 throughout"
    assert found.columns[0].words == "holds 0 of 3 throughout"
    for one in matrix.critical:
        assert one.words in text


def test_each_failure_has_its_picture_and_a_truth_is_held_once(text: str, matrix: Matrix) -> None:
    found = embedded_in(text, "hard")
    failed = [n for n, run in enumerate(matrix.runs) if run.outcome != "ok"]
    assert sorted(picture["run"] for picture in found["pictures"]) == failed
    assert len(failed) > 10
    assert len(found["drawings"]) < len(failed)
    assert set(map(str, failed)) <= {each["value"] for each in Outline(text).named("option")}
    assert found["runs"][failed[0]]["command"] == command(matrix.runs[failed[0]])


def single(matrix: Matrix, **run: object) -> tuple[str, str, list[str]]:
    """The page of the first run alone, changed; what its cell says, and the classes of that."""
    text = stability_page(one_case(matrix, **run))
    (cell,) = buttons(text).values()
    return text, cell["title"] or "", (cell["class"] or "").split()


def test_what_is_no_number_is_shown(matrix: Matrix) -> None:
    for error in (math.nan, math.inf, None):
        _, told, classes = single(matrix, error=error)
        assert "blank" in classes
        assert "error \N{EN DASH}" in told
    lost = dict.fromkeys(
        ("error", "gap", "drive", "sine", "at_s", "at_driver_rad", "dt_s", "wall_s"), math.nan
    )
    found = embedded_in(single(matrix, **lost)[0], "hard")["runs"][0]
    assert {found[name] for name in (*lost, "at_driver")} == {None}
    assert [same(None, math.nan), same(1.0, math.nan), same(1.0, None)] == [True, False, False]
    assert single(matrix, value=math.nan)[1].startswith("nan, mujoco")


def test_an_outcome_of_good_engines_is_held_and_an_unknown_one_shown(matrix: Matrix) -> None:
    text, told, classes = single(matrix, outcome=f"{EVIL} exploded")
    assert "o-strange" in classes
    assert "exploded (fails)" in told
    assert "unknown on this page" in text
    assert Outline(text).named("img") == []
    locked = one_case(matrix, outcome="locked")
    right = replace(locked, cases=(replace(locked.cases[0], good=("locked",)),))
    for one, state in ((locked, "failed"), (right, "held")):
        text, _, classes = single(one)
        assert {state, "o-locked"} <= set(classes)
    assert "right: locked" in text


def test_a_value_that_was_not_run_or_only_by_a_bisection_says_so(matrix: Matrix) -> None:
    first, *others = matrix.runs
    for runs in (others, [replace(first, grid=False), *others]):
        found = replace(matrix, runs=tuple(runs))
        assert 'title="360: not run"' in stability_page(found)
        assert heat(found).columns[0].words == "holds 0 of 3 throughout"


def test_a_matrix_of_no_run_has_a_page_and_of_one_with_its_long_reason(matrix: Matrix) -> None:
    nothing = stability_page(Matrix({}, (), (), ()))
    assert "0 cases, 0 runs" in nothing
    reason = "it broke " * 300
    text, told, _ = single(matrix, reason=reason)
    assert Outline(text).open == Outline(nothing).open == []
    assert "hard-failures" not in text.split("<script>")[2]
    assert "1 case, 1 run;" in text
    assert len(told) < 400  # in the map it is cut
    assert embedded_in(text, "hard")["runs"][0]["reason"] == reason


def evil(matrix: Matrix) -> Matrix:
    def marked(one: Any, *fields: str, **other: object) -> Any:
        names = {name: f"{EVIL}{getattr(one, name)}" for name in (*fields, "engine", "profile")
                 if hasattr(one, name)}  # fmt: skip
        return replace(one, **names, **other)

    told = ("name", "group", "title", "source", "truth", "expected", "parameter", "unit")
    labels = [tuple(f"{EVIL}{label}" for label in case.labels) for case in matrix.cases]
    drawings = [{**one.drawing, "name": EVIL} for one in matrix.pictures]
    return Matrix(
        {EVIL: EVIL, "made": EVIL},
        tuple(marked(x, *told, labels=own) for x, own in zip(matrix.cases, labels, strict=True)),
        tuple(marked(x, "case", label=EVIL, reason=EVIL) for x in matrix.runs),
        tuple(marked(x, "case", words=EVIL) for x in matrix.critical),
        tuple(marked(x, "case", title=EVIL, drawing=own)
              for x, own in zip(matrix.pictures, drawings, strict=True)),
    )  # fmt: skip


def test_hostile_text_is_shown_and_not_read(matrix: Matrix) -> None:
    text = stability_page(evil(matrix))
    shown_and_not_read(text, scripts=2)  # the theme, ours
    assert len(buttons(text)) == 48


def test_the_hard_cases_stand_in_the_report_change_no_other_section_and_give_way(
    tiny: Stored, tiny_page: Path, matrix: Matrix, monkeypatch: pytest.MonkeyPatch
) -> None:
    without, found = tiny_page.read_text(encoding="utf-8"), page(tiny, matrix)
    absent = ("engines", "reading_forces", "free", "elastic", "cams")
    there = [name for name in SECTIONS if name not in absent]
    assert Outline(found).sections() == there
    parts = [re.findall(r"<section.*?</section>", text, re.DOTALL) for text in (without, found)]
    assert parts[0] == [part for part in parts[1] if not part.startswith('<section id="hard"')]
    most = len(found.encode()) - 30_000  # where the report gets too large
    monkeypatch.setattr(build, "MOST_BYTES", most)
    less = page(tiny, matrix)
    assert len(less.encode()) <= most
    kept, every = (embedded_in(each, "hard")["pictures"] for each in (less, found))
    assert 0 < len(kept) < len(every)
    assert "to keep the page small" in less.lower()


def test_what_does_not_fit_makes_way_and_the_first_failures_stay(matrix: Matrix) -> None:
    room = 30_000
    section = hard(matrix, room)
    numbers = [picture["run"] for picture in section.embedded["pictures"]]
    assert 0 < len(numbers) < len(matrix.pictures)
    lines = {matrix.runs[n].case + matrix.runs[n].profile for n in numbers}
    assert len(lines) > len(numbers) / 3
    shown = [section.embedded[name] for name in ("pictures", "drawings")]
    assert len(embedded(shown)) < room + 40 * len(numbers)
    assert section.words["thinned"]
    assert not hard(matrix).words["thinned"]
    assert fitting([0, 1, 2], [5, 5, 1], 6) == [0, 2]
    assert fitting([1, 2, 0], [5, 5, 1], 6) == [1, 2]


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
    place = f"{run.at_s:.4g} s, crank at {math.degrees(run.at_driver_rad):.1f}°"
    for words in (f"Shaper: a heavy ram on a slotted lever: {run.outcome}", run.reason,
                  f"{run.error:.1e}".replace("e+00", "e0"), place, " 24 steps",
                  "crankcheck stability shaper-steps", "--engine pymunk", "--at 12"):  # fmt: skip
        assert words in told, words
    row = opened.page.locator("#hard-row")
    opened.page.locator("#hard-play").focus()
    opened.page.keyboard.press("Escape")
    assert not row.is_visible()
    assert opened.page.evaluate("() => document.activeElement.dataset.run") == str(number)
    held = cell(opened.page, 0)
    held.click()
    assert opened.page.locator("#hard-numbers").is_visible()
    assert not opened.page.locator("#hard-figure").is_visible()
    assert "of failures only" in opened.text("#hard-note")
    held.click()
    assert not row.is_visible()


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
    opened.page.select_option("#hard-failures", failed[0])
    number = next(n for n, run in enumerate(matrix.runs) if not run.grid)
    chip = opened.page.locator(f"#hard-between [data-near='{number}']")
    chip.click()
    assert "steps in a turn = 60" in opened.text("#hard-told")  # what a bisection looked at
    assert chip.get_attribute("aria-pressed") == "true"


def test_the_picture_moves_and_magnifies_errors(opened: Tab, page: Page, matrix: Matrix) -> None:
    """How it moves by itself, and stops again, is the same stage's in `test_browser`."""
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
    true = opened.drawn(RUN)
    page.select_option("#hard-factor", "10")
    assert opened.drawn(RUN) != true
    assert "m." in opened.text("#hard-readout")


def test_the_command_is_copied(opened: Tab) -> None:
    opened.page.context.grant_permissions(["clipboard-read", "clipboard-write"])
    opened.page.locator(".repeat .copy").click()
    opened.page.locator(".repeat .copy", has_text="Copied").wait_for()
    copied = opened.page.evaluate("() => navigator.clipboard.readText()")
    asked = "--engine mujoco --profile as-shipped --at 90"
    assert copied == f"crankcheck stability fourbar-lecture-1-steps {asked}"


def test_hostile_text_does_nothing(wide: Tab, matrix: Matrix, written: Write) -> None:
    page = wide.open(written(stability_page(evil(matrix)))).page
    page.locator("#hard-map button").evaluate_all("all => all.forEach(each => each.click())")
    page.select_option("#hard-failures", index=1)
    wide.hostile_text_does_nothing("#hard-told")


def test_what_is_missing_is_told_and_not_drawn(wide: Tab, matrix: Matrix, written: Write) -> None:
    picture = copy.deepcopy(matrix.pictures[0])
    samples = len(np.asarray(picture.drawing["told"]["at"]))
    rows = np.full((4, samples), 1e-3)
    rows[:, samples // 2 :] = np.nan
    exact = np.ones((4, samples)) * np.linspace(0.0, 0.1, samples)
    exact[:, samples - 5 :] = np.nan
    drawing = {**picture.drawing, "places": packed(exact)}
    broken = replace(picture, drawing=drawing, rows=packed(rows))
    lost = dict.fromkeys(("error", "gap", "drive", "sine", "dt_s", "wall_s"), math.nan)
    runs = tuple(replace(run, **lost) for run in matrix.runs)
    wide.open(written(stability_page(replace(matrix, pictures=(broken,), runs=runs))))
    assert "NaN" not in wide.text("#hard-told")
    wide.page.locator("#hard-slider").focus()
    for key, count in (("Home", 3), ("End", 0)):
        wide.page.keyboard.press(key)
        assert [wide.page.locator(each).count() for each in (TRUTH, RUN)] == [count, count]


def test_nothing_runs_out_of_a_phone(phone: Tab, hard_page: Path) -> None:
    as_opened(phone, hard_page).nothing_runs_out()
    cases = phone.page.locator("#hard .map")
    inner, outer = cases.evaluate(WIDTHS)
    assert inner > outer  # the map scrolls in its own box
    cases.evaluate("each => { each.scrollLeft = 200; }")
    place = phone.page.locator("#hard-panel").bounding_box()
    assert 0 <= place["x"] < place["x"] + place["width"] <= 390  # and the panel stays
