"""A polygon sheet as a file: layers of an SVG, a PDF, or an animation."""

from __future__ import annotations

import io

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from PIL import Image

from reports.lectures.drawing.sheets.polygons.polygon_course import PolygonCourse
from reports.lectures.drawing.sheets.polygons.polygon_sheet import (
    PolygonSheet,
    draw_sheet,
    over_positions,
)
from reports.lectures.drawing.sheets.sheet_note import sheet_note

ANIMATED, PAGE = ".gif", ".html"
ENDINGS = (".svg", ".pdf", ANIMATED, PAGE)
FRAMES, MOST_FRAMES = 24, 40
"""Of a turn, and at most of a free motion: each takes half a second to draw."""
FRAME_S, STEP_S, LAST_S = 0.15, 1.2, 3.0
DPI = 100


def polygon_file(sheet: PolygonSheet, ending: str) -> bytes:
    """The sheet as a file of an ending in `ENDINGS`, animated step by step."""
    canvas = draw_sheet(sheet, sheet_note(sheet.drawn.placement.scene))
    name = sheet.drawn.placement.scene.name
    if ending != ANIMATED:
        return canvas.saved(ending[1:], f"Vector polygons of {name}")
    built = [
        axes for axes in canvas.layers if axes.get_gid() not in ("layer-frame", "layer-scheme")
    ]
    for axes in built:
        axes.set_visible(False)
    frames = [_picture(canvas.figure)]
    for axes in built:
        axes.set_visible(True)
        frames.append(_picture(canvas.figure))
    return _animated(frames, [STEP_S] * (len(frames) - 1) + [LAST_S])


def turning_file(sheet: PolygonSheet, *, steady: bool = False) -> bytes:
    """The sheet over a turn of the driver's law, or over its free motion, as an animation at one
    scale; with a ``steady`` driver at the speed of the sheet. Raises CrankcheckError where the
    driver goes through no turn."""
    placement = sheet.drawn.placement
    course = PolygonCourse.of(placement, FRAMES + 1, MOST_FRAMES, steady=steady)
    frames = [
        _picture(draw_sheet(each, sheet_note(course.scene)).figure)
        for each in over_positions(course.frames, sheet.paper)
    ]
    return _animated(frames, [FRAME_S] * len(frames))


def _picture(figure: Figure) -> Image.Image:
    """The figure as it stands now."""
    figure.set_dpi(DPI)
    canvas = FigureCanvasAgg(figure)
    canvas.draw()  # type: ignore[no-untyped-call]  # matplotlib has no annotation here
    pixels = np.asarray(canvas.buffer_rgba())  # type: ignore[no-untyped-call]  # as above
    return Image.fromarray(pixels).convert("RGB")


def _animated(frames: list[Image.Image], seconds: list[float]) -> bytes:
    """Pictures one after the other, again and again, in the colours of the last, which has all."""
    colours = frames[-1].quantize(64, dither=Image.Dither.NONE)
    frames = [each.quantize(palette=colours, dither=Image.Dither.NONE) for each in frames]
    buffer = io.BytesIO()
    frames[0].save(
        buffer, "GIF", save_all=True, append_images=frames[1:],
        duration=[round(1000 * each) for each in seconds], loop=0, optimize=True,
    )  # fmt: skip
    return buffer.getvalue()
