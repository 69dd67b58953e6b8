"""The similarity theorem: the image of a link is similar to the link, and turned.

The image of a link's points is the link itself times one complex number: i omega of velocities,
i alpha - omega^2 of accelerations. Where that is 0, the image is one point. Source: lecture "Phan
tich dong hoc", part III.
"""

from __future__ import annotations

import cmath
from dataclasses import dataclass

import numpy as np

from analytic.lectures.drawings.body_rates import BodyRates
from analytic.lectures.drawings.drawn_polygons import DrawnPolygons
from analytic.lectures.drawings.polygon import Quantity

POINT = 1e-12
"""An image that is smaller than so much of the largest vector is one point: what is left of it is
the rounding of the crossing."""


@dataclass(frozen=True)
class Similarity:
    """How the image of a link comes from the link: ``scale`` [1/s or 1/s^2], turned by ``turn_rad``
    counter-clockwise; of a link that moves without turning the scale is 0, and the image a point.
    """

    scale: float
    turn_rad: float

    @property
    def is_point(self) -> bool:
        return self.scale == 0.0


def similarity(drawn: DrawnPolygons, link: str, quantity: Quantity) -> Similarity:
    """That of a link that was drawn, of its velocities or accelerations."""
    factor = _factor(drawn.rates[link], quantity)
    if _is_rounding(drawn, link, quantity, abs(factor)):
        return Similarity(0.0, 0.0)
    return Similarity(abs(factor), cmath.phase(factor))


def link_rates(drawn: DrawnPolygons, link: str) -> tuple[float, float]:
    """omega [rad/s] and alpha [rad/s^2] of a link that was drawn, 0 where no more than rounding is
    left of them."""
    body = drawn.rates[link]
    rates: tuple[tuple[float, Quantity], ...] = (
        (body.omega, "velocity"),
        (body.alpha, "acceleration"),
    )
    omega, alpha = (
        0.0 if _is_rounding(drawn, link, quantity, abs(rate)) else rate for rate, quantity in rates
    )
    return omega, alpha


def _is_rounding(drawn: DrawnPolygons, link: str, quantity: Quantity, scale: float) -> bool:
    """Whether an image of the link at a scale [1/s or 1/s^2] is as small as the rounding."""
    polygon = drawn.velocity if quantity == "velocity" else drawn.acceleration
    places = np.array([*drawn.placement.scene.links[link].points.values()])
    reach = float(np.hypot(*np.ptp(places, axis=0)))
    return scale * reach <= POINT * polygon.largest


def _factor(body: BodyRates, quantity: Quantity) -> complex:
    """What the link is multiplied by, x + iy being its places."""
    if quantity == "velocity":
        return 1j * body.omega
    return 1j * body.alpha - body.omega**2
