"""Instant centres, circles and centrodes, each by its definition."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from analytic.drawings.centrodes import centrodes
from analytic.drawings.curvature_circles import curvature_circles
from analytic.drawings.drawn_polygons import DrawnPolygons, draw_polygons
from analytic.drawings.instant_centres import instant_centres
from analytic.drawings.placed_mechanism import DriverState
from analytic.kinematics import solve
from models.errors import CrankcheckError
from models.files import load_scene, shipped

ANGLES = (0.31, 1.07, 2.2)


def drawn_at(name: str, theta: float, alpha: float = 0.0) -> DrawnPolygons:
    return draw_polygons(load_scene(name), DriverState(theta, 10.0, alpha))


@pytest.mark.parametrize("name", [n for n in shipped() if "double-rocker" not in n])
def test_in_an_instant_centre_both_bodies_have_one_velocity(name: str) -> None:
    for theta in ANGLES:
        drawn = drawn_at(name, theta)
        centres = instant_centres(drawn.placement)
        bodies = len(drawn.placement.structure.bodies) + 1
        assert len(centres) == bodies * (bodies - 1) // 2
        for pair, centre in centres.items():
            one, other = (drawn.rates[body] for body in pair)
            scale = 10.0 * drawn.placement.scene.longest_m
            if centre.place is None or np.hypot(*centre.place) > 1e6:
                assert abs(one.omega - other.omega) < 1e-6 * 10.0  # no turning against each other
                continue
            gap = one.velocity_at(centre.place) - other.velocity_at(centre.place)
            away = 1.0 + float(np.hypot(*centre.place)) / drawn.placement.scene.longest_m
            assert np.hypot(*gap) < 1e-9 * scale * away**2, (pair, centre)


def test_three_bodies_have_their_centres_on_a_line() -> None:
    centres = instant_centres(drawn_at("fourbar-lecture-1", 1.0).placement)
    a, b, c = (
        np.array([*centres[frozenset(pair)].place, 1.0])
        for pair in (("ground", "crank"), ("crank", "rocker"), ("ground", "rocker"))
    )
    assert np.linalg.det([a, b, c]) == pytest.approx(0.0, abs=1e-12)


@pytest.mark.parametrize("name", ["fourbar-lecture-1", "slider-crank-offset", "sixbar-watt"])
@pytest.mark.parametrize("alpha", [0.0, 7.0])
def test_circles_by_their_definitions(name: str, alpha: float) -> None:
    drawn = drawn_at(name, 1.0, alpha)
    for link in drawn.placement.scene.links:
        body = drawn.rates[link]
        circles = curvature_circles(drawn, link)
        assert body.velocity_at(circles.pole) == pytest.approx([0.0, 0.0], abs=1e-12)
        assert body.acceleration_at(circles.acceleration_pole) == pytest.approx([0, 0], abs=1e-9)
        round_about = np.linspace(0.3, 6.0, 9)
        ways = np.stack([np.cos(round_about), np.sin(round_about)], axis=1)
        for place in circles.inflection.middle + circles.inflection.radius * ways:
            v, a = body.velocity_at(place), body.acceleration_at(place)
            assert v[0] * a[1] - v[1] * a[0] == pytest.approx(0.0, abs=1e-9 * (1 + v @ v) * 100)
        if circles.still_speed is None:
            assert body.alpha == 0.0
            continue
        for place in circles.still_speed.middle + circles.still_speed.radius * ways:
            v, a = body.velocity_at(place), body.acceleration_at(place)
            assert v @ a == pytest.approx(0.0, abs=1e-9 * (np.hypot(*v) * np.hypot(*a) + 1.0))


def test_a_link_that_does_not_turn_has_no_circles() -> None:
    drawn = drawn_at("scotch-yoke", 1.0)
    with pytest.raises(CrankcheckError, match="does not turn"):
        curvature_circles(drawn, "yoke")


def test_the_moving_centrode_rolls_on_the_fixed_one() -> None:
    """Ways of the pole on both are equally long: it rolls, and does not slide."""
    scene = load_scene("fourbar-lecture-1")
    times = np.linspace(0.0, 0.2, 2001)
    both = centrodes(solve(scene, times, bound=False), "coupler", "B")
    steps = [np.hypot(*np.diff(way, axis=0).T) for way in (both.fixed, both.moving)]
    assert steps[0] == pytest.approx(steps[1], rel=1e-4)
    still = replace(solve(scene, times[:3], bound=False))
    assert np.isfinite(centrodes(still, "rocker", "D").fixed).all()


def test_a_link_that_turns_by_rounding_alone_does_not_turn() -> None:
    """The coupler of a parallelogram is carried round: its circles would be 1e14 m large."""
    drawn = drawn_at("fourbar-lecture-1", math.pi / 2)
    coupler = replace(drawn.rates["coupler"], omega=1e-15)
    drawn = replace(drawn, rates={**drawn.rates, "coupler": coupler})
    with pytest.raises(CrankcheckError, match="coupler does not turn at this instant"):
        curvature_circles(drawn, "coupler")
    motion = solve(drawn.placement.scene, np.linspace(0.0, 0.1, 9), bound=False)
    still = replace(motion.links["coupler"], omega=np.full(9, 1e-15))
    with pytest.raises(CrankcheckError, match="coupler never turns"):
        centrodes(replace(motion, links={**motion.links, "coupler": still}), "coupler", "B")
