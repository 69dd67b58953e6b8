"""The sheet of positions: a turn of the crank in equal parts, with the loci of the points.

Every pin of a group is found as one draws it: arcs about the pins that it hangs on, or a ray along
a line, cross in it (lecture "Phan tich dong hoc", part II); the first position is drawn full.
"""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Arc, Circle

from analytic.drawings.paper_scale import round_scale
from analytic.drawings.placed_mechanism import DriverState, PlacedMechanism
from analytic.kinematics import reach, solve_driven
from analytic.structure.groups import Group
from models.array import Array
from models.errors import CrankcheckError
from models.laws import Oscillating
from models.scene import Scene
from reports.drawing.lettering import Label, place
from reports.figures.style import INK, POINTS, QUIET, SMALL, TINY, width_in
from reports.sheets.canvas import Canvas, line, text
from reports.sheets.paper import MM_PER_IN, Box, Paper
from reports.sheets.scheme import draw_scheme
from reports.sheets.sheet_frame import draw_border, inner_box, write_head

PADDING = 12.0
LEAST_APART_MM = 2.5
"""Divisions of the crank circle that stand closer can not be numbered."""
LOCUS = 361
ARC_DEG = 5.0
FAINT, LOCI = "#9aa5b1", "#b7791f"


@dataclass(frozen=True)
class PositionSheet:
    """The mechanism at ``angles`` of the driver (n,), its points there and along the loci
    [m], and the scale of lengths [m/mm]."""

    scene: Scene
    placement: PlacedMechanism
    angles: Array
    points: dict[str, Array]
    loci: dict[str, Array]
    scale: float
    middle: Array
    paper: Paper

    @property
    def box(self) -> Box:
        return inner_box(self.paper)

    def at(self, place: Array) -> Array:
        """Where places [m], (..., 2), stand on the sheet [mm]."""
        return np.asarray(self.box.middle + (place - self.middle) / self.scale)


def positions(scene: Scene, divisions: int, paper: Paper) -> PositionSheet:
    """The scene with its crank circle in so many parts, from the driver's angle at time 0 on.

    Raises CrankcheckError where the parts are too small to be told apart on the paper.
    """
    start = float(scene.driver.law.at(np.zeros(1))[0][0])
    low, high = _reach_about(scene, start)
    whole = high - low >= math.tau - 1e-9
    if whole:
        angles = start + math.tau * np.arange(divisions) / divisions
        dense = np.linspace(start, start + math.tau, LOCUS)
    else:
        angles, dense = np.linspace(low, high, divisions), np.linspace(low, high, LOCUS)
    points, loci = (_points(scene, each) for each in (angles, dense))
    places = np.concatenate(list(loci.values()))
    corner, size = places.min(axis=0), np.ptp(places, axis=0)
    box = inner_box(paper)
    room = np.array([box.width, box.height]) - 2 * PADDING
    scale = max(round_scale(s, r) for s, r in zip(size, room, strict=True) if s > 0.0)
    placement = PlacedMechanism.of(scene, DriverState(float(angles[0]), 1.0))
    sheet = PositionSheet(scene, placement, angles, points, loci, scale, corner + size / 2, paper)
    _check_apart(sheet, divisions)
    return sheet


def _reach_about(scene: Scene, start: float) -> tuple[float, float]:
    """The driver's angles: those that it swings through, or can reach from its start."""
    law = scene.driver.law
    if isinstance(law, Oscillating):
        swing = abs(law.amplitude_rad)
        return law.centre_rad - swing, law.centre_rad + swing
    for low, high in reach(scene):
        shift = math.tau * round((start - 0.5 * (low + high)) / math.tau)
        if low + shift - 1e-9 <= start <= high + shift + 1e-9:
            return low + shift, high + shift
    raise CrankcheckError(f"{scene.name}: can not be assembled at its start")


def _points(scene: Scene, angles: Array) -> dict[str, Array]:
    """All points at driver angles [m], (n, 2) each."""
    ones = np.ones_like(angles)
    motion = solve_driven(scene, angles, ones, 0.0 * ones, links=(), sliders=(), bound=False)
    return {name: point.position for name, point in motion.points.items()}


def _check_apart(sheet: PositionSheet, divisions: int) -> None:
    """Refuse divisions that fall together on the paper."""
    crank = sheet.scene.links[sheet.scene.driver.link].points
    apart = max(
        float(np.hypot(*np.diff(sheet.at(sheet.points[name])[:2], axis=0)[0])) for name in crank
    )
    if apart < LEAST_APART_MM:
        fit = max(2, int(divisions * apart / LEAST_APART_MM))
        raise CrankcheckError(
            f"--divisions {divisions}: the crank's positions are {apart:.2g} mm apart on "
            f"{sheet.paper.width:g} x {sheet.paper.height:g} mm; at most {fit} fit, or take larger "
            "paper"
        )


def draw_positions(sheet: PositionSheet, note: str) -> Canvas:
    """The sheet, in layers: loci, positions, construction, the mechanism, letters."""
    canvas = Canvas(sheet.paper)
    _frame(canvas.layer("frame"), sheet, note)
    _loci(canvas.layer("loci"), sheet)
    _positions(canvas.layer("positions"), sheet)
    _construction(canvas.layer("construction"), sheet)
    first = {name: sheet.at(at[0]) for name, at in sheet.points.items()}
    draw_scheme(canvas.layer("mechanism"), sheet.placement, first)
    _letters(canvas.layer("letters"), sheet)
    return canvas


def _frame(axes: Axes, sheet: PositionSheet, note: str) -> None:
    count, law = len(sheet.angles), sheet.scene.driver.link
    told = f"{sheet.scene.name}: {count} positions of {law}, K_l = {sheet.scale:g} m/mm"
    write_head(axes, sheet.paper, told, note)
    draw_border(axes, sheet.box)


def _loci(axes: Axes, sheet: PositionSheet) -> None:
    """The ways of all points that move."""
    for name, way in sheet.loci.items():
        places = sheet.at(way)
        if np.ptp(places, axis=0).max() > 0.1:
            drawn = axes.plot(places[:, 0], places[:, 1], color=LOCI, lw=0.8)[0]
            drawn.set_gid(f"locus-{name}")


def _positions(axes: Axes, sheet: PositionSheet) -> None:
    """All positions of all links, faint."""
    for link in sheet.scene.links.values():
        corners = [sheet.at(sheet.points[name]) for name in link.points]
        for k in range(len(sheet.angles)):
            ring = [corner[k] for corner in corners]
            ring = [*ring, ring[0]] if len(ring) > 2 else ring
            for start, end in itertools.pairwise(ring):
                line(axes, start, end, color=FAINT, linewidth=0.5)
    crank = sheet.scene.links[sheet.scene.driver.link].points
    for name in crank:
        for at in sheet.at(sheet.points[name]):
            axes.add_patch(Circle(tuple(at), 0.45, fc=FAINT, ec="none"))


def _construction(axes: Axes, sheet: PositionSheet) -> None:
    """The arcs about outer pins that cross in the inner pin of each group."""
    for part in sheet.placement.structure.order:
        if not isinstance(part, Group) or part.kind not in ("RRR", "RRP"):
            continue
        outer = [part.outer1, part.outer2] if part.kind == "RRR" else [part.outer1]
        inner = sheet.at(sheet.points[part.inner])
        for pin in outer:
            about = sheet.at(sheet.points[pin])
            for centre, end in zip(about, inner, strict=True):
                away = end - centre
                angle = math.degrees(math.atan2(away[1], away[0]))
                size = 2 * float(np.hypot(*away))
                axes.add_patch(
                    Arc(
                        tuple(centre), size, size, theta1=angle - ARC_DEG, theta2=angle + ARC_DEG,
                        color=INK, lw=0.35,
                    )
                )  # fmt: skip


def _letters(axes: Axes, sheet: PositionSheet) -> None:
    """Letters of the points in the first position, and numbers along the driver's circle."""
    corner = np.array([sheet.box.left, sheet.box.bottom])
    spots = {name: sheet.at(at[0]) for name, at in sheet.points.items()}
    crank = sheet.scene.links[sheet.scene.driver.link].points
    pivot = sheet.scene.driver_pivot
    pin = max(crank, key=lambda name: float(np.hypot(*(spots[name] - spots[pivot]))))
    labels = [
        Label(n, (width_in(n, SMALL), SMALL / POINTS), _inches(at, corner)[None], 0.05)
        for n, at in spots.items()
    ]
    labels += [
        Label(str(k), (width_in(str(k), TINY), TINY / POINTS), _inches(at, corner)[None], 0.02)
        for k, at in enumerate(sheet.at(sheet.points[pin]))
    ]
    heavy = np.concatenate([sheet.at(at) for at in sheet.points.values()])
    thick = np.column_stack([_inches(heavy, corner), np.full(len(heavy), 0.02)])
    thin = _inches(np.concatenate([sheet.at(way) for way in sheet.loci.values()]), corner)
    frame = (sheet.box.width / MM_PER_IN, sheet.box.height / MM_PER_IN)
    for k, (label, at) in enumerate(zip(labels, place(labels, thick, thin, frame), strict=True)):
        x, y = corner + MM_PER_IN * np.array(at)
        size, ink = (SMALL, INK) if k < len(spots) else (TINY, QUIET)
        text(axes, x, y, label.text, size, ha="center", va="center", color=ink)


def _inches(places: Array, corner: Array) -> Array:
    return np.asarray((places - corner) / MM_PER_IN)
