"""The page of a solved scene: one HTML file with its motion, and its forces if requested, or with
its free motion, or with its elastic links."""

import base64
import math
from collections.abc import Mapping

import numpy as np

from analytic.elastic.elastic_motion import ElasticHistory
from analytic.free.free_motion import FreeMotion
from models.array import Array
from models.motion import Motion
from models.scene import Scene
from models.scene.cut_links import line_of
from models.scene.driver import driver_unit
from models.scene.laws import ConstantSpeed
from reports.describe import elastic_course, with_forces
from reports.describe.elastic_course import ElasticCourse
from reports.describe.elastic_words import (
    beam_certainty,
    elastic_facts,
    elastic_warnings,
    start_words,
)
from reports.describe.force_tables import friction_words, largest_of
from reports.describe.free_motion import free_notes, instants
from reports.drawing import moving
from reports.drawing.force_arrows import force_arrows
from reports.drawing.moving import INSTANTS, drawing, magnification, moving_points, packed
from reports.drawing.shape import size_of_motion, turn_of
from reports.output.numbers import count
from reports.output.write import crankcheck_version
from reports.page.build import Head, assembled
from reports.page.sections.motion import scene_words
from reports.page.sections.section import Section
from reports.plan.singular import continued_note


def scene_page(scene: Scene, figures: Mapping[str, bytes] | None = None) -> str:
    """Return the page of a scene; ``figures`` are SVG files of its forces by name, None for a page
    without forces.

    Raises CrankcheckError where the driver goes through no turn, or there are no forces.
    """
    sections = [_motion(scene, acting=figures is not None)]
    if figures is not None:
        sections.append(_forces(scene, figures))
    return assembled(_head(scene, "the closed form"), sections)


def free_page(free: FreeMotion, figures: Mapping[str, bytes], *, acting: bool = False) -> str:
    """Return the page of a free motion, with its reactions if requested; ``figures`` are SVG files
    by name. Raises CrankcheckError for reactions that are open."""
    words = f"free motion over {free.until_s:g} s"
    shown = {name: svg for name, svg in figures.items() if name in FREE_CAPTIONS}
    sections = [_free(free, shown)]
    if acting:
        fine, others = (
            with_forces.finely_loaded(free),
            {n: figures[n] for n in figures.keys() - shown},
        )
        sections.append(_force_section(free.scene, fine, others, over="the motion"))
    return assembled(_head(free.scene, words), sections)


def elastic_page(motion: ElasticHistory, fine: ElasticCourse, figures: Mapping[str, bytes]) -> str:
    """Return the page of a motion with elastic links; ``fine`` is the same closely sampled,
    ``figures`` are SVG files by name. Raises CrankcheckError where there is no motion."""
    links = count(len(motion.scene.elastic), "elastic link")
    return assembled(_head(motion.scene, links), [_elastic(motion, fine, figures)])


def _head(scene: Scene, what: str) -> Head:
    counts = {"link": scene.links, "load": scene.loads, "spring": scene.springs}
    return Head(
        title=f"crankcheck: {scene.name}",
        facts=(
            what,
            *(count(len(each), noun) for noun, each in counts.items() if each),
            f"crankcheck {crankcheck_version()}",
        ),
        made="",
        first="motion",
    )


def _pictures(
    figures: Mapping[str, bytes], captions: Mapping[str, str]
) -> list[tuple[str, str, str]]:
    """Return SVG files with their captions; a file without a caption has its name."""
    return [
        (name, captions.get(name, name), base64.b64encode(svg).decode("ascii"))
        for name, svg in figures.items()
    ]


def _moving(name: str, words: Mapping[str, object], embedded: Mapping[str, object]) -> Section:
    """Return the section of a moving scene; ``name`` is that of its template and of its script."""
    return Section(
        anchor="motion",
        title="In motion",
        template=f"{name}.html",
        words=words,
        embedded=embedded,
        scripts=("arrows.js", "mechanism.js", "stage.js", f"{name}.js"),
        styles=("forces.css",),
    )


def _motion(scene: Scene, *, acting: bool) -> Section:
    """Return a scene in motion by the closed form, with its forces if requested. Raises
    CrankcheckError where the driver goes through no turn."""
    turn = turn_of(scene, INSTANTS, with_forces=acting)
    drawn = drawing(scene, turn.time_s, turn)
    if turn.forces is not None:
        arrows = force_arrows(scene, turn)
        low, high = arrows.box(turn)
        drawn |= {"forces": arrows.embedded(turn), "box": [*low, *high]}
    return _moving(
        "scene_motion",
        {
            "scene": scene_words(scene),
            "has_arrows": "forces" in drawn and bool(drawn["forces"]["arrows"]),  # type: ignore[index]  # as embedded
            "with_forces": acting,
        },
        {"drawing": drawn, "effort": _effort(scene, turn)},
    )


def _effort(scene: Scene, turn: Motion) -> dict[str, object] | None:
    if turn.forces is None:
        return None
    series = packed(np.atleast_2d(turn.forces.torque))
    return {"name": scene.driver.effort, "unit": scene.driver.effort_unit, "series": series}


FORCE_CAPTIONS: Mapping[str, str] = {
    "torque": "Driving torque or force, and its mean over the turn.",
    "reactions": "Size of the reactions; normal forces of guides with their sign.",
    "reactions-polar": "The tip of each reaction over a turn, drawn from the cross.",
    "efficiency": "Power of the drive that goes on to loads and masses.",
    "reduced": "The machine reduced to one mass at the driver.",
    "forces": "The mechanism at its largest reactions.",
}


def _forces(scene: Scene, figures: Mapping[str, bytes]) -> Section:
    return _force_section(scene, with_forces.turn_with_forces(scene), figures, over="a turn")


def _force_section(
    scene: Scene, turn: Motion, figures: Mapping[str, bytes], *, over: str
) -> Section:
    assert turn.forces is not None
    driven = bool(turn.forces.drive_unit)
    return Section(
        anchor="forces",
        title="Forces",
        template="scene_forces.html",
        words={
            "driver": scene.driver.joint,
            "effort": scene.driver.effort if driven else "",
            "over": over,
            "degrees": "\N{DEGREE SIGN}" if driver_unit(scene) == "deg" else " m",
            "rows": largest_of(scene, turn, with_forces.cleaned_forces(turn.forces)),
            "notes": [
                *(friction_words(scene) if driven else ()),
                *with_forces.force_notes(scene, turn),
                with_forces.force_certainty(scene, turn.forces),
            ],
            "figures": _pictures(figures, FORCE_CAPTIONS),
        },
        styles=("forces.css",),
    )


FREE_CAPTIONS: Mapping[str, str] = {
    "over-time": "The driver's angle and angular velocity.",
    "energy": "Energy of the motion, and work done on it.",
    "phase": "The driver's angular velocity over its angle.",
}
SHORTEST_MS, LONGEST_MS = 4000, 12000
"""Bounds on the time of one round of the animation [ms]."""


def _free(free: FreeMotion, figures: Mapping[str, bytes]) -> Section:
    time_s = np.linspace(0.0, free.until_s, instants(free))
    motion = free.at(time_s, bound=False)
    drawn = drawing(free.scene, time_s, motion)
    lasts_ms = float(np.clip(1000.0 * free.until_s, SHORTEST_MS, LONGEST_MS))
    return _moving(
        "scene_free",
        {
            "scene": scene_words(free.scene),
            "notes": [
                *filter(None, (*free_notes(free, free.until_s), continued_note(free.scene, motion)))
            ],
            "figures": _pictures(figures, FREE_CAPTIONS),
        },
        {"drawing": drawn | {"until_s": free.until_s}, "lasts_ms": lasts_ms},
    )


ELASTIC_CAPTIONS: Mapping[str, str] = {
    "deflection": "Distance of the middle of each elastic link from the line between its pins.",
    "angles": "Motion of the links with elastic and with rigid links, and the difference.",
    "extension": "Extension between the pins of each elastic link.",
    "torque": "The driving torque with elastic links and with rigid ones.",
    "positions": "The mechanism at six instants, magnified as it says.",
}
MOST = 1201
"""Most instants of the drawing."""
EVERY = 2
"""Stride of the drawn places among the sampled places of a link."""
STEPS = (1.0, 2.0, 5.0)
"""Factors that are offered within a power of ten."""


def _elastic(motion: ElasticHistory, fine: ElasticCourse, figures: Mapping[str, bytes]) -> Section:
    """Return a scene with elastic links in motion, its deflections magnified, over the same with
    rigid links; its extreme values, and the figures."""
    scene = motion.scene
    turns = motion.until_s / scene.driver.law.period_s
    count = int(np.clip(round((INSTANTS - 1) * turns), INSTANTS - 1, MOST - 1)) + 1
    course = elastic_course.elastic_course(motion, np.linspace(0.0, motion.until_s, count))
    size_m = size_of_motion(scene, course.base)
    factor = magnification(course.motion, course.base, course.bent, size_m)
    drawn = drawing(scene, course.time_s, course.base)
    if not isinstance(scene.driver.law, ConstantSpeed) or turns > 1.0 + 1e-9:
        drawn |= {"until_s": motion.until_s}
    notes = [start_words(scene, elastic_course.start_of(motion)), *beam_certainty(motion)]
    return _moving(
        "scene_elastic",
        {
            "scene": scene_words(scene),
            "elastic": elastic_facts(scene, motion.by, stiffened=motion.stiffened),
            "along": "Time" if "until_s" in drawn else "Crank angle",
            "factors": factors(factor),
            "factor": f"{factor:g}",
            "rows": elastic_course.extremes(fine),
            "driver": scene.driver.link,
            "free": scene.is_free,
            "notes": [*notes, *elastic_warnings(scene, elastic_course.largest_deflections(fine))],
            "figures": _pictures(figures, ELASTIC_CAPTIONS),
        },
        {
            "drawing": drawn,
            "moved": packed(_moved(course)),
            "bent": _bent(course),
            "lasts_ms": 5000 * min(max(1.0, turns), 6.0),
        },
    )


def factors(chosen: float) -> list[tuple[str, str]]:
    """Return magnifications that a reader may choose, by value and name, ``chosen`` among them,
    from 1 to ten times as much."""
    last = math.ceil(math.log10(chosen)) + 1
    every = [step * 10.0**power for power in range(last) for step in STEPS]
    each = [one for one in every if one == 1.0 or chosen / 50.0 <= one <= 10.0 * chosen * 1.001]
    return [(f"{one:g}", "true scale" if one == 1.0 else f"{one:g} times") for one in each]


def _moved(course: ElasticCourse) -> Array:
    """Return the offset of points and guides from the drawing: x and y by point [m], then angles of
    the links that carry guides [rad], (R, T), as the rows of the drawing."""
    bent, base = course.motion, course.base
    rows = [
        row
        for name in moving_points(course.scene)
        for row in (bent.points[name].position - base.points[name].position).T
    ]
    turning = moving.drawn_links(course.scene)
    rows += [bent.links[name].theta - base.links[name].theta for name in turning]
    return np.array(rows)


def _bent(course: ElasticCourse) -> dict[str, object]:
    """Return links that bend by name: their pins, and deflections at equal parts between them."""
    bending = [name for name, link in course.scene.elastic.items() if link.bends]
    return {
        name: {"pins": list(line_of(course.scene, name).pins), "rows": packed(each[:, ::EVERY].T)}
        for name, each in course.bent.items()
        if name in bending
    }
