"""A mechanism in one position as an SVG picture, for a page whose colours are not known.

Lines and letters have the colour of the text around them, links a colour that is seen on white and
on black. It is complete in itself: no script, no style sheet, nothing to load.
"""

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from html import escape

import numpy as np

from models.array import Array
from models.motion import Motion
from models.scene import GROUND, Scene, Slider
from models.scene.driver import driver_stands
from reports.drawing import shape
from reports.drawing.force_arrows import Arrow, ForceArrows, force_arrows
from reports.drawing.pair_curves import BodyCurves, blocks_of, pair_curves

WIDTH, HEIGHT = 440, 320
"""Largest picture [px]; the mechanism's own shape makes it narrower or lower."""
INCH = 96
SAMPLES = 181
BLOCK = (11.0, 7.0)
"""Half the length and half the width of a slider's block [px]."""
LETTER, LINK_NAME = 14, 12
"""Size of letters and names [px]."""
COLOURS = ("#d9596b", "#4a86c8", "#459150", "#b97f1f", "#9070c8", "#15889a")
"""Colours of links, the driver first: at least 3 to 1 against white and against black."""


@dataclass(frozen=True)
class _Paper:
    """Conversion from metres to pixels: the upper left corner [m] and the scale."""

    left: float
    top: float
    per_m: float

    def at(self, places: Array) -> Array:
        """Return places [m], (..., 2), in pixels from the upper left corner, y down."""
        return np.asarray((places - (self.left, self.top)) * (self.per_m, -self.per_m))


def svg(
    scene: Scene,
    logged: Motion | None = None,
    most_s: float = math.inf,
    *,
    with_forces: bool = False,
) -> str:
    """Draw the mechanism where its points stand farthest apart, and their paths over a turn, or
    over its first ``most_s``; if requested, with its forces as arrows, where these are largest.

    Paths of ``logged``, the motion of a run, are drawn over the reference paths. Raises
    CrankcheckError where the mechanism can not go through all of that, or there are no forces.
    """
    path = shape.turn_of(scene, SAMPLES, most_s, with_forces=with_forces)
    arrows = None if path.forces is None else force_arrows(scene, path)
    low, high = shape.box_of(scene, path) if arrows is None else arrows.box(path)
    at = shape.clearest(path) if arrows is None else arrows.largest_at(path)
    per_m = float(min(WIDTH / (high[0] - low[0]), HEIGHT / (high[1] - low[1])))
    wide, tall = (float(each) * per_m for each in high - low)
    paper = _Paper(float(low[0]), float(high[1]), per_m)
    size = shape.size_of_motion(scene, path)
    colours = shape.colours_of(scene, COLOURS)
    spare_m = 0.08 * size
    sheet = shape.Sheet(
        low, (wide / INCH, tall / INCH), per_m / INCH, spare_m, math.hypot(*BLOCK) / INCH
    )
    title = f"{scene.name}, {driver_stands(scene, path, at)}"
    curves = pair_curves(scene)
    acting = arrows.at(path, at) if arrows else []
    taken = [each.shaft for each in acting]
    parts = [
        *_paths(scene, path, paper, 'opacity="0.35" stroke-width="1.2"'),
        *(_paths(scene, logged, paper, 'opacity="0.8" stroke-dasharray="3 4"') if logged else ()),
        *_guides(scene, path, at, paper, spare_m, colours),
        *(_feet(path.points[name].position[at], paper, size) for name in scene.ground),
        *(_curves(own, path, at, paper, colours.get(own.body, "currentColor")) for own in curves),
        *(_bar(scene, name, path, at, paper, colours[name]) for name in scene.links),
        *(_block(slider, path, at, paper) for slider in blocks_of(scene)),
        *(_pin(point.position[at], paper) for point in path.points.values()),
        *(_arrow(each, paper, size, colours) for each in acting),
        *(_text(name, paper) for name in shape.names(scene, path, at, sheet, _size, taken)),
        *(_scale_bar(arrows, paper, (wide, tall)) if arrows else ()),
    ]
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" role="img" width="{wide:.0f}" '
        f'height="{tall:.0f}" viewBox="0 0 {wide:.0f} {tall:.0f}" style="max-width:100%" '
        f'fill="none" stroke="currentColor"><title>{escape(title)}</title>{"".join(parts)}</svg>'
    )


def _paths(scene: Scene, motion: Motion, paper: _Paper, look: str) -> Iterable[str]:
    for name, point in motion.points.items():
        places = point.position[np.isfinite(point.position).all(axis=1)]
        few = places[:: max(1, len(places) // SAMPLES)]
        if name not in scene.ground and len(few) > 1:
            yield f'<polyline points="{_points(paper.at(few))}" {look}/>'


def _guides(
    scene: Scene, path: Motion, at: int, paper: _Paper, spare_m: float, colours: dict[str, str]
) -> Iterable[str]:
    for slider in scene.sliders.values():
        ends = shape.rail(slider, path, path, at, spare_m)[[0, -1]]
        colour = "currentColor" if slider.on == GROUND else colours[slider.on]
        yield (
            f'<polyline points="{_points(paper.at(ends))}" stroke="{colour}" stroke-width="1.5" '
            'stroke-dasharray="7 4" opacity="0.8"/>'
        )


def _curves(own: BodyCurves, path: Motion, at: int, paper: _Paper, colour: str) -> str:
    d = "".join(f"M{_points(paper.at(curve))}Z" for curve in own.at(path, at))
    dim = 0.55 if own.body == GROUND else 1.0
    look = f'stroke="{colour}" stroke-width="1.5" fill="{colour}" fill-opacity="0.12"'
    return f'<path d="{d}" {look} opacity="{dim}"/>'


def _bar(scene: Scene, name: str, path: Motion, at: int, paper: _Paper, colour: str) -> str:
    """Return a bar between two points; of more points a plate."""
    corners = [path.points[point].position[at] for point in scene.links[name].points]
    places = _points(paper.at(np.array(corners)))
    inside = f'fill="{colour}" fill-opacity="0.2"' if len(corners) > 2 else ""
    return (
        f'<polygon points="{places}" stroke="{colour}" stroke-width="5" stroke-linejoin="round" '
        f'stroke-linecap="round" {inside}/>'
    )


def _block(slider: Slider, path: Motion, at: int, paper: _Paper) -> str:
    corners = shape.block_at(slider, path, at, np.array(BLOCK) / paper.per_m)
    places = _points(paper.at(corners))
    return (
        f'<polygon points="{places}" stroke-width="1.5" fill="currentColor" fill-opacity="0.15"/>'
    )


def _feet(place: Array, paper: _Paper, size: float) -> str:
    corners = shape.foot_of(place, size)
    return (
        f'<polygon points="{_points(paper.at(corners))}" fill="currentColor" opacity="0.55" '
        'stroke="none"/>'
    )


def _pin(place: Array, paper: _Paper) -> str:
    x, y = paper.at(place)
    return f'<circle cx="{x:.1f}" cy="{y:.1f}" r="3.5" fill="currentColor" stroke="none"/>'


def _arrow(arrow: Arrow, paper: _Paper, size: float, colours: dict[str, str]) -> str:
    """Return a force in the colour of the body that it acts on; on a block in the text colour."""
    colour = colours.get(arrow.body, "currentColor")
    head, line = (_points(paper.at(each)) for each in (arrow.head(size), arrow.line(size)))
    corners = f'<polygon points="{head}" fill="{colour}" stroke="none"/>'
    return (
        f'<polyline points="{line}" stroke="{colour}" stroke-width="2"/>{corners * arrow.is_whole}'
    )


def _scale_bar(arrows: ForceArrows, paper: _Paper, size: tuple[float, float]) -> Iterable[str]:
    """Yield the scale bar of forces, in the lower right corner of a picture of a size [px]."""
    if arrows.bar_n:
        right, low = size[0] - 10.0, size[1] - 8.0
        left = right - arrows.bar_n * arrows.m_per_n * paper.per_m
        yield (
            f'<path d="M{left:.1f} {low - 4:.1f}v8m0-4H{right:.1f}m0-4v8"/>'
            f'<text x="{(left + right) / 2:.1f}" y="{low - 6:.1f}" font-size="{LINK_NAME}" '
            'font-family="sans-serif" text-anchor="middle" fill="currentColor" stroke="none">'
            f"{arrows.bar_n:g} N</text>"
        )


def _text(name: shape.Name, paper: _Paper) -> str:
    x, y = paper.at(np.array([name.x, name.y]))
    size, style = (LETTER, "") if name.is_point else (LINK_NAME, ' font-style="italic"')
    return (
        f'<text x="{x:.1f}" y="{y:.1f}" font-size="{size}" font-family="sans-serif"{style} '
        f'text-anchor="middle" dominant-baseline="central" fill="currentColor" stroke="none">'
        f"{escape(name.text)}</text>"
    )


def _size(text: str, is_point: bool) -> tuple[float, float]:
    """Return the approximate width and height of a text [inch], whose font is the reader's own."""
    pixels = LETTER if is_point else LINK_NAME
    return 0.6 * pixels * len(text) / INCH, 0.75 * pixels / INCH


def _points(places: Sequence[Array] | Array) -> str:
    return " ".join(f"{x:.1f},{y:.1f}" for x, y in places)
