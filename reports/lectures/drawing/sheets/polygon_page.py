"""Polygons one after the other, and the page of a turn: they move with the mechanism, and are
drawn step by step."""

from __future__ import annotations

import io
import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from PIL import Image

from analytic.lectures.drawings import drawn_polygons
from analytic.lectures.drawings.polygon import UNITS, PlacedMechanism, Polygon, Quantity
from models.array import Array
from models.motion import Motion
from models.scene import Scene
from models.scene.laws import ConstantSpeed
from reports.describe.facts import describe_law
from reports.describe.free_motion import instants
from reports.drawing.moving import drawing, packed
from reports.drawing.shape import turn_of
from reports.lectures.drawing.sheets import polygon_sheet
from reports.lectures.drawing.sheets.paper import sheet_note
from reports.lectures.drawing.sheets.polygon_drawing import POLES, lower_case
from reports.lectures.drawing.sheets.polygon_table import drawn_links
from reports.output.numbers import count
from reports.output.write import crankcheck_version


@dataclass(frozen=True)
class PolygonCourse:
    """A turn of the driver's law and the polygons at each of its instants, both ends included;
    ``nearest`` is the instant most like the requested placement."""

    scene: Scene
    motion: Motion
    drawn: tuple[drawn_polygons.DrawnPolygons, ...]
    nearest: int
    title = "Polygons over a turn"
    words = "a turn"

    @staticmethod
    def kind(scene: Scene, *, steady: bool) -> type[PolygonCourse]:
        """The kind of course of a scene: with a ``steady`` driver always a turn."""
        return FreeMotionCourse if scene.is_free and not steady else PolygonCourse

    @classmethod
    def of(
        cls, placement: PlacedMechanism, samples: int, most: int, *, steady: bool
    ) -> PolygonCourse:
        """Sample a turn of the driver's law at ``samples`` instants, with a ``steady`` driver at
        the speed of the placement; or a free motion at as many as it needs, up to ``most``. Raises
        CrankcheckError where the driver goes through no turn."""
        scene = placement.scene
        course = cls.kind(scene, steady=steady)
        if steady:
            law = ConstantSpeed(placement.driver.theta, placement.driver.omega)
            scene = replace(scene, driver=replace(scene.driver, law=law))
        samples = course.instants(scene, samples, most)
        motion = turn_of(scene, samples)
        drawn = tuple(
            drawn_polygons.polygons_of(PlacedMechanism.standing(scene, motion, sample=at))
            for at in range(samples)
        )
        return course(scene, motion, drawn, _nearest(motion, placement))

    @classmethod
    def instants(cls, scene: Scene, samples: int, most: int) -> int:
        """The number of instants."""
        return samples

    @property
    def frames(self) -> tuple[drawn_polygons.DrawnPolygons, ...]:
        """The polygons of an animation that repeats: the last equals the first."""
        return self.drawn[:-1]

    @property
    def along(self) -> str:
        """The label of a page's slider."""
        return f"Angle of the {self.scene.driver.link}"

    @property
    def until(self) -> dict[str, object]:
        """Further data for the drawing of a page."""
        return {}


class FreeMotionCourse(PolygonCourse):
    """A free motion and the polygons at its instants."""

    title = "Polygons over the motion"
    words = "its motion"
    along = "Time"

    @classmethod
    def instants(cls, scene: Scene, samples: int, most: int) -> int:
        from reports.compare.free_truth import kept_motion  # integrates

        return min(instants(kept_motion(scene, scene.driver.law.period_s)), most)

    @property
    def frames(self) -> tuple[drawn_polygons.DrawnPolygons, ...]:
        return self.drawn

    @property
    def until(self) -> dict[str, object]:
        """The end of the drawn time [s]: the slider has times."""
        return {"until_s": float(self.motion.time_s[-1])}


def _nearest(motion: Motion, placement: PlacedMechanism) -> int:
    link, driver = placement.scene.driver.link, placement.driver
    moved = motion.links[link]
    off = np.abs((moved.theta - driver.theta + math.pi) % math.tau - math.pi)
    other_way = np.sign(moved.omega) * np.sign(driver.omega) < 0.0
    return int(np.argmin(off + math.pi * other_way))


ANIMATED, PAGE = ".gif", ".html"
ENDINGS = (".svg", ".pdf", ANIMATED, PAGE)
FRAMES, MOST_FRAMES = 24, 40
"""Frames of a turn, and at most of a free motion: each takes half a second to draw."""
FRAME_S, STEP_S, LAST_S = 0.15, 1.2, 3.0
DPI = 100


def polygon_file(sheet: polygon_sheet.PolygonSheet, ending: str) -> bytes:
    """The sheet as a file with an ending of `ENDINGS`, animated step by step."""
    canvas = polygon_sheet.draw_sheet(sheet, sheet_note(sheet.drawn.placement.scene))
    name = sheet.drawn.placement.scene.name
    if ending != ANIMATED:
        return canvas.saved(ending[1:], f"Vector polygons of {name}")
    built = [
        axes for axes in canvas.layers if axes.get_gid() not in ("layer-frame", "layer-scheme")
    ]
    for axes in built:
        axes.set_visible(False)
    frames = [_picture(canvas.figure)]
    for axes in built:
        axes.set_visible(True)
        frames.append(_picture(canvas.figure))
    return _animated(frames, [STEP_S] * (len(frames) - 1) + [LAST_S])


def turning_file(sheet: polygon_sheet.PolygonSheet, *, steady: bool = False) -> bytes:
    """The sheet over a turn of the driver's law, or over its free motion, as an animation at one
    scale; with a ``steady`` driver at the speed of the sheet. Raises CrankcheckError where the
    driver goes through no turn."""
    placement = sheet.drawn.placement
    course = PolygonCourse.of(placement, FRAMES + 1, MOST_FRAMES, steady=steady)
    frames = [
        _picture(polygon_sheet.draw_sheet(each, sheet_note(course.scene)).figure)
        for each in polygon_sheet.over_positions(course.frames, sheet.paper)
    ]
    return _animated(frames, [FRAME_S] * len(frames))


def _picture(figure: Figure) -> Image.Image:
    figure.set_dpi(DPI)
    canvas = FigureCanvasAgg(figure)
    canvas.draw()  # type: ignore[no-untyped-call]  # matplotlib has no annotation here
    pixels = np.asarray(canvas.buffer_rgba())  # type: ignore[no-untyped-call]  # as above
    return Image.fromarray(pixels).convert("RGB")


def _animated(frames: list[Image.Image], seconds: list[float]) -> bytes:
    """An endless animation of the pictures, in the colours of the last, which has all."""
    colours = frames[-1].quantize(64, dither=Image.Dither.NONE)
    frames = [each.quantize(palette=colours, dither=Image.Dither.NONE) for each in frames]
    buffer = io.BytesIO()
    frames[0].save(
        buffer, "GIF", save_all=True, append_images=frames[1:],
        duration=[round(1000 * each) for each in seconds], loop=0, optimize=True,
        comment=b"crankcheck",
    )  # fmt: skip
    return buffer.getvalue()


INSTANTS, MOST = 181, 721
"""Instants of a turn, both ends included; and at most of a free motion."""
LASTS_MS = 9000
"""Duration of a round of the page [ms]: slow enough to follow vectors with the eye."""


def polygon_page(placement: PlacedMechanism, *, steady: bool = False) -> str:
    """The page of a mechanism over a turn of its driver's law, or over its free motion, which
    starts at the ``placement``; with a ``steady`` driver over a turn at the speed there.

    Raises CrankcheckError where the driver goes through no turn.
    """
    from reports.page.build import Head, assembled  # the machinery of a page, for it alone
    from reports.page.sections.section import Section

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
            "polygons": [_embedded(drawn, quantity) for quantity in drawn_polygons.QUANTITIES],
            "links": _links(drawn),
        },
        scripts=("arrows.js", "mechanism.js", "stage.js", "polygon_figure.js", "polygons.js"),
        styles=("polygons.css",),
    )
    facts = ("the closed form", describe_law(scene), f"crankcheck {crankcheck_version()}")
    head = Head(f"crankcheck: polygons of {scene.name}", facts, made="", first="polygons")
    return assembled(head, [section])


def _missing(drawn: Sequence[drawn_polygons.DrawnPolygons]) -> str:
    some = sum(bool(each.undetermined) for each in drawn)
    return f"At {count(some, 'instant')} of {len(drawn)} not all is determined." if some else ""


def _embedded(
    drawn: Sequence[drawn_polygons.DrawnPolygons], quantity: Quantity
) -> dict[str, object]:
    """A polygon at all instants: its vectors from x, y to x, y, and its images at x, y."""
    every = [each.velocity if quantity == "velocity" else each.acceleration for each in drawn]
    whole = max(every, key=lambda each: (len(each.steps), len(each.vectors)))
    vectors = {vector.name: vector for each in [whole, *every] for vector in each.vectors}
    steps = [numbered for each in every for numbered in enumerate(each.steps)]
    step_of = {vector.name: n for n, step in steps for vector in step.vectors}
    node_of = {name: n for n, step in steps for name in step.nodes}
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
    """The numbers of each link's points, -1 for a point that stays in the pole."""
    return [
        [points.index(name) if name in points else -1 for name in image]
        for image in polygon.images.values()
        if len(image) > 1
    ]


def _box(rows: Array, places: Array) -> list[float]:
    xs = np.concatenate([rows[::2].ravel(), places[::2].ravel(), [0.0]])
    ys = np.concatenate([rows[1::2].ravel(), places[1::2].ravel(), [0.0]])
    return [np.nanmin(xs), np.nanmin(ys), np.nanmax(xs), np.nanmax(ys)]


def _links(drawn: Sequence[drawn_polygons.DrawnPolygons]) -> dict[str, object]:
    """The rates of links; exactly 0 where their image is one point."""
    names = list(dict.fromkeys(name for each in drawn for name in drawn_links(each)))
    rows = np.full((2 * len(names), len(drawn)), np.nan)
    for at, each in enumerate(drawn):
        for number, name in enumerate(names):
            if name in each.rates:
                rows[2 * number : 2 * number + 2, at] = drawn_polygons.link_rates(each, name)
    return {"names": names, "rows": packed(rows)}
