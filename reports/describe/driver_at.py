"""The state of a scene's driver at an angle that a user named."""

from __future__ import annotations

import math

from models.errors import CrankcheckError
from models.passing import passing
from models.scene import Scene

MOST_DEG = 1e6
"""Beyond this too few digits of the angle within a turn are left."""


def angle_at(at_deg: float) -> float:
    """An angle that a user named [rad]. Raises CrankcheckError for what is none."""
    if not abs(at_deg) <= MOST_DEG:
        raise CrankcheckError(
            f"--at-deg {at_deg:g}: give an angle in degrees, such as 90, up to {MOST_DEG:g}"
        )
    return math.radians(at_deg)


def driver_at(
    scene: Scene, at_deg: float, *, clockwise: bool = False
) -> tuple[float, float, float]:
    """Angle [rad], angular velocity [rad/s] and acceleration [rad/s^2] as the driver's law moves it
    through an angle [deg]. Raises CrankcheckError for an angle that it never has."""
    theta = angle_at(at_deg)
    try:
        omega, alpha = passing(scene.driver.law, theta, clockwise=clockwise)
    except ValueError as error:
        raise CrankcheckError(f"--at-deg {at_deg:g}: the driver of {scene.name} {error}") from None
    return theta, omega, alpha
