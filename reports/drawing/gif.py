"""Draw a mechanism in motion: an animated GIF over one turn, or a strip of positions as PNG."""

from __future__ import annotations

import io
import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patheffects import withStroke
from PIL import Image

from models.array import Array
from models.motion import Motion
from models.scene import GROUND, Scene, Slider
from models.scene.driver import driver_stands
from reports.drawing import shape
from reports.drawing.force_arrows import ForceArrows, force_arrows
from reports.drawing.pair_curves import blocks_of, pair_curves
from reports.output.numbers import readable
from reports.protocol.way import way_of

INK = "#1f2933"
"""Colour of everything but the links."""


def draw_arrows(axes: Axes, arrows: ForceArrows, motion: Motion, index: int) -> None:
    """Draw the forces at a sample, each in the colour of the body that it acts on."""
    colours = shape.colours_of(arrows.scene)
    for arrow in arrows.at(motion, index):
        colour, line = colours.get(arrow.body, INK), arrow.line(arrows.size).T
        axes.plot(*line, color="white", linewidth=3.2, zorder=6)
        axes.plot(*line, color=colour, linewidth=1.6, zorder=6)
        if arrow.is_whole:
            look: dict[str, Any] = {"facecolor": colour, "edgecolor": "white", "linewidth": 0.5}
            axes.fill(*arrow.head(arrows.size).T, zorder=7, **look)


def scale_bar(axes: Axes, arrows: ForceArrows, box: tuple[Array, Array], fontsize: float) -> None:
    """Draw the length of a force, in the lower right corner of the box."""
    if not arrows.bar_n:
        return
    long = arrows.bar_n * arrows.m_per_n
    right, low = float(box[1][0]) - 0.03 * arrows.size, float(box[0][1]) + 0.03 * arrows.size
    tick = 0.012 * arrows.size
    ends = [right - long, right - long, right - long, right, right, right]
    high = [low - tick, low + tick, low, low, low + tick, low - tick]
    axes.plot(ends, high, color=INK, linewidth=1.2, zorder=8)
    axes.annotate(
        f"{arrows.bar_n:g} N",
        (right - long / 2, low),
        (0, 2.5),
        textcoords="offset points",
        ha="center",
        va="bottom",
        fontsize=fontsize,
        color=INK,
        zorder=8,
    )


FRAMES, FRAME_S = 60, 0.06
STRIP = 6
GUIDE = "#9aa5b1"


def animation(scene: Scene, *, with_forces: bool = False) -> bytes:
    """Return one turn of the scene, or its free motion as far as it goes in that time, as a GIF
    that repeats, its forces as arrows if requested."""
    turn = _Turn.of(scene, FRAMES, with_forces=with_forces)
    figure = _figure(turn.box, columns=1, rows=1, width=6.4)
    canvas = FigureCanvasAgg(figure)
    axes = figure.add_subplot()
    _legend(figure, turn)
    frames = []
    for index in range(FRAMES):
        axes.clear()
        _draw(axes, turn, index)
        canvas.draw()  # type: ignore[no-untyped-call]  # matplotlib has no annotation here
        pixels = np.asarray(canvas.buffer_rgba())  # type: ignore[no-untyped-call]  # as above
        picture = Image.fromarray(pixels).convert("RGB")
        frames.append(picture.quantize(64, dither=Image.Dither.NONE))
    buffer = io.BytesIO()
    frames[0].save(
        buffer,
        "GIF",
        save_all=True,
        append_images=frames[1:],
        duration=round(1000 * FRAME_S),
        loop=0,
        optimize=True,
    )
    return buffer.getvalue()


def strip(scene: Scene, *, with_forces: bool = False) -> bytes:
    """Return six positions over one turn, side by side, as a PNG; forces as in `animation`."""
    turn = _Turn.of(scene, STRIP, with_forces=with_forces)
    columns, rows = STRIP // 2, 2
    figure = _figure(turn.box, columns, rows, width=4.0)
    for index in range(STRIP):
        _draw(figure.add_subplot(rows, columns, index + 1), turn, index)
    _legend(figure, turn)
    buffer = io.BytesIO()
    FigureCanvasAgg(figure).print_png(buffer)  # type: ignore[no-untyped-call]  # as above
    return buffer.getvalue()


@dataclass(frozen=True)
class _Turn:
    """Content of a drawing: the positions, the whole turn behind them, and arrows if requested,
    within the corners of a box [m]."""

    scene: Scene
    motion: Motion
    path: Motion
    box: tuple[Array, Array]
    arrows: ForceArrows | None = None

    @staticmethod
    def of(scene: Scene, positions: int, *, with_forces: bool) -> _Turn:
        most_s = way_of(scene).drawn_s(FRAMES * FRAME_S)
        path = shape.turn_of(scene, shape.PATH_SAMPLES, most_s, with_forces=with_forces)
        motion = shape.turn_of(scene, positions + 1, most_s, with_forces=with_forces)
        arrows = None if path.forces is None else force_arrows(scene, path)
        box = shape.box_of(scene, path) if arrows is None else arrows.box(path)
        return _Turn(scene, motion, path, box, arrows)


def _figure(box: tuple[Array, Array], columns: int, rows: int, width: float) -> Figure:
    """Return a figure whose panels of ``width`` [inch] have the shape of their content."""
    low, high = box
    left, right, top, bottom, legend = 0.65, 0.15, 0.35, 0.5, 0.35
    inner = width - left - right
    height = min(max(inner * (high[1] - low[1]) / (high[0] - low[0]), 1.2), 6.0)
    size = (columns * width, rows * (height + top + bottom) + legend)
    figure = Figure(figsize=size, dpi=100)
    figure.subplots_adjust(
        left=left / size[0],
        right=1 - right / size[0],
        top=1 - top / size[1],
        bottom=(bottom + legend) / size[1],
        wspace=(left + right) / inner,
        hspace=(top + bottom) / height,
    )
    return figure


def _legend(figure: Figure, turn: _Turn) -> None:
    colours = shape.colours_of(turn.scene)
    handles = [Line2D([], [], color=colours[name], linewidth=4, label=name) for name in colours]
    if turn.arrows is not None:
        words = "force on the body of that colour, black: on a block"
        look: dict[str, Any] = {"color": INK, "linewidth": 1.6, "marker": ">", "markersize": 5}
        handles.append(Line2D([], [], label=words, **look))
    figure.legend(
        handles=handles, loc="lower center", ncols=len(handles), fontsize=8, frameon=False
    )


def _draw(axes: Axes, turn: _Turn, index: int) -> None:
    scene, motion = turn.scene, turn.motion
    low, high = turn.box
    axes.set_xlim(low[0], high[0])
    axes.set_ylim(low[1], high[1])
    axes.set_aspect("equal", adjustable="box")
    size = draw_bodies(axes, scene, motion, turn.path, index, 0.8)
    blocks = {slider.point for slider in scene.sliders.values()}
    for name, point in motion.points.items():
        aside = (0.055 if name in blocks else 0.025) * size  # clear of the block
        x, y = (float(each) + aside for each in point.position[index])
        halo = [withStroke(linewidth=2.5, foreground="white")] if turn.arrows else []
        axes.annotate(name, (x, y), fontsize=8, color=INK, zorder=9, path_effects=halo)
    title = f"{scene.name}   {driver_stands(scene, motion, index)}"
    if turn.arrows is not None and motion.forces is not None:
        draw_arrows(axes, turn.arrows, motion, index)
        scale_bar(axes, turn.arrows, turn.box, fontsize=8)
        torque, effort = float(motion.forces.torque[index]), scene.driver.effort
        title += (
            f"   {effort} {readable(torque)} {scene.driver.effort_unit}"
            if math.isfinite(torque)
            else ""
        )
    axes.set_title(title, fontsize=9 if turn.arrows is None else 8, color=INK)
    axes.set_xlabel("x [m]", fontsize=8)
    axes.set_ylabel("y [m]", fontsize=8)
    axes.tick_params(labelsize=7)
    axes.grid(color="#e4e7eb", linewidth=0.5)
    axes.set_axisbelow(True)


def draw_bodies(
    axes: Axes, scene: Scene, motion: Motion, path: Motion, index: int, line: float
) -> float:
    """Draw paths (lines of ``line`` points), guides, blocks, links and pins, without a letter.

    They stand as at sample ``index`` of ``motion``; ``path`` is a whole turn. Returns the size of
    the moving parts [m].
    """
    size = shape.size_of_motion(scene, path)
    for name, point in path.points.items():
        if name not in scene.ground:
            axes.plot(*point.position.T, color=GUIDE, linewidth=line, zorder=1)
    colours = shape.colours_of(scene)
    for slider in blocks_of(scene):
        rail = GUIDE if slider.on == GROUND else colours[slider.on]
        _slider(axes, slider, rail, motion, path, index, size)
    for own in pair_curves(scene):
        colour = colours.get(own.body, GUIDE)
        for curve in own.at(motion, index):
            axes.fill(*curve.T, fc=(colour, 0.12), ec=colour, linewidth=1.2, zorder=2.5)
    for name, link in scene.links.items():
        ends = [motion.points[point].position[index] for point in link.points]
        _link(axes, ends, colours[name])
    for name, point in motion.points.items():
        place = point.position[index]
        if name in scene.ground:  # on a triangle
            axes.fill(*shape.foot_of(place, size).T, color=INK, alpha=0.75, linewidth=0, zorder=2)
        axes.plot(*place, "o", markersize=6, color="white", markeredgecolor=INK, zorder=5)
    return size


def _link(axes: Axes, corners: Sequence[Array], colour: str) -> None:
    """Draw a bar between two points; with more points a plate."""
    places = np.array(corners)
    if len(places) > 2:
        axes.fill(*places.T, color=colour, alpha=0.25, linewidth=0, zorder=3)
        places = np.vstack([places, places[:1]])
    axes.plot(*places.T, color=colour, linewidth=4, solid_capstyle="round", zorder=3)


def _slider(
    axes: Axes,
    slider: Slider,
    colour: str,
    motion: Motion,
    path: Motion,
    index: int,
    size: float,
) -> None:
    """Draw the guide as far as the slider runs on it, and the block."""
    travel = path.sliders[slider.name].displacement
    place = motion.points[slider.point].position[index]
    along = float(motion.sliders[slider.name].displacement[index])
    direction = shape.guide_direction(slider, motion, index)
    reach = 0.06 * size
    ends = [travel.min() - reach - along, travel.max() + reach - along]
    rail = place + np.outer(ends, direction)
    axes.plot(*rail.T, color=colour, linewidth=1.4, linestyle=(0, (6, 3)), zorder=2)
    half = np.array([[-1, -0.6], [1, -0.6], [1, 0.6], [-1, 0.6]]) * 0.045 * size
    across = np.array([-direction[1], direction[0]])
    corners = place + half @ np.array([direction, across])
    axes.fill(*corners.T, facecolor="white", edgecolor=INK, linewidth=1.2, zorder=4)
