"""The figures of regulation: nothing over something else, and the right curves."""

from __future__ import annotations

import numpy as np
import pytest

from analytic.regulation.flywheel import WantedFlywheel, wanted_flywheel
from analytic.regulation.turning_machine import TurningMachine
from models.files import load_scene
from reports.figures.regulation.all_figures import REGULATION_FIGURES
from reports.figures.regulation.regulated import Regulated
from reports.figures.style import styled
from tests.reports.figures.room import has_room


@pytest.fixture(scope="module")
def wanted() -> WantedFlywheel:
    return wanted_flywheel(TurningMachine.of(load_scene("engine-four-stroke")), 0.02)


@pytest.mark.parametrize("name", REGULATION_FIGURES)
def test_words_keep_off_each_other_and_off_the_edge(wanted: WantedFlywheel, name: str) -> None:
    with styled():
        drawn = REGULATION_FIGURES[name](Regulated(wanted.cycle, wanted))
        has_room(drawn)


def test_tangents_touch_the_curve_and_do_not_cross_it(wanted: WantedFlywheel) -> None:
    diagram = wanted.diagram
    for slope, above in zip(wanted.slopes, (True, False), strict=True):
        height, at = diagram.tangent(slope, above=above)
        off = height + slope * diagram.inertia - diagram.work
        assert off[at] == pytest.approx(0.0, abs=1e-9 * np.ptp(diagram.work))
        assert np.all(off >= 0.0 if above else off <= 0.0) or np.min(np.abs(off)) < 1e-9


def test_the_speed_has_a_panel_without_the_flywheel_and_a_closer_one(
    wanted: WantedFlywheel,
) -> None:
    figure = REGULATION_FIGURES["speed"](Regulated(wanted.cycle, wanted))
    far, near = (np.ptp(axes.get_ylim()) for axes in figure.axes)
    assert wanted.bare is not None
    assert far > 20.0 * near
    alone = REGULATION_FIGURES["speed"](Regulated(wanted.cycle))
    assert len(alone.axes) == 1
