"""The units of logs: what one of each is in SI, by what is measured."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Literal

Dimension = Literal[
    "time",
    "angle",
    "angular velocity",
    "angular acceleration",
    "length",
    "velocity",
    "acceleration",
]
DEG, REV, INCH = math.pi / 180.0, math.tau, 0.0254
UNITS: Mapping[Dimension, Mapping[str, float]] = {
    "time": {"s": 1.0, "ms": 1e-3, "us": 1e-6, "ns": 1e-9, "min": 60.0},
    "angle": {"rad": 1.0, "deg": DEG, "mrad": 1e-3, "rev": REV},
    "angular velocity": {"rad/s": 1.0, "deg/s": DEG, "rpm": REV / 60.0, "rev/s": REV},
    "angular acceleration": {"rad/s^2": 1.0, "deg/s^2": DEG, "rev/s^2": REV},
    "length": {"m": 1.0, "mm": 1e-3, "cm": 1e-2, "um": 1e-6, "in": INCH, "ft": 12 * INCH},
    "velocity": {"m/s": 1.0, "mm/s": 1e-3, "cm/s": 1e-2, "in/s": INCH, "ft/s": 12 * INCH},
    "acceleration": {
        "m/s^2": 1.0,
        "mm/s^2": 1e-3,
        "cm/s^2": 1e-2,
        "in/s^2": INCH,
        "ft/s^2": 12 * INCH,
    },
}
"""By dimension: each unit in SI, the SI unit first."""


def si(dimension: Dimension) -> str:
    """The SI unit of a dimension."""
    return next(iter(UNITS[dimension]))
