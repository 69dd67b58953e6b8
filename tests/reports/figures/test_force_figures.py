"""The figures of forces: nothing over something else, the right numbers, and all of a turn."""

from __future__ import annotations

import itertools
import math
from dataclasses import replace

import numpy as np
import pytest
from matplotlib.transforms import Bbox

from analytic.forces.kinetostatics import forces
from models.characteristics import Tabulated
from models.files import load_scene
from models.laws import ConstantSpeed
from models.loads import Load
from models.scene import Scene
from reports.figures.forces.all_figures import FORCE_FIGURES
from reports.figures.forces.force_turn import force_turn
from reports.figures.forces.torque import mean_torque
from reports.figures.style import styled
from tests.reports.figures.test_layout import boxes

FOUR_STROKES = Tabulated((0.0, 3.0, 6.0, 12.0), (0.0, 5.0, -2.0, 0.0), period=4.0 * math.pi)
WORK = Load("work", "crank", None, FOUR_STROKES, "angle")


@pytest.mark.parametrize("name", ["shaper", "tangent"])
@pytest.mark.parametrize("figure", FORCE_FIGURES)
def test_words_of_a_figure_keep_off_each_other_and_off_the_edge(name: str, figure: str) -> None:
    with styled():
        drawn = FORCE_FIGURES[figure](force_turn(load_scene(name)))
        assert drawn is not None
        found = boxes(drawn)
    page = drawn.bbox
    for text, box in found:
        inside = box.x0 >= -1 and box.y0 >= -1 and box.x1 <= page.x1 + 1 and box.y1 <= page.y1 + 1
        assert inside, f"{text!r} leaves the sheet"
    for (a, first), (b, second) in itertools.combinations(found, 2):
        shared = Bbox.intersection(first, second)
        assert shared is None or min(shared.width, shared.height) < 2.0, f"{a!r} on {b!r}"


def test_a_turn_like_every_other_is_drawn_from_0_to_360_deg(fourbar: Scene) -> None:
    turn = force_turn(fourbar)
    assert turn.ends == (0.0, 360.0)
    assert turn.x[0] <= 0.0
    assert turn.x[-1] >= 360.0
    assert np.all(np.diff(turn.x) > 0.0)
    law = fourbar.driver.law
    assert isinstance(law, ConstantSpeed)
    time_s = (np.radians(turn.x) - law.start_rad) / law.speed_rad_s
    again = forces(fourbar, time_s).torque
    np.testing.assert_allclose(turn.acting.torque[turn.order], again, atol=1e-9)


def test_a_load_of_two_turns_is_drawn_over_the_angles_that_it_is_of(fourbar: Scene) -> None:
    """From 90 to 450 deg: the next turn is another."""
    loaded = replace(fourbar, loads={"work": WORK})
    turn = force_turn(loaded)
    np.testing.assert_allclose(turn.ends, (90.0, 450.0))


def test_the_mean_is_the_work_of_the_loads(fourbar: Scene) -> None:
    """Over a whole turn inertia takes none: what the reduced torque does, the drive does
    against it."""
    steady = replace(WORK, characteristic=replace(FOUR_STROKES, values=(2.0, 2.0, 2.0, 2.0)))
    turn = force_turn(replace(fourbar, loads={"work": steady}))
    assert mean_torque(turn) == pytest.approx(-2.0, rel=1e-9)
    assert mean_torque(force_turn(fourbar)) == 0.0
