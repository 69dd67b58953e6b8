"""The scheme of a mechanism as books draw it: bars and plates, pins, hatched ground, blocks."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator, Mapping

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Circle
from matplotlib.patches import Polygon as Patch

from analytic.drawings.placed_mechanism import PlacedMechanism, quarter_turn
from models.array import Array
from models.scene import GROUND
from reports.figures.style import INK, QUIET
from reports.sheets.canvas import line

PIN_MM, BLOCK_MM, FOOT_MM = 0.9, (5.0, 3.0), 3.2
HATCH_MM, HATCHES = 1.1, 5
FRONT = 6
"""Pins lie over everything."""


def draw_scheme(axes: Axes, placement: PlacedMechanism, places: Mapping[str, Array]) -> None:
    """The mechanism with its points at ``places`` [mm]."""
    scene = placement.scene
    for name, slider in scene.sliders.items():
        along = placement.along(name)
        on_ground = slider.on == GROUND
        _block(axes, places[slider.point], along, on_ground=on_ground)
    for link in scene.links.values():
        corners = np.array([places[point] for point in link.points])
        if len(corners) > 2 and not _flat(corners):
            axes.add_patch(
                Patch(corners, closed=True, fc="#eef1f4", ec=INK, lw=1.1, joinstyle="round")
            )
        else:
            for start, end in _segments(corners):
                line(axes, start, end, f"scheme-{link.name}", linewidth=1.3)
    for name, slider in scene.sliders.items():
        if slider.on != GROUND:
            _guide(axes, placement, places, name)
    pinned = [point for point, bodies in placement.structure.pins.items() if len(bodies) > 1]
    for point in scene.ground:
        if point in pinned:
            _foot(axes, places[point])
    for point, at in places.items():
        radius = PIN_MM if point in pinned else 0.5 * PIN_MM
        face = "white" if point in pinned else INK
        axes.add_patch(Circle(tuple(at), radius, fc=face, ec=INK, lw=0.7, zorder=FRONT))


def _segments(corners: Array) -> Iterator[tuple[Array, Array]]:
    """The bar from end to end of points on a line, or of two."""
    if len(corners) > 1:
        apart = np.linalg.norm(corners[:, None] - corners[None], axis=-1)
        i, j = np.unravel_index(int(apart.argmax()), apart.shape)
        yield corners[i], corners[j]


def _flat(corners: Array) -> bool:
    """Whether points stand in a line."""
    spread = np.linalg.svd(corners - corners.mean(axis=0), compute_uv=False)
    return bool(spread[1] < 1e-6 * spread[0])


def _foot(axes: Axes, place: Array) -> None:
    """A pin's support on hatched ground."""
    side, spare = np.array([0.6 * FOOT_MM, 0.0]), np.array([0.8, 0.0])
    left, right = place - (0.0, FOOT_MM) - side, place - (0.0, FOOT_MM) + side
    axes.add_patch(Patch([place, left, right], closed=True, fc="white", ec=INK, lw=0.7))
    _hatched(axes, left - spare, right + spare)


def _hatched(axes: Axes, start: Array, end: Array) -> None:
    """Ground: a line with short strokes on its right side."""
    along = end - start
    length = math.hypot(*along)
    unit = along / length
    stroke = HATCH_MM * np.array([unit[1] - unit[0], -unit[0] - unit[1]]) / math.sqrt(2)
    line(axes, start, end, linewidth=0.8)
    for share in np.linspace(0.15, 1.0, HATCHES):
        at = start + share * along
        line(axes, at, at + stroke, linewidth=0.5)


def _block(axes: Axes, place: Array, along: Array, *, on_ground: bool) -> None:
    """The block of a slider; a guide of the ground is hatched on both sides."""
    across = np.array([-along[1], along[0]])
    half = 0.5 * BLOCK_MM[0] * along
    aside = 0.5 * BLOCK_MM[1] * across
    corners = [
        place + half + aside,
        place - half + aside,
        place - half - aside,
        place + half - aside,
    ]
    axes.add_patch(Patch(corners, closed=True, fc="white", ec=INK, lw=0.8, zorder=3))
    if on_ground:
        for side in (-1.0, 1.0):
            reach, beside = 1.3 * BLOCK_MM[0] * along, side * aside
            start, end = place - side * -reach + beside, place + side * -reach + beside
            _hatched(axes, start, end)


def _guide(axes: Axes, placement: PlacedMechanism, places: Mapping[str, Array], name: str) -> None:
    """The line of a guide that moves, from its nearest point through the block."""
    slider = placement.scene.sliders[name]
    along, block = placement.along(name), places[slider.point]
    ends = [places[p] for p in placement.scene.links[slider.on].points]
    shares = [float((end - block) @ along) for end in ends]
    low, high = min([*shares, -4.0]), max([*shares, 4.0])
    line(axes, block + low * along, block + high * along, linewidth=1.0, color=QUIET, zorder=1)


def bars(placement: PlacedMechanism, places: Mapping[str, Array]) -> Array:
    """Points along everything that is drawn (n, 2) [mm]: links, blocks, feet."""
    drawn = [np.array(list(places.values()))]
    for link in placement.scene.links.values():
        corners = [places[point] for point in link.points]
        drawn += [_along(a, b) for a, b in itertools.combinations(corners, 2)]
    for name, slider in placement.scene.sliders.items():
        reach = 1.3 * BLOCK_MM[0] * placement.along(name)
        block, aside = places[slider.point], 0.5 * BLOCK_MM[1] * quarter_turn(placement.along(name))
        drawn += [_along(block + s * aside - reach, block + s * aside + reach) for s in (-1, 1)]
    drawn += [places[point][None] - (0.0, FOOT_MM) for point in placement.scene.ground]
    return np.vstack(drawn)


def _along(start: Array, end: Array) -> Array:
    return np.linspace(start, end, max(int(np.hypot(*(end - start))), 1) + 1)
