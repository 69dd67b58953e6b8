"""Differentiation and integration with ruler and pole: what they give, and their orders."""

from __future__ import annotations

import numpy as np
import pytest

from analytic.drawings.graphical import by_chords, by_tangents, integrate
from analytic.kinematics import solve
from models.files import load_scene

DIVISIONS = (12, 24, 48, 96)


def errors(method: str) -> list[float]:
    """The largest error of the rocker's rate over its largest, by the number of divisions."""
    scene = load_scene("fourbar-lecture-1")
    period, found = scene.driver.law.period_s, []
    for count in DIVISIONS:
        x = np.linspace(0.0, period, count + 1)
        middles = 0.5 * (x[1:] + x[:-1])
        rocker = solve(scene, x, links="rocker", points=(), sliders=()).links["rocker"]
        if method == "integral":
            between = solve(scene, middles, links="rocker", points=(), sliders=()).links["rocker"]
            drawn = integrate(x, between.omega, 20.0, 0.01, 0.1).y
            exact = rocker.theta - rocker.theta[0]
        else:
            differentiate = by_chords if method == "chords" else by_tangents
            got = differentiate(x, rocker.theta, 20.0, 0.01, 0.1)
            drawn = got.y
            exact = solve(scene, got.x, links="rocker", points=(), sliders=()).links["rocker"].omega
        found.append(float(np.abs(drawn - exact).max() / np.abs(exact).max()))
    return found


@pytest.mark.parametrize("method", ["chords", "tangents", "integral"])
def test_errors_fall_with_the_square_of_the_divisions(method: str) -> None:
    slope = -float(np.polyfit(np.log(DIVISIONS), np.log(errors(method)), 1)[0])
    assert slope == pytest.approx(2.0, abs=0.15)


def test_a_straight_graph_is_differentiated_to_rounding_and_a_parabola_by_tangents() -> None:
    x = np.array([0.0, 1.0, 3.0, 4.0, 8.0])
    assert by_chords(x, 3.0 * x - 1.0, 10.0, 1.0, 1.0).y == pytest.approx(3.0)
    tangents = by_tangents(x, x**2, 10.0, 1.0, 1.0)
    assert tangents.y == pytest.approx(2.0 * x[1:-1])


def test_scales_are_those_of_the_book() -> None:
    x = np.linspace(0.0, 1.0, 5)
    drawn = by_chords(x, x**2, pole_mm=25.0, scale_x=0.01, scale_y=0.02)
    assert drawn.scale == pytest.approx(0.02 / (25.0 * 0.01))
    assert drawn.ordinates_mm * drawn.scale == pytest.approx(drawn.y)
    # a ray over the pole distance has the slope of the chord on paper
    on_paper = (np.diff(x**2) / 0.02) / (np.diff(x) / 0.01)
    assert drawn.ordinates_mm / 25.0 == pytest.approx(on_paper)
    total = integrate(x, 0.5 * (x[1:] + x[:-1]), pole_mm=25.0, scale_x=0.01, scale_y=0.02)
    assert total.scale == pytest.approx(25.0 * 0.01 * 0.02)
    assert total.y[-1] == pytest.approx(0.5)
