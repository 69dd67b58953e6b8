"""What of forces is drawn where friction locks a mechanism in part of its turn."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from models.array import Array
from models.motion import Forces

BESIDE = 5.0 / 360.0
"""The part of a turn on either side of a locked range that is not drawn."""


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
