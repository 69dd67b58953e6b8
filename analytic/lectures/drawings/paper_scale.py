"""Scales of a drawing: how much of a quantity a millimetre of paper stands for.

Source: lecture "Phan tich dong hoc": K is the real value over the length drawn in mm, and is taken
from 1, 2, 5 times a power of ten. The problem book takes the one that gives the vector of the
crank's pin a length of k times the drawn crank, p b = k AB.
"""

from __future__ import annotations

import math

STEPS = (1.0, 2.0, 5.0)
ROUNDING = 1e-9
"""By what a size may pass the room and fit still."""


def round_scale(size: float, room_mm: float) -> float:
    """The finest round scale [unit/mm] at which a size [unit] fits into a room [mm].

    Raises ValueError for a size or a room that is not above 0.
    """
    if not (0.0 < size < math.inf and 0.0 < room_mm < math.inf):
        raise ValueError(f"size {size!r} in {room_mm!r} mm: a scale needs both above 0")
    least = size / room_mm
    power = 10.0 ** math.floor(math.log10(least))
    tried = [step * power for step in (*STEPS, 10.0)]
    return next(scale for scale in tried if scale * (1.0 + ROUNDING) >= least)


def book_scales(length_scale: float, omega: float, k: float) -> tuple[float, float]:
    """The scales of velocities [m/s/mm] and accelerations [m/s^2/mm] of the problem book.

    With a scale of lengths [m/mm], a crank of constant ``omega`` [rad/s] and a wanted ``k``, the
    vectors of the crank's pin are k times as long as the crank is drawn.
    """
    rate = abs(omega)
    return rate * length_scale / k, rate * rate * length_scale / k
