"""The figures of a motion with elastic links, over the driver's angle in a turn or over time."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from models.array import Array
from models.scene import Scene, cut_links, laws
from models.scene.driver import Controlled
from reports.describe.elastic_course import Apart, ElasticCourse
from reports.drawing.moving import Magnified, magnification
from reports.drawing.shape import MARGIN, box_of, colours_of, guide_direction, size_of_motion
from reports.figures.layout import LAYOUT
from reports.figures.sheet import SIDES, LinePanel, Panels, line_figure, sheet, spaced
from reports.figures.style import INK, PAGE_IN, QUIET, SMALL, FigureSet, Look, note, shorten
from reports.output.numbers import readable
from reports.protocol import length, way

ELASTIC: Look = {"color": "#1f5f9e", "linewidth": 1.1}
RIGID: Look = {"color": "#c04a1d", "linewidth": 0.9, "linestyle": (0, (4.0, 2.0))}
WITHOUT = RIGID | {"linestyle": "-"}
"""Look of the motion without control."""
COLOURS = ("#1f5f9e", "#c04a1d", "#2f7d4c", "#7a3e9d", "#b97f1f", "#15889a")
"""Colours of elastic links, in the order of the scene."""
DASHES = ("-", (0, (5.0, 1.5)), (0, (1.2, 1.2)), (0, (6.0, 1.5, 1.0, 1.5)))
TURN = 1.0001
"""Periods of a constant speed up to which an axis shows the driver's angle."""
SEEN = 1e-12
"""Extension, over the longest link, below which there is none."""
MOST = 8
"""Most links and sliders of one figure: the furthest apart are shown."""
COLUMNS, ROWS = 3, 2
GHOST: Look = {"color": "#a9b3bd", "linewidth": 1.0, "zorder": 1}


@dataclass(frozen=True)
class CourseAxis:
    """Values (T,) with their label; ``step`` is between its numbers, 0 for any."""

    scene: Scene
    values: Array
    label: str
    step: float = 0.0

    @staticmethod
    def of(course: ElasticCourse) -> CourseAxis:
        scene, time_s = course.scene, course.time_s
        law = scene.driver.law
        if isinstance(law, laws.ConstantSpeed) and time_s[-1] <= TURN * law.period_s:
            degrees = np.degrees(course.motion.links[scene.driver.link].theta)
            return CourseAxis(scene, degrees, f"angle of {scene.driver.link} [deg]", 60.0)
        if isinstance(law, laws.ConstantSpeed):
            return CourseAxis(scene, time_s / law.period_s, f"turns of {scene.driver.link}")
        return CourseAxis(scene, time_s, "time [s]")

    def plot(self, axes: Axes, series: Array, **look: Any) -> None:
        """Draw a series of the course (T,)."""
        axes.plot(self.values, series, **look)

    def mark(self, axes: Axes, *, labelled: bool = True) -> None:
        """Set limits and label of the axis, short numbers on the other, and a line at 0."""
        axes.set_xlim(float(self.values.min()), float(self.values.max()))
        if self.step:
            spaced(axes, self.step)
        low, high = axes.get_ylim()
        if low <= 0.0 <= high:
            axes.axhline(0.0, color=QUIET, linewidth=0.5)
        shorten(axes)
        axes.set_xlabel(self.label if labelled else "")
        axes.tick_params(labelbottom=labelled)


def _notes(course: ElasticCourse) -> list[str]:
    return [note(course.scene, course.words, course.scene.driver.link)]


def _deflection(course: ElasticCourse) -> Figure | None:
    curves = {}
    for name in (name for name, own in course.scene.elastic.items() if own.bends):
        line = cut_links.line_of(course.scene, name)
        label = f"middle of {name}, {readable(0.5 * line.length_m)} m from {line.pins[0]}"
        curves[label] = 1e3 * course.motion.elastic[name].middle
    return _of_links(course, curves, "Deflection", "deflection [mm]") if curves else None


def _extension(course: ElasticCourse) -> Figure | None:
    """Draw the extension between the pins of each elastic link against rest: it stretches, and a
    bent one is shorter; None where no link is longer or shorter."""
    shapes = course.motion.elastic
    largest = max(float(abs(shape.extension).max()) for shape in shapes.values())
    if largest <= SEEN * course.scene.longest_m:
        return None
    curves = {f"end of {name}, along it": 1e6 * one.extension for name, one in shapes.items()}
    return _of_links(course, curves, "Axial displacement of the end", "extension [µm]")


def _of_links(course: ElasticCourse, curves: Mapping[str, Array], title: str, label: str) -> Figure:
    """Draw one panel with a curve for each elastic link, by its text in the legend."""
    named = [
        (name, series, {"color": COLOURS[k % len(COLOURS)], "linestyle": DASHES[k % len(DASHES)]})
        for k, (name, series) in enumerate(curves.items())
    ]
    panel = LinePanel(label, named)
    return line_figure(CourseAxis.of(course), title, [panel], _notes(course))[0]


def _torque(course: ElasticCourse) -> Figure | None:
    if course.torques is None:
        return None
    elastic, rigid = course.torques
    curves = [("elastic links", elastic, ELASTIC), ("rigid links", rigid, RIGID)]
    panels = [
        LinePanel("torque [N m]", curves),
        LinePanel("elastic less rigid [N m]", [("", elastic - rigid, ELASTIC)]),
    ]
    axis = CourseAxis.of(course)
    return line_figure(axis, "Driving torque", panels, _notes(course), height=1.25)[0]


def _angles(course: ElasticCourse) -> Figure | None:
    """Draw the angles of links, and displacements of sliders, with elastic links beside rigid ones,
    as in the thesis, and their differences; None where there are none."""
    each = _chosen(course)
    if not each:
        return None
    axis = CourseAxis.of(course)
    height = 1.5 if len(each) == 1 else 1.15
    panels = Panels(len(each), 2, height, *SIDES, 0.15, between=(0.65, 0.2))
    title = f"Elastic beside rigid links: {course.scene.name}"
    entries = [
        (Line2D([], [], **ELASTIC), "elastic links"),
        (Line2D([], [], **RIGID), "rigid links"),
    ]
    figure, panes = sheet(PAGE_IN, panels, title, entries, _notes(course))
    for one, left, right in zip(each, panes[::2], panes[1::2], strict=True):
        scale, unit = (np.degrees(1.0), "deg") if one.unit == "rad" else (1.0, "m")
        axis.plot(left, scale * one.elastic, **ELASTIC)
        axis.plot(left, scale * one.rigid, **RIGID)
        left.set_ylabel(f"{one.name} [{unit}]")
        axis.plot(right, one.difference, **ELASTIC)
        right.set_ylabel(f"elastic less rigid [{one.unit}]")
        for pane in (left, right):
            axis.mark(pane, labelled=one is each[-1])
    return figure


def _chosen(course: ElasticCourse) -> list[Apart]:
    """Return at most so many, in the order of the scene; none that follow a driver's law alone."""
    every = [one for one in course.apart() if np.any(one.difference)]
    sizes = sorted((float(np.max(np.abs(one.difference))) for one in every), reverse=True)
    least = sizes[min(MOST, len(sizes)) - 1] if sizes else 0.0
    return [one for one in every if float(np.max(np.abs(one.difference))) >= least][:MOST]


BESIDE = {
    length.TURNS: ("rigid links", "Displacements from rigid links", 1.0),
    length.SECONDS: ("lines between pins", "Deflections", 0.0),
}
"""Name of the thin mechanism, magnified quantity, and turns from which on times are shown."""


def _positions(course: ElasticCourse) -> Figure | None:
    """Draw the mechanism at six instants, evenly spread over the motion, from its start on, its
    deflection magnified, over the same with rigid links."""
    scene, base = course.scene, course.base
    size = size_of_motion(scene, base)
    factor = magnification(course.motion, base, course.bent, size)
    own = Magnified(scene, course.motion, base, course.bent, factor)
    low, high = box_of(scene, base)
    low, high = low + 0.5 * MARGIN * size, high - 0.5 * MARGIN * size
    panels = Panels(ROWS, COLUMNS, 1.0, 0.06, 0.06, 0.22, 0.06, between=(0.1, 0.22))
    wide = (LAYOUT.get().across(PAGE_IN) - 0.12 - 2 * panels.between[0]) / COLUMNS
    height = float(np.clip(wide * (high[1] - low[1]) / (high[0] - low[0]), 0.8, 3.0))
    colours = colours_of(scene)
    entries: list[tuple[Artist, str]] = [
        (Line2D([], [], color=colour, linewidth=2.0), f"{name}{' (elastic)' * (name in own.bent)}")
        for name, colour in colours.items()
    ]
    ghost, what, turns = BESIDE[way.way_of(scene).clock]
    entries.append((Line2D([], [], **GHOST), ghost))
    title = f"{what}, magnified {factor:g} times: {scene.name}"
    figure, panes = sheet(PAGE_IN, replace(panels, height=height), title, entries, _notes(course))
    last = course.time_s.size - 1
    for number, axes in enumerate(panes):
        index = round(number * last / len(panes))
        _position(axes, own, index, colours)
        axes.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]), xticks=[], yticks=[])
        axes.set_aspect("equal", adjustable="box")
        degrees = math.degrees(base.links[scene.driver.link].theta[index]) % 360.0
        when = f"{scene.driver.link} {degrees:.0f} deg"
        if course.turns > turns:
            when += f", {course.time_s[index]:.3g} s"
        axes.set_title(when, fontsize=SMALL, loc="left")
    return figure


def _position(axes: Axes, own: Magnified, index: int, colours: dict[str, str]) -> None:
    for name, link in own.scene.links.items():
        ghost = np.array([own.rigid.points[p].position[index] for p in link.points])
        outline = own.outline(name, index)
        if name not in own.bent and len(outline) > 2:
            ghost, outline = (np.vstack([each, each[:1]]) for each in (ghost, outline))
        axes.plot(*ghost.T, **GHOST)
        axes.plot(*outline.T, color=colours[name], linewidth=2.0, zorder=3)
    for slider in own.scene.sliders.values():
        place, direction = own.place(slider.point, index), guide_direction(slider, own.rigid, index)
        reach = 0.06 * size_of_motion(own.scene, own.rigid)
        axes.plot(*np.array([place - reach * direction, place + reach * direction]).T,
                  color=INK, linewidth=3.5, alpha=0.5, solid_capstyle="butt", zorder=2)  # fmt: skip
    pins = np.array([own.place(name, index) for name in own.rigid.points])
    axes.plot(*pins.T, "o", markersize=3.0, color="white", markeredgecolor=INK, zorder=5)
    grounded = np.array(list(own.scene.ground.values())).reshape(-1, 2)
    axes.plot(*grounded.T, "^", markersize=5.0, color=INK, alpha=0.7, zorder=2)


def _control(course: ElasticCourse) -> Figure | None:
    """Draw elastic links under a controller, over the same with the torque of rigid links alone:
    deflections, the driver's speed, and its lead over its command; None without a controller."""
    law = course.scene.driver.law
    if course.uncontrolled is None or not isinstance(law, Controlled):
        return None
    gains = f"kP = {law.kp_n_m_rad:g} N m/rad, kD = {law.kd_n_m_s:g} N m s/rad"
    entries = [
        (Line2D([], [], **ELASTIC), f"controlled, {gains}"),
        (Line2D([], [], **WITHOUT), "not controlled: the torque of rigid links alone"),
    ]
    driver = course.scene.driver.link
    both = ((course.uncontrolled, WITHOUT), (course.motion, ELASTIC))
    bending = [name for name, own in course.scene.elastic.items() if own.bends]
    bent = [
        ("", 1e3 * motion.elastic[name].middle, look | {"linestyle": dash})
        for motion, look in both
        for name, dash in zip(bending, DASHES * len(bending), strict=False)
    ]
    driven = [(motion.links[driver], look) for motion, look in both]
    wanted = law.at(course.time_s)[0]
    ahead = [("", np.degrees(own.theta - wanted), look) for own, look in driven]
    speeds = [("", own.omega, look) for own, look in driven]
    panels = [
        LinePanel("deflection [mm]", bent),
        LinePanel(f"speed of {driver} [rad/s]", speeds, level=law.speed_rad_s),
        LinePanel(f"{driver} ahead by [deg]", ahead),
    ]
    axis, title = CourseAxis(course.scene, course.time_s, "time [s]"), "With and without control"
    return line_figure(axis, title, panels, _notes(course), entries, height=1.15)[0]


ELASTIC_FIGURES: FigureSet[ElasticCourse] = FigureSet(
    "elastic links",
    {
        "deflection": _deflection,
        "extension": _extension,
        "torque": _torque,
        "angles": _angles,
        "positions": _positions,
        "control": _control,
    },
)
"""Figures of elastic links; a free motion has no drive, few scenes are controlled."""
