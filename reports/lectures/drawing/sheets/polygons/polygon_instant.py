"""The instant that polygons are drawn of: by the angle of the driver, or by the time."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from analytic.lectures.drawings.placed_mechanism import DriverState, PlacedMechanism
from models.errors import CrankcheckError, few
from models.laws import Oscillating
from models.motion import Motion
from models.scene import Scene
from reports.compare.free.kept_motion import LOOK, kept_motion
from reports.describe.facts import angle_at, driver_at, time_at
from reports.drawing.shape import true_motion

AT_DEG = 90.0
"""The angle where nothing is said."""
LARGEST = 1e9
"""A speed [rad/s] that a user names is no more than this, and no less than one over it."""
MOST_PERIODS = 10.0
"""So many of its own durations what is let go is followed for: that takes seconds."""
REST = 1e-12
"""A speed [rad/s] that is less than so much of the root of the acceleration is rounding."""


def placed_at_angle(
    scene: Scene, at_deg: float = AT_DEG, omega: float | None = None
) -> PlacedMechanism:
    """The mechanism with its driver at an angle [deg], with the speed of its law there, or with
    ``omega`` [rad/s], which is constant.

    Raises CrankcheckError for an angle that it never has, and for a driver that is let go without a
    speed.
    """
    if omega is not None:
        if not 1 / LARGEST <= abs(omega) <= LARGEST:  # or no number
            raise CrankcheckError(
                f"--omega {omega:g}: give a speed other than 0 in rad/s, from {1 / LARGEST:g} to "
                f"{LARGEST:g} either way; at rest there is nothing to draw"
            )
        return PlacedMechanism.of(scene, DriverState(angle_at(at_deg), omega))
    if scene.is_free:
        raise CrankcheckError(
            f"{scene.name}: its driver is let go, and no law says how fast it is at {at_deg:g} "
            "deg; give --at-s for an instant of its motion, or --omega"
        )
    return PlacedMechanism.of(scene, DriverState(*driver_at(scene, at_deg)))


def placed_at_time(scene: Scene, at_s: float) -> PlacedMechanism:
    """The mechanism as it stands and moves at a time [s], by its driver's law, or let go as masses
    and forces have it. Raises CrankcheckError for a time at which it does not move."""
    motion = _motion_at(scene, time_at(scene, at_s))
    placed = PlacedMechanism.standing(scene, motion)
    driver = placed.driver
    if abs(driver.omega) < REST * math.sqrt(abs(driver.alpha)):  # it is let go from rest
        placed = replace(placed, driver=replace(driver, omega=0.0))
    if not (placed.driver.omega or placed.driver.alpha):
        turns = "swings" if isinstance(scene.driver.law, Oscillating) else "moves"
        raise CrankcheckError(
            f"--at-s {at_s:g}: {scene.driver.link} of {scene.name} is at rest there, and there is "
            f"nothing to draw; give a time at which it {turns}"
        )
    return placed


def _motion_at(scene: Scene, time_s: float) -> Motion:
    """The motion at one instant [s]; what is let go is integrated over a part of its time at least,
    as it begins at 0."""
    if not scene.is_free:
        return true_motion(scene, np.array([time_s]))
    if scene.elastic:
        raise CrankcheckError(
            f"{scene.name}: {few(scene.elastic, 4)} bends or stretches and is let go, and polygons "
            "are those of rigid links; take [elastic] out of the scene, or name an --omega, with "
            "which links are drawn as rigid"
        )
    own_s = scene.driver.law.period_s
    if time_s > MOST_PERIODS * own_s:
        raise CrankcheckError(
            f"--at-s {time_s:g}: {scene.name} is let go, and its motion from t = 0 to there takes "
            f"too long to find; give a time up to {MOST_PERIODS * own_s:.6g} s, {MOST_PERIODS:g} "
            "times its own duration"
        )
    lasts_s = max(time_s, LOOK * own_s)
    return kept_motion(scene, lasts_s).at(np.array([time_s]), bound=False)
