"""Where the letters of points and the names of links stand in a drawing of a mechanism."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from models.array import Array
from models.motion import Motion
from models.scene import Scene, Slider
from reports.drawing.lettering import Label, place
from reports.drawing.shape import guide_direction

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
