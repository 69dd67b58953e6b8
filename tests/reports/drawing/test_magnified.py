"""Mechanisms with elastic links as they are drawn: displacements magnified."""

from __future__ import annotations

import numpy as np
import pytest

from analytic.elastic.discretisation import Modes
from analytic.elastic.elastic_motion import DrivenElasticMotion
from models.files import load_scene
from reports.describe.elastic_course import ElasticCourse, elastic_course
from reports.drawing.magnified import Magnified, magnification


@pytest.fixture(scope="module")
def course() -> ElasticCourse:
    scene = load_scene("fourbar-elastic")
    motion = DrivenElasticMotion(scene, 1.0, Modes(3), "periodic", stiffened=True)
    return elastic_course(motion, np.linspace(0.0, 0.8, 9))


def drawn(course: ElasticCourse, factor: float) -> Magnified:
    return Magnified(course.scene, course.motion, course.rigid, course.bent, factor)


def test_at_true_scale_everything_is_where_it_is(course: ElasticCourse) -> None:
    own = drawn(course, 1.0)
    outline = own.outline("coupler", 2)
    ends = [course.motion.points[pin].position[2] for pin in ("B", "C")]
    np.testing.assert_allclose(outline[[0, -1]], ends, rtol=0, atol=1e-15)
    chord = ends[1] - ends[0]
    aside = outline[20] - ends[0]
    off = (chord[0] * aside[1] - chord[1] * aside[0]) / np.hypot(*chord)
    assert off == pytest.approx(course.motion.elastic["coupler"].middle[2], rel=1e-9)
    np.testing.assert_allclose(own.outline("rocker", 2)[1], ends[1], rtol=0, atol=1e-15)


def test_displacements_are_magnified_and_rigid_links_stay_where_nothing_moves_them(
    course: ElasticCourse,
) -> None:
    own = drawn(course, 1000.0)
    exact = course.rigid.points["C"].position[2]
    moved = course.motion.points["C"].position[2] - exact
    np.testing.assert_allclose(own.place("C", 2) - exact, 1000.0 * moved, rtol=1e-9)
    np.testing.assert_allclose(own.outline("crank", 2)[1], course.rigid.points["B"].position[2])


@pytest.mark.parametrize("size_m", [1e-3, 0.3, 1.0, 40.0])
def test_a_magnification_is_a_round_number_that_fits(course: ElasticCourse, size_m: float) -> None:
    factor = magnification(course.motion, course.rigid, course.bent, size_m)
    assert f"{factor:e}"[0] in "125"
    largest = np.max(np.abs(course.bent["coupler"]))
    assert factor == 1.0 or 0.02 < factor * largest / size_m <= 0.06


def test_what_does_not_bend_is_drawn_as_it_is(course: ElasticCourse) -> None:
    assert magnification(course.rigid, course.rigid, {}, 1.0) == 1.0
