"""The law of a driver in words."""

from __future__ import annotations

import math

from models.controlled import Controlled
from models.errors import CrankcheckError
from models.laws import Accelerating, ConstantSpeed, FromRest, Oscillating
from models.passing import passing
from models.released import Released
from models.scene import Scene
from reports.way.way import way_of


def describe_law(scene: Scene) -> str:
    """The driver's law in a few words."""
    law, slides = scene.driver.law, scene.driver.slider is not None
    unit = "m" if slides else "rad"

    def place(value: float) -> str:
        return f"{value:g}" if slides else f"{math.degrees(value):g}"

    where = "m" if slides else "deg"
    if isinstance(law, Controlled):
        return (
            f"controlled to {law.speed_rad_s:g} rad/s from {math.degrees(law.start_rad):g} deg, by "
            f"kP = {law.kp_n_m_rad:g} N m/rad and kD = {law.kd_n_m_s:g} N m s/rad"
        )
    if isinstance(law, ConstantSpeed):
        return f"{law.speed_rad_s:g} {unit}/s from {place(law.start_rad)} {where}"
    if isinstance(law, Accelerating):
        return (
            f"{law.speed_rad_s:g} {unit}/s and {law.acceleration_rad_s2:g} {unit}/s^2 from "
            f"{place(law.start_rad)} {where}"
        )
    if isinstance(law, FromRest):
        return f"from rest to {law.speed_rad_s:g} {unit}/s in {law.rise_s:g} s"
    if isinstance(law, Oscillating):
        centre, swing = place(law.centre_rad), place(abs(law.amplitude_rad))
        return f"swings {centre} +- {swing} {where} at {law.frequency_rad_s:g} rad/s"
    if isinstance(law, Released):
        speed = f"at {law.speed_rad_s:g} {unit}/s" if law.speed_rad_s else "at rest"
        return f"let go {speed} at {place(law.start_rad)} {where}, for {law.duration_s:g} s"
    return type(law).__name__


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
    latest = way_of(scene).latest_s(scene)
    if not 0.0 <= at_s <= latest:  # or no number
        raise CrankcheckError(
            f"--at-s {at_s:g}: {scene.name} moves from t = 0 on; give a time in seconds, such as "
            f"{0.25 * scene.driver.law.period_s:.3g}, up to {latest:.3g}"
        )
    return at_s


def place_at(scene: Scene, at_deg: float | None, at_m: float | None) -> float:
    """Where the driver was asked to stand: an angle [rad] that is given in degrees, or a slider's
    displacement [m]. Raises CrankcheckError for what is none, or not the driver's."""
    if at_deg is not None and at_m is not None:
        raise CrankcheckError("--at-deg and --at-m: the driver stands at one place; give one")
    slides = scene.driver.slider is not None
    if at_m is not None:
        if not slides:
            raise CrankcheckError(
                f"--at-m: the driver of {scene.name} is {scene.driver.joint}, which turns; give "
                "its angle by --at-deg"
            )
        if not math.isfinite(at_m):
            raise CrankcheckError(f"--at-m {at_m:g}: give a displacement in metres")
        return at_m
    assert at_deg is not None
    theta = angle_at(at_deg)
    if slides:
        raise CrankcheckError(
            f"--at-deg {at_deg:g}: the driver of {scene.name} is {scene.driver.joint}, which has "
            "no angle; give its displacement by --at-m"
        )
    return theta


def driver_at(
    scene: Scene, at_deg: float | None, at_m: float | None = None, *, clockwise: bool = False
) -> tuple[float, float, float]:
    """Place [rad or m], speed and acceleration as the driver's law moves it through an angle [deg]
    or a displacement [m]. Raises CrankcheckError for one that it never has."""
    place = place_at(scene, at_deg, at_m)
    asked = f"--at-deg {at_deg:g}" if at_m is None else f"--at-m {at_m:g}"
    if clockwise and at_m is not None:
        raise CrankcheckError(
            f"{asked} --clockwise: {scene.driver.joint} does not turn; leave it out"
        )
    try:
        speed, rate = passing(scene.driver.law, place, clockwise=clockwise, slides=at_m is not None)
    except ValueError as error:
        raise CrankcheckError(f"{asked}: the driver of {scene.name} {error}") from None
    return place, speed, rate
