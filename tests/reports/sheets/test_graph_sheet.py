"""The sheet of graphs: rays parallel to chords, and what is refused."""

from __future__ import annotations

import re
from xml.etree import ElementTree

import numpy as np
import pytest

from models.errors import CrankcheckError
from models.files import load_scene
from reports.sheets.graph_sheet import GraphSheet, draw_graphs, graphs
from reports.sheets.paper import Paper

A4 = Paper.of("A4")
SVG = "{http://www.w3.org/2000/svg}"


def sheet_of(name: str, of: str, divisions: int = 24) -> GraphSheet:
    return graphs(load_scene(name), of, divisions, A4)


def test_a_ray_over_the_pole_distance_is_parallel_to_its_chord_on_paper() -> None:
    sheet = sheet_of("fourbar-lecture-1", "rocker")
    drawing = ElementTree.fromstring(draw_graphs(sheet, "").saved("svg", "graphs"))
    slopes = []
    for k in range(sheet.divisions):
        group = next(g for g in drawing.iter(f"{SVG}g") if g.get("id") == f"chord-phi-{k}")
        path = group.find(f"{SVG}path").get("d")
        x0, y0, x1, y1 = map(float, re.findall(r"-?\d+\.?\d*", path))
        slopes.append(-(y1 - y0) / (x1 - x0))
    rate = sheet.graphs[1]
    assert rate.rays_mm / rate.pole_mm == pytest.approx(slopes, abs=2e-4)


def test_twice_as_many_parts_are_four_times_as_near() -> None:
    coarse, fine = (sheet_of("fourbar-lecture-1", "rocker", n) for n in (36, 72))
    for one, other in zip(coarse.graphs[1:], fine.graphs[1:], strict=True):
        assert one.off / other.off == pytest.approx(4.0, rel=0.15)


@pytest.mark.parametrize(("name", "of"), [("slider-crank-offset", "C"), ("shaper", "E.y")])
def test_sliders_and_coordinates_are_drawn_within_their_graphs(name: str, of: str) -> None:
    sheet = sheet_of(name, of)
    for graph in sheet.graphs:
        assert np.abs(graph.exact / graph.scale).max() < 30.0
        assert graph.off < 0.15  # of the shaper's quick return in 24 parts
    part = float(sheet.dense_s[-1]) / sheet.divisions / sheet.scale_x
    assert part == pytest.approx(round(part))  # whole millimetres


def test_what_is_let_go_has_no_period_to_draw() -> None:
    with pytest.raises(CrankcheckError, match="let go, and has no period"):
        sheet_of("fourbar-swing", "rocker")


@pytest.mark.parametrize(
    ("of", "divisions", "told"),
    [
        ("roker", 24, "did you mean rocker"),
        ("C.z", 24, "--of C.z"),
        ("rocker", 720, r"at most \d+ fit, or take larger paper"),
    ],
)
def test_what_can_not_be_drawn_is_refused(of: str, divisions: int, told: str) -> None:
    with pytest.raises(CrankcheckError, match=told):
        sheet_of("fourbar-lecture-1", of, divisions)
