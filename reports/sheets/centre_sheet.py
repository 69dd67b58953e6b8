"""The sheet of instant centres, with the circles and centrodes of a link."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Circle as Round
from matplotlib.patches import Rectangle

from analytic.drawings.centrodes import Centrodes, centrodes
from analytic.drawings.curvature_circles import CurvatureCircles, curvature_circles
from analytic.drawings.drawn_polygons import DrawnPolygons
from analytic.drawings.instant_centres import Centre, Pair, instant_centres
from analytic.drawings.paper_scale import round_scale
from analytic.kinematics import solve_driven
from models.array import Array
from models.errors import CrankcheckError
from models.scene import GROUND
from reports.figures.style import INK, SMALL, cut
from reports.sheets.canvas import Canvas, line, text
from reports.sheets.driver_range import range_about
from reports.sheets.letters import Letter, together, write_letters
from reports.sheets.paper import MM_PER_IN, Box, Paper
from reports.sheets.scheme import draw_scheme
from reports.sheets.sheet_frame import draw_border, inner_box, write_head

PADDING = 12.0
NEAR_MM = 0.5
"""Centres that stand nearer have their names in one label."""
COLUMN_MM, POLYGON_MM = 46.0, 42.0
"""Width of the column on the right, and of the polygon of centres, which is at its top."""
ROW_MM, SAMPLE_MM, CURVE_ROWS = 4.0, 7.0, 7.5
"""A line of the column, the sample of a curve before its name; lines that tell poles and curves."""
FAR = 1.5
"""Centres that are further from the mechanism than so many times its size are told, not drawn."""
POLE, INFLECTION, STILL = "#d1495b", "#2e6f9e", "#3a7d44"
FIXED, MOVING, THEOREM = "#b7791f", "#6b4e9b", "#a9b3bf"
CENTRE_MM, CENTRE_SIZE = 0.8, 7.0
"""Radius of a centre's circle, and the type of its name [point]."""
GAP = 3.0
DENSE = 1441


@dataclass(frozen=True)
class CentreSheet:
    """The centres at one position, and what is drawn of the link that was named, if one was."""

    drawn: DrawnPolygons
    centres: Mapping[Pair, Centre]
    link: str
    circles: CurvatureCircles | None
    ways: Centrodes | None
    scale: float
    middle: Array
    paper: Paper

    @property
    def box(self) -> Box:
        return _boxes(self.paper)[0]

    def at(self, places: Array) -> Array:
        """Where places [m], (..., 2), stand on the sheet [mm]."""
        return np.asarray(self.box.middle + (places - self.middle) / self.scale)

    def is_near(self, place: Array | None) -> bool:
        """Whether a place [m] is on the sheet."""
        if place is None:
            return False
        away = np.abs(self.at(place) - self.box.middle)
        return bool(np.all(away < (self.box.width / 2 - 3.0, self.box.height / 2 - 3.0)))


def centres_of(drawn: DrawnPolygons, link: str, paper: Paper) -> CentreSheet:
    """The sheet of a position; ``link`` is "" for the centres alone.

    Raises CrankcheckError for a link that the scene has not, or that does not turn, and for paper
    on which not all fits.
    """
    placement = drawn.placement
    if drawn.undetermined:
        raise CrankcheckError(
            f"{placement.scene.name}: velocities are not determined here, and neither are centres "
            f"({drawn.undetermined[0]}); take another angle"
        )
    centres = instant_centres(placement)
    circles = ways = None
    if link:
        if link not in placement.scene.links:
            known = ", ".join(placement.scene.links)
            raise CrankcheckError(f"--link {link}: no such link; there are {known}")
        circles = curvature_circles(drawn.rates[link], link)
        ways = _ways(drawn, link)
    _check_room(drawn, paper, rows_of_curves=CURVE_ROWS if link else 0.0)
    scale, middle = _frame(drawn, centres, circles, paper)
    return CentreSheet(drawn, centres, link, circles, ways, scale, middle, paper)


def _check_room(drawn: DrawnPolygons, paper: Paper, rows_of_curves: float) -> None:
    """Refuse paper on which the column on the right does not fit."""
    bodies = len(body_numbers(drawn))
    column = _boxes(paper)[1]
    needed = POLYGON_MM + ROW_MM * (bodies + rows_of_curves + 1.0)
    if column.height < needed:
        tall = math.ceil(paper.height - column.height + needed)
        raise CrankcheckError(
            f"--paper {paper.width:g}x{paper.height:g}: too low for the names of {bodies} bodies"
            + (" and of the curves" if rows_of_curves else "")
            + f"; {paper.width:g}x{tall} would do"
        )


def _ways(drawn: DrawnPolygons, link: str) -> Centrodes:
    """The centrodes over what the driver reaches."""
    scene = drawn.placement.scene
    theta = np.linspace(*range_about(scene, drawn.placement.driver.theta), DENSE)[1:-1]
    ones = np.ones_like(theta)
    motion = solve_driven(scene, theta, ones, 0.0 * ones, bound=False)
    return centrodes(motion, link, next(iter(scene.links[link].points)))


def _frame(
    drawn: DrawnPolygons,
    centres: Mapping[Pair, Centre],
    circles: CurvatureCircles | None,
    paper: Paper,
) -> tuple[float, Array]:
    """The scale [m/mm], and what is in the middle [m]: the mechanism, and what is near it."""
    points = np.array(list(drawn.placement.points.values()))
    low, high = points.min(axis=0), points.max(axis=0)
    about, size = (low + high) / 2, float(np.max(high - low))
    more = [centre.place for centre in centres.values() if centre.place is not None]
    if circles is not None:
        more += [circles.pole, circles.acceleration_pole, circles.inflection.middle]
    near = [at for at in more if np.abs(at - about).max() < FAR * size]
    places = np.array([*points, *near])
    low, high = places.min(axis=0), places.max(axis=0)
    box = _boxes(paper)[0]
    room = np.array([box.width, box.height]) - 2 * PADDING
    scales = [round_scale(s, r) for s, r in zip(high - low, room, strict=True) if s > 0.0]
    return max(scales), (low + high) / 2


def _boxes(paper: Paper) -> tuple[Box, Box]:
    """The drawing, and the column on its right."""
    inner = inner_box(paper)
    wide = inner.width - COLUMN_MM - GAP
    left = inner.left + wide + GAP
    return (
        Box(inner.left, inner.bottom, wide, inner.height),
        Box(left, inner.bottom, COLUMN_MM, inner.height),
    )


def draw_centres(sheet: CentreSheet, note: str) -> Canvas:
    """The sheet, in layers."""
    canvas = Canvas(sheet.paper)
    _head(canvas.layer("frame"), sheet, note)
    if sheet.ways is not None:
        _centrodes(canvas.layer("centrodes"), sheet, sheet.ways)
    if sheet.circles is not None:
        _circles(canvas.layer("circles"), sheet, sheet.circles)
    points = {name: sheet.at(at) for name, at in sheet.drawn.placement.points.items()}
    draw_scheme(canvas.layer("mechanism"), sheet.drawn.placement, points)
    _centres(canvas.layer("centres"), sheet)
    column = _boxes(sheet.paper)[1]
    _polygon(canvas.layer("polygon-of-centres"), sheet, column)
    _legend(canvas.layer("legend"), sheet, column)
    write_letters(canvas, canvas.layer("letters"), _letters(sheet), sheet.box)
    return canvas


def _head(axes: Axes, sheet: CentreSheet, note: str) -> None:
    scene, driver = sheet.drawn.placement.scene, sheet.drawn.placement.driver
    angle = math.degrees(driver.theta) % 360.0
    title = (
        f"{scene.name}: instant centres, {scene.driver.link} at {angle:.6g}°, "
        f"K_l = {sheet.scale:g} m/mm"
    )
    write_head(axes, sheet.paper, title, note)
    for box in _boxes(sheet.paper):
        draw_border(axes, box)


def _legend(axes: Axes, sheet: CentreSheet, column: Box) -> None:
    """The bodies by number; of the link that was named, what is which curve."""
    left, y = column.left + 2.0, column.bottom + column.height - POLYGON_MM - ROW_MM
    room = (column.width - 4.0) / MM_PER_IN
    for body, k in body_numbers(sheet.drawn).items():
        text(axes, left, y, cut(f"{k}  {body}", room, SMALL), SMALL)
        y -= ROW_MM
    if sheet.circles is None:
        return
    y -= 0.5 * ROW_MM
    for words in (f"of {sheet.link}:", "P  velocity pole", "Q  acceleration pole"):
        text(axes, left, y, cut(words, room, SMALL), SMALL)
        y -= ROW_MM
    kinds = {
        "inflection circle": INFLECTION, "second circle of Bresse": STILL,
        "fixed centrode": FIXED, "moving centrode": MOVING,
    }  # fmt: skip
    for words, colour in kinds.items():
        start = np.array([left, y + 0.8])
        line(axes, start, start + np.array([SAMPLE_MM, 0.0]), color=colour, linewidth=0.9)
        text(axes, left + SAMPLE_MM + 1.5, y, words, SMALL)
        y -= ROW_MM


def _centrodes(axes: Axes, sheet: CentreSheet, ways: Centrodes) -> None:
    """Both ways of the pole, as far as they are on the sheet; the moving one as the link stands."""
    theta = sheet.drawn.placement.angles[sheet.link]
    first = next(iter(sheet.drawn.placement.scene.links[sheet.link].points))
    c, s = math.cos(theta), math.sin(theta)
    turned = ways.moving @ np.array([[c, s], [-s, c]])
    moving = sheet.drawn.placement.points[first] + turned
    for places, colour in ((ways.fixed, FIXED), (moving, MOVING)):
        drawn = sheet.at(places)
        inside = np.abs(drawn - sheet.box.middle) < (sheet.box.width / 2, sheet.box.height / 2)
        drawn[~inside.all(axis=1)] = np.nan
        axes.plot(drawn[:, 0], drawn[:, 1], color=colour, lw=0.7)


def _circles(axes: Axes, sheet: CentreSheet, circles: CurvatureCircles) -> None:
    box = sheet.box
    edge = Rectangle((box.left, box.bottom), box.width, box.height, transform=axes.transData)
    for circle, colour in ((circles.inflection, INFLECTION), (circles.still_speed, STILL)):
        if circle is not None:
            x, y = sheet.at(circle.middle)
            drawn = axes.add_patch(
                Round((x, y), circle.radius / sheet.scale, fill=False, ec=colour, lw=0.7)
            )
            drawn.set_clip_path(edge)


def _centres(axes: Axes, sheet: CentreSheet) -> None:
    """Every centre on the sheet, and the lines that cross in it, of the theorem."""
    for centre in sheet.centres.values():
        if not sheet.is_near(centre.place):
            continue
        assert centre.place is not None
        here = sheet.at(centre.place)
        for pairs in centre.by:
            for pair in pairs:
                other = sheet.centres[pair].place
                if other is not None and sheet.is_near(other):
                    line(axes, here, sheet.at(other), color=THEOREM, linewidth=0.5)
        axes.add_patch(Round(tuple(here), CENTRE_MM, fc="white", ec=POLE, lw=0.8, zorder=7))
    if sheet.circles is not None and sheet.is_near(sheet.circles.acceleration_pole):
        there = sheet.at(sheet.circles.acceleration_pole)
        axes.add_patch(Round(tuple(there), 0.5 * CENTRE_MM, fc=POLE, ec="none", zorder=7))


def _letters(sheet: CentreSheet) -> list[Letter]:
    numbers, circles = body_numbers(sheet.drawn), sheet.circles
    places = {name_of(pair, numbers): centre.place for pair, centre in sheet.centres.items()}
    if circles is not None:
        places |= {"P": circles.pole, "Q": circles.acceleration_pole}
    at = {
        name: sheet.at(place)
        for name, place in places.items()
        if place is not None and sheet.is_near(place)
    }
    joined = together(at, NEAR_MM)
    return [Letter(name, spot, CENTRE_MM, CENTRE_SIZE) for name, spot in joined.items()]


def body_numbers(drawn: DrawnPolygons) -> dict[str, int]:
    """The numbers of the bodies, as books have them: 0 the ground, 1 the driver, then the rest."""
    placement = drawn.placement
    driver = placement.scene.driver.link
    rest = [body for body in placement.structure.bodies if body != driver]
    return {body: k for k, body in enumerate([GROUND, driver, *rest])}


def name_of(pair: Pair, numbers: Mapping[str, int]) -> str:
    """P12 and the like, the lower number first."""
    low, high = sorted(numbers[body] for body in pair)
    return f"P{low}{high}" if high < 10 else f"P{low}.{high}"


def _polygon(axes: Axes, sheet: CentreSheet, column: Box) -> None:
    """The polygon of centres: bodies as corners, centres of joints as full sides, others dashed."""
    numbers = body_numbers(sheet.drawn)
    top = column.bottom + column.height
    middle = np.array([column.left + column.width / 2, top - POLYGON_MM / 2])
    radius = POLYGON_MM / 2 - 5.0
    angles = math.pi / 2 + math.tau * np.arange(len(numbers)) / len(numbers)
    corners = middle + radius * np.stack([np.cos(angles), np.sin(angles)], axis=1)
    for pair, centre in sheet.centres.items():
        one, other = (corners[numbers[body]] for body in sorted(pair))
        style = (0, (3, 2)) if centre.by else "-"
        line(axes, one, other, color=THEOREM if centre.by else INK, linewidth=0.6, linestyle=style)
    for body, k in numbers.items():
        at = corners[k]
        axes.add_patch(Round(tuple(at), 2.2, fc="white", ec=INK, lw=0.6, zorder=7))
        look: dict[str, Any] = {"ha": "center", "zorder": 8, "gid": f"body-{body}"}
        text(axes, at[0], at[1] - 0.75, str(k), SMALL, **look)
