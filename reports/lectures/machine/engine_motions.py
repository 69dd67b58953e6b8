"""Motions of an engine's poses, and their derivatives, as those of the reference."""

from __future__ import annotations

import numpy as np

from models.array import Array
from models.motion import Bound, Motion
from models.scene import Scene
from models.scene.joints import bodies
from sim.engine import BodyPose, Poses
from sim.engine.gradient import OFFSETS, STEP, PoseGradient, Variation, slope
from sim.engine.measure import motion as measured


def columns(motion: Motion | Bound, like: Motion, longest_m: float) -> Array:
    """Return the angles of links, then coordinates of sliders and points over the longest link, of
    those that a motion has (T, N)."""
    count = like.time_s.size
    series = [motion.links[name].theta for name in like.links]
    series += [motion.sliders[name].displacement / longest_m for name in like.sliders]
    for name in like.points:
        series += list(np.broadcast_to(motion.points[name].position.T / longest_m, (2, count)))
    return np.stack(series, axis=1)


def motions(variation: Variation, found: PoseGradient) -> tuple[Motion, dict[str, Motion]]:
    """Return the motion of an engine's poses, and its derivatives by a unit of each dimension: a
    point moves with its body, and on it."""
    slopes = {}
    for name, by in found.by.items():
        near = [
            measured(scene, poses_at(scene, found.places + offset * STEP * by), rates=False)
            for offset, (scene, _) in zip(OFFSETS, variation.neighbours(name), strict=True)
        ]
        slopes[name] = near[0].each_series(lambda *values: slope(values), *near[1:])
    return measured(variation.scene, poses_at(variation.scene, found.places), rates=False), slopes


def poses_at(scene: Scene, places: Array) -> Poses:
    """Return poses at places (T, B, 3), without rates."""
    still = np.full(places.shape[:1], np.nan)
    return Poses(
        still,
        {
            name: BodyPose(places[:, k, :2], places[:, k, 2], *[still] * 4)
            for k, name in enumerate(bodies(scene))
        },
    )
