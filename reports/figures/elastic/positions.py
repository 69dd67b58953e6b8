"""The mechanism at several instants, its deflection magnified, over the same with rigid links."""

from __future__ import annotations

import math

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from reports.describe.elastic_course import ElasticCourse
from reports.drawing.moving import Magnified, magnification
from reports.drawing.shape import MARGIN, box_of, colours_of, guide_direction, size_of_motion
from reports.figures.elastic.course_axis import notes
from reports.figures.sheet import Panels, sheet
from reports.figures.style import INK, PAGE_IN, SMALL

COLUMNS, ROWS = 3, 2
GHOST = {"color": "#a9b3bd", "linewidth": 1.0, "zorder": 1}


def draw(course: ElasticCourse) -> Figure | None:
    """Six positions, evenly spread over the motion, from its start on."""
    scene, base = course.scene, course.base
    size = size_of_motion(base)
    factor = magnification(course.motion, base, course.bent, size)
    own = Magnified(scene, course.motion, base, course.bent, factor)
    low, high = box_of(base)
    low, high = low + 0.5 * MARGIN * size, high - 0.5 * MARGIN * size
    panels = Panels(ROWS, COLUMNS, 1.0, 0.06, 0.06, 0.22, 0.06, between=(0.1, 0.22))
    wide = (PAGE_IN - 0.12 - 2 * panels.between[0]) / COLUMNS
    height = float(np.clip(wide * (high[1] - low[1]) / (high[0] - low[0]), 0.8, 3.0))
    colours = colours_of(scene)
    entries: list[tuple[Artist, str]] = [
        (Line2D([], [], color=colour, linewidth=2.0), f"{name}{' (elastic)' * (name in own.bent)}")
        for name, colour in colours.items()
    ]
    ghost = "lines between pins" if scene.is_free else "rigid links"
    entries.append((Line2D([], [], **GHOST), ghost))  # type: ignore[arg-type]  # looks of a line
    what = "Deflections" if scene.is_free else "Displacements from rigid links"
    title = f"{what}, magnified {factor:g} times: {scene.name}"
    figure, panes = sheet(
        PAGE_IN, Panels(**{**vars(panels), "height": height}), title, entries, notes(course)
    )
    last = course.time_s.size - 1
    for number, axes in enumerate(panes):
        index = round(number * last / len(panes))
        _position(axes, own, index, colours)
        axes.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]), xticks=[], yticks=[])
        axes.set_aspect("equal", adjustable="box")
        degrees = math.degrees(base.links[scene.driver.link].theta[index]) % 360.0
        when = f"{scene.driver.link} {degrees:.0f} deg"
        if scene.is_free or course.turns > 1.0:
            when += f", {course.time_s[index]:.3g} s"
        axes.set_title(when, fontsize=SMALL, loc="left")
    return figure


def _position(axes: Axes, own: Magnified, index: int, colours: dict[str, str]) -> None:
    """Links, sliders and pins at a sample, the rigid mechanism behind them."""
    for name, link in own.scene.links.items():
        ghost = np.array([own.rigid.points[p].position[index] for p in link.points])
        outline = own.outline(name, index)
        if name not in own.bent and len(outline) > 2:
            ghost, outline = (np.vstack([each, each[:1]]) for each in (ghost, outline))
        axes.plot(*ghost.T, **GHOST)  # type: ignore[arg-type]  # looks of a line
        axes.plot(*outline.T, color=colours[name], linewidth=2.0, zorder=3)
    for slider in own.scene.sliders.values():
        place, direction = own.place(slider.point, index), guide_direction(slider, own.rigid, index)
        reach = 0.06 * size_of_motion(own.rigid)
        axes.plot(*np.array([place - reach * direction, place + reach * direction]).T,
                  color=INK, linewidth=3.5, alpha=0.5, solid_capstyle="butt", zorder=2)  # fmt: skip
    pins = np.array([own.place(name, index) for name in own.rigid.points])
    axes.plot(*pins.T, "o", markersize=3.0, color="white", markeredgecolor=INK, zorder=5)
    grounded = np.array(list(own.scene.ground.values())).reshape(-1, 2)
    axes.plot(*grounded.T, "^", markersize=5.0, color=INK, alpha=0.7, zorder=2)
