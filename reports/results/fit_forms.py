"""The possible forms of an error, and the number of points of a line that each goes through."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from models.array import Array
from reports.results.floor_fit import ORDERS, ErrorCurve, added, curvature, opposed, straight

LEAST_SCATTER = 0.02
"""Least scatter: the largest error of a run is not known better, as samples miss its peak."""
UNKNOWN_SCATTER = 0.05
"""Scatter, as a share of the error, of a curve that goes through any points."""
WILD = 0.25
"""Scatter beyond which points lie on no curve."""
CLEARLY = 3.0
"""Factor of the scatter by which a curve must be better than one with fewer parameters."""
OFF = (10.0, 7.0, 4.5, 3.7, 3.4, 3.1, 3.0)
"""Distance of a point, over the scatter of the others, at which it is left out, by their degrees of
freedom from 1: Student's t for one in fifty (32 for the first, which would see nothing)."""
BEYOND_DOUBT = 2.0
"""Factor of that distance at which the finest point is off where the line of the others ends."""
FLAT = 0.3
"""Slope below which there is none."""
LOWEST, LEVEL = 1.0, 0.75
"""Lowest order of an integrator, and a slope at the finest step that is clearly less."""
LEAST_REST, MOST_REST = 0.5, 2.0
"""Bounds of a seen floor over the finest error; a floor of more than twice that is a guess."""


@dataclass(frozen=True)
class Form:
    """A form with its least number of points."""

    fit: Callable[[Array, Array], ErrorCurve | None]
    least: int


POWER = Form(straight, 3)
FLOOR = Form(added, 3)
OPPOSED = Form(opposed, 5)


def scatter(curve: ErrorCurve) -> float:
    """Return the scatter of the points of a curve, at least the unavoidable one."""
    return max(curve.scatter, LEAST_SCATTER if curve.freedom else UNKNOWN_SCATTER)


def uncertainty(curve: ErrorCurve) -> float:
    """Return the root of the increase of a misfit for an uncertainty that holds 68.3 %.

    Scatter times Student's t (Cornish-Fisher series; 1 % low at one degree of freedom).
    """
    per = 1.0 / max(curve.freedom, 1)
    return scatter(curve) * (1.0 + per / 2.0 + per**2 / 4.0 + per**3 / 16.0)


def longest(form: Form, dts: Array, errors: Array) -> ErrorCurve | None:
    """Fit a form to as many points as lie on one curve, the coarsest left out one after another.

    Points are finest first, at three different steps or more. None where no curve exists.
    """
    least = max(form.least, int(np.searchsorted(dts, np.unique(dts)[2], side="right")))
    best = form.fit(dts, errors) if len(dts) >= least else None
    for number in range(len(dts) - 1, least - 1, -1):
        others = form.fit(dts[:number], errors[:number])
        if best is not None and not (
            best.scatter > WILD
            or (others is not None and best.misfit - others.misfit > _off(others))
            or (form is POWER and _curved(dts[: number + 1], errors[: number + 1]))
        ):
            return best
        best = others
    return best


def _off(others: ErrorCurve) -> float:
    """Return the increase of the misfit by a point that is off the curve of the others."""
    return (_times(others.freedom) * scatter(others)) ** 2


def _times(freedom: int) -> float:
    return OFF[min(max(freedom, 1), len(OFF)) - 1]


def _curved(dts: Array, errors: Array) -> bool:
    """True if points on a straight line would be better on a parabola: the order changes."""
    line, parabola = curvature(dts, errors)
    freedom = len(dts) - 3
    spread = max(parabola / max(freedom, 1), LEAST_SCATTER**2)
    return bool(freedom > 0 and line - parabola > _times(freedom) ** 2 * spread)


def slower(than: float, dts: Array, errors: Array) -> bool:
    """True if the error falls with less than an order between the two finest steps."""
    last = dts <= np.unique(dts)[1]
    return abs(straight(dts[last], errors[last]).order) < than


def floor_seen(curve: ErrorCurve, dts: Array, errors: Array) -> bool:
    """True if the points of a curve show its floor: it is most of the finest error, it hardly
    falls any more, and no power of dt alone goes through the same points."""
    if not LEAST_REST <= curve.rest <= MOST_REST or abs(curve.slope) > LEVEL:
        return False
    if curve.scatter > WILD or (curve.freedom == 0 and curve.order >= ORDERS[-1]):
        return False  # scattered, or a floor through two points and a third that is just higher
    line = straight(dts[: curve.points], errors[: curve.points])
    return abs(line.order) < FLAT or better(curve, line)


def opposed_seen(dts: Array, errors: Array) -> ErrorCurve | None:
    """Return a floor that works against the step, through as many points as show it, or None."""
    if not slower(LEVEL, dts, errors):
        return None
    for number in range(len(dts), OPPOSED.least - 1, -1):
        points = dts[:number], errors[:number]
        curve, bend = OPPOSED.fit(*points), FLOOR.fit(*points)
        if curve is None or bend is None or curve.alignment >= 0.0:
            continue
        if better(curve, bend) and floor_seen(curve, dts, errors):
            return curve
    return None


def better(curve: ErrorCurve, than: ErrorCurve) -> bool:
    """True if a curve is clearly better than one with fewer parameters, through the same points."""
    return than.misfit - curve.misfit > (CLEARLY * scatter(curve)) ** 2


def leaves(dts: Array, errors: Array) -> bool:
    """True if the finest point leaves the straight line of the others (five points or more)."""
    if len(dts) < 5:
        return False
    line, rest = straight(dts, errors), straight(dts[1:], errors[1:])
    return line.misfit - rest.misfit > BEYOND_DOUBT**2 * _off(rest)
