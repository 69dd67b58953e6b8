"""A polygon sheet as a file: layers of an SVG, a PDF, or an animation."""

from __future__ import annotations

import io
import math
from dataclasses import replace

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from PIL import Image

from analytic.drawings.drawn_polygons import draw_polygons
from models.errors import ReachError
from reports.sheets.polygon_sheet import PolygonSheet, draw_sheet, over_positions
from reports.sheets.sheet_note import sheet_note

ANIMATED, PAGE = ".gif", ".html"
ENDINGS = (".svg", ".pdf", ANIMATED, PAGE)
FRAMES, FRAME_S, STEP_S, LAST_S = 48, 0.1, 1.2, 3.0
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


def turning_file(sheet: PolygonSheet) -> bytes:
    """The sheet over a turn of the driver, as an animation at one scale."""
    placement = sheet.drawn.placement
    angles = placement.driver.theta + np.linspace(0.0, math.tau, FRAMES, endpoint=False)
    drawn = []
    for theta in angles:
        try:
            state = replace(placement.driver, theta=float(theta))
            drawn.append(draw_polygons(placement.scene, state))
        except ReachError:  # the driver swings: what it reaches is shown
            continue
    sheets = over_positions(drawn, sheet.paper)
    frames = [
        _picture(draw_sheet(each, sheet_note(each.drawn.placement.scene)).figure) for each in sheets
    ]
    return _animated(frames, [FRAME_S] * len(frames))


def _picture(figure: Figure) -> Image.Image:
    """The figure as it stands now."""
    figure.set_dpi(DPI)
    canvas = FigureCanvasAgg(figure)
    canvas.draw()  # type: ignore[no-untyped-call]  # matplotlib has no annotation here
    pixels = np.asarray(canvas.buffer_rgba())  # type: ignore[no-untyped-call]  # as above
    return Image.fromarray(pixels).convert("RGB").quantize(64, dither=Image.Dither.NONE)


def _animated(frames: list[Image.Image], seconds: list[float]) -> bytes:
    """Pictures one after the other, again and again."""
    buffer = io.BytesIO()
    frames[0].save(
        buffer, "GIF", save_all=True, append_images=frames[1:],
        duration=[round(1000 * each) for each in seconds], loop=0, optimize=True,
    )  # fmt: skip
    return buffer.getvalue()
