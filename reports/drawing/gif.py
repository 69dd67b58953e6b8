"""Draw a mechanism in motion: an animated GIF over one turn, or a strip of positions as PNG."""

from __future__ import annotations

import io
import math
from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from PIL import Image

from models.array import Array
from models.motion import Motion
from models.scene import GROUND, Scene, Slider
from reports.drawing.shape import MARGIN, PATH_SAMPLES, box_of, colours_of, guide_direction, turn_of

FRAMES = 60
STRIP = 6
INK = "#1f2933"
GUIDE = "#9aa5b1"


def animation(scene: Scene) -> bytes:
    """One turn of the scene as a GIF that repeats."""
    path = turn_of(scene, PATH_SAMPLES)
    motion = turn_of(scene, FRAMES + 1)
    figure = _figure(path, columns=1, rows=1, width=6.4)
    canvas = FigureCanvasAgg(figure)
    axes = figure.add_subplot()
    _legend(figure, scene)
    frames = []
    for index in range(FRAMES):
        axes.clear()
        _draw(axes, scene, motion, index, path)
        canvas.draw()  # type: ignore[no-untyped-call]  # matplotlib has no annotation here
        pixels = np.asarray(canvas.buffer_rgba())  # type: ignore[no-untyped-call]  # as above
        picture = Image.fromarray(pixels).convert("RGB")
        frames.append(picture.quantize(64, dither=Image.Dither.NONE))
    buffer = io.BytesIO()
    frames[0].save(
        buffer, "GIF", save_all=True, append_images=frames[1:], duration=60, loop=0, optimize=True
    )
    return buffer.getvalue()


def strip(scene: Scene) -> bytes:
    """Six positions over one turn, side by side, as a PNG."""
    path = turn_of(scene, PATH_SAMPLES)
    motion = turn_of(scene, STRIP + 1)
    columns, rows = STRIP // 2, 2
    figure = _figure(path, columns, rows, width=4.0)
    for index in range(STRIP):
        _draw(figure.add_subplot(rows, columns, index + 1), scene, motion, index, path)
    _legend(figure, scene)
    buffer = io.BytesIO()
    FigureCanvasAgg(figure).print_png(buffer)  # type: ignore[no-untyped-call]  # as above
    return buffer.getvalue()


def _figure(path: Motion, columns: int, rows: int, width: float) -> Figure:
    """A figure whose panels of ``width`` [inch] have the shape of what they show."""
    low, high = box_of(path)
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


def _legend(figure: Figure, scene: Scene) -> None:
    """The links by colour, below everything that moves."""
    colours = colours_of(scene)
    handles = [Line2D([], [], color=colours[name], linewidth=4, label=name) for name in colours]
    figure.legend(
        handles=handles, loc="lower center", ncols=len(handles), fontsize=8, frameon=False
    )


def _draw(axes: Axes, scene: Scene, motion: Motion, index: int, path: Motion) -> None:
    """One position with the paths of the points behind it."""
    low, high = box_of(path)
    axes.set_xlim(low[0], high[0])
    axes.set_ylim(low[1], high[1])
    axes.set_aspect("equal", adjustable="box")
    size = draw_bodies(axes, scene, motion, path, index, 0.8)
    blocks = {slider.point for slider in scene.sliders.values()}
    for name, point in motion.points.items():
        aside = (0.055 if name in blocks else 0.025) * size  # clear of the block
        x, y = (float(each) + aside for each in point.position[index])
        axes.annotate(name, (x, y), fontsize=8, color=INK, zorder=6)
    theta = math.degrees(motion.links[scene.driver.link].theta[index])
    axes.set_title(f"{scene.name}   {scene.driver.link} {theta:.0f} deg", fontsize=9, color=INK)
    axes.set_xlabel("x [m]", fontsize=8)
    axes.set_ylabel("y [m]", fontsize=8)
    axes.tick_params(labelsize=7)
    axes.grid(color="#e4e7eb", linewidth=0.5)
    axes.set_axisbelow(True)


def draw_bodies(
    axes: Axes, scene: Scene, motion: Motion, path: Motion, index: int, line: float
) -> float:
    """Paths (lines of ``line`` points), guides, blocks, links and pins, without a letter.

    They stand as at sample ``index`` of ``motion``; ``path`` is a whole turn. Returns the size of
    what moves [m].
    """
    low, high = box_of(path)
    size = float(np.max(high - low)) / (1 + 2 * MARGIN)
    for name, point in path.points.items():
        if name not in scene.ground:
            axes.plot(*point.position.T, color=GUIDE, linewidth=line, zorder=1)
    colours = colours_of(scene)
    for slider in scene.sliders.values():
        rail = GUIDE if slider.on == GROUND else colours[slider.on]
        _slider(axes, slider, rail, motion, path, index, size)
    for name, link in scene.links.items():
        ends = [motion.points[point].position[index] for point in link.points]
        _link(axes, ends, colours[name])
    for name, point in motion.points.items():
        place = point.position[index]
        if name in scene.ground:  # on a triangle
            foot = 0.035 * size
            corners = place + np.array([[0.0, 0.0], [-foot, -1.6 * foot], [foot, -1.6 * foot]])
            axes.fill(*corners.T, color=INK, alpha=0.75, linewidth=0, zorder=2)
        axes.plot(*place, "o", markersize=6, color="white", markeredgecolor=INK, zorder=5)
    return size


def _link(axes: Axes, corners: Sequence[Array], colour: str) -> None:
    """A bar between two points; with more points a plate."""
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
    """The guide as far as the slider runs on it, and the block."""
    travel = path.sliders[slider.name].displacement
    place = motion.points[slider.point].position[index]
    along = float(motion.sliders[slider.name].displacement[index])
    direction = guide_direction(slider, motion, index)
    reach = 0.06 * size
    ends = [travel.min() - reach - along, travel.max() + reach - along]
    rail = place + np.outer(ends, direction)
    axes.plot(*rail.T, color=colour, linewidth=1.4, linestyle=(0, (6, 3)), zorder=2)
    half = np.array([[-1, -0.6], [1, -0.6], [1, 0.6], [-1, 0.6]]) * 0.045 * size
    across = np.array([-direction[1], direction[0]])
    corners = place + half @ np.array([direction, across])
    axes.fill(*corners.T, facecolor="white", edgecolor=INK, linewidth=1.2, zorder=4)
