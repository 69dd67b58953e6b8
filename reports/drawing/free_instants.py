"""At how many instants a free motion is drawn: more of one that is longer or quicker."""

from __future__ import annotations

import math

import numpy as np

from analytic.free.free_motion import FreeMotion

LEAST, MOST, IN_A_TURN, IN_A_SECOND = 121, 1201, 45, 60
"""Instants of the drawing: at least and at most, in a turn, and in a second."""


def instants(free: FreeMotion) -> int:
    """How many a free motion is drawn at."""
    turns = free.peak_speed_rad_s * free.until_s / math.tau
    wanted = max(IN_A_TURN * turns, IN_A_SECOND * free.until_s)
    return int(np.clip(wanted, LEAST, MOST))
