"""Positions and motion of a mechanism on paper: a turn of it, its box, and colours;
and places for the names in it.
"""

import itertools
import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from models.array import Array
from models.motion import Forces, Motion
from models.scene import GROUND, Scene, Slider
from models.scene.laws import Oscillating
from reports.drawing.pair_curves import pair_curves, places_of
from reports.protocol.way import way_of

PATH_SAMPLES = 361
MARGIN = 0.14
"""Room around the moving parts, over their size."""
COLOURS = ("#d1495b", "#2e6f9e", "#3a7d44", "#b7791f", "#6b4e9b", "#00798c")
"""Colours of links, driver first; distinct in grey as well, by brightness."""
TRIED = 24
"""Positions of a turn of which the clearest is drawn."""

BESIDE = 5.0 / 360.0
"""Part of a turn on either side of a locked range that is not drawn."""


def turn_of(
    scene: Scene, samples: int, most_s: float = math.inf, *, with_forces: bool = False
) -> Motion:
    """Return one turn, or the first ``most_s`` of it, both ends included; of a free scene its free
    motion. A driver that swings begins at an end of its swing, so that an even number of equal
    parts of its period shows the other end as well. Its forces are outside of dead points, and
    clear of where friction locks."""
    law, way = scene.driver.law, way_of(scene)
    time_s = np.linspace(0.0, min(law.period_s, most_s), samples)
    if isinstance(law, Oscillating):
        time_s += (math.pi / 2 - law.phase_rad) / law.frequency_rad_s % law.period_s
    acting = way.drawn_forces(scene, time_s) if with_forces else None
    return replace(way.motion(scene, time_s), forces=acting)


def clearest(path: Motion) -> int:
    """Return the index of the position, among some of a turn, with the points farthest apart."""
    places = np.stack([point.position for point in path.points.values()], axis=1)
    tried = np.linspace(0, len(places) - 1, TRIED, endpoint=False).round().astype(int)
    apart = np.linalg.norm(places[tried][:, :, None] - places[tried][:, None, :], axis=-1)
    pairs = np.sort(apart[:, *np.triu_indices(places.shape[1], 1)], axis=1)
    return int(tried[int(np.argmax(pairs[:, :2].sum(axis=1)))])


def box_of(scene: Scene, path: Motion) -> tuple[Array, Array]:
    """Return the corners of the shown box: all points and curves at all times, and a margin."""
    places = places_of(scene, path)
    low, high = places.min(axis=0), places.max(axis=0)
    size = float(np.max(high - low))
    # A mechanism on one line still needs some height.
    spare = np.maximum(0.35 * size - (high - low), 0.0) / 2 + MARGIN * size
    return np.asarray(low - spare), np.asarray(high + spare)


def size_of_motion(scene: Scene, path: Motion) -> float:
    """Return the size of the moving parts [m]: the longer side of their box, without the margin."""
    low, high = box_of(scene, path)
    return float(np.max(high - low)) / (1 + 2 * MARGIN)


def foot_of(place: Array, size: float) -> Array:
    """Return the corners of the foot below a pin of the ground [m], (3, 2)."""
    foot = 0.035 * size
    corners = np.array([[0.0, 0.0], [-foot, -1.6 * foot], [foot, -1.6 * foot]])
    return np.asarray(place + corners)


def guide_direction(slider: Slider, motion: Motion, index: int) -> Array:
    """Return the unit vector along a guide at a sample."""
    angle = slider.direction_rad
    if slider.on != GROUND:
        angle += float(motion.links[slider.on].theta[index])
    return np.array([math.cos(angle), math.sin(angle)])


def colours_of(scene: Scene, colours: Sequence[str] = COLOURS) -> dict[str, str]:
    """Return a colour for every link, the driver's first."""
    names = sorted(scene.links, key=lambda name: name != scene.driver.link)
    return dict(zip(names, itertools.cycle(colours), strict=False))


def clear_of_locking(acting: Forces) -> Forces:
    """Return the forces of a turn to be drawn, without those near locking, which grow past all
    bounds and would leave the others too small to see."""
    locked = acting.has_equilibria(0)
    if not locked.any():
        return acting
    reach = math.ceil(BESIDE * locked.size)
    near = np.any([np.roll(locked, k) for k in range(-reach, reach + 1)], axis=0)

    def drawn(series: Array) -> Array:
        return np.asarray(np.where(near if series.ndim == 1 else near[:, None], np.nan, series))

    return replace(acting.each_series(drawn), friction_solution=acting.friction_solution)


def true_motion(scene: Scene, time_s: Array) -> Motion:
    """Return the reference motion of a scene at times [s], driven or free, without bounds. Raises
    CrankcheckError where there is none."""
    return way_of(scene).motion(scene, time_s)


CLEAR = 0.05
"""Room to the nearest obstacle beyond which more is no better [inch]."""
AWAY = (0.04, 0.08, 0.14, 0.22)
"""Distances of the edge of a label from its anchor [inch]."""
AROUND = 24
NEAR_COST, LIGHT_COST, OUT_COST = 0.12, 0.1, 10.0
"""Costs of an inch away from the anchor, of standing on a light line, of leaving the frame."""


@dataclass(frozen=True)
class Label:
    """A text of a size (width, height) [inch], to stand beside one of ``anchors`` (n, 2) [inch];
    ``radius`` is half the thickness of the labelled part."""

    text: str
    size: tuple[float, float]
    anchors: Array
    radius: float


def place(
    labels: Sequence[Label], heavy: Array, light: Array, frame: tuple[float, float]
) -> list[tuple[float, float]]:
    """Return the centre of each label [inch], in the order given; earlier ones choose first.

    No label may cover ``heavy`` points, (n, 3), the third number a radius [inch], nor should it
    ``light`` ones, (m, 2). ``frame`` is the width and height of the drawing [inch]; all is measured
    from its lower left corner.
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
    """Yield centres around each anchor, shape (k, 2), so that the edge is some way off it."""
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
    """Return distances of points (n, 2) to boxes around centres (k, 2), (k, n); below 0 inside."""
    away = np.abs(points - centres[:, None]) - half
    across, along = away[..., 0], away[..., 1]
    outside = np.hypot(np.maximum(across, 0.0), np.maximum(along, 0.0))
    return np.asarray(outside + np.minimum(np.maximum(across, along), 0.0))


RAIL = 200
"""Points along a guide."""
BAR, PIN, BLOCK = 0.035, 0.05, 0.09
"""Half the thickness of a link, radius of a pin, and of a slider's block [inch]."""
FOOT, FOOT_BELOW = 0.08, 0.1
"""Radius of the foot of a ground pin, and distance of its middle below the pin [inch]."""
Side = tuple[Array, Array]
"""Both ends of a bar, or of a side of a plate [inch]."""
Size = Callable[[str, bool], tuple[float, float]]
"""Width and height [inch] of a text: the letter of a point or the name of a link."""


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
        """Return the place on it [inch] of a point [m], or several, (..., 2)."""
        return np.asarray((point - self.low) * self.per_m)


@dataclass(frozen=True)
class _Spot:
    """A point of the mechanism on the paper, and the radius of its mark [inch]."""

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
    """Return the letters of the points, then the names of the links, where there is room.

    The mechanism stands as at sample ``at`` of ``path``, a whole turn; places [m] that are
    ``taken``, (n, 2) each, are kept clear.
    """
    blocks = {slider.point for slider in scene.sliders.values()}
    spots = {
        name: _Spot(sheet.place(point.position[at]), sheet.block if name in blocks else PIN)
        for name, point in path.points.items()
    }
    bars = {
        name: _sides([spots[point].place for point in link.points])
        for name, link in scene.links.items()
    }
    labels = [Label(n, size(n, True), spot.place[None], spot.radius) for n, spot in spots.items()]
    labels += [Label(name, size(name, False), _middle(bar), BAR) for name, bar in bars.items()]
    drawn = [p.position for name, p in path.points.items() if name not in scene.ground]
    drawn += [rail(slider, path, path, at, sheet.spare_m) for slider in scene.sliders.values()]
    drawn += [curve for own in pair_curves(scene) for curve in own.at(path, at)]
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
    """Return obstacles of labels: points and radii [inch] of links, pins, and ground feet."""
    circles = [(*spot, BAR) for bar in bars.values() for side in bar for spot in _sampled(*side)]
    circles += [(*spot.place, spot.radius) for spot in spots.values()]
    feet = (spots[name].place for name in scene.ground)
    return np.array(circles + [(x, y - FOOT_BELOW, FOOT) for x, y in feet])


def _sides(corners: Sequence[Array]) -> list[Side]:
    """Return the bar between two points; of more points, all sides of the plate."""
    ends = [*corners, corners[0]] if len(corners) > 2 else corners
    return list(itertools.pairwise(ends))


def _middle(sides: Sequence[Side]) -> Array:
    """Return places on a link for its name: along the middle part of each side."""
    parts = np.linspace(0.25, 0.75, 7)[:, None]
    return np.concatenate([a + parts * (b - a) for a, b in sides])


def _sampled(a: Array, b: Array) -> Array:
    return np.linspace(a, b, max(int(np.linalg.norm(b - a) / BAR), 1) + 1)


def rail(slider: Slider, path: Motion, motion: Motion, at: int, spare_m: float) -> Array:
    """Return points along the guide of a slider at a sample of a motion, a little farther than it
    runs on a path [m], (n, 2)."""
    travel, there = path.sliders[slider.name].displacement, motion.sliders[slider.name].displacement
    along = np.linspace(travel.min() - spare_m, travel.max() + spare_m, RAIL) - there[at]
    direction = guide_direction(slider, motion, at)
    return np.asarray(motion.points[slider.point].position[at] + np.outer(along, direction))


def block_at(slider: Slider, motion: Motion, at: int, half: Array) -> Array:
    """Return the corners of a block at a sample [m], (4, 2), ``half`` as long and wide, (2,)."""
    c, s = guide_direction(slider, motion, at)
    corners = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]]) * half
    return np.asarray(motion.points[slider.point].position[at] + corners @ [[c, s], [-s, c]])
