"""Figures of a store: nothing over something else, and curves told apart without colour."""

import itertools
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path

import pytest
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.text import Text
from matplotlib.transforms import Bbox

from models.files.reading import find_scene, load_scene, read_text
from reports.figures.drawing import COLOURS, marks
from reports.figures.error_parts import LOOKS
from reports.figures.mechanism import draw
from reports.figures.style import cut, styled, width_in
from reports.requests.figures import FIGURES
from reports.results.lines import label, lines
from reports.results.overview import Report
from reports.store.manifest import Manifest
from reports.store.reader import read_store
from tests.reports.results.made import cell, stored
from tests.worlds.free_store import LASTS_S, SCENE
from tests.worlds.small_store import SCENES
from tests.worlds.tiers import few

DRIVEN = [name for name, drawing in FIGURES.items() if "driven" in drawing.drives]
SHOWN = [(name, scene) for name in DRIVEN for scene in (*SCENES, None)]
EMPTY = {("split", None), ("mechanism", None), *(("profile", scene) for scene in SCENES)}
QUICK = {(n, scene) for n in DRIVEN for scene in (SCENES[1], None)} - {("profile", SCENES[1])}
LET_GO = [name for name, drawing in FIGURES.items() if "let go" in drawing.drives]
LETTERED = ("scotch-yoke", "sixbar-stephenson", "shaper", "tangent")
OTHER = "what differs between figures is that one is of a scene, of all, or of what was let go"


def boxes(figure: Figure) -> list[tuple[str, Bbox]]:
    """Every text that is drawn, with where it stands [pixel]."""
    canvas = FigureCanvasAgg(figure)
    canvas.draw()
    renderer = canvas.get_renderer()
    outside = {text for axes in figure.axes for text in _undrawn(axes)}
    texts = (text for text in figure.findobj(Text) if text.get_visible() and text not in outside)
    return [(t.get_text(), t.get_window_extent(renderer)) for t in texts if t.get_text().strip()]


def _undrawn(axes: Axes) -> Iterator[Text]:
    for axis in (axes.xaxis, axes.yaxis):
        low, high = sorted(axis.get_view_interval())
        for tick in axis.get_major_ticks():
            if not low <= tick.get_loc() <= high:
                yield from (tick.label1, tick.label2)


def has_room(draw: Callable[..., Figure | None], *arguments: object) -> None:
    """Every word on the sheet, and none on another."""
    with styled():
        figure = draw(*arguments)
        assert figure is not None
        found, page = boxes(figure), figure.bbox
    assert len(found) > 5
    for text, box in found:
        inside = box.x0 >= -1 and box.y0 >= -1 and box.x1 <= page.x1 + 1 and box.y1 <= page.y1 + 1
        assert inside, f"{text!r} leaves the sheet"
    for (a, first), (b, second) in itertools.combinations(found, 2):
        shared = Bbox.intersection(first, second)
        assert shared is None or min(shared.width, shared.height) < 2.0, f"{a!r} on {b!r}"


@pytest.fixture(scope="module")
def report(store: Path) -> Report:
    return Report(read_store(store))


def figure_of(report: Report, name: str, scene: str | None) -> Figure | None:
    drawing = FIGURES[name]
    if scene is None:
        return drawing.over_all(report) if drawing.over_all else None
    return drawing.of(report, scene) if drawing.of else None


@pytest.mark.parametrize("shown", few(SHOWN, QUICK, OTHER), ids=str)
def test_words_keep_off_each_other_and_the_edge(
    report: Report, shown: tuple[str, str | None]
) -> None:
    if shown in EMPTY:
        assert figure_of(report, *shown) is None
    else:
        has_room(figure_of, report, *shown)


@pytest.mark.parametrize("name", few(LET_GO, {"let-go", "phase"}, OTHER))
def test_words_of_what_was_let_go_keep_off_each_other(free_store: Path, name: str) -> None:
    has_room(figure_of, Report(read_store(free_store)), name, SCENE)


def test_energies_are_drawn_over_the_whole_run(free_store: Path) -> None:
    drawn = figure_of(Report(read_store(free_store)), "energy", SCENE)
    ends = [axes.get_xlim() for axes in drawn.axes]
    assert ends == [(0.0, pytest.approx(LASTS_S))] * len(ends)


@pytest.mark.parametrize("scene", few(LETTERED, {"shaper", "sixbar-stephenson"}, OTHER))
def test_letters_and_names_of_a_drawing_find_room(scene: str) -> None:
    made = stored([cell(scene, "tuned", 90, 1e-3, 1.0)])
    made = replace(made, manifest=Manifest({scene: read_text(find_scene(scene))}))
    with styled():
        found = boxes(draw(Report(made), scene))
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


def brightness(colour: str) -> float:
    red, green, blue = to_rgb(colour)
    return 0.2126 * red + 0.7152 * green + 0.0722 * blue


@pytest.mark.parametrize("number", [1, 4, 13, 30])
def test_no_two_variants_share_marker_and_dashes(number: int) -> None:
    named = itertools.product(("mujoco", "pymunk", "third"), range(number))
    rows = [cell("a", f"v{i}", 90, 1e-3, 1.0, engine=engine) for engine, i in named]
    found = marks(lines(stored(rows)))
    assert len(found) == 3 * number
    assert len({(mark.marker, mark.dashes) for mark in found.values()}) == 3 * number
    for mark in found.values():
        Line2D([], [], **mark.style)  # matplotlib knows the marker and takes the dashes


def test_engines_differ_in_filling_and_in_dashes_and_drives_in_name(report: Report) -> None:
    found = marks(report.lines)
    for of in (lambda mark: mark.filled, lambda mark: mark.dashes):
        mujoco = {of(mark) for (engine, *_), mark in found.items() if engine == "mujoco"}
        pymunk = {of(mark) for (engine, *_), mark in found.items() if engine == "pymunk"}
        assert len(mujoco) == len(pymunk) == 1
        assert mujoco != pymunk
    assert label(("mujoco", "tuned", "servo")) != label(("mujoco", "tuned", "prescribed"))


def test_variants_and_parts_of_an_error_are_scales_of_brightness_that_print() -> None:
    """But for parts that differ in their dashes."""
    for hue in COLOURS:
        bright = [brightness(colour) for colour in hue]
        assert all(b - a > 0.08 for a, b in itertools.pairwise(bright))
        assert bright[-1] < 0.72  # on white paper
    dashes = [look.get("dashes") for _, look in LOOKS.values()]
    assert len(set(dashes) - {None}) == len(LOOKS) - 2
    total, rest = LOOKS["total"][1], LOOKS["discretisation"][1]
    assert brightness(total["color"]) - brightness(rest["color"]) > 0.5
    assert total["linewidth"] > 2.0
