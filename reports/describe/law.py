"""The law of a driver in words."""

from __future__ import annotations

import math

from models.controlled import Controlled
from models.laws import Accelerating, ConstantSpeed, FromRest, Oscillating
from models.released import Released
from models.scene import Scene


def describe_law(scene: Scene) -> str:
    """The driver's law in a few words."""
    law = scene.driver.law
    if isinstance(law, Controlled):
        return (
            f"controlled to {law.speed_rad_s:g} rad/s from {math.degrees(law.start_rad):g} deg, by "
            f"kP = {law.kp_n_m_rad:g} N m/rad and kD = {law.kd_n_m_s:g} N m s/rad"
        )
    if isinstance(law, ConstantSpeed):
        return f"{law.speed_rad_s:g} rad/s from {math.degrees(law.start_rad):g} deg"
    if isinstance(law, Accelerating):
        return (
            f"{law.speed_rad_s:g} rad/s and {law.acceleration_rad_s2:g} rad/s^2 from "
            f"{math.degrees(law.start_rad):g} deg"
        )
    if isinstance(law, FromRest):
        return f"from rest to {law.speed_rad_s:g} rad/s in {law.rise_s:g} s"
    if isinstance(law, Oscillating):
        centre, swing = math.degrees(law.centre_rad), math.degrees(law.amplitude_rad)
        return f"swings {centre:g} +- {abs(swing):g} deg at {law.frequency_rad_s:g} rad/s"
    if isinstance(law, Released):
        speed = f"at {law.speed_rad_s:g} rad/s" if law.speed_rad_s else "at rest"
        return f"let go {speed} at {math.degrees(law.start_rad):g} deg, for {law.duration_s:g} s"
    return type(law).__name__
