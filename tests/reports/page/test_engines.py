"""The page of many engines: their table on top, legends by formulation, one of them alone."""

from dataclasses import replace
from pathlib import Path

import pytest

from reports.page.build import render, stability_page
from reports.page.comment import summary
from reports.page.sections import SECTIONS
from reports.page.sections.engines import held
from reports.page.sections.section import PageReport
from reports.stability.matrix import Matrix
from reports.store.reader import Stored
from tests.reports.page.conftest import Write
from tests.reports.page.tab import Tab
from tests.reports.page.test_page import JUDGED
from tests.reports.results.made import cell, stored

ENGINES = ("mujoco", "pymunk", "exudyn", "box2d", "rapier", "bullet", "drake", "dart", "simbody")
SHOWN = """id => [...new Set(document.getElementById(id).data.filter(each => each.visible !== false
    && each.x.length).map(each => each.name.split(' ')[0]))]"""


@pytest.fixture(scope="module")
def nine() -> Stored:
    return stored(
        cell("fourbar", variant, steps, at * (90 / steps) ** 2, 2.0,
             **JUDGED | {"engine": engine, "gated": variant == "tuned"})
        for at, engine in enumerate(ENGINES, 1)
        for variant in ("as-shipped", "tuned")
        for steps in (90, 180, 360)
    )  # fmt: skip


@pytest.fixture(scope="module")
def nine_page(nine: Stored, written: Write) -> Path:
    report = PageReport(nine)
    names = ("engines", "verdict", "precision", "convergence", "stability")
    return written(render(report, [SECTIONS[name](report) for name in names]))


def many(matrix: Matrix) -> Matrix:
    """The runs of two engines, and again as those of a third."""
    third = tuple(replace(run, engine="dart") for run in matrix.runs if run.engine == "pymunk")
    return replace(matrix, runs=(*matrix.runs, *third))


def test_the_table_of_engines_follows_the_verdict_and_is_in_the_comment(
    nine: Stored, matrix: Matrix
) -> None:
    text = summary(nine, matrix)
    assert text.index("### Engines") < text.index("### What to set")
    assert "box2d 4.0.0, single precision | constraint impulses" in text
    assert list(SECTIONS)[:2] == ["verdict", "engines"]
    assert "### Engines" not in summary(replace(nine, cells=nine.cells[:12]))


def test_hard_cases_held_are_counted(matrix: Matrix) -> None:
    assert held(None, "mujoco").remark == held(matrix, "dart").remark == "not run"
    assert held(matrix, "mujoco").number == "100 %"
    assert held(matrix, "mujoco").remark == "3 of 3 cases throughout"
    first = next(run for run in matrix.runs if (run.engine, run.profile) == ("mujoco", "tuned"))
    runs = {
        "diverged": "2 of 3 cases throughout",
        "unsupported": "3 of 3 cases throughout; 1 value unsupported",
    }
    for outcome, remark in runs.items():
        other = tuple(replace(run, outcome=outcome) if run is first else run for run in matrix.runs)
        assert held(replace(matrix, runs=other), "mujoco").remark == remark


def test_the_map_of_many_engines_has_a_row_for_each(matrix: Matrix) -> None:
    few, text = stability_page(matrix), stability_page(many(matrix))
    assert 'class="by-engine"' not in few
    assert text.count('<tr class="case">') == 3 * len(matrix.cases)
    assert text.count('id="hard-row"') == 1


def test_a_click_on_an_engine_shows_it_alone_in_all_diagrams_and_another_all(
    wide: Tab, nine_page: Path
) -> None:
    page = wide.open(nine_page, "precision", "convergence").page
    families = page.locator("#precision-legend .family > .quietly").all_inner_texts()
    assert families == ["soft constraints", "constraint impulses", "constraint equations"]
    assert page.locator("#precision-legend").inner_text().count("single precision") == 2
    charts = ("precision-chart", "convergence-chart")
    before = [page.evaluate(SHOWN, chart) for chart in charts]
    name = page.locator("#precision-legend button", has_text="rapier")
    page.locator("#convergence-legend [data-item='0']").uncheck()
    name.click()
    for chart in charts:
        assert set(page.evaluate(SHOWN, chart)) - {"front"} == {"rapier"}
    assert name.get_attribute("aria-pressed") == "true"
    name.click()
    assert [page.evaluate(SHOWN, chart) for chart in charts] == before
    assert not page.locator("#convergence-legend [data-item='0']").is_checked()
    wide.needs_no_scrolling_aside()
    wide.every_control_has_a_name(is_reached_by_tab=False)


def test_the_tables_of_nine_engines_need_no_scrolling(wide: Tab, nine_page: Path) -> None:
    page = wide.visit(nine_page).page
    over = "all => all.filter(each => each.scrollWidth > each.clientWidth + 1).length"
    assert page.locator(".scroll").evaluate_all(over) == 0


def test_nothing_runs_out_of_a_phone(phone: Tab, nine_page: Path) -> None:
    phone.open(nine_page, "precision").nothing_runs_out()
