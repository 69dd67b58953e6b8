"""The sheet of both vector polygons: scheme, velocities, accelerations, and their table.

::

    title
    +----------+-------------------+
    | scheme   | velocity polygon  |
    +----------+-------------------+
    | table    | acceleration      |
    +----------+-------------------+
    versions
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes

from analytic.lectures.drawings.drawn_polygons import DrawnPolygons
from models.array import Array
from models.errors import CrankcheckError
from reports.figures.style import QUIET, SMALL, TINY, cut
from reports.lectures.drawing.sheets import polygon_on_paper, polygon_table
from reports.lectures.drawing.sheets.graph_drawing import LOGGED
from reports.lectures.drawing.sheets.letters import Letter, ink_of, write_letters
from reports.lectures.drawing.sheets.paper import (
    MM_PER_IN,
    Box,
    Canvas,
    Paper,
    book_scales,
    headed,
    inner_box,
    of_elastic,
    text,
)
from reports.lectures.drawing.sheets.polygon_drawing import draw_polygon, polygon_letters
from reports.lectures.drawing.sheets.polygon_instant import LoggedInstant
from reports.lectures.drawing.sheets.scheme import draw_scheme, extent_of, point_letters
from reports.output.numbers import readable

GAP = 4.0
LEFT_SHARE, SCHEME_SHARE = 0.38, 0.5
SCHEME_PADDING = 9.0
DOUBT = "#a52a16"


@dataclass(frozen=True)
class PolygonSheet:
    """The contents of the sheet: the polygons, each with its scale; the scale of lengths [m/mm],
    and the middle of the scheme [m]; the log beside it, if any; the time [s], where known."""

    drawn: DrawnPolygons
    velocity: polygon_on_paper.DrawnPolygon
    acceleration: polygon_on_paper.DrawnPolygon
    length_scale: float
    middle: Array
    boxes: dict[str, Box]
    paper: Paper
    log: LoggedInstant | None = None
    time_s: float | None = None

    def place(self, at: Array) -> Array:
        """The place in the scheme [mm] of a place [m]."""
        return np.asarray(self.boxes["scheme"].middle + (at - self.middle) / self.length_scale)

    @property
    def misplaced(self) -> polygon_on_paper.MagnifiedErrors | None:
        """The errors of the log in the scheme."""
        if self.log is None:
            return None
        exact = {name: self.place(at) for name, at in self.drawn.placement.points.items()}
        errors = {name: error / self.length_scale for name, error in self.log.places.items()}
        return polygon_on_paper.MagnifiedErrors.of(exact, errors)


def laid_out(
    drawn: DrawnPolygons,
    paper: Paper,
    k: float | None = None,
    log: LoggedInstant | None = None,
    time_s: float | None = None,
) -> PolygonSheet:
    """Lay out polygons on paper, at the finest round scales that fit; with ``k`` at the book's
    scales, the crank's vectors k times as long as the drawn crank; with the images of a ``log``
    beside them, or of an instant named by its time [s]. Raises CrankcheckError for small paper."""
    boxes = _boxes(paper)
    places = extent_of(drawn.placement)
    length_scale, middle = boxes["scheme"].fitted(places, SCHEME_PADDING)
    if log is not None:  # which may have come apart: it is to be seen
        off = {name: error / length_scale for name, error in log.places.items()}
        if polygon_on_paper.MagnifiedErrors.of(drawn.placement.points, off).is_large:
            own = [drawn.placement.points[n] + error for n, error in log.places.items()]
            length_scale, middle = boxes["scheme"].fitted(np.array([*places, *own]), SCHEME_PADDING)
    scales: tuple[float | None, float | None] = (None, None)
    if k is not None:
        if drawn.placement.driver.alpha:
            raise CrankcheckError("--k: the book's scales are those of a crank at constant speed")
        scales = book_scales(length_scale, drawn.placement.driver.omega, k)
    velocity, acceleration = (
        polygon_on_paper.fitted(polygon, boxes[polygon.quantity], scale)
        if log is None
        else polygon_on_paper.fitted(polygon, boxes[polygon.quantity], scale).beside(
            log.rates[polygon.quantity], log.ways[polygon.quantity], boxes[polygon.quantity], scale
        )
        for polygon, scale in zip((drawn.velocity, drawn.acceleration), scales, strict=True)
    )
    return PolygonSheet(
        drawn, velocity, acceleration, length_scale, middle, boxes, paper, log, time_s
    )


def over_positions(drawn: Sequence[DrawnPolygons], paper: Paper) -> list[PolygonSheet]:
    """A sheet for each position, all at the same scales and with the same pole."""
    boxes = _boxes(paper)
    places = np.concatenate([extent_of(each.placement) for each in drawn])
    scheme = boxes["scheme"].fitted(places, SCHEME_PADDING)
    velocity = polygon_on_paper.frame_of([each.velocity for each in drawn], boxes["velocity"])
    acceleration = polygon_on_paper.frame_of(
        [each.acceleration for each in drawn], boxes["acceleration"]
    )
    return [
        PolygonSheet(
            each,
            polygon_on_paper.DrawnPolygon(each.velocity, *velocity),
            polygon_on_paper.DrawnPolygon(each.acceleration, *acceleration),
            *scheme,
            boxes,
            paper,
        )
        for each in drawn
    ]


def _boxes(paper: Paper) -> dict[str, Box]:
    inner = inner_box(paper)
    left, bottom = inner.left, inner.bottom
    wide, tall = LEFT_SHARE * inner.width, SCHEME_SHARE * inner.height
    right, rest = left + wide + GAP, inner.width - wide - GAP
    half = (inner.height - GAP) / 2
    return {
        "scheme": Box(left, inner.top - tall, wide, tall),
        "table": Box(left, bottom, wide, inner.height - tall - GAP),
        "velocity": Box(right, bottom + half + GAP, rest, half),
        "acceleration": Box(right, bottom, rest, half),
    }


def draw_sheet(sheet: PolygonSheet, note: str) -> Canvas:
    """Draw the sheet, a layer for each part and each step of drawing; ``note`` is its foot.

    Raises CrankcheckError for paper on which its table can not be read.
    """
    canvas = draw_lines(sheet, note)
    ink = ink_of(canvas.figure)  # once: no box has ink in another
    for name, letters in _letters(sheet).items():
        layer = name if name == "scheme" else f"{name}-letters"
        write_letters(canvas, canvas.named(layer), letters, sheet.boxes[name], ink)
    rows = [
        *polygon_table.vector_rows(sheet.velocity),
        *polygon_table.vector_rows(sheet.acceleration),
        *polygon_table.link_rows(sheet.drawn),
    ]
    polygon_table.draw_table(canvas.named("table"), rows, sheet.boxes["table"], sheet.paper)
    return canvas


def draw_lines(sheet: PolygonSheet, note: str) -> Canvas:
    """Draw the sheet without its letters and its table, whose layers are present."""
    canvas, frame = headed(sheet.paper, heading(sheet), note, *sheet.boxes.values())
    _caption(frame, sheet)
    scheme, placement = canvas.layer("scheme"), sheet.drawn.placement
    draw_scheme(scheme, placement, sheet.place)
    if (log := sheet.misplaced) is not None:
        links = (link.points for link in placement.scene.links.values())
        polygon_on_paper.draw_errors(scheme, log, links, "scheme-error")
    canvas.layer("table")
    draw_polygon(canvas, sheet.velocity, sheet.boxes["velocity"])
    draw_polygon(canvas, sheet.acceleration, sheet.boxes["acceleration"])
    return canvas


def heading(sheet: PolygonSheet) -> str:
    """The heading: the mechanism, with the position and speed of its driver."""
    scene, driver = sheet.drawn.placement.scene, sheet.drawn.placement.driver
    angle = round(math.degrees(driver.theta), 9) % 360.0
    at_time = f" (t = {sheet.time_s:.6g} s)" if sheet.time_s is not None else ""
    alpha = f", alpha {readable(driver.alpha)} rad/s²" if driver.alpha else ""
    rigid = of_elastic(scene, "; its elastic links taken as rigid")
    return (
        f"{scene.name}: {scene.driver.link} at {angle:.6g}°{at_time}, omega "
        f"{readable(driver.omega)} rad/s{alpha}{rigid}"
    )


def _caption(axes: Axes, sheet: PolygonSheet) -> None:
    captions = {
        "scheme": f"scheme, K_l = {sheet.length_scale:g} m/mm",
        "velocity": f"velocities, K_v = {sheet.velocity.scale:g} m/s per mm",
        "acceleration": f"accelerations, K_a = {sheet.acceleration.scale:g} m/s² per mm",
        "table": "lengths on paper, and values",
    }
    for name, box in sheet.boxes.items():
        x, y = box.left + 1.5, box.top - 3.2
        text(axes, x, y, captions[name], SMALL, color=QUIET)
        if told := _logged(sheet).get(name):
            room = (box.width - 3.0) / MM_PER_IN
            text(axes, x, y - 2.8, cut(told, room, TINY), TINY, color=LOGGED)
    _doubts(axes, sheet)


def _doubts(axes: Axes, sheet: PolygonSheet) -> None:
    """Write the parts not drawn above the legend of each polygon; also that it is one point."""
    for drawn in (sheet.velocity, sheet.acceleration):
        box = sheet.boxes[drawn.polygon.quantity]
        told = polygon_table.doubts(sheet.drawn)
        if drawn.polygon.largest == 0.0:
            told.append(polygon_table.at_rest(drawn.polygon.quantity))
        for number, words in enumerate(reversed(told), 1):
            room = (box.width - 3.0) / MM_PER_IN
            at = box.bottom + 1.8 + 2.8 * number
            text(axes, box.left + 1.5, at, cut(words, room, TINY), TINY, color=DOUBT)


def _logged(sheet: PolygonSheet) -> dict[str, str]:
    log, misplaced = sheet.log, sheet.misplaced
    if log is None or misplaced is None:
        return {}
    name = Path(log.source).name
    told = {"scheme": f"{name}: {misplaced.words}"} if misplaced.errors else {}
    for drawn in (sheet.velocity, sheet.acceleration):
        if drawn.logged is not None and drawn.logged.errors:
            words = f"{name}, {drawn.logged_by}: {drawn.logged.words}"
        else:
            words = f"{name}: no {drawn.polygon.quantity} of any point in it"
        told[drawn.polygon.quantity] = words
    return told


def _letters(sheet: PolygonSheet) -> dict[str, list[Letter]]:
    placement = sheet.drawn.placement
    places = {name: sheet.place(at) for name, at in placement.points.items()}
    of_scheme = point_letters(placement, places)
    if (log := sheet.misplaced) is not None:
        of_scheme += [
            Letter(f"{name}{polygon_on_paper.STAR}", tip[None], 0.0, SMALL, LOGGED)
            for name, tip in log.tips.items()
            if np.any(log.errors[name])
        ]
    return {
        "scheme": of_scheme,
        "velocity": polygon_letters(sheet.velocity),
        "acceleration": polygon_letters(sheet.acceleration),
    }
