"""Centrodes: the way of the velocity pole of a link on the ground, and on the link itself.

The moving one rolls on the fixed one without sliding, which is how the link moves.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from models.array import Array
from models.errors import CrankcheckError
from models.motion import Motion

ROUNDING = 1e-12
"""An angular velocity that is less than so much of the fastest link's is none."""


@dataclass(frozen=True)
class Centrodes:
    """Both ways of the pole [m], (T, 2): on the ground, and in the frame of the link; NaN where the
    link does not turn."""

    fixed: Array
    moving: Array


def centrodes(motion: Motion, link: str, point: str) -> Centrodes:
    """The centrodes of a link over a motion, by one of its points.

    Raises CrankcheckError for a link that never turns.
    """
    body, at = motion.links[link], motion.points[point]
    # against the fastest link: one that is carried round turns by the rounding of its neighbours
    fastest = max(float(np.abs(other.omega).max()) for other in motion.links.values())
    turning = np.abs(body.omega) > ROUNDING * fastest
    if not turning.any():
        raise CrankcheckError(f"{link} never turns: it has no centrodes; take another link")
    omega = np.where(turning, body.omega, np.nan)[:, None]
    across = np.stack([-at.velocity[:, 1], at.velocity[:, 0]], axis=1)
    fixed = at.position + across / omega
    away = fixed - at.position
    c, s = np.cos(body.theta), np.sin(body.theta)
    moving = np.stack([c * away[:, 0] + s * away[:, 1], c * away[:, 1] - s * away[:, 0]], axis=1)
    return Centrodes(fixed, moving)
