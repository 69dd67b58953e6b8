"""One fact has the same words and numbers in table, page, figure and README."""

import re
from pathlib import Path

import pytest
from matplotlib.figure import Figure
from matplotlib.text import Text

from reports.figures.convergence import draw
from reports.figures.error_parts import draw as draw_parts
from reports.figures.style import styled
from reports.page import build
from reports.page.comment import summary
from reports.results.overview import Report
from reports.store.reader import read_store
from tests.worlds.command_line import flat, told
from tests.worlds.tiers import slow

README = Path(__file__).parents[3] / "README.md"
SCENE = "fourbar-lecture-1"
UNSEEN = r"a floor below (\S+) (?:rad )?is not excluded by these steps"


@pytest.fixture(scope="module")
def swept(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A sweep with steps that are fine enough to show the floor of MuJoCo as shipped."""
    folder = tmp_path_factory.mktemp("swept") / "out"
    line = f"sweep {SCENE} --engine mujoco --steps-per-turn 180,720,2880 --turns 1 --no-timing"
    told(f"{line} --jobs 1 -o", folder)
    return folder


def words_of(figure: Figure) -> str:
    return flat(" ".join(text.get_text() for text in figure.findobj(Text)))


@slow("a sweep, its page and its figures")
def test_a_floor_has_the_same_words_in_table_page_figure_and_readme(swept: Path) -> None:
    stored = read_store(swept)
    report = Report(stored)
    table, page = summary(stored), flat(build.page(stored))
    with styled():
        figure = words_of(draw(report, SCENE))
        parts = words_of(draw_parts(report, SCENE))
    (row,) = re.findall(rf"\| {SCENE} \| mujoco as-shipped \| ([^|]*) \|", table)
    wrong, floor, unit = re.fullmatch(r"(.*): (floor \S+) (rad)", row).groups()
    readme = flat(README.read_text(encoding="utf-8"))
    assert wrong in readme
    (kept,) = re.findall(r"The four-bar keeps (\S+) rad", readme)
    assert float(kept) == float(f"{float(floor.removeprefix('floor ')):.0e}")
    assert f"{wrong}: {floor} {unit}" in page
    assert floor in figure
    # Tuned, its size is that of the fit, in all of them.
    (row,) = re.findall(rf"\| {SCENE} \| mujoco tuned \| ([^|]*) \|", table)
    (below,) = re.findall(UNSEEN, row)
    line = next(each for each in report.lines_of(SCENE) if each.name == "tuned")
    assert float(below) == float(f"{line.fit.floor_below:.1e}")
    assert row in page
    assert re.search(UNSEEN, parts)
    for text in (table, page, figure, parts):
        assert not re.search("no (model )?floor|none seen", text)


def test_counts_of_cells_say_that_the_tolerance_shrinks_and_have_fixed_errors(store: Path) -> None:
    stored = read_store(store)
    page = flat(build.page(stored))
    assert "a budget that shrinks with its step" in page
    cells = stored.cells
    shipped = cells[(cells["engine"] == "mujoco") & (cells["variant"] == "as-shipped")]
    counts = [int((shipped["place_pure"] <= target).sum()) for target in (1e-3, 1e-4, 1e-6)]
    section = page[page.index("Engines and settings over all scenes") :]
    row = section[section.index("as-shipped") :].partition("</tr>")[0]
    found = re.findall(r">(\d+)(?: of \d+)?</td>", row)[:4]
    assert [int(each) for each in found[1:]] == counts
