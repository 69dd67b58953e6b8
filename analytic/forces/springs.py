"""The length of each spring over a chunk, its rate, and what it pulls with."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from analytic.dyads.chunk import Chunk
from analytic.dyads.plane import PointKinematics
from models.array import Array
from models.joints import block_name
from models.scene import GROUND, Scene
from models.springs import LineSpring, PinSpring, Spring


def spring_lengths(scene: Scene, chunk: Chunk) -> Iterator[tuple[Spring, Array, Array]]:
    """Every spring of a scene with its q [m or rad] and its rate q' [m/s or rad/s], (T,) each.

    Of a spring in a pin q is in (-pi, pi] of its free angle.
    """
    like = np.zeros_like(chunk.theta)
    for spring in scene.springs.values():
        if isinstance(spring, LineSpring):
            a, b = (_point(scene, chunk, name) for name in spring.points)
            way, drift = b.p - a.p, b.v - a.v
            length = way.norm()
            yield spring, like + length, like + way.dot(drift) / length
        elif isinstance(spring, PinSpring):
            first, second = (chunk.bodies[name] for name in spring.bodies)
            x, y = first.turn.dot(second.turn), first.turn.cross(second.turn)
            c, s = np.cos(spring.free), np.sin(spring.free)
            off = np.arctan2(c * y - s * x, c * x + s * y)
            yield spring, like + spring.free + off, like + (second.omega - first.omega)
        else:
            sliding = chunk.sliders[spring.slider]
            yield spring, like + sliding.s, like + sliding.speed


def _point(scene: Scene, chunk: Chunk, name: str) -> PointKinematics:
    """A named point, by whichever body carries it."""
    bodies = scene.pins.get(name)
    if bodies is None:  # that of blocks alone
        slider = next(s for s in scene.sliders.values() if s.link is None and s.point == name)
        return chunk.point(block_name(slider), name)
    body = next((one for one in bodies if one != GROUND), GROUND)
    return chunk.point(body, name)
