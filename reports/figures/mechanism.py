"""The mechanism of a scene in one position: links and points by name, and the paths of the points.

It is drawn with the parts of `reports.drawing.gif`; only letters and names are placed anew, as a
figure of a column's width has little room for them.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator
from dataclasses import replace

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from models.array import Array
from models.motion import Motion
from models.scene import GROUND, Scene, Slider
from reports.describe.law import describe_law
from reports.drawing.gif import (
    GUIDE,
    MARGIN,
    PATH_SAMPLES,
    box_of,
    colours_of,
    draw_link,
    draw_pin,
    draw_slider,
    turn_of,
)
from reports.drawing.lettering import Label, place
from reports.figures.sheet import Panels, sheet
from reports.figures.style import COLUMN_IN, POINTS, SIZE, SMALL, width_in
from reports.results.origin import facts_of
from reports.results.overview import Report

TRIED = 24
"""Positions of a turn of which the clearest is drawn."""
RAIL = 200
"""Points along a guide."""
BAR, PIN, BLOCK = 0.035, 0.05, 0.09
"""Half the thickness of a link, radius of a pin, and of a slider's block [inch]."""


def draw(report: Report, scene: str) -> Figure | None:
    """The drawing; None for a scene whose text in the store can not be read."""
    known = report.scenes[scene]
    if known is None:
        return None
    path = turn_of(known, PATH_SAMPLES)
    low, high = box_of(path)
    panels = Panels(top=0.05, right=0.1)
    wide = COLUMN_IN - panels.left - panels.right
    height = float(np.clip(wide * (high[1] - low[1]) / (high[0] - low[0]), 1.0, 4.0))
    at = clearest(path)
    angle = math.degrees(path.links[known.driver.link].theta[at]) % 360.0
    title = f"{scene}, {known.driver.link} at {angle:.0f} deg"
    under = [f"{known.source}. {known.note}", _origin(report, known)]
    figure, (axes,) = sheet(COLUMN_IN, replace(panels, height=height), title, [], under)
    axes.set(xlabel="x [m]", ylabel="y [m]", xlim=(low[0], high[0]), ylim=(low[1], high[1]))
    axes.set_aspect("equal", adjustable="box", anchor="N")
    per_m = min(wide / (high[0] - low[0]), height / (high[1] - low[1]))
    _bodies(axes, known, path, at)
    _names(axes, known, path, at, low, float(per_m), tuple((high - low) * per_m))
    return figure


def clearest(path: Motion) -> int:
    """The index of the position in which the points stand farthest apart, of some over a turn."""
    places = np.stack([point.position for point in path.points.values()], axis=1)
    tried = np.linspace(0, len(places) - 1, TRIED, endpoint=False).round().astype(int)
    apart = np.linalg.norm(places[tried][:, :, None] - places[tried][:, None, :], axis=-1)
    pairs = np.sort(apart[:, *np.triu_indices(places.shape[1], 1)], axis=1)
    return int(tried[int(np.argmax(pairs[:, :2].sum(axis=1)))])


def _bodies(axes: Axes, scene: Scene, path: Motion, at: int) -> None:
    """Paths, guides, blocks, links and pins, without a letter."""
    low, high = box_of(path)
    size = float(np.max(high - low)) / (1.0 + 2.0 * MARGIN)
    colours = colours_of(scene)
    for name, point in path.points.items():
        if name not in scene.ground:
            axes.plot(*point.position.T, color=GUIDE, linewidth=0.5, zorder=1)
    for slider in scene.sliders.values():
        rail = GUIDE if slider.on == GROUND else colours[slider.on]
        draw_slider(axes, slider, rail, path, path, at, size)
    for name, link in scene.links.items():
        draw_link(axes, [path.points[point].position[at] for point in link.points], colours[name])
    for name, point in path.points.items():
        draw_pin(axes, "", point.position[at], name in scene.ground, size, 0.0)


def _names(
    axes: Axes,
    scene: Scene,
    path: Motion,
    at: int,
    low: Array,
    per_m: float,
    frame: tuple[float, float],
) -> None:
    """The letters of the points, then the names of the links, where there is room."""
    spots = {name: (p.position[at] - low) * per_m for name, p in path.points.items()}
    blocks = {slider.point for slider in scene.sliders.values()}
    bars = {
        name: np.array([spots[point] for point in link.points])
        for name, link in scene.links.items()
    }
    labels = [
        Label(name, _size(name, SIZE), spot[None], BLOCK if name in blocks else PIN)
        for name, spot in spots.items()
    ]
    labels += [Label(name, _size(name, SMALL), _along(bar), BAR) for name, bar in bars.items()]
    heavy = [(*spot, BAR) for bar in bars.values() for spot in _sampled(bar)]
    heavy += [(*spot, BLOCK if name in blocks else PIN) for name, spot in spots.items()]
    heavy += [(x, y - 0.1, 0.08) for x, y in (spots[name] for name in scene.ground)]
    moving = [p.position for name, p in path.points.items() if name not in scene.ground]
    rails = [_rail(scene, slider, path, at) for slider in scene.sliders.values()]
    light = (np.concatenate([*moving, *rails]) - low) * per_m
    centres = place(labels, np.array(heavy), light, frame)
    for label, (x, y) in zip(labels, centres, strict=True):
        size = SIZE if label.text in spots else SMALL
        style = "normal" if label.text in spots else "italic"
        where = (low[0] + x / per_m, low[1] + y / per_m)
        axes.text(*where, label.text, size=size, style=style, ha="center", va="center", zorder=8)


def _size(text: str, points: float) -> tuple[float, float]:
    """Width and height of a text [inch]."""
    return width_in(text, points), 0.75 * points / POINTS


def _along(corners: Array) -> Array:
    """Where on a link its name may stand: along its middle part, or all around a plate."""
    ends = [*corners, corners[0]] if len(corners) > 2 else list(corners)
    parts = np.linspace(0.25, 0.75, 7)[:, None]
    return np.concatenate([a + parts * (b - a) for a, b in itertools.pairwise(ends)])


def _sampled(corners: Array) -> Iterator[Array]:
    """Points along a link, closely."""
    ends = [*corners, corners[0]] if len(corners) > 2 else list(corners)
    for a, b in itertools.pairwise(ends):
        number = max(int(np.linalg.norm(b - a) / BAR), 1) + 1
        yield from np.linspace(a, b, number)


def _rail(scene: Scene, slider: Slider, path: Motion, at: int) -> Array:
    """Points along the guide of a slider, as far as it runs [m], shape (n, 2)."""
    travel = path.sliders[slider.name].displacement
    angle = slider.direction_rad
    if slider.on != GROUND:
        angle += float(path.links[slider.on].theta[at])
    spare = 0.1 * scene.longest_m
    along = np.linspace(travel.min() - spare, travel.max() + spare, RAIL) - travel[at]
    direction = np.array([math.cos(angle), math.sin(angle)])
    return np.asarray(path.points[slider.point].position[at] + np.outer(along, direction))


def _origin(report: Report, scene: Scene) -> str:
    """Where the drawing comes from: it is the closed form's, and no engine's."""
    own = facts_of(report).get("crankcheck", "")
    longest = f"longest link L = {scene.longest_m:g} m"
    return f"crankcheck {own}, closed form; driver {describe_law(scene)}; {longest}."
