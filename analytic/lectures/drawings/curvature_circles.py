"""The circles of a moving plane: where paths are straight, where speed keeps, and their poles.

With the velocity pole P, omega, alpha and the acceleration a_P of the body's point in P:

* the inflection circle (the first circle of Bresse), of points without normal acceleration, whose
  paths have an inflection: through P, with the diameter a_P / omega^2;
* the second circle of Bresse, of points without tangential acceleration: through P, with the
  diameter a_P turned by a quarter turn, over alpha;
* their other crossing is the acceleration pole.

Source: any text of planar kinematics, e.g. J. Uicker, G. Pennock, J. Shigley, Theory of Machines
and Mechanisms, chapter 4 (inflection circle, Bresse's circles); derived here from
a = a_P + alpha x r - omega^2 r.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from analytic.lectures.drawings.body_rates import BodyRates
from analytic.lectures.drawings.drawn_polygons import DrawnPolygons
from analytic.lectures.drawings.placed_mechanism import quarter_turn
from analytic.lectures.drawings.similarity import link_rates
from models.array import Array
from models.errors import CrankcheckError


@dataclass(frozen=True)
class Circle:
    """A circle through the velocity pole [m]: its middle (2,) and radius."""

    middle: Array
    radius: float


@dataclass(frozen=True)
class CurvatureCircles:
    """Velocity pole, inflection circle, second circle of Bresse (None where alpha is 0, it being a
    line), and acceleration pole of a body [m]."""

    pole: Array
    inflection: Circle
    still_speed: Circle | None
    acceleration_pole: Array


def velocity_pole(body: BodyRates) -> Array:
    """The point without velocity [m], (2,), of a body that turns."""
    return np.asarray(body.place + quarter_turn(body.velocity) / body.omega)


def curvature_circles(drawn: DrawnPolygons, link: str) -> CurvatureCircles:
    """The circles of a link that was drawn. Raises CrankcheckError where it does not turn, but for
    the rounding of the polygons."""
    omega, alpha = link_rates(drawn, link)
    if omega == 0.0:
        raise CrankcheckError(
            f"{link} does not turn at this instant: its pole is at infinity, and it has no "
            "inflection circle; take another angle, or another link"
        )
    body = replace(drawn.rates[link], alpha=alpha)
    pole = velocity_pole(body)
    at_pole = body.acceleration_at(pole)
    square = body.omega**2
    inflection = _through(pole, at_pole / square)
    still = _through(pole, quarter_turn(at_pole) / body.alpha) if body.alpha else None
    # a = a_P + alpha x r - omega^2 r = 0
    away = (square * at_pole + body.alpha * quarter_turn(at_pole)) / (square**2 + body.alpha**2)
    return CurvatureCircles(pole, inflection, still, np.asarray(pole + away))


def _through(pole: Array, diameter: Array) -> Circle:
    return Circle(np.asarray(pole + 0.5 * diameter), float(np.hypot(*diameter)) / 2)
