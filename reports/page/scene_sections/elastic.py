"""A scene with elastic links in motion, its deflections magnified, over the same with rigid links;
what they come to, and the figures."""

from __future__ import annotations

import base64
import math
from collections.abc import Mapping

import numpy as np

from analytic.elastic.elastic_motion import ElasticHistory
from models.array import Array
from models.cut_links import line_of
from models.laws import ConstantSpeed
from reports.describe.elastic_course import (
    ElasticCourse,
    elastic_course,
    extremes,
    largest_deflections,
    start_of,
)
from reports.describe.elastic_words import certainty, elastic_facts, elastic_warnings, start_words
from reports.drawing.moving import INSTANTS, drawing, magnification, moving_points
from reports.drawing.packed import packed
from reports.drawing.shape import size_of_motion
from reports.page.sections.motion import scene_words
from reports.page.sections.section import Section

CAPTIONS: Mapping[str, str] = {
    "deflection": "How far the middle of each elastic link is from the line between its pins.",
    "angles": "What links do with elastic links and with rigid ones, and what is between them.",
    "extension": "By how much the pins of each elastic link are further apart than at rest.",
    "torque": "The driving torque with elastic links and with rigid ones.",
    "positions": "The mechanism at six instants, magnified as it says.",
}
"""What stands under a figure; one that is not here has its name."""
MOST = 1201
"""Instants of the drawing."""
EVERY = 2
"""Of the places of a link at which it is looked at, so many make one of the drawing."""
STEPS = (1.0, 2.0, 5.0)
"""Of the factors that are offered, within a power of ten."""


def build(motion: ElasticHistory, fine: ElasticCourse, figures: Mapping[str, bytes]) -> Section:
    """The section; ``fine`` is the motion closely sampled, ``figures`` are SVG files by name."""
    scene = motion.scene
    turns = motion.until_s / scene.driver.law.period_s
    count = int(np.clip(round((INSTANTS - 1) * turns), INSTANTS - 1, MOST - 1)) + 1
    course = elastic_course(motion, np.linspace(0.0, motion.until_s, count))
    factor = magnification(course.motion, course.base, course.bent, size_of_motion(course.base))
    drawn = drawing(scene, course.time_s, course.base)
    if not isinstance(scene.driver.law, ConstantSpeed) or turns > 1.0 + 1e-9:
        drawn |= {"until_s": motion.until_s}
    notes = [start_words(scene, start_of(motion)), *certainty(motion)]
    return Section(
        anchor="motion",
        title="In motion",
        template="scene_elastic.html",
        words={
            "scene": scene_words(scene),
            "elastic": elastic_facts(scene, motion.by, stiffened=motion.stiffened),
            "along": "Time" if "until_s" in drawn else "Crank angle",
            "factors": factors(factor),
            "factor": f"{factor:g}",
            "rows": extremes(fine),
            "driver": scene.driver.link,
            "free": scene.is_free,
            "notes": [*notes, *elastic_warnings(scene, largest_deflections(fine))],
            "figures": [
                (name, CAPTIONS.get(name, name), base64.b64encode(svg).decode("ascii"))
                for name, svg in figures.items()
            ],
        },
        embedded={
            "drawing": drawn,
            "moved": packed(_moved(course)),
            "bent": _bent(course),
            "lasts_ms": 5000 * min(max(1.0, turns), 6.0),
        },
        scripts=("arrows.js", "mechanism.js", "stage.js", "scene_elastic.js"),
        styles=("forces.css",),
    )


def factors(chosen: float) -> list[tuple[str, str]]:
    """Magnifications that a reader may choose, by value and name, ``chosen`` among them, from 1 to
    ten times as much."""
    last = math.ceil(math.log10(chosen)) + 1
    every = [step * 10.0**power for power in range(last) for step in STEPS]
    each = [one for one in every if one == 1.0 or chosen / 50.0 <= one <= 10.0 * chosen * 1.001]
    return [(f"{one:g}", "true scale" if one == 1.0 else f"{one:g} times") for one in each]


def _moved(course: ElasticCourse) -> Array:
    """How far points and guides are off those of the drawing: x and y by point [m], then angles
    of the links that carry guides [rad], (R, T), as the rows of the drawing."""
    elastic, rigid = course.motion, course.base
    rows = [
        row
        for name in moving_points(course.scene)
        for row in (elastic.points[name].position - rigid.points[name].position).T
    ]
    guides = dict.fromkeys(s.on for s in course.scene.sliders.values() if s.on in elastic.links)
    rows += [elastic.links[name].theta - rigid.links[name].theta for name in guides]
    return np.array(rows)


def _bent(course: ElasticCourse) -> dict[str, object]:
    """Links that bend by name: their pins, and deflections at equal parts between them."""
    return {
        name: {"pins": list(line_of(course.scene, name).pins), "rows": packed(each[:, ::EVERY].T)}
        for name, each in course.bent.items()
        if course.scene.elastic[name].bends
    }
