"""The sheet of instant centres, with the circles and centrodes of a link."""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, TypeGuard

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Circle as Round
from matplotlib.patches import Rectangle

from analytic.kinematics import solve_driven
from analytic.lectures.drawings.drawn_polygons import DrawnPolygons
from analytic.lectures.drawings.instant_centres import (
    Centre,
    Centrodes,
    CurvatureCircles,
    Pair,
    centrodes,
    curvature_circles,
    instant_centres,
)
from models.array import Array
from models.errors import CrankcheckError
from models.scene import GROUND
from reports.figures.style import INK, SMALL, cut
from reports.lectures.drawing.sheets.letters import Letter, together, write_letters
from reports.lectures.drawing.sheets.paper import (
    MM_PER_IN,
    Box,
    Canvas,
    Paper,
    ToScale,
    arc_places,
    headed,
    inner_box,
    line,
    near_angles,
    text,
)
from reports.lectures.drawing.sheets.scheme import assembled, draw_scheme, extent_of, range_about

POLYGON_MM = 42.0
"""Height of the polygon of centres, at the top [mm]."""
ROW_MM, SAMPLE_MM, CURVE_ROWS = 4.0, 7.0, 7.5
"""Height of a line of the column, sample of a curve before its name; lines for poles and curves."""
INFLECTION, NO_TANGENTIAL = "#2e6f9e", "#3a7d44"
FIXED, MOVING, THEOREM = "#b7791f", "#6b4e9b", "#a9b3bf"


def write_legend(axes: Axes, numbers: Mapping[str, int], link: str, column: Box) -> None:
    """Write the bodies by number; with a ``link``, also the key of its poles and curves."""
    left, y = column.left + 2.0, column.top - POLYGON_MM - ROW_MM
    room = (column.width - 4.0) / MM_PER_IN
    for body, k in numbers.items():
        text(axes, left, y, cut(f"{k}  {body}", room, SMALL), SMALL)
        y -= ROW_MM
    if not link:
        return
    y -= 0.5 * ROW_MM
    for words in (f"of {link}:", "P  velocity pole", "Q  acceleration pole"):
        text(axes, left, y, cut(words, room, SMALL), SMALL)
        y -= ROW_MM
    kinds = {
        "inflection circle": INFLECTION, "second circle of Bresse": NO_TANGENTIAL,
        "fixed centrode": FIXED, "moving centrode": MOVING,
    }  # fmt: skip
    for words, colour in kinds.items():
        start = np.array([left, y + 0.8])
        line(axes, start, start + np.array([SAMPLE_MM, 0.0]), color=colour, linewidth=0.9)
        text(axes, left + SAMPLE_MM + 1.5, y, words, SMALL)
        y -= ROW_MM


def body_numbers(drawn: DrawnPolygons) -> dict[str, int]:
    """The numbers of the bodies, as in books: 0 the ground, 1 the driver, then the rest."""
    placement = drawn.placement
    driver = placement.scene.driver.link
    rest = [body for body in placement.structure.bodies if body != driver]
    return {body: k for k, body in enumerate([GROUND, driver, *rest])}


def centre_name(pair: Pair, numbers: Mapping[str, int]) -> str:
    """The name of a centre, such as P12, the lower number first."""
    low, high = sorted(numbers[body] for body in pair)
    return f"P{low}{high}" if high < 10 else f"P{low}.{high}"


def draw_polygon_of_centres(
    axes: Axes, centres: Mapping[Pair, Centre], numbers: Mapping[str, int], column: Box
) -> None:
    """Draw bodies as corners, centres of joints as full sides, others dashed; atop the column."""
    middle = np.array([column.middle[0], column.top - POLYGON_MM / 2])
    radius = POLYGON_MM / 2 - 5.0
    angles = math.pi / 2 + math.tau * np.arange(len(numbers)) / len(numbers)
    corners = middle + radius * np.stack([np.cos(angles), np.sin(angles)], axis=1)
    for pair, centre in centres.items():
        one, other = (corners[numbers[body]] for body in sorted(pair))
        style = (0, (3, 2)) if centre.by else "-"
        line(axes, one, other, color=THEOREM if centre.by else INK, linewidth=0.6, linestyle=style)
    for body, k in numbers.items():
        at = corners[k]
        axes.add_patch(Round(tuple(at), 2.2, fc="white", ec=INK, lw=0.6, zorder=7))
        look: dict[str, Any] = {"ha": "center", "zorder": 8, "gid": f"body-{body}"}
        text(axes, at[0], at[1] - 0.75, str(k), SMALL, **look)


PADDING = 12.0
NEAR_MM = 0.5
"""Distance of centres [mm] below which their names share a label."""
COLUMN_MM = 46.0
"""Width of the column on the right."""
FAR = 1.5
"""Distance from the mechanism, in its sizes, beyond which centres are not drawn."""
POLE = "#d1495b"
CENTRE_MM, CENTRE_SIZE = 0.8, 7.0
"""Radius of a centre's circle [mm], and the type of its name [point]."""
GAP = 3.0
DENSE = 1441
"""Number of places along a centrode."""


@dataclass(frozen=True)
class CentreSheet(ToScale):
    """The centres at one position, and the circles and centrodes of the named link, if any; the
    column of words stands on the right."""

    drawn: DrawnPolygons
    centres: Mapping[Pair, Centre]
    link: str
    circles: CurvatureCircles | None
    centrodes: Centrodes | None
    column: Box
    paper: Paper

    def is_near(self, place: Array | None) -> TypeGuard[Array]:
        """True if a place [m] is on the sheet."""
        if place is None:
            return False
        away = np.abs(self.at(place) - self.box.middle)
        return bool(np.all(away < (self.box.width / 2 - 3.0, self.box.height / 2 - 3.0)))


def centres_of(drawn: DrawnPolygons, link: str, paper: Paper) -> CentreSheet:
    """The sheet of a position; ``link`` is "" for the centres alone.

    Raises CrankcheckError for a link that the scene has not, or that does not turn, and for paper
    that is too small.
    """
    placement = drawn.placement
    if drawn.undetermined:
        raise CrankcheckError(
            f"{placement.scene.name}: velocities are not determined here, and neither are centres "
            f"({drawn.undetermined[0]}); take another angle"
        )
    centres = instant_centres(placement)
    circles = curves = None
    if link:
        if link not in placement.scene.links:
            known = ", ".join(placement.scene.links)
            raise CrankcheckError(f"--link {link}: no such link; there are {known}")
        circles = curvature_circles(drawn, link)
        curves = _centrodes_of(drawn, link)
    box, column = inner_box(paper).side_by_side(COLUMN_MM, GAP)
    bodies = len(body_numbers(drawn))
    needed = POLYGON_MM + ROW_MM * (bodies + (CURVE_ROWS if link else 0.0) + 1.0)
    if column.height < needed:
        tall = math.ceil(paper.height - column.height + needed)
        raise CrankcheckError(
            f"--paper {paper.width:g}x{paper.height:g}: too low for the names of {bodies} bodies"
            + (" and of the curves" if link else "")
            + f"; {paper.width:g}x{tall} would do"
        )
    fitted = box.fitted(_shown(drawn, centres, circles), PADDING)
    return CentreSheet(box, *fitted, drawn, centres, link, circles, curves, column, paper)


def _centrodes_of(drawn: DrawnPolygons, link: str) -> Centrodes:
    """The centrodes over the range of the driver, with gaps at its singular angles."""
    scene = drawn.placement.scene
    theta = np.linspace(*range_about(scene, drawn.placement.driver.theta), DENSE)[1:-1]
    possible = assembled(scene, theta)
    one = np.ones(1)
    motion = solve_driven(scene, theta[possible], one, 0.0 * one, bound=False)
    some = centrodes(motion, link, next(iter(scene.links[link].points)))
    fixed, moving = (np.full((theta.size, 2), np.nan) for _ in range(2))
    fixed[possible], moving[possible] = some.fixed, some.moving
    return Centrodes(fixed, moving)


def _shown(
    drawn: DrawnPolygons, centres: Mapping[Pair, Centre], circles: CurvatureCircles | None
) -> Array:
    """The mechanism, and the centres near it [m], (n, 2)."""
    points = extent_of(drawn.placement)
    low, high = points.min(axis=0), points.max(axis=0)
    about, size = (low + high) / 2, float(np.max(high - low))
    more = [centre.place for centre in centres.values() if centre.place is not None]
    if circles is not None:
        more += [circles.pole, circles.acceleration_pole, circles.inflection.middle]
    near = [at for at in more if np.abs(at - about).max() < FAR * size]
    return np.array([*points, *near])


def draw_centres(sheet: CentreSheet, note: str) -> Canvas:
    """The sheet, in layers."""
    scene, driver = sheet.drawn.placement.scene, sheet.drawn.placement.driver
    angle = math.degrees(driver.theta) % 360.0
    title = (
        f"{scene.name}: instant centres, {scene.driver.link} at {angle:.6g}°, "
        f"K_l = {sheet.scale:g} m/mm"
    )
    canvas, _ = headed(sheet.paper, title, note, sheet.box, sheet.column)
    if sheet.centrodes is not None:
        _draw_centrodes(canvas.layer("centrodes"), sheet, sheet.centrodes)
    if sheet.circles is not None:
        _circles(canvas.layer("circles"), sheet, sheet.circles)
    draw_scheme(canvas.layer("mechanism"), sheet.drawn.placement, sheet.at)
    _centres(canvas.layer("centres"), sheet)
    numbers = body_numbers(sheet.drawn)
    axes = canvas.layer("polygon-of-centres")
    draw_polygon_of_centres(axes, sheet.centres, numbers, sheet.column)
    write_legend(canvas.layer("legend"), numbers, sheet.link, sheet.column)
    write_letters(canvas, canvas.layer("letters"), _letters(sheet), sheet.box)
    return canvas


def _draw_centrodes(axes: Axes, sheet: CentreSheet, curves: Centrodes) -> None:
    """Draw both curves, as far as they are on the sheet; the moving one in the link's position."""
    theta = sheet.drawn.placement.angles[sheet.link]
    first = next(iter(sheet.drawn.placement.scene.links[sheet.link].points))
    c, s = math.cos(theta), math.sin(theta)
    turned = curves.moving @ np.array([[c, s], [-s, c]])
    moving = sheet.drawn.placement.points[first] + turned
    for places, colour in ((curves.fixed, FIXED), (moving, MOVING)):
        drawn = sheet.at(places)
        inside = np.abs(drawn - sheet.box.middle) < (sheet.box.width / 2, sheet.box.height / 2)
        drawn[~inside.all(axis=1)] = np.nan
        axes.plot(drawn[:, 0], drawn[:, 1], color=colour, lw=0.7)


def _circles(axes: Axes, sheet: CentreSheet, circles: CurvatureCircles) -> None:
    box = sheet.box
    edge = Rectangle((box.left, box.bottom), box.width, box.height, transform=axes.transData)
    for circle, colour in ((circles.inflection, INFLECTION), (circles.still_speed, NO_TANGENTIAL)):
        if circle is not None:
            middle, radius = sheet.at(circle.middle), circle.radius / sheet.scale
            arc = arc_places(middle, radius, *near_angles(middle, radius, *box.corners))
            drawn = axes.plot(arc[:, 0], arc[:, 1], color=colour, lw=0.7)[0]
            drawn.set_clip_path(edge)


def _centres(axes: Axes, sheet: CentreSheet) -> None:
    """Draw every centre on the sheet, and the lines of the theorem that cross in it."""
    for centre in sheet.centres.values():
        if not sheet.is_near(centre.place):
            continue
        here = sheet.at(centre.place)
        for pairs in centre.by:
            for pair in pairs:
                other = sheet.centres[pair].place
                if sheet.is_near(other):
                    line(axes, here, sheet.at(other), color=THEOREM, linewidth=0.5)
        axes.add_patch(Round(tuple(here), CENTRE_MM, fc="white", ec=POLE, lw=0.8, zorder=7))
    if sheet.circles is not None and sheet.is_near(sheet.circles.acceleration_pole):
        there = sheet.at(sheet.circles.acceleration_pole)
        axes.add_patch(Round(tuple(there), 0.5 * CENTRE_MM, fc=POLE, ec="none", zorder=7))


def _letters(sheet: CentreSheet) -> list[Letter]:
    numbers, circles = body_numbers(sheet.drawn), sheet.circles
    places = {centre_name(pair, numbers): centre.place for pair, centre in sheet.centres.items()}
    if circles is not None:
        places |= {"P": circles.pole, "Q": circles.acceleration_pole}
    near = {name: place for name, place in places.items() if sheet.is_near(place)}
    joined = together({name: sheet.at(place) for name, place in near.items()}, NEAR_MM)
    return [Letter(name, spot, CENTRE_MM, CENTRE_SIZE) for name, spot in joined.items()]
