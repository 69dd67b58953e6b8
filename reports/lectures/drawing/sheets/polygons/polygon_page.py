"""The polygons over a turn as a page: they move with the mechanism, and are drawn step by step."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from analytic.lectures.drawings.drawn_polygons import QUANTITIES, DrawnPolygons, link_rates
from analytic.lectures.drawings.placed_mechanism import PlacedMechanism
from analytic.lectures.drawings.polygon import UNITS, Polygon, Quantity
from models.array import Array
from reports.describe.facts import describe_law
from reports.drawing.moving import drawing
from reports.drawing.packed import packed
from reports.lectures.drawing.sheets.polygons.polygon_course import PolygonCourse
from reports.lectures.drawing.sheets.polygons.polygon_drawing import POLES, lower_case
from reports.lectures.drawing.sheets.polygons.polygon_table import drawn_links
from reports.output.numbers import count
from reports.output.provenance import crankcheck_version
from reports.page.build import Head, assembled
from reports.page.sections.section import Section

INSTANTS, MOST = 181, 721
"""Over the turn, both ends included; and at most of a free motion."""
LASTS_MS = 9000
"""What a round of the page takes: slow enough to follow vectors with the eye."""


def polygon_page(placement: PlacedMechanism, *, steady: bool = False) -> str:
    """The page of a mechanism over a turn of its driver's law, or over its free motion, which
    stands at first as the ``placement``; with a ``steady`` driver over a turn at the speed there.

    Raises CrankcheckError where the driver goes through no turn.
    """
    course = PolygonCourse.of(placement, INSTANTS, MOST, steady=steady)
    scene, motion, drawn = course.scene, course.motion, course.drawn
    section = Section(
        anchor="polygons",
        title=course.title,
        template="polygons.html",
        words={
            "along": course.along,
            "steps": max(len(each.velocity.steps) for each in drawn),
            "rigid": ", ".join(scene.elastic),
            "missing": _missing(drawn),
        },
        embedded={
            "drawing": drawing(scene, motion.time_s, motion) | course.until,
            "home": course.nearest,
            "lasts_ms": LASTS_MS,
            "polygons": [_embedded(drawn, quantity) for quantity in QUANTITIES],
            "links": _links(drawn),
        },
        scripts=("arrows.js", "mechanism.js", "stage.js", "polygon_figure.js", "polygons.js"),
        styles=("polygons.css",),
    )
    facts = ("the closed form", describe_law(scene), f"crankcheck {crankcheck_version()}")
    head = Head(f"crankcheck: polygons of {scene.name}", facts, made="", first="polygons")
    return assembled(head, [section])


def _missing(drawn: Sequence[DrawnPolygons]) -> str:
    """At how many instants polygons are not determined."""
    some = sum(bool(each.undetermined) for each in drawn)
    return f"At {count(some, 'instant')} of {len(drawn)} not all is determined." if some else ""


def _embedded(drawn: Sequence[DrawnPolygons], quantity: Quantity) -> dict[str, object]:
    """A polygon at all instants: its vectors from x, y to x, y, and its images at x, y."""
    every = [each.velocity if quantity == "velocity" else each.acceleration for each in drawn]
    whole = max(every, key=lambda each: (len(each.steps), len(each.vectors)))
    vectors = {vector.name: vector for each in [whole, *every] for vector in each.vectors}
    step_of = {
        v.name: n for each in every for n, step in enumerate(each.steps) for v in step.vectors
    }
    node_of = {
        name: n for each in every for n, step in enumerate(each.steps) for name in step.nodes
    }
    points = [name for name in whole.ends if name in node_of or np.any(whole.ends[name])]
    row_of = {name: 4 * number for number, name in enumerate(vectors)}
    rows = np.full((4 * len(vectors), len(every)), np.nan)
    places = np.full((2 * len(points), len(every)), np.nan)
    for at, polygon in enumerate(every):
        for vector in polygon.vectors:
            first = row_of[vector.name]
            rows[first : first + 4, at] = [*vector.start, *vector.end]
        ends = polygon.ends
        for number, name in enumerate(points):
            if name in ends:
                places[2 * number : 2 * number + 2, at] = ends[name]
    prime = "'" if quantity == "acceleration" else ""
    return {
        "quantity": quantity,
        "unit": UNITS[quantity].replace("^2", "\N{SUPERSCRIPT TWO}"),
        "pole": POLES[quantity],
        "steps": [step.title for step in whole.steps],
        "vectors": [
            {"name": name, "kind": each.kind, "step": step_of[name], "found": each.direction}
            for name, each in vectors.items()
        ],
        "rows": packed(rows),
        "points": [
            {"letter": lower_case(name) + prime, "step": node_of.get(name, -1)} for name in points
        ],
        "places": packed(places),
        "images": _images(whole, points),
        "box": _box(rows, places),
    }


def _images(polygon: Polygon, points: Sequence[str]) -> list[list[int]]:
    """Of each link the numbers of its points, -1 for one that stays in the pole."""
    return [
        [points.index(name) if name in points else -1 for name in image]
        for image in polygon.images.values()
        if len(image) > 1
    ]


def _box(rows: Array, places: Array) -> list[float]:
    """The corners of what holds the polygon at all instants."""
    xs = np.concatenate([rows[::2].ravel(), places[::2].ravel(), [0.0]])
    ys = np.concatenate([rows[1::2].ravel(), places[1::2].ravel(), [0.0]])
    return [np.nanmin(xs), np.nanmin(ys), np.nanmax(xs), np.nanmax(ys)]


def _links(drawn: Sequence[DrawnPolygons]) -> dict[str, object]:
    """How fast links turn; 0 exactly where their image is one point."""
    names = list(dict.fromkeys(name for each in drawn for name in drawn_links(each)))
    rows = np.full((2 * len(names), len(drawn)), np.nan)
    for at, each in enumerate(drawn):
        for number, name in enumerate(names):
            if name not in each.rates:
                continue
            rows[2 * number : 2 * number + 2, at] = link_rates(each, name)
    return {"names": names, "rows": packed(rows)}
