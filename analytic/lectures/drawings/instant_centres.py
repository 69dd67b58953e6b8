"""Instant centres of a mechanism by the theorem of Aronhold and Kennedy.

Three bodies have their three centres on a line. Joints give the first centres: a pin is the centre
of its two bodies; that of a slider and its guide is at infinity, across the line. Each other centre
is where two lines cross, each through two centres that are known (the polygon of centres has the
bodies as its corners, known centres as sides, and a new one as the diagonal that closes two
triangles).

Centres and lines are homogeneous and of unit length, lengths over the longest link, so that
infinity (a direction, the line of all directions) needs no special case.

A link moves as its moving centrode rolls on the fixed one without sliding. With the velocity pole
P, omega, alpha and the acceleration a_P of the body's point in P:

* the inflection circle (the first circle of Bresse), of points without normal acceleration, whose
  paths have an inflection: through P, with the diameter a_P / omega^2;
* the second circle of Bresse, of points without tangential acceleration: through P, with the
  diameter a_P turned by a quarter turn, over alpha;
* their other crossing is the acceleration pole.

Source: any text of planar kinematics, e.g. J. Uicker, G. Pennock, J. Shigley, Theory of Machines
and Mechanisms, chapter 4 (inflection circle, Bresse's circles); derived here from
a = a_P + alpha x r - omega^2 r.
"""

import itertools
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace

import numpy as np

from analytic.lectures.drawings.drawn_polygons import DrawnPolygons, link_rates
from analytic.lectures.drawings.polygon import BodyRates, PlacedMechanism, quarter_turn
from models.array import Array
from models.errors import CrankcheckError
from models.motion import Motion
from models.scene import GROUND

Pair = frozenset[str]
SURE = 1e-7
"""Length of the product of two lines, of unit length each, below which they are one line."""
FAR = 1e-12
"""Third coordinate of a centre at infinity, up to rounding."""


@dataclass(frozen=True)
class Centre:
    """Instant centre: its ``place`` [m], (2,), or None where it is at infinity, across the unit
    vector ``along`` then, in which the two bodies slide against each other. ``by`` names the two
    pairs of centres whose lines cross in it, and is empty for a joint's."""

    place: Array | None
    along: Array | None = None
    by: tuple[tuple[Pair, Pair], ...] = ()


@dataclass(frozen=True)
class _KnownCentres:
    """Centre in homogeneous coordinates (3,)."""

    at: Array
    by: tuple[tuple[Pair, Pair], ...] = ()


def instant_centres(placement: PlacedMechanism) -> dict[Pair, Centre]:
    """Return the centres of all pairs of bodies that the theorem leads to, the joints' first."""
    size = placement.scene.longest_m
    found = _of_joints(placement, size)
    bodies = [GROUND, *placement.structure.bodies]
    while new := _crossings(bodies, found):
        found |= new
    return {pair: _centre(known, size) for pair, known in found.items()}


def _centre(known: _KnownCentres, size: float) -> Centre:
    x, y, w = known.at
    if abs(w) < FAR:
        return Centre(None, -quarter_turn(np.array([x, y])), known.by)
    return Centre(size * np.array([x, y]) / w, None, known.by)


def _of_joints(placement: PlacedMechanism, size: float) -> dict[Pair, _KnownCentres]:
    found: dict[Pair, _KnownCentres] = {}
    for point, bodies in placement.structure.pins.items():
        at = _KnownCentres(_unit(np.array([*placement.points[point] / size, 1.0])))
        found |= {frozenset(pair): at for pair in itertools.combinations(bodies, 2)}
    for slider, ends in placement.structure.prismatics.items():
        across = quarter_turn(placement.along(slider))
        found[frozenset(ends)] = _KnownCentres(np.array([*across, 0.0]))
    return found


def _crossings(bodies: list[str], found: Mapping[Pair, _KnownCentres]) -> dict[Pair, _KnownCentres]:
    """Return the centres that follow at once, each by the two lines that cross best."""
    new: dict[Pair, _KnownCentres] = {}
    for pair in map(frozenset, itertools.combinations(bodies, 2)):
        if pair in found:
            continue
        lines = list(_lines(pair, bodies, found))
        crossed = [
            (np.cross(one, other), (a, b))
            for (a, one), (b, other) in itertools.combinations(lines, 2)
        ]
        at, by = max(crossed, key=lambda each: _length(each[0]), default=(np.zeros(3), ()))
        if _length(at) > SURE:
            new[pair] = _KnownCentres(_unit(at), by)
    return new


def _lines(
    pair: Pair, bodies: list[str], found: Mapping[Pair, _KnownCentres]
) -> Iterator[tuple[tuple[Pair, Pair], Array]]:
    """Yield the lines that the centre of a pair is on, one for each third body that both have a
    centre with, except coincident ones."""
    one, other = sorted(pair)
    for third in bodies:
        sides = frozenset({one, third}), frozenset({other, third})
        if third in pair or not all(side in found for side in sides):
            continue
        line = np.cross(found[sides[0]].at, found[sides[1]].at)
        if _length(line) > SURE:
            yield sides, _unit(line)


def _length(vector: Array) -> float:
    return float(np.linalg.norm(vector))


def _unit(vector: Array) -> Array:
    return np.asarray(vector / np.linalg.norm(vector))


ROUNDING = 1e-12
"""Angular velocity over that of the fastest link, below which it is none."""


@dataclass(frozen=True)
class Centrodes:
    """Both ways of the pole [m], (T, 2): on the ground, and in the frame of the link; NaN where the
    link does not turn."""

    fixed: Array
    moving: Array


def centrodes(motion: Motion, link: str, point: str) -> Centrodes:
    """Return the centrodes of a link over a motion, by one of its points. Raises CrankcheckError
    for a link that never turns."""
    body, at = motion.links[link], motion.points[point]
    # Against the fastest link: a link without rotation turns by the rounding of its neighbours.
    fastest = max(float(np.abs(other.omega).max()) for other in motion.links.values())
    turning = np.abs(body.omega) > ROUNDING * fastest
    if not turning.any():
        raise CrankcheckError(f"{link} never turns: it has no centrodes; take another link")
    omega = np.where(turning, body.omega, np.nan)[:, None]
    across = np.stack([-at.velocity[:, 1], at.velocity[:, 0]], axis=1)
    fixed = at.position + across / omega
    away = fixed - at.position
    c, s = np.cos(body.theta), np.sin(body.theta)
    moving = np.stack([c * away[:, 0] + s * away[:, 1], c * away[:, 1] - s * away[:, 0]], axis=1)
    return Centrodes(fixed, moving)


@dataclass(frozen=True)
class CentreCircle:
    """Circle through the velocity pole [m]: its middle (2,) and radius."""

    middle: Array
    radius: float


@dataclass(frozen=True)
class CurvatureCircles:
    """Velocity pole, inflection circle, second circle of Bresse (None where alpha is 0, as it is a
    line), and acceleration pole of a body [m]."""

    pole: Array
    inflection: CentreCircle
    still_speed: CentreCircle | None
    acceleration_pole: Array


def velocity_pole(body: BodyRates) -> Array:
    """Return the point without velocity [m], (2,), of a body that turns."""
    return np.asarray(body.place + quarter_turn(body.velocity) / body.omega)


def curvature_circles(drawn: DrawnPolygons, link: str) -> CurvatureCircles:
    """Return the circles of a drawn link. Raises CrankcheckError where it does not turn, but for
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


def _through(pole: Array, diameter: Array) -> CentreCircle:
    return CentreCircle(np.asarray(pole + 0.5 * diameter), float(np.hypot(*diameter)) / 2)
