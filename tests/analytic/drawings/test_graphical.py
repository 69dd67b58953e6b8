"""Differentiation and integration with ruler and pole: what they give, and their orders."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pytest

from analytic.drawings.graphical import (
    Method,
    Plotted,
    by_chords,
    by_tangents,
    derivative_scale,
    integrated,
    three_graphs,
)
from analytic.kinematics import solve
from models.array import Array
from models.files import load_scene
from models.motion import Order

DIVISIONS = (24, 48, 96, 192)
FIELDS = ("theta", "omega", "alpha")
LECTURE = load_scene("fourbar-lecture-1")


def rocker(order: Order, x: Array) -> Array:
    link = solve(LECTURE, x, links="rocker", points=(), sliders=(), bound=False).links["rocker"]
    return getattr(link, FIELDS[order])


def errors(method: Method, order: Order) -> list[float]:
    """The largest error of the rocker's angle or rate, by the number of divisions."""
    found = []
    for count in DIVISIONS:
        x = np.linspace(0.0, LECTURE.driver.law.period_s, count + 1)
        start = (float(rocker(0, x[:1])[0]), float(rocker(1, x[:1])[0]))
        graph = three_graphs(method, x, rocker, start).graphs[order]
        found.append(float(np.abs(graph.y - rocker(order, graph.x)).max()))
    return found


def fitted(divisions: Sequence[int], found: Sequence[float]) -> float:
    return -float(np.polyfit(np.log(divisions), np.log(found), 1)[0])


@pytest.mark.parametrize(
    ("method", "order", "within"),
    [
        ("chords", 1, 0.02),
        ("chords", 2, 0.1),
        ("tangents", 1, 0.06),
        ("tangents", 2, 0.2),
        ("integration", 1, 0.02),
        ("integration", 0, 0.02),
    ],
)
def test_errors_fall_with_the_square_of_the_divisions(
    method: Method, order: Order, within: float
) -> None:
    assert fitted(DIVISIONS, errors(method, order)) == pytest.approx(2.0, abs=within)


def test_a_straight_graph_is_differentiated_to_rounding_and_a_parabola_by_tangents() -> None:
    x = np.array([0.0, 1.0, 3.0, 4.0, 8.0])
    assert by_chords(Plotted(x, 3.0 * x - 1.0)).y == pytest.approx(3.0)
    tangents = by_tangents(Plotted(x, x**2))
    assert tangents.x == pytest.approx(x[1:-1])
    assert tangents.y == pytest.approx(2.0 * x[1:-1])


def test_what_was_differentiated_is_integrated_back_from_its_start() -> None:
    x = np.array([0.0, 1.0, 3.0, 4.0, 8.0])
    y = np.array([2.0, -1.0, 5.0, 5.5, 0.0])
    assert integrated(x, by_chords(Plotted(x, y)).y, start=2.0).y == pytest.approx(y)


def test_constants_of_integration_are_those_of_the_start() -> None:
    x = np.linspace(0.0, 2.0, 5)
    drawn = three_graphs("integration", x, lambda _, at: np.full_like(at, 3.0), (7.0, -1.0))
    assert drawn.graphs[1].y == pytest.approx(-1.0 + 3.0 * x)
    assert drawn.graphs[0].y == pytest.approx(7.0 - x + 1.5 * x**2)


def test_a_ray_over_the_pole_distance_has_the_slope_of_the_chord_on_paper() -> None:
    graph = Plotted(np.linspace(0.0, 1.0, 5), np.linspace(0.0, 1.0, 5) ** 2)
    mu_x, mu_y, pole = 0.01, 0.02, 25.0
    ordinates = by_chords(graph).y / derivative_scale(pole, mu_x, mu_y)
    on_paper = (np.diff(graph.y) / mu_y) / (np.diff(graph.x) / mu_x)
    assert ordinates / pole == pytest.approx(on_paper)
