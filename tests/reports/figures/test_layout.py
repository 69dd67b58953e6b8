"""Nothing in a figure stands over something else, or over the edge."""

from __future__ import annotations

import itertools
from dataclasses import replace
from pathlib import Path

import pytest
from matplotlib.figure import Figure
from matplotlib.transforms import Bbox

from models.files import find_scene, load_scene, read_text
from reports.figures.all_figures import FIGURES
from reports.figures.mechanism import draw
from reports.figures.style import cut, styled, width_in
from reports.results.overview import Report
from reports.store.manifest import Manifest
from reports.store.reader import read_store
from tests.reports.figures.room import boxes, has_room
from tests.reports.results.made import cell, stored
from tests.worlds.free_store import SCENE
from tests.worlds.small_store import SCENES
from tests.worlds.tiers import few

DRIVEN = [name for name, drawing in FIGURES.items() if "driven" in drawing.drives]
SHOWN = [(name, scene) for name in DRIVEN for scene in (*SCENES, None)]
EMPTY = {("split", None), ("mechanism", None), *(("profile", scene) for scene in SCENES)}
QUICK = {
    *((name, SCENES[1]) for name in DRIVEN if name != "profile"),
    *((name, None) for name in DRIVEN),
}
LET_GO = [name for name, drawing in FIGURES.items() if "let go" in drawing.drives]
OTHER = "what differs between figures is that one is of a scene, of all, or of what was let go"


def figure_of(report: Report, name: str, scene: str | None) -> Figure | None:
    drawing = FIGURES[name]
    if scene is None:
        return drawing.over_all(report) if drawing.over_all else None
    return drawing.of(report, scene) if drawing.of else None


@pytest.mark.parametrize("shown", few(SHOWN, QUICK, OTHER), ids=str)
def test_words_keep_off_each_other_and_off_the_edge(
    report: Report, shown: tuple[str, str | None]
) -> None:
    with styled():
        figure = figure_of(report, *shown)
        if shown in EMPTY:
            assert figure is None
        else:
            has_room(figure)


@pytest.mark.parametrize("name", few(LET_GO, {"let-go", "phase"}, OTHER))
def test_words_of_what_was_let_go_keep_off_each_other(free_store: Path, name: str) -> None:
    with styled():
        has_room(figure_of(Report(read_store(free_store)), name, SCENE))


@pytest.mark.parametrize(
    "scene",
    few(
        ["scotch-yoke", "sixbar-stephenson", "shaper", "tangent"],
        {"shaper", "sixbar-stephenson"},
        OTHER,
    ),
)
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
