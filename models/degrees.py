"""Angles of a file, in degrees, as the numbers that are reckoned with."""

from __future__ import annotations

import math


def within_a_turn(degrees: float) -> float:
    """An angle that counts but for whole turns, in radians: without them it loses no digits."""
    return math.radians(math.fmod(degrees, 360.0))
