"""Nearly straight part of a coupler curve, its line, and its deviation from that."""

import math
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from scipy.optimize import brentq, minimize_scalar  # type: ignore[import-untyped]  # ships no stubs

from analytic.lectures.synthesis.path.coupler_curve import CouplerCurve
from analytic.lectures.synthesis.path.unit_four_bar import Complexes
from models.array import Array
from models.errors import CrankcheckError

LOOKS = 2401
"""Crank angles at which a part is measured: between two of them the deviation changes by less than
a millionth of its own size."""
TRIALS, HALVINGS = 120, 30
STEP = math.radians(0.25)
"""Step of the crank's angle along its way."""
CLEAR = math.radians(2.0)
"""Distance from the crank's limit positions, where its speed is boundless."""


@dataclass(frozen=True)
class StraightPart:
    """Nearly straight part of a coupler curve, and the line that is nearest to it everywhere.

    ``crank_rad`` are the crank's angles at its ends [rad], ``start`` and ``along`` the line's first
    point [m] and its direction. ``length_m`` is its length along the line, ``deviation_m`` the
    largest distance of the curve from the line, to either side. ``uneven`` is the change of the
    speed along the line, over its mean, with a crank at constant speed.
    """

    crank_rad: tuple[float, float]
    start: complex
    along: complex
    length_m: float
    deviation_m: float
    uneven: float

    @property
    def share(self) -> float:
        """Share of a turn of the crank."""
        return abs(self.crank_rad[1] - self.crank_rad[0]) / math.tau

    def off(self, places: Complexes) -> Array:
        """Return the distance of places to the left of the line [m]."""
        return np.asarray(((places - self.start) * self.along.conjugate()).imag)


def measured(four_bar: CouplerCurve, low: float, high: float) -> StraightPart:
    """Measure the part between two angles of the crank [rad], and its line: that of the least
    largest distance (Chebyshev's)."""
    angles = np.linspace(low, high, LOOKS)
    places = four_bar.at(angles)
    chord = complex(places[-1] - places[0])
    own = (places - places[0]) * (abs(chord) / chord)
    slope = _slope(own)
    along = chord / abs(chord) * (1.0 + 1j * slope) / math.hypot(1.0, slope)
    turned = (places - places[0]) * along.conjugate()
    middle = 0.5 * (float(np.max(turned.imag)) + float(np.min(turned.imag)))
    speed = np.gradient(turned.real, angles, edge_order=2)
    length = float(turned.real[-1])
    return StraightPart(
        (low, high),
        complex(places[0]) + 1j * middle * along,
        along,
        length,
        0.5 * float(np.ptp(turned.imag)),
        float(np.ptp(speed)) * abs(high - low) / length,
    )


def _slope(own: Complexes) -> float:
    """Return the slope with the narrowest band along a chord: its width is a convex function."""
    steepest = 2.0 * float(np.ptp(own.imag) / np.ptp(own.real))
    if steepest < 1e-12:
        return 0.0
    result = minimize_scalar(
        lambda slope: np.ptp(own.imag - slope * own.real),
        bounds=(-steepest, steepest),
        method="bounded",
        options={"xatol": 1e-9 * steepest},
    )
    return float(result.x)


def longest(four_bar: CouplerCurve, centre_rad: float, deviation: float) -> StraightPart:
    """Find the longest part about a crank angle [rad] that deviates by a share of its length. Its
    ends are equally far from the place at its centre. Raises CrankcheckError where the shortest
    tried part deviates more."""
    angles, far = _both_ways(four_bar, centre_rad)
    ways = [(angle, np.maximum.accumulate(each)) for angle, each in zip(angles, far, strict=True)]
    reach = min(float(each[-1]) for _, each in ways)

    def part(half: float) -> StraightPart:
        low, high = (float(np.interp(half, each, angle)) for angle, each in ways)
        return measured(four_bar, low, high)

    # From the longest part down: the curve may leave the line and come back to it.
    good, bad = 0.0, reach
    for half in np.linspace(reach, 0.0, TRIALS, endpoint=False).tolist():
        one = part(half)
        if one.deviation_m <= deviation * one.length_m:
            good = half
            break
        bad = half
    if good == 0.0:
        raise CrankcheckError(
            f"a straight part with a deviation of {deviation:.3g} of its length was asked for; ask "
            "for more, or for another linkage"
        )
    for _ in range(HALVINGS):
        half = 0.5 * (good + bad)
        one = part(half)
        good, bad = (half, bad) if one.deviation_m <= deviation * one.length_m else (good, half)
    return part(good)


def _both_ways(four_bar: CouplerCurve, centre: float) -> tuple[tuple[Array, Array], list[Array]]:
    """Return the crank's angles from a centre down and up, as far as the curve leads away from it
    within half a turn, and its distances there [m]."""
    steps = np.arange(0.0, math.pi, STEP)
    angles, far = [], []
    for sense in (-1.0, 1.0):
        way = centre + sense * steps
        beyond = way[1:] + sense * CLEAR
        closes = [four_bar.leads_through(np.array([centre, at])) for at in beyond]
        count = 1 + (closes.index(False) if False in closes else len(closes))
        off = np.abs(four_bar.at(way[:count]) - four_bar.at(way[:1]))
        away = int(np.argmax(off)) + 1
        angles.append(way[:away])
        far.append(off[:away])
    return (angles[0], angles[1]), far


def on_line(four_bar: CouplerCurve, part: StraightPart) -> list[float]:
    """Return the angles of the crank [rad] at which the curve crosses the line of a part."""

    def off(angle: float) -> float:
        return float(part.off(four_bar.at(np.array([angle])))[0])

    angles = np.linspace(*part.crank_rad, LOOKS)
    sides = np.sign(part.off(four_bar.at(angles)))
    return [
        float(brentq(off, angles[i], angles[j], xtol=1e-15, rtol=1e-14))
        for i, j in pairwise(range(LOOKS))
        if sides[i] != sides[j] and sides[i] != 0.0
    ]
