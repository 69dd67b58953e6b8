"""Polygons at a time: of what is let go and of what follows a law, against how that moves."""

from __future__ import annotations

import numpy as np
import pytest

from analytic.drawings.drawn_polygons import polygons_of
from models.errors import CrankcheckError
from models.files import load_scene
from reports.drawing.true_motion import true_motion
from reports.sheets.polygons.polygon_instant import placed_at_angle, placed_at_time


@pytest.mark.parametrize(
    ("name", "at_s"),
    [
        ("fourbar-double-rocker-swing", 0.9),  # it has turned back at a limit, on another branch
        ("fourbar-pulse", 1.3),
        ("fourbar-double-rocker", 0.3),  # it swings by a law
        ("tangent", 0.1),
        ("fourbar-elastic-controlled", 0.2),
    ],
)
def test_polygons_at_a_time_are_the_motion_s_rates(name: str, at_s: float) -> None:
    scene = load_scene(name)
    motion = true_motion(scene, np.array([at_s]))
    drawn = polygons_of(placed_at_time(scene, at_s))
    assert drawn.undetermined == ()
    for polygon in (drawn.velocity, drawn.acceleration):
        for image in polygon.images.values():
            for point, end in image.items():
                exact = getattr(motion.points[point], polygon.quantity)[0]
                assert end == pytest.approx(exact, abs=1e-9 * polygon.largest)


def test_what_is_let_go_from_rest_has_accelerations_alone() -> None:
    drawn = polygons_of(placed_at_time(load_scene("press-motor"), 0.0))
    assert drawn.velocity.largest == 0.0
    assert drawn.acceleration.largest > 1.0


def test_what_is_let_go_needs_a_time_or_a_speed() -> None:
    scene = load_scene("fourbar-swing")
    with pytest.raises(CrankcheckError, match="give --at-s for an instant of its motion"):
        placed_at_angle(scene, 90.0)
    assert placed_at_angle(scene, 90.0, 2.0).driver.omega == 2.0


def test_a_driver_at_rest_has_nothing_to_draw() -> None:
    scene = load_scene("whitworth")
    with pytest.raises(CrankcheckError, match="other than 0"):
        placed_at_angle(scene, 90.0, 0.0)


@pytest.mark.parametrize("omega", [1e200, 5e-324, float("nan")])
def test_a_speed_out_of_all_bounds_is_refused(omega: float) -> None:
    with pytest.raises(CrankcheckError, match="from 1e-09 to 1e\\+09 either way"):
        placed_at_angle(load_scene("whitworth"), 90.0, omega)


def test_a_time_that_takes_too_long_to_come_to_is_refused() -> None:
    with pytest.raises(CrankcheckError, match="give a time up to 100 s"):
        placed_at_time(load_scene("fourbar-swing"), 1000.0)
