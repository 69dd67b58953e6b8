"""Rounding of sums of constant angles."""

from __future__ import annotations

import math

from analytic.dyads.plane import EPS


def rounding_of_angles(*angles: float) -> float:
    """Rounding of the direction of a sum of constant angles [rad]; 0 where all are.

    Within a turn they may come from degrees, which are rounded to radians; larger ones are as they
    were given. The sum may be small where they are large: what is lost is that of the large ones.
    """
    sizes = [abs(angle) for angle in angles if angle]
    if not sizes:
        return 0.0
    summed = sum(sizes) if len(sizes) > 1 else 0.0
    return EPS * (3.0 + sum(min(size, math.tau) for size in sizes) + summed)
