"""The figures of vibration and of its control: nothing over something else, the right curves."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from matplotlib.figure import Figure

from analytic.elastic.control import control_elastic
from analytic.elastic.discretisation import Modes
from analytic.elastic.over_inertia import over_inertia as inertia_map
from analytic.elastic.over_speeds import OverSpeeds, over_speeds
from analytic.elastic.steady_vibration import SteadyVibration, steady_vibration
from models.controlled import Controlled
from models.files import load_scene
from reports.describe.elastic_course import drawn_course
from reports.figures.elastic.control import draw
from reports.figures.style import styled
from reports.figures.vibration import over_inertia, over_speed, over_turn
from tests.reports.figures.room import has_room
from tests.worlds.tiers import slowly

ONE = Modes(1, 0)
UNTIL_S = 0.4
"""By then the vibration is out, or is not."""


@pytest.fixture(scope="module")
def vibration() -> SteadyVibration:
    return steady_vibration(load_scene("fourbar-elastic"), ONE)


@pytest.fixture(scope="module", params=[14, slowly(27, reason="sharper peaks, nearer to words")])
def speeds(request: pytest.FixtureRequest) -> OverSpeeds:
    return over_speeds(load_scene("fourbar-elastic"), ONE, np.linspace(8.0, 60.0, request.param))


@pytest.fixture(scope="module")
def figures(vibration: SteadyVibration, speeds: OverSpeeds) -> dict[str, Callable[[], Figure]]:
    def mapped() -> Figure:
        factors, few = np.array([1.0, 30.0]), np.linspace(17.0, 19.0, 3)
        return over_inertia.draw(inertia_map(vibration.scene, ONE, few, "rocker", factors))

    return {
        "deflection": lambda: over_turn.draw(vibration),
        "spectrum": lambda: over_turn.draw_spectrum(vibration),
        "speeds": lambda: over_speed.draw(speeds),
        "waterfall": lambda: over_speed.draw_waterfall(speeds),
        "map": mapped,
    }


@pytest.mark.parametrize("name", ["deflection", "spectrum", "speeds", "waterfall", "map"])
def test_words_keep_off_each_other_and_off_the_edge(
    figures: dict[str, Callable[[], Figure]], name: str
) -> None:
    with styled():
        drawn = figures[name]()
        has_room(drawn)


def test_the_curve_is_the_deflection(vibration: SteadyVibration) -> None:
    with styled():
        (axes,) = over_turn.draw(vibration).axes
    curve = np.asarray(axes.lines[0].get_ydata(), dtype=float)
    swing = vibration.swings["coupler"]
    assert np.abs(curve).max() == pytest.approx(1e3 * swing.largest_m, rel=2e-3)
    assert curve[0] == pytest.approx(curve[-1], abs=1e-9)
    assert curve[0] == pytest.approx(1e3 * swing.middle[0], abs=1e-9)


def test_control_takes_out_what_rings_without_it() -> None:
    scene = load_scene("fourbar-elastic-controlled")
    motion = control_elastic(scene, UNTIL_S, Modes(1))
    course = drawn_course(motion, np.linspace(0.0, UNTIL_S, 201))
    assert course.uncontrolled is not None
    law = scene.driver.law
    assert isinstance(law, Controlled)
    late = course.time_s > 0.9 * UNTIL_S
    with_it, without = (
        np.ptp(each.links[scene.driver.link].omega[late])
        for each in (course.motion, course.uncontrolled)
    )
    assert with_it < 0.2 * without
    with styled():
        figure = draw(course)
    _, speeds, ahead = figure.axes
    assert [len(line.get_ydata()) for line in speeds.lines[:2]] == [201, 201]  # type: ignore[arg-type]
    assert ahead.get_ylabel() == "crank ahead by [deg]"
    assert draw(replace(course, uncontrolled=None)) is None
