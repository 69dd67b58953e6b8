"""The law of a driver in words."""

from __future__ import annotations

import math

from models.driver import Controlled, Released
from models.laws import Accelerating, ConstantSpeed, FromRest, Oscillating
from models.scene import Scene


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
