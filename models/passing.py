"""How a law of motion takes its driver through an angle: with which speed and acceleration."""

from __future__ import annotations

import math

from models.laws import Accelerating, ConstantSpeed, FromRest, Law, Oscillating

ROUNDING = 1e-12
"""Of a square: an angle in degrees that is rounded is still the end of a swing."""


def passing(
    law: Law, theta_rad: float, *, clockwise: bool = False, slides: bool = False
) -> tuple[float, float]:
    """Angular velocity [rad/s] and acceleration [rad/s^2] of the driver at an angle; where it
    ``slides``, speed [m/s] and acceleration [m/s^2] at a displacement [m].

    A start from rest is taken after its rise. Where the law passes an angle both ways, an
    oscillating one is taken counter-clockwise and an accelerating one for the first time;
    ``clockwise`` takes the way of falling angle. A driver of one speed is then turned round.

    Raises
    ------
    ValueError
        The law does not come to that angle, or not that way; the message names what would do.
    """
    if isinstance(law, Oscillating):
        return _swinging(law, theta_rad, clockwise=clockwise, slides=slides)
    if isinstance(law, Accelerating):
        return _accelerating(law, theta_rad, clockwise=clockwise, slides=slides)
    if isinstance(law, ConstantSpeed | FromRest):
        return -abs(law.speed_rad_s) if clockwise else law.speed_rad_s, 0.0
    raise ValueError("has a law without a speed at an angle; give --turns")


def _swinging(
    law: Oscillating, theta: float, *, clockwise: bool, slides: bool
) -> tuple[float, float]:
    swing = theta - law.centre_rad
    rest = law.amplitude_rad**2 - swing**2
    if rest < -ROUNDING * law.amplitude_rad**2:
        low, high = sorted(law.centre_rad + s * law.amplitude_rad for s in (-1.0, 1.0))
        if slides:
            raise ValueError(f"goes from {low:.6g} to {high:.6g} m; give a place between")
        low, high = math.degrees(low), math.degrees(high)
        raise ValueError(f"swings from {low:.6g} to {high:.6g} deg; give an angle between")
    frequency = abs(law.frequency_rad_s)
    omega = frequency * math.sqrt(max(rest, 0.0))
    return -omega if clockwise else omega, -(frequency**2) * swing


def _accelerating(
    law: Accelerating, theta: float, *, clockwise: bool, slides: bool
) -> tuple[float, float]:
    """From omega^2 = speed^2 + 2 alpha (theta - start), at a time that is not before 0."""
    start, alpha, turned = law.speed_rad_s, law.acceleration_rad_s2, theta - law.start_rad
    square = start**2 + 2.0 * alpha * turned
    size = math.sqrt(max(square, 0.0)) if turned else abs(start)
    times = {omega: (omega - start) / alpha for omega in (size, -size)}
    rounded = -ROUNDING * (start**2 + 2.0 * abs(alpha * turned))
    comes = [w for w, time_s in times.items() if square >= rounded and time_s >= 0.0]
    down = [w for w in comes if w < 0.0]
    if not comes and slides:
        raise ValueError(f"never comes there from {law.start_rad:g} m on")
    if not comes:
        way = math.copysign(math.tau, alpha)
        same = theta + way * math.ceil(-turned / way)
        raise ValueError(
            f"never comes there; it comes to the same driver angle at {math.degrees(same):.6g} deg"
        )
    if clockwise and not down:
        raise ValueError("does not turn clockwise there; leave out --clockwise")
    return min(down if clockwise else comes, key=times.__getitem__), alpha
