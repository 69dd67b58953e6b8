"""Nothing in a figure stands over something else, or over the edge."""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import pytest
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.text import Text
from matplotlib.transforms import Bbox

from models.files import find_scene, load_scene, read_text
from reports.figures.all_figures import FIGURES
from reports.figures.mechanism import draw
from reports.figures.style import cut, styled, width_in
from reports.results.overview import Report
from reports.store.manifest import Manifest
from reports.store.reader import read_store
from tests.reports.results.made import cell, stored
from tests.worlds.free_store import SCENE
from tests.worlds.small_store import SCENES

SHOWN = [
    (name, scene)
    for name, drawing in FIGURES.items()
    if "driven" in drawing.drives
    for scene in (*SCENES, None)
]
LET_GO = [name for name, drawing in FIGURES.items() if "let go" in drawing.drives]


def figure_of(report: Report, name: str, scene: str | None) -> Figure | None:
    drawing = FIGURES[name]
    if scene is None:
        return drawing.over_all(report) if drawing.over_all else None
    return drawing.of(report, scene) if drawing.of else None


def boxes(figure: Figure) -> list[tuple[str, Bbox]]:
    """Every text that is drawn, with where it stands [pixel]."""
    canvas = FigureCanvasAgg(figure)
    canvas.draw()
    renderer = canvas.get_renderer()
    outside = {text for axes in figure.axes for text in _undrawn(axes)}
    texts = (text for text in figure.findobj(Text) if text.get_visible() and text not in outside)
    return [(t.get_text(), t.get_window_extent(renderer)) for t in texts if t.get_text().strip()]


def _undrawn(axes: Axes) -> Iterator[Text]:
    """The labels of ticks beyond the ends of their axis."""
    for axis in (axes.xaxis, axes.yaxis):
        low, high = sorted(axis.get_view_interval())
        for tick in axis.get_major_ticks():
            if not low <= tick.get_loc() <= high:
                yield from (tick.label1, tick.label2)


@pytest.mark.parametrize(("name", "scene"), SHOWN)
def test_words_keep_off_each_other_and_off_the_edge(
    report: Report, name: str, scene: str | None
) -> None:
    with styled():
        figure = figure_of(report, name, scene)
        if figure is None:
            assert (name, scene is None) in {
                ("split", True),
                ("mechanism", True),
                ("profile", False),
            }
            return
        _has_room(figure)


@pytest.mark.parametrize("name", LET_GO)
def test_words_of_what_was_let_go_keep_off_each_other(free_store: Path, name: str) -> None:
    with styled():
        figure = figure_of(Report(read_store(free_store)), name, SCENE)
        assert figure is not None
        _has_room(figure)


def _has_room(figure: Figure) -> None:
    """Every word on the sheet, and none on another."""
    found, page = boxes(figure), figure.bbox
    assert len(found) > 5
    for text, box in found:
        inside = box.x0 >= -1 and box.y0 >= -1 and box.x1 <= page.x1 + 1 and box.y1 <= page.y1 + 1
        assert inside, f"{text!r} leaves the sheet"
    for (a, first), (b, second) in itertools.combinations(found, 2):
        shared = Bbox.intersection(first, second)
        assert shared is None or min(shared.width, shared.height) < 2.0, f"{a!r} on {b!r}"


@pytest.mark.parametrize("scene", ["scotch-yoke", "sixbar-stephenson", "shaper", "tangent"])
def test_letters_and_names_of_a_drawing_find_room(scene: str) -> None:
    made = stored([cell(scene, "tuned", 90, 1e-3, 1.0)])
    made = replace(made, manifest=Manifest({scene: read_text(find_scene(scene))}))
    with styled():
        figure = draw(Report(made), scene)
        assert figure is not None
        found = boxes(figure)
    names = {text for text, _ in found}
    for link in load_scene(scene).links.values():
        assert {link.name, *link.points} <= names
    for (a, first), (b, second) in itertools.combinations(found, 2):
        assert Bbox.intersection(first, second) is None, f"{a!r} on {b!r}"


def test_a_name_that_is_too_long_loses_its_middle() -> None:
    name = "a variant with a name that no column has room for, iterations=20"
    short = cut(name, 1.5)
    assert width_in(short) <= 1.5 < width_in(name)
    assert short.startswith("a variant")
    assert short.endswith("iterations=20")
    assert "…" in short
    assert cut("short", 1.5) == "short"
