"""Polygons one after the other: over a turn of the driver's law, or over a free motion."""

from __future__ import annotations

import io
import math
from dataclasses import dataclass, replace

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from PIL import Image

from analytic.lectures.drawings.drawn_polygons import DrawnPolygons, polygons_of
from analytic.lectures.drawings.placed_mechanism import PlacedMechanism
from models.motion import Motion
from models.scene import Scene
from models.scene.laws import ConstantSpeed
from reports.compare.free.free_truth import kept_motion
from reports.describe.free_motion import instants
from reports.drawing.shape import turn_of
from reports.lectures.drawing.sheets.paper import sheet_note
from reports.lectures.drawing.sheets.polygons.polygon_sheet import (
    PolygonSheet,
    draw_sheet,
    over_positions,
)


@dataclass(frozen=True)
class PolygonCourse:
    """A turn of the driver's law and the polygons at each of its instants, both ends included;
    ``nearest`` is the one that stands and moves most like the placement it was asked for with."""

    scene: Scene
    motion: Motion
    drawn: tuple[DrawnPolygons, ...]
    nearest: int
    title = "Polygons over a turn"
    words = "a turn"

    @staticmethod
    def kind(scene: Scene, *, steady: bool) -> type[PolygonCourse]:
        """What a scene is drawn over: with a ``steady`` driver always a turn."""
        return FreeMotionCourse if scene.is_free and not steady else PolygonCourse

    @classmethod
    def of(
        cls, placement: PlacedMechanism, samples: int, most: int, *, steady: bool
    ) -> PolygonCourse:
        """Over a turn of the driver's law at a number of instants, with a ``steady`` driver at the
        speed of the placement; over a free motion at as many as it needs, up to ``most``. Raises
        CrankcheckError where the driver goes through no turn.
        """
        scene = placement.scene
        course = cls.kind(scene, steady=steady)
        if steady:
            law = ConstantSpeed(placement.driver.theta, placement.driver.omega)
            scene = replace(scene, driver=replace(scene.driver, law=law))
        samples = course.instants(scene, samples, most)
        motion = turn_of(scene, samples)
        drawn = tuple(
            polygons_of(PlacedMechanism.standing(scene, motion, sample=at)) for at in range(samples)
        )
        return course(scene, motion, drawn, _nearest(motion, placement))

    @classmethod
    def instants(cls, scene: Scene, samples: int, most: int) -> int:
        """How many there are."""
        return samples

    @property
    def frames(self) -> tuple[DrawnPolygons, ...]:
        """Those that an animation shows again and again: the last comes first again."""
        return self.drawn[:-1]

    @property
    def along(self) -> str:
        """What the slider of a page says."""
        return f"Angle of the {self.scene.driver.link}"

    @property
    def until(self) -> dict[str, object]:
        """What the drawing of a page is told besides."""
        return {}


class FreeMotionCourse(PolygonCourse):
    """A free motion and the polygons at its instants."""

    title = "Polygons over the motion"
    words = "its motion"
    along = "Time"

    @classmethod
    def instants(cls, scene: Scene, samples: int, most: int) -> int:
        return min(instants(kept_motion(scene, scene.driver.law.period_s)), most)

    @property
    def frames(self) -> tuple[DrawnPolygons, ...]:
        return self.drawn

    @property
    def until(self) -> dict[str, object]:
        """The time that it is drawn for [s]: the slider is one of times."""
        return {"until_s": float(self.motion.time_s[-1])}


def _nearest(motion: Motion, placement: PlacedMechanism) -> int:
    link, driver = placement.scene.driver.link, placement.driver
    moved = motion.links[link]
    off = np.abs((moved.theta - driver.theta + math.pi) % math.tau - math.pi)
    other_way = np.sign(moved.omega) * np.sign(driver.omega) < 0.0
    return int(np.argmin(off + math.pi * other_way))


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
