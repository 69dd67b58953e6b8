"""A four-bar that knows nothing of crankcheck, and how it moves.

The numbers are those of the lecture's first example (crank 0.1, coupler 0.25, rocker 0.2, ground
0.3 m, rods of 1 kg/m, crank from 90 deg); the angles to be found follow from the law of cosines.
"""

from __future__ import annotations

import math

import numpy as np

from models.array import Array

CRANK, COUPLER, ROCKER, GROUND = 0.1, 0.25, 0.2, 0.3
START = math.pi / 2
TURNS = 2


def angles(crank: Array) -> tuple[Array, Array]:
    """Angles of coupler and rocker [rad] at angles of the crank; the open assembly."""
    bx, by = CRANK * np.cos(crank), CRANK * np.sin(crank)
    diagonal = np.hypot(bx - GROUND, by)
    at_d = np.arccos((diagonal**2 + ROCKER**2 - COUPLER**2) / (2 * diagonal * ROCKER))
    rocker = np.unwrap(np.arctan2(by, bx - GROUND)) - at_d
    cx, cy = GROUND + ROCKER * np.cos(rocker), ROCKER * np.sin(rocker)
    return np.unwrap(np.arctan2(cy - by, cx - bx)), rocker


def rates(crank: float, speed: float) -> tuple[float, float]:
    """Angular velocities of coupler and rocker [rad/s], from the law of sines of the velocities."""
    coupler, rocker = (float(each[0]) for each in angles(np.array([crank])))
    across = math.sin(rocker - coupler)
    return (
        speed * CRANK / COUPLER * math.sin(crank - rocker) / across,
        speed * CRANK / ROCKER * math.sin(crank - coupler) / across,
    )


def worst(found: tuple[Array, ...], exact: tuple[Array, ...]) -> float:
    """The largest difference."""
    return max(float(np.abs(a - b).max()) for a, b in zip(found, exact, strict=True))
