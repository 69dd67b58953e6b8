"""How a mechanism stands and moves on paper: a turn of it, the box that holds that, and colours."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from models.array import Array
from models.motion import Forces, Motion
from models.scene import GROUND, Scene, Slider
from models.scene.laws import Oscillating
from reports.way.way import way_of

PATH_SAMPLES = 361
MARGIN = 0.14
"""Room around what moves, over its size."""
COLOURS = ("#d1495b", "#2e6f9e", "#3a7d44", "#b7791f", "#6b4e9b", "#00798c")
"""Driver first; told apart in grey as well, by brightness."""
TRIED = 24
"""Positions of a turn of which the clearest is drawn."""

BESIDE = 5.0 / 360.0
"""The part of a turn on either side of a locked range that is not drawn."""


def turn_of(
    scene: Scene, samples: int, most_s: float = math.inf, *, with_forces: bool = False
) -> Motion:
    """One turn, or the first ``most_s`` of it, both ends included; of a scene that is let go its
    free motion. A driver that swings begins at an end of its swing, so that an even number of equal
    parts of its period shows the other end as well. Its forces are those outside of dead points,
    and clear of where friction locks."""
    law, way = scene.driver.law, way_of(scene)
    time_s = np.linspace(0.0, min(law.period_s, most_s), samples)
    if isinstance(law, Oscillating):
        time_s += (math.pi / 2 - law.phase_rad) / law.frequency_rad_s % law.period_s
    acting = way.drawn_forces(scene, time_s) if with_forces else None
    return replace(way.motion(scene, time_s), forces=acting)


def clearest(path: Motion) -> int:
    """The index of the position in which the points stand farthest apart, of some over a turn."""
    places = np.stack([point.position for point in path.points.values()], axis=1)
    tried = np.linspace(0, len(places) - 1, TRIED, endpoint=False).round().astype(int)
    apart = np.linalg.norm(places[tried][:, :, None] - places[tried][:, None, :], axis=-1)
    pairs = np.sort(apart[:, *np.triu_indices(places.shape[1], 1)], axis=1)
    return int(tried[int(np.argmax(pairs[:, :2].sum(axis=1)))])


def box_of(path: Motion) -> tuple[Array, Array]:
    """The corners of the box that is shown: all points at all times, and a margin."""
    places = np.concatenate([point.position for point in path.points.values()])
    low, high = places.min(axis=0), places.max(axis=0)
    size = float(np.max(high - low))
    # A mechanism on one line still needs some height.
    spare = np.maximum(0.35 * size - (high - low), 0.0) / 2 + MARGIN * size
    return np.asarray(low - spare), np.asarray(high + spare)


def size_of_motion(path: Motion) -> float:
    """How large what moves is [m]: the longer side of its box, without the margin."""
    low, high = box_of(path)
    return float(np.max(high - low)) / (1 + 2 * MARGIN)


def guide_direction(slider: Slider, motion: Motion, index: int) -> Array:
    """The unit vector along a guide at a sample."""
    angle = slider.direction_rad
    if slider.on != GROUND:
        angle += float(motion.links[slider.on].theta[index])
    return np.array([math.cos(angle), math.sin(angle)])


def colours_of(scene: Scene) -> dict[str, str]:
    """A colour for every link, the driver's first."""
    names = sorted(scene.links, key=lambda name: name != scene.driver.link)
    return {name: COLOURS[i % len(COLOURS)] for i, name in enumerate(names)}


def clear_of_locking(acting: Forces) -> Forces:
    """The forces of a turn to be drawn: those beside where friction locks grow past all bounds, and
    would leave the others too small to see."""
    locked = acting.has_equilibria(0)
    if not locked.any():
        return acting
    reach = math.ceil(BESIDE * locked.size)
    near = np.any([np.roll(locked, k) for k in range(-reach, reach + 1)], axis=0)

    def drawn(series: Array) -> Array:
        return np.asarray(np.where(near if series.ndim == 1 else near[:, None], np.nan, series))

    return replace(acting.each_series(drawn), friction_solution=acting.friction_solution)


def true_motion(scene: Scene, time_s: Array) -> Motion:
    """How a scene moves in truth at times [s], driven or let go, without bounds. Raises
    CrankcheckError where it does not."""
    return way_of(scene).motion(scene, time_s)
