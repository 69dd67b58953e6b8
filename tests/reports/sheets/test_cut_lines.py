"""Lines cut to a box, against what of them is in it by looking."""

from __future__ import annotations

import math

import numpy as np
import pytest

from models.array import Array
from reports.sheets.cut_lines import arc_places, cut_line, near_angles

LOW, HIGH = np.array([-1.0, -0.5]), np.array([2.0, 1.0])


def length(places: Array) -> float:
    return float(np.sum(np.hypot(*np.diff(places, axis=0).T)))


def test_a_line_is_cut_to_as_long_as_it_is_in_the_box() -> None:
    random = np.random.default_rng(3)
    for start, end in random.uniform(-4.0, 4.0, (200, 2, 2)):
        along = start + np.linspace(0.0, 1.0, 20001)[:, None] * (end - start)
        inside = np.all((along >= LOW) & (along <= HIGH), axis=1).mean()
        parts = cut_line(np.array([start, end]), LOW, HIGH)
        assert len(parts) <= 1
        share = sum(map(length, parts)) / math.dist(start, end)
        assert share == pytest.approx(inside, abs=2e-4)


def test_lines_along_the_axes_and_on_the_edge_are_kept() -> None:
    for ends in ([[0.0, -3.0], [0.0, 3.0]], [[-9.0, 0.0], [9.0, 0.0]], [[-1.0, 0.0], [-1.0, 0.5]]):
        assert len(cut_line(np.array(ends), LOW, HIGH)) == 1
    assert cut_line(np.array([[3.0, -3.0], [3.0, 3.0]]), LOW, HIGH) == []


def test_a_line_that_leaves_and_comes_back_has_two_parts_and_one_that_stays_has_one() -> None:
    out = np.array([[0.0, 0.0], [0.0, 2.0], [1.0, 2.0], [1.0, 0.0], [1.5, 0.0]])
    first, second = cut_line(out, LOW, HIGH)
    assert first == pytest.approx(np.array([[0.0, 0.0], [0.0, 1.0]]))
    assert second == pytest.approx(np.array([[1.0, 1.0], [1.0, 0.0], [1.5, 0.0]]))
    (whole,) = cut_line(out[[0, 3, 4]], LOW, HIGH)
    assert len(whole) == 3


def test_a_curve_that_comes_back_from_infinity_does_not_jump_across() -> None:
    curve = np.array([[0.0, 0.0], [1.0, 0.5], [40.0, 20.0], [-40.0, -20.0], [-0.5, -0.25]])
    parts = cut_line(curve, LOW, HIGH)
    assert [len(part) for part in parts] == [3, 2]


@pytest.mark.parametrize("radius", [5.0, 500.0, 5e5])
def test_of_a_large_circle_all_that_is_in_the_box_is_kept(radius: float) -> None:
    middle = np.array([0.3, 0.1]) + radius * np.array([math.cos(1.0), math.sin(1.0)])
    arc = arc_places(middle, radius, *near_angles(middle, radius, LOW, HIGH))
    (part,) = cut_line(arc, LOW, HIGH)
    for end in (part[0], part[-1]):
        assert min(np.abs(np.concatenate([end - LOW, end - HIGH]))) < 1e-9
    assert len(part) > 100
