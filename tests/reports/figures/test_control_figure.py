"""A controlled driver with and without its gains, drawn over each other."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from analytic.elastic.control import control_elastic
from analytic.elastic.discretisation import Modes
from models.controlled import Controlled
from models.files import load_scene
from reports.describe.elastic_course import drawn_course
from reports.figures.elastic.control import draw
from reports.figures.style import styled

UNTIL_S = 0.4
"""By then the vibration is out, or is not."""


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
    assert figure is not None
    _, speeds, ahead = figure.axes
    assert [len(line.get_ydata()) for line in speeds.lines[:2]] == [201, 201]  # type: ignore[arg-type]
    assert ahead.get_ylabel() == "crank ahead by [deg]"
    assert draw(replace(course, uncontrolled=None)) is None
