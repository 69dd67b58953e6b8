"""The sheet of positions: a turn of the crank in equal parts, with the loci of the points.

Every pin of a group is found as in a drawing: arcs about its neighbour pins, or a ray along a line,
cross in it (lecture "Phan tich dong hoc", part II); the first position is drawn in full.
"""

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Arc, Circle

from analytic.kinematics import solve_driven
from analytic.lectures.drawings.placed_mechanism import DriverState, PlacedMechanism
from analytic.structure.groups import Group
from models.array import Array
from models.errors import CrankcheckError
from models.scene import Scene
from reports.figures.style import INK, QUIET
from reports.lectures.drawing.sheets import scheme
from reports.lectures.drawing.sheets.letters import NUMBER, Letter, write_letters
from reports.lectures.drawing.sheets.paper import Canvas, Paper, ToScale, headed, inner_box

PADDING = 12.0
LEAST_APART_MM = 2.5
"""Least distance of divisions of the crank circle that can be numbered."""
LOCUS, LOCUS_PLACES = 361, 36
"""Number of places along a locus, and of those considered for its name."""
LEAST_WAY_MM = 0.1
"""Least path of a moving point."""
ARC_MM, DOT_MM = 4.0, 0.45
"""Half the length of the arcs of the construction, and the radius of a position's mark."""
FAINT, LOCI = "#a9b3bf", "#b7791f"


@dataclass(frozen=True)
class PositionSheet(ToScale):
    """The mechanism at ``angles`` of the driver (n,), its points there and along the loci [m]."""

    scene: Scene
    placement: PlacedMechanism
    angles: Array
    points: dict[str, Array]
    loci: dict[str, Array]
    paper: Paper


def positions(scene: Scene, divisions: int, paper: Paper) -> PositionSheet:
    """The scene with its crank circle in so many parts, from the driver's angle at time 0 on; a
    slider, or a driver that does not turn fully, is drawn from end to end of its range. The
    positions are numbered in the sense in which the driver starts.

    Raises CrankcheckError where the parts are too small to be distinguished on the paper.
    """
    start = float(scene.driver.law.at(np.zeros(1))[0][0])
    low, high = scheme.range_of_law(scene)
    sense = scheme.sense_of_law(scene)
    whole = scene.driver.slider is None and high - low >= math.tau - 1e-9
    if whole:
        angles = start + sense * math.tau * np.arange(divisions) / divisions
        dense = np.linspace(start, start + math.tau, LOCUS)
    else:
        first, last = (low, high) if sense > 0.0 else (high, low)
        angles, dense = np.linspace(first, last, divisions), np.linspace(first, last, LOCUS)
    points, loci = (_points(scene, each) for each in (angles, dense))
    placement = PlacedMechanism.of(scene, DriverState(float(angles[0]), sense))
    places = np.concatenate([*loci.values(), scheme.extent_of(placement)])
    box = inner_box(paper)
    fitted = box.fitted(places, PADDING)
    sheet = PositionSheet(box, *fitted, scene, placement, angles, points, loci, paper)
    _check_apart(sheet, divisions)
    return sheet


def _points(scene: Scene, angles: Array) -> dict[str, Array]:
    """All points at driver angles [m], (n, 2) each."""
    ones = np.ones_like(angles)
    motion = solve_driven(scene, angles, ones, 0.0 * ones, links=(), sliders=(), bound=False)
    return {name: point.position for name, point in motion.points.items()}


def _check_apart(sheet: PositionSheet, divisions: int) -> None:
    apart = max(
        float(np.hypot(*np.diff(sheet.at(sheet.points[name])[:2], axis=0)[0]))
        for name in _driven(sheet.scene)
    )
    if apart < LEAST_APART_MM:
        fit = max(2, int(divisions * apart / LEAST_APART_MM))
        joint, paper = sheet.scene.driver.joint, sheet.paper
        raise CrankcheckError(
            f"--divisions {divisions}: the positions of {joint} are {apart:.2g} mm apart on "
            f"{paper.width:g} x {paper.height:g} mm; at most {fit} fit, or take larger paper"
        )


def _driven(scene: Scene) -> tuple[str, ...]:
    """The points that the driver moves: of a crank, the point of a slider, a pin of two links."""
    driver = scene.driver
    if driver.slider is not None:
        return (scene.sliders[driver.slider].point,)
    return (driver.pin,) if driver.pin is not None else tuple(scene.links[driver.link].points)


def draw_positions(sheet: PositionSheet, note: str) -> Canvas:
    """Draw the sheet, in layers: loci, positions, construction, the mechanism, letters."""
    joint, count = sheet.scene.driver.joint, len(sheet.angles)
    title = f"{sheet.scene.name}: {count} positions of {joint}, K_l = {sheet.scale:g} m/mm"
    canvas, _ = headed(sheet.paper, title, note, sheet.box)
    loci = canvas.layer("loci")
    for name, way in _ways(sheet):
        loci.plot(way[:, 0], way[:, 1], color=LOCI, lw=0.8, gid=f"locus-{name}")
    _positions(canvas.layer("positions"), sheet)
    _construction(canvas.layer("construction"), sheet)
    scheme.draw_scheme(canvas.layer("mechanism"), sheet.placement, sheet.at)
    write_letters(canvas, canvas.layer("letters"), _letters(sheet), sheet.box)
    return canvas


def _ways(sheet: PositionSheet) -> Iterator[tuple[str, Array]]:
    """The paths of all points that move [mm], (n, 2) each."""
    for name, way in sheet.loci.items():
        places = sheet.at(way)
        if np.ptp(places, axis=0).max() > LEAST_WAY_MM:
            yield name, places


def _positions(axes: Axes, sheet: PositionSheet) -> None:
    for k in range(len(sheet.angles)):
        places = {name: sheet.at(at[k]) for name, at in sheet.points.items()}
        scheme.draw_outline(axes, sheet.scene.links.values(), places, FAINT, 0.5)
    for name in _driven(sheet.scene):
        for at in sheet.at(sheet.points[name]):
            axes.add_patch(Circle(tuple(at), DOT_MM, fc=FAINT, ec="none"))


def _construction(axes: Axes, sheet: PositionSheet) -> None:
    """Draw the arcs about outer pins that cross in the inner pin of each group."""
    for part in sheet.placement.structure.order:
        if not isinstance(part, Group) or part.kind not in ("RRR", "RRP"):
            continue
        outer = [part.outer1, part.outer2] if part.kind == "RRR" else [part.outer1]
        inner = sheet.at(sheet.points[part.inner])
        for pin in outer:
            about = sheet.at(sheet.points[pin])
            for centre, end in zip(about, inner, strict=True):
                _arc(axes, centre, end)


def _arc(axes: Axes, centre: Array, through: Array) -> None:
    """Draw a short arc about a centre on both sides of a place [mm]."""
    away = through - centre
    radius = float(np.hypot(*away))
    angle, half = math.degrees(math.atan2(away[1], away[0])), math.degrees(ARC_MM / radius)
    ends = {"theta1": angle - half, "theta2": angle + half}
    axes.add_patch(Arc(tuple(centre), 2 * radius, 2 * radius, color=INK, lw=0.5, **ends))


def _letters(sheet: PositionSheet) -> list[Letter]:
    spots = {name: sheet.at(at[0]) for name, at in sheet.points.items()}
    letters = scheme.point_letters(sheet.placement, spots)
    pivot = sheet.scene.driver_pivot if sheet.scene.driver.is_crank else ""
    pin, *others = _driven(sheet.scene)
    if pivot:
        pin = max((pin, *others), key=lambda name: float(np.hypot(*(spots[name] - spots[pivot]))))
    for k, at in enumerate(sheet.at(sheet.points[pin])):
        radius = scheme.symbol_radius(sheet.placement, pin) if k == 0 else DOT_MM
        letters.append(Letter(str(k), at, radius, NUMBER, QUIET))
    for name, places in _ways(sheet):
        few = places[:: max(1, len(places) // LOCUS_PLACES)]
        letters.append(Letter(f"locus of {name}", few, 0.2, NUMBER, LOCI))
    return letters
