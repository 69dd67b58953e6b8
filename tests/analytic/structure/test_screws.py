"""Screws: finite motions, axes that are carried along, and what does no work."""

from __future__ import annotations

import mpmath
import numpy as np
import pytest

from analytic.structure.freedom_names import axis_in_words, names_of_freedoms
from analytic.structure.screws import (
    carried,
    cross_matrix,
    displaced,
    force,
    gap,
    reciprocal,
    rotation,
    translation,
)


def matrix(twist: np.ndarray) -> np.ndarray:
    """A twist as the matrix (4, 4) whose exponential is its motion."""
    whole = np.zeros((4, 4))
    whole[:3, :3], whole[:3, 3] = cross_matrix(twist[:3]), twist[3:]
    return whole


@pytest.mark.parametrize("size", [0.0, 1e-13, 1e-6, 1e-3, 1.0, 2.5])
def test_a_finite_motion_is_the_exponential_of_its_twist(size: float) -> None:
    draw = np.random.default_rng(1)
    for _ in range(5):
        twist = draw.standard_normal(6)
        with mpmath.workdps(40):
            exact = mpmath.expm(mpmath.matrix((size * matrix(twist)).tolist())).tolist()
        assert np.allclose(displaced(twist, size), np.array(exact, float), atol=4e-15, rtol=0)


def test_a_carried_axis_turns_as_the_body_that_carries_it() -> None:
    draw = np.random.default_rng(2)
    for _ in range(5):
        twist, move = draw.standard_normal(6), displaced(draw.standard_normal(6), 1.0)
        there = move @ matrix(twist) @ np.linalg.inv(move)
        assert np.allclose(matrix(carried(move, twist)), there, atol=1e-13)


def test_the_gap_of_a_small_motion_is_its_twist() -> None:
    twist = np.random.default_rng(3).standard_normal(6)
    assert np.allclose(gap(displaced(twist, 1e-7)) / 1e-7, twist, atol=1e-6)


def test_a_force_through_an_axis_does_no_work_on_a_turn_about_it() -> None:
    turn = rotation((0.1, 0.2, 0.3), (0.0, 0.6, 0.8))
    assert force((0.1, 0.2 + 0.6, 0.3 + 0.8), (1.0, 2.0, 3.0)) @ turn == pytest.approx(0.0)
    assert np.allclose(reciprocal(turn[:, None]) @ turn, 0.0)
    assert reciprocal(turn[:, None]).shape == (5, 6)


def test_freedoms_have_names_where_axes_of_the_frame_do_and_places_else() -> None:
    at = (0.1, 0.0, 0.0)
    pair = np.array([rotation(at, (0, 0, 1)) + translation((1, 0, 0)), translation((1, 0, 0))]).T
    assert names_of_freedoms(pair, at) == ["Qz", "Tx"]
    skew = rotation((0.5, 0.0, 0.0), (0.0, 0.0, 1.0))[:, None]
    assert names_of_freedoms(skew, at) == ["turn about (0, 0, 1) through (0.5, 0, 0) m"]
    assert axis_in_words(translation((0.0, 3.0, 4.0))) == "slide along (0, 0.6, 0.8)"
    thread = rotation((0.0, 0.2, 0.0), (1.0, 0.0, 0.0), 0.006 / (2 * np.pi))
    words = "screw about (1, 0, 0) through (0, 0.2, 0) m, 0.006 m in a turn"
    assert axis_in_words(thread) == words
