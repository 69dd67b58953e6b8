"""Where the letters of points and the names of links stand in a drawing of a mechanism."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from models.array import Array
from models.motion import Motion
from models.scene import Scene, Slider
from reports.drawing.shape import guide_direction

CLEAR = 0.05
"""More room than this to the nearest obstacle is no better [inch]."""
AWAY = (0.04, 0.08, 0.14, 0.22)
"""How far the edge of a label may be from what it names [inch]."""
AROUND = 24
NEAR_COST, LIGHT_COST, OUT_COST = 0.12, 0.1, 10.0
"""Costs of an inch away from what is named, of standing on a light line, of leaving the frame."""


@dataclass(frozen=True)
class Label:
    """A text of a size (width, height) [inch], to stand beside one of ``anchors`` (n, 2) [inch];
    ``radius`` is half the thickness of what it names."""

    text: str
    size: tuple[float, float]
    anchors: Array
    radius: float


def place(
    labels: Sequence[Label], heavy: Array, light: Array, frame: tuple[float, float]
) -> list[tuple[float, float]]:
    """The centre of each label [inch], in the order given; those first have the first choice.

    Parameters
    ----------
    heavy, light : Array
        Points that no label may cover, and those that it should not, shape (n, 3) and (m, 2); the
        third number is a radius [inch].
    frame : tuple
        Width and height of the drawing [inch]; all is measured from its lower left corner.
    """
    centres: list[tuple[float, float]] = []
    boxes: list[tuple[float, float, float, float]] = []
    for label in labels:
        rings = list(_rings(label))
        costs = [_costs(label, ring, heavy, light, boxes, frame) for ring in rings]
        x, y = np.concatenate(rings)[int(np.argmin(np.concatenate(costs)))]
        centres.append((float(x), float(y)))
        boxes.append((float(x), float(y), *label.size))
    return centres


def _rings(label: Label) -> Iterator[Array]:
    """Centres around each anchor, shape (k, 2), so that the edge is some way off it."""
    angle = np.linspace(0.0, math.tau, AROUND, endpoint=False) + math.pi / 4
    direction = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    half = np.array(label.size) / 2
    # from the centre of a box to its edge along a direction
    with np.errstate(divide="ignore"):
        edge = np.min(half / np.abs(direction), axis=1)
    for away in AWAY:
        ring = direction * (label.radius + away + edge)[:, None]
        yield (label.anchors[:, None, :] + ring).reshape(-1, 2)


def _costs(
    label: Label,
    centres: Array,
    heavy: Array,
    light: Array,
    boxes: Sequence[tuple[float, float, float, float]],
    frame: tuple[float, float],
) -> Array:
    """What speaks against each place (k, 2), shape (k,)."""
    half = np.array(label.size) / 2
    room = np.min(_distance(heavy[:, :2], centres, half) - heavy[:, 2], axis=1, initial=CLEAR)
    for x, y, width, height in boxes:
        gap = np.abs(centres - (x, y)) - half - np.array([width, height]) / 2
        most = gap.max(axis=1)
        room = np.minimum(room, np.where(most < 0, most, np.hypot(*gap.clip(0.0).T)))
    crossed = np.min(_distance(light, centres, half), axis=1, initial=1.0) < 0.01
    middle = np.array(frame) / 2
    out = np.maximum(np.abs(centres - middle) + half - middle, 0.0).sum(axis=1)
    off = np.linalg.norm(label.anchors[:, None] - centres, axis=2).min(axis=0)
    hidden = 4.0 * np.maximum(-room, 0.0)
    costs = CLEAR - room + hidden + NEAR_COST * off + LIGHT_COST * crossed + OUT_COST * out
    return np.asarray(costs)


def _distance(points: Array, centres: Array, half: Array) -> Array:
    """From points (n, 2) to boxes around centres (k, 2), shape (k, n); below 0 inside of one."""
    away = np.abs(points - centres[:, None]) - half
    across, along = away[..., 0], away[..., 1]
    outside = np.hypot(np.maximum(across, 0.0), np.maximum(along, 0.0))
    return np.asarray(outside + np.minimum(np.maximum(across, along), 0.0))


RAIL = 200
"""Points along a guide."""
BAR, PIN, BLOCK = 0.035, 0.05, 0.09
"""Half the thickness of a link, radius of a pin, and of a slider's block [inch]."""
FOOT, FOOT_BELOW = 0.08, 0.1
"""Radius of what a pin of the ground stands on, and how far below the pin its middle is [inch]."""
Side = tuple[Array, Array]
"""The two ends of a bar, or of a side of a plate [inch]."""
Size = Callable[[str, bool], tuple[float, float]]
"""Width and height [inch] of a text, which is the letter of a point or the name of a link."""


@dataclass(frozen=True)
class Name:
    """A letter of a point, or the name of a link, and the middle of its place [m]."""

    text: str
    x: float
    y: float
    is_point: bool


@dataclass(frozen=True)
class Sheet:
    """The paper: its lower left corner [m], width and height [inch], and the inches of a metre.

    Blocks of sliders have the radius ``block`` [inch], and guides go on by ``spare_m`` beyond them.
    """

    low: Array
    size: tuple[float, float]
    per_m: float
    spare_m: float
    block: float = BLOCK

    def place(self, point: Array) -> Array:
        """Where a point [m], or several, (..., 2), stand on it [inch]."""
        return np.asarray((point - self.low) * self.per_m)


@dataclass(frozen=True)
class _Spot:
    """A point of the mechanism on the paper, and the radius of what is drawn there [inch]."""

    place: Array
    radius: float


def names(
    scene: Scene,
    path: Motion,
    at: int,
    sheet: Sheet,
    size: Size,
    taken: Sequence[Array] = (),
) -> list[Name]:
    """The letters of the points, then the names of the links, where there is room.

    The mechanism stands as at sample ``at`` of ``path``, a whole turn; places [m] that are
    ``taken``, (n, 2) each, are kept clear.
    """
    blocks = {slider.point for slider in scene.sliders.values()}
    spots = {
        name: _Spot(
            (point.position[at] - sheet.low) * sheet.per_m, sheet.block if name in blocks else PIN
        )
        for name, point in path.points.items()
    }
    bars = {
        name: _sides([spots[point].place for point in link.points])
        for name, link in scene.links.items()
    }
    labels = [Label(n, size(n, True), spot.place[None], spot.radius) for n, spot in spots.items()]
    labels += [Label(name, size(name, False), _middle(bar), BAR) for name, bar in bars.items()]
    drawn = [p.position for name, p in path.points.items() if name not in scene.ground]
    drawn += [rail(slider, path, at, sheet.spare_m) for slider in scene.sliders.values()]
    lines = sheet.place(np.concatenate(drawn))
    heavy = [_obstacles(scene, spots, bars)]
    heavy += [np.column_stack([sheet.place(p), np.full(len(p), BAR)]) for p in taken]
    centres = place(labels, np.vstack(heavy), lines, sheet.size)
    low_x, low_y = (float(each) for each in sheet.low)
    return [
        Name(label.text, low_x + x / sheet.per_m, low_y + y / sheet.per_m, index < len(spots))
        for index, (label, (x, y)) in enumerate(zip(labels, centres, strict=True))
    ]


def _obstacles(
    scene: Scene, spots: Mapping[str, _Spot], bars: Mapping[str, Sequence[Side]]
) -> Array:
    """What no label may cover: points and radii [inch] of links, pins, and feet on the ground."""
    circles = [(*spot, BAR) for bar in bars.values() for side in bar for spot in _sampled(*side)]
    circles += [(*spot.place, spot.radius) for spot in spots.values()]
    feet = (spots[name].place for name in scene.ground)
    return np.array(circles + [(x, y - FOOT_BELOW, FOOT) for x, y in feet])


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


def rail(slider: Slider, path: Motion, at: int, spare_m: float) -> Array:
    """Points along the guide of a slider, as far as it runs and a little farther [m], (n, 2)."""
    travel = path.sliders[slider.name].displacement
    along = np.linspace(travel.min() - spare_m, travel.max() + spare_m, RAIL) - travel[at]
    direction = guide_direction(slider, path, at)
    return np.asarray(path.points[slider.point].position[at] + np.outer(along, direction))
