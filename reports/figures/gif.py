"""Draw a mechanism in motion, a run over it if there is one: an animated GIF over one turn, or a
strip of positions as PNG."""

from __future__ import annotations

import io
import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from PIL import Image

from models.array import Array
from models.errors import CrankcheckError
from models.motion import Motion
from models.scene import GROUND, Scene
from models.scene.driver import driver_stands
from reports.drawing import shape
from reports.drawing.force_arrows import ForceArrows, force_arrows
from reports.drawing.moving import (
    FARTHEST,
    Magnified,
    largest_displacement,
    magnification,
    rounded,
)
from reports.drawing.pair_curves import blocks_of, pair_curves
from reports.figures.style import POINTS, SIZE, SMALL, Look, width_in
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
            look: Look = {"facecolor": colour, "edgecolor": "white", "linewidth": 0.5}
            axes.fill(*arrow.head(arrows.size).T, zorder=7, **look)


def scale_bar(axes: Axes, arrows: ForceArrows, box: tuple[Array, Array], fontsize: float) -> None:
    """Draw the length of a force, in the lower right corner of the box."""
    if not arrows.bar_n:
        return
    long = arrows.bar_n * arrows.m_per_n
    right, low = float(box[1][0]) - 0.03 * arrows.size, float(box[0][1]) + 0.03 * arrows.size
    tick = 0.012 * arrows.size
    high = [low - tick, low + tick, low, low, low + tick, low - tick]
    axes.plot([right - long] * 3 + [right] * 3, high, color=INK, linewidth=1.2, zorder=8)
    look: Look = {"ha": "center", "va": "bottom", "fontsize": fontsize, "color": INK, "zorder": 8}
    places = (right - long / 2, low), (0, 2.5)
    axes.annotate(f"{arrows.bar_n:g} N", *places, textcoords="offset points", **look)


def write_names(
    axes: Axes,
    scene: Scene,
    motion: Motion,
    at: int,
    box: tuple[Array, Array],
    per_m: float,
    taken: Sequence[Array] = (),
    larger: float = 1.0,
) -> None:
    """Write the letters of points and the names of links at a sample, clear of the drawing and of
    places ``taken`` [m]; a metre is ``per_m`` inches, and type ``larger`` than in figures."""
    sizes = {True: larger * SIZE, False: larger * SMALL}

    def room(text: str, is_point: bool) -> tuple[float, float]:
        return width_in(text, sizes[is_point]), 0.75 * sizes[is_point] / POINTS

    low, high = box
    paper = shape.Sheet(low, tuple((high - low) * per_m), per_m, 0.1 * scene.longest_m)
    for each in shape.names(scene, motion, at, paper, room, taken):
        slope = "normal" if each.is_point else "italic"
        look: Look = {"size": sizes[each.is_point], "style": slope, "zorder": 8}
        axes.text(each.x, each.y, each.text, ha="center", va="center", **look)


FRAMES, FRAME_S, LARGER = 60, 0.06, 8.0 / 7.0
STRIP = 6
GUIDE = "#9aa5b1"
RUN: Look = {"color": INK, "linewidth": 1.4, "linestyle": (0, (3.0, 1.5))}


@dataclass(frozen=True)
class DrawnRun:
    """A run in an engine, its name, and the factor of its errors; None for one that shows them."""

    motion: Motion
    name: str
    factor: float | None = None

    def beside(self, scene: Scene, positions: int, most_s: float) -> Magnified:
        """Return the run and the reference at some of its samples: those of its second turn, where
        it has two, and of free motion from its start on. Raises CrankcheckError for a factor that
        draws the run far out of the picture."""
        time_s, lasts = self.motion.time_s, min(scene.driver.law.period_s, most_s)
        start = 0.0 if scene.is_free or time_s[-1] < 1.99 * lasts else scene.driver.law.period_s
        ends = np.searchsorted(time_s, [start - 1e-9 * lasts, start + (1.0 + 1e-9) * lasts])
        samples = np.linspace(ends[0], ends[1] - 1, positions).round().astype(int)
        exact = way_of(scene).motion(scene, time_s[samples])
        run = self.motion.each_series(lambda series: series[samples])
        size = shape.size_of_motion(scene, exact)
        factor = magnification(run, exact, {}, size) if self.factor is None else self.factor
        off = largest_displacement(run, exact, {})
        if factor > 1.0 and factor * off > (reach := FARTHEST * scene.longest_m):
            raise CrankcheckError(
                f"--magnify: found {factor:g}, which draws the run up to {factor * off:.3g} m off; "
                f"give {max(1.0, rounded(reach / off)):g} at most, or auto"
            )
        return Magnified(scene, run, exact, {}, factor)


def animation(scene: Scene, run: DrawnRun | None = None, *, with_forces: bool = False) -> bytes:
    """Return one turn of the scene, or its free motion as far as it goes in that time, as a GIF
    that repeats, its forces as arrows if requested."""
    turn = _Turn.of(scene, FRAMES, run, with_forces=with_forces)
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
    film: Look = {"duration": round(1000 * FRAME_S), "loop": 0, "optimize": True}
    film["comment"] = b"crankcheck"
    frames[0].save(buffer, "GIF", save_all=True, append_images=frames[1:], **film)
    return buffer.getvalue()


def strip(scene: Scene, run: DrawnRun | None = None, *, with_forces: bool = False) -> bytes:
    """Return six positions over one turn, side by side, as a PNG; forces as in `animation`."""
    turn = _Turn.of(scene, STRIP, run, with_forces=with_forces)
    columns, rows = STRIP // 2, 2
    figure = _figure(turn.box, columns, rows, width=4.0)
    for index in range(STRIP):
        _draw(figure.add_subplot(rows, columns, index + 1), turn, index)
    _legend(figure, turn)
    buffer = io.BytesIO()
    canvas, mark = FigureCanvasAgg(figure), {"Software": "crankcheck"}
    canvas.print_png(buffer, metadata=mark)  # type: ignore[no-untyped-call]  # as above
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
    run: DrawnRun | None = None
    beside: Magnified | None = None

    @staticmethod
    def of(scene: Scene, positions: int, run: DrawnRun | None, *, with_forces: bool) -> _Turn:
        most_s = way_of(scene).drawn_s(FRAMES * FRAME_S)
        path = shape.turn_of(scene, shape.PATH_SAMPLES, most_s, with_forces=with_forces)
        motion = shape.turn_of(scene, positions + 1, most_s, with_forces=with_forces)
        arrows = None if path.forces is None else force_arrows(scene, path)
        box = shape.box_of(scene, path) if arrows is None else arrows.box(path)
        if run is None:
            return _Turn(scene, motion, path, box, arrows)
        beside = run.beside(scene, positions + 1, most_s)
        return _Turn(scene, beside.rigid, path, box, None, run, beside)


def _figure(box: tuple[Array, Array], columns: int, rows: int, width: float) -> Figure:
    """Return a figure whose panels of ``width`` [inch] have the shape of their content."""
    low, high = box
    left, right, top, bottom, legend = 0.65, 0.15, 0.35, 0.5, 0.35
    inner = width - left - right
    height = min(max(inner * (high[1] - low[1]) / (high[0] - low[0]), 1.2), 6.0)
    size = (columns * width, rows * (height + top + bottom) + legend)
    figure = Figure(figsize=size, dpi=100)
    ends = {"left": left / size[0], "right": 1 - right / size[0], "top": 1 - top / size[1]}
    figure.subplots_adjust(**ends, bottom=(bottom + legend) / size[1])
    figure.subplots_adjust(wspace=(left + right) / inner, hspace=(top + bottom) / height)
    return figure


def _legend(figure: Figure, turn: _Turn) -> None:
    handles = []
    if turn.run is not None and turn.beside is not None:
        words = f"{turn.run.name}, error magnified {turn.beside.factor:g} times"
        handles.append(Line2D([], [], label="reference", color=GUIDE, linewidth=4))
        handles.append(Line2D([], [], label=words, **RUN))
    if turn.arrows is not None:
        words = "force on the body of that colour, black: on a block"
        look: Look = {"color": INK, "linewidth": 1.6, "marker": ">", "markersize": 5}
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
    draw_bodies(axes, scene, motion, turn.path, index, 0.8)
    taken = [] if turn.arrows is None else [each.shaft for each in turn.arrows.at(motion, index)]
    if turn.beside is not None:
        outlines = [turn.beside.outline(name, index) for name in scene.links]
        for line in outlines:
            axes.plot(*np.vstack([line, line[: len(line) > 2]]).T, **RUN, zorder=6)
            taken += [np.linspace(a, b, 24) for a, b in pairwise(line)]
    room = np.array(axes.get_window_extent().size) / axes.figure.dpi
    per_m = float(np.min(room / (high - low)))
    write_names(axes, scene, motion, index, turn.box, per_m, taken, LARGER)
    title = f"{scene.name}   {driver_stands(scene, motion, index)}"
    if turn.arrows is not None and motion.forces is not None:
        draw_arrows(axes, turn.arrows, motion, index)
        scale_bar(axes, turn.arrows, turn.box, fontsize=8)
        if math.isfinite(torque := float(motion.forces.torque[index])):
            title += f"   {scene.driver.effort} {readable(torque)} {scene.driver.effort_unit}"
    axes.set_title(title, fontsize=9 if turn.arrows is None else 8, color=INK)
    axes.set_xlabel("x [m]", fontsize=8)
    axes.set_ylabel("y [m]", fontsize=8)
    axes.tick_params(labelsize=7)
    axes.grid(color="#e4e7eb", linewidth=0.5)
    axes.set_axisbelow(True)


def draw_bodies(
    axes: Axes, scene: Scene, motion: Motion, path: Motion, index: int, line: float
) -> None:
    """Draw paths (lines of ``line`` points), guides, blocks, links and pins, without a letter.

    They stand as at sample ``index`` of ``motion``; ``path`` is a whole turn.
    """
    size = shape.size_of_motion(scene, path)
    for name, point in path.points.items():
        if name not in scene.ground:
            axes.plot(*point.position.T, color=GUIDE, linewidth=line, zorder=1)
    colours = shape.colours_of(scene)
    for slider in blocks_of(scene):
        rail = shape.rail(slider, path, motion, index, 0.06 * size)[[0, -1]]
        colour = GUIDE if slider.on == GROUND else colours[slider.on]
        axes.plot(*rail.T, color=colour, linewidth=1.4, linestyle=(0, (6, 3)), zorder=2)
        block = shape.block_at(slider, motion, index, np.array([1.0, 0.6]) * 0.045 * size)
        axes.fill(*block.T, facecolor="white", edgecolor=INK, linewidth=1.2, zorder=4)
    for own in pair_curves(scene):
        colour = colours.get(own.body, GUIDE)
        for curve in own.at(motion, index):
            axes.fill(*curve.T, fc=(colour, 0.12), ec=colour, linewidth=1.2, zorder=2.5)
    for name, link in scene.links.items():
        places = np.array([motion.points[point].position[index] for point in link.points])
        if len(places) > 2:  # a plate
            axes.fill(*places.T, color=colours[name], alpha=0.25, linewidth=0, zorder=3)
            places = np.vstack([places, places[:1]])
        axes.plot(*places.T, color=colours[name], linewidth=4, solid_capstyle="round", zorder=3)
    for name, point in motion.points.items():
        place = point.position[index]
        if name in scene.ground:  # on a triangle
            axes.fill(*shape.foot_of(place, size).T, color=INK, alpha=0.75, linewidth=0, zorder=2)
        axes.plot(*place, "o", markersize=6, color="white", markeredgecolor=INK, zorder=5)
