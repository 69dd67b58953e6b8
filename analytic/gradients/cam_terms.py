"""Linearised equation of the follower of a cam: its coordinate by the law of motion.

::

    coordinate = lowest + lift(angle of the cam against the carrier)

The follower keeps its law: the lowest coordinate follows from the base circle, the centres, the
arm and the line as in the scene (`models.scene.pairs.CamPair.lowest`), and the profile with them.
"""

from __future__ import annotations

import math

import numpy as np

from analytic.dyads.plane import EPS
from analytic.gradients.forms import DerivativeForm, Places
from analytic.gradients.varying import Varying
from analytic.higher_pairs.follower_step import lift_at, lift_errors
from models.scene.cams import OscillatingFollower, TranslatingFollower
from models.scene.joints import local_point
from models.scene.pairs import CamPair

LOOSE = 64 * EPS
"""Rounding of a derivative of the lowest coordinate, over its terms."""


def follower_form(places: Places, pair: CamPair) -> DerivativeForm:
    """Return the derivative of the follower's coordinate, less those of its law: it is 0."""
    turned = places.angle(pair.cam) - places.angle(pair.carrier)
    if pair.slider:
        moved = places.ride(places.scene.sliders[pair.slider])
    else:
        moved = places.angle(pair.follower) - places.angle(pair.carrier)
    return moved - turned.times(_slope(places, pair)) - DerivativeForm(by=_lowest(places, pair))


def _slope(places: Places, pair: CamPair) -> Varying:
    """Return the derivative of the lift by the angle of the cam against the carrier, in time."""
    chunk = places.chunk
    cam, carrier = chunk.bodies[pair.cam], chunk.bodies[pair.carrier]
    lift = lift_at(pair, cam, carrier)
    omega, alpha = cam.omega - carrier.omega, cam.alpha - carrier.alpha
    second = lift.third * omega**2 + lift.second * alpha
    levels = (lift.first, lift.second * omega, second)
    if cam.error is None or carrier.error is None:
        return Varying.of(levels, (0.0, 0.0, 0.0), chunk.theta)
    e = lift_errors(pair, cam, carrier, 4)
    rate, gain = cam.error.omega + carrier.error.omega, cam.error.alpha + carrier.error.alpha
    rate, gain = rate + 2 * EPS * np.abs(omega), gain + 2 * EPS * np.abs(alpha)
    w, a = np.abs(omega), np.abs(alpha)
    bend, jerk = np.abs(lift.second) + e[2], np.abs(lift.third) + e[3]
    errors = (
        e[1],
        e[2] * w + bend * rate,
        e[3] * w**2 + jerk * rate * (2.0 * w + rate) + e[2] * a + bend * gain,
    )
    return Varying.of(levels, errors, chunk.theta)


def _lowest(places: Places, pair: CamPair) -> dict[int, Varying]:
    """Return the derivative of the coordinate at lift 0 by each dimension."""
    points, carrier = places.scene.points_of, pair.carrier
    centre, pivot = pair.pivots(points)
    follower, start = pair.profile.follower, pair.profile.start
    middle = places.shifts("point", carrier, centre)
    base = places.shifts("base", pair.name)
    total: dict[int, complex] = {}

    def add(shifts: dict[int, complex], factor: complex) -> None:
        """Add the real part of shifts times a factor."""
        for number, shift in shifts.items():
            total[number] = total.get(number, 0.0) + (shift * factor).real

    if isinstance(follower, TranslatingFollower):
        # The foot of the centre on the line; the start is the third side over the offset.
        slider = places.scene.sliders[pair.slider]
        line = np.exp(1j * slider.direction_rad)
        away = (complex(*points[carrier][centre]) - complex(*slider.through_m)) * line.conjugate()
        offset = 0.0 if follower.is_flat else away.imag / start
        along = line.conjugate() * (1.0 + 1j * offset)  # Re - offset Im
        add(middle, along)
        add(places.shifts("through", slider.name), -along)
        add(places.shifts("direction", slider.name), away.imag + offset * away.real)
        reach = start if follower.is_flat else pair.profile.base_m + follower.roller_m
        add(base, reach / start)
    else:
        assert isinstance(follower, OscillatingFollower)
        ends = (local_point(places.scene, pair.follower, name) for name in (pivot, pair.tip))
        hinge, tip = (complex(*end) for end in ends)
        seat = complex(*points[carrier][pivot])
        across, arm = complex(*points[carrier][centre]) - seat, tip - hinge
        d, a, sine, cosine = abs(across), abs(arm), math.sin(start), math.cos(start)
        if follower.is_flat:
            by_d, by_a, by_base = -sine / cosine / d, 0.0, 1.0 / (d * cosine)
        else:  # the law of cosines for the triangle of pivot, centre and roller
            height = d * a * sine
            by_d, by_a = -(d - a * cosine) / height, -(a - d * cosine) / height
            by_base = (pair.profile.base_m + follower.roller_m) / height
        towards = -1j / across - pair.side * by_d * across.conjugate() / d
        add(middle, towards)
        add(places.shifts("point", carrier, pivot), -towards)
        swing = 1j / arm - pair.side * by_a * arm.conjugate() / a
        add(places.shifts("point", pair.follower, pair.tip), swing)
        add(places.shifts("point", pair.follower, pivot), -swing)
        add(base, -pair.side * by_base)
    return {n: Varying.constant(value, LOOSE * abs(value)) for n, value in total.items()}
