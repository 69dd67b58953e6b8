"""The state of a scene's driver at an angle that a user named."""

from __future__ import annotations

import math

from models.errors import CrankcheckError
from models.laws import MOST_TURNS
from models.passing import passing
from models.released import LONGEST_S
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


def time_at(scene: Scene, at_s: float) -> float:
    """A time that a user named [s]. Raises CrankcheckError for what is none, or of no motion."""
    latest = LONGEST_S if scene.is_free else MOST_TURNS * scene.driver.law.period_s
    if not 0.0 <= at_s <= latest:  # or no number
        raise CrankcheckError(
            f"--at-s {at_s:g}: {scene.name} moves from t = 0 on; give a time in seconds, such as "
            f"{0.25 * scene.driver.law.period_s:.3g}, up to {latest:.3g}"
        )
    return at_s


def driver_at(
    scene: Scene, at_deg: float, *, clockwise: bool = False
) -> tuple[float, float, float]:
    """Angle [rad], angular velocity [rad/s] and acceleration [rad/s^2] as the driver's law moves it
    through an angle [deg]. Raises CrankcheckError for an angle that it never has."""
    theta = angle_at(at_deg)
    if scene.driver.slider is not None:
        raise CrankcheckError(
            f"--at-deg {at_deg:g}: the driver of {scene.name} is {scene.driver.joint}, which has a "
            "place and no angle; ask for its motion"
        )
    try:
        omega, alpha = passing(scene.driver.law, theta, clockwise=clockwise)
    except ValueError as error:
        raise CrankcheckError(f"--at-deg {at_deg:g}: the driver of {scene.name} {error}") from None
    return theta, omega, alpha
