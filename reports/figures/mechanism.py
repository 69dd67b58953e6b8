"""The mechanism of a scene in one position: links and points by name, and the paths of the points.

It is drawn with the parts of `reports.drawing.gif`; only letters and names are placed anew, as a
figure of a column's width has little room for them.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from models.array import Array
from models.motion import Motion
from models.scene import Scene, Slider
from reports.describe.law import describe_law
from reports.drawing.gif import PATH_SAMPLES, box_of, draw_bodies, guide_direction, turn_of
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
FOOT, FOOT_BELOW = 0.08, 0.1
"""Radius of what a pin of the ground stands on, and how far below the pin its middle is [inch]."""
Side = tuple[Array, Array]
"""The two ends of a bar, or of a side of a plate [inch]."""


@dataclass(frozen=True)
class _Spot:
    """A point of the mechanism on the paper, and the radius of what is drawn there [inch]."""

    place: Array
    radius: float


def draw(report: Report, name: str) -> Figure | None:
    """The drawing; None for a scene whose text in the store can not be read."""
    scene = report.scenes[name]
    if scene is None:
        return None
    path = turn_of(scene, PATH_SAMPLES)
    low, high = box_of(path)
    panels = Panels(top=0.05, right=0.1)
    wide = COLUMN_IN - panels.left - panels.right
    height = float(np.clip(wide * (high[1] - low[1]) / (high[0] - low[0]), 1.0, 4.0))
    at = clearest(path)
    angle = math.degrees(path.links[scene.driver.link].theta[at]) % 360.0
    title = f"{name}, {scene.driver.link} at {angle:.0f} deg"
    under = [f"{scene.source}. {scene.note}", _origin(report, scene)]
    figure, (axes,) = sheet(COLUMN_IN, replace(panels, height=height), title, [], under)
    axes.set(xlabel="x [m]", ylabel="y [m]", xlim=(low[0], high[0]), ylim=(low[1], high[1]))
    axes.set_aspect("equal", adjustable="box", anchor="N")
    per_m = min(wide / (high[0] - low[0]), height / (high[1] - low[1]))
    draw_bodies(axes, scene, path, path, at, 0.5)
    _names(axes, scene, path, at, low, float(per_m), tuple((high - low) * per_m))
    return figure


def clearest(path: Motion) -> int:
    """The index of the position in which the points stand farthest apart, of some over a turn."""
    places = np.stack([point.position for point in path.points.values()], axis=1)
    tried = np.linspace(0, len(places) - 1, TRIED, endpoint=False).round().astype(int)
    apart = np.linalg.norm(places[tried][:, :, None] - places[tried][:, None, :], axis=-1)
    pairs = np.sort(apart[:, *np.triu_indices(places.shape[1], 1)], axis=1)
    return int(tried[int(np.argmax(pairs[:, :2].sum(axis=1)))])


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
    blocks = {slider.point for slider in scene.sliders.values()}
    spots = {
        name: _Spot((point.position[at] - low) * per_m, BLOCK if name in blocks else PIN)
        for name, point in path.points.items()
    }
    bars = {
        name: _sides([spots[point].place for point in link.points])
        for name, link in scene.links.items()
    }
    labels = [Label(n, _size(n, SIZE), spot.place[None], spot.radius) for n, spot in spots.items()]
    labels += [Label(name, _size(name, SMALL), _middle(bar), BAR) for name, bar in bars.items()]
    drawn = [p.position for name, p in path.points.items() if name not in scene.ground]
    drawn += [_rail(scene, slider, path, at) for slider in scene.sliders.values()]
    lines = (np.concatenate(drawn) - low) * per_m
    centres = place(labels, _obstacles(scene, spots, bars), lines, frame)
    for label, (x, y) in zip(labels, centres, strict=True):
        size, style = (SIZE, "normal") if label.text in spots else (SMALL, "italic")
        where = (low[0] + x / per_m, low[1] + y / per_m)
        axes.text(*where, label.text, size=size, style=style, ha="center", va="center", zorder=8)


def _obstacles(
    scene: Scene, spots: Mapping[str, _Spot], bars: Mapping[str, Sequence[Side]]
) -> Array:
    """What no label may cover: points and radii [inch] of links, pins, and feet on the ground."""
    circles = [(*spot, BAR) for bar in bars.values() for side in bar for spot in _sampled(*side)]
    circles += [(*spot.place, spot.radius) for spot in spots.values()]
    feet = (spots[name].place for name in scene.ground)
    return np.array(circles + [(x, y - FOOT_BELOW, FOOT) for x, y in feet])


def _size(text: str, points: float) -> tuple[float, float]:
    """Width and height of a text [inch]."""
    return width_in(text, points), 0.75 * points / POINTS


def _sides(corners: Sequence[Array]) -> list[Side]:
    """The bar between two points; of more points, all sides of the plate."""
    ends = [*corners, corners[0]] if len(corners) > 2 else corners
    return list(itertools.pairwise(ends))


def _middle(sides: Sequence[Side]) -> Array:
    """Where on a link its name may stand: along the middle part of each side."""
    parts = np.linspace(0.25, 0.75, 7)[:, None]
    return np.concatenate([a + parts * (b - a) for a, b in sides])


def _sampled(a: Array, b: Array) -> Array:
    """Points along a side, closely."""
    return np.linspace(a, b, max(int(np.linalg.norm(b - a) / BAR), 1) + 1)


def _rail(scene: Scene, slider: Slider, path: Motion, at: int) -> Array:
    """Points along the guide of a slider, as far as it runs [m], shape (n, 2)."""
    travel = path.sliders[slider.name].displacement
    spare = 0.1 * scene.longest_m
    along = np.linspace(travel.min() - spare, travel.max() + spare, RAIL) - travel[at]
    direction = guide_direction(slider, path, at)
    return np.asarray(path.points[slider.point].position[at] + np.outer(along, direction))


def _origin(report: Report, scene: Scene) -> str:
    """Where the drawing comes from: it is the closed form's, and no engine's."""
    own = facts_of(report).get("crankcheck", "")
    longest = f"longest link L = {scene.longest_m:g} m"
    return f"crankcheck {own}, closed form; driver {describe_law(scene)}; {longest}."
