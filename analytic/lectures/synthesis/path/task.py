r"""Task of path generation: the points of a path; and the four-bar of ground length 1::

              B
         b  /  \            O2 = 0, O4 = 1, A = a exp(i phi), B = A + b u, |B - O4| = c
        A         \ c
     a /            \       u(phi), the direction of the coupler, is to the left of A-O4
    O2 ------------- O4

A coupler point of any four-bar of this shape, of any size and place, is at

    P = O + G a exp(i phi) + Q u(phi)

with three complex numbers O (the fixed pivot), G (the ground, from O2 to O4) and Q (place in the
coupler), in which it is linear. The other assembly is the mirror image of this one.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from models.array import Array
from models.errors import CrankcheckError

Complexes = NDArray[np.complex128]
Family = Literal["crank-rocker", "double-crank", "limited"]
"""Families: the crank turns fully, shorter than the ground or longer; or has limits."""
FULL: tuple[Family, ...] = ("crank-rocker", "double-crank")

BOUNDS: dict[Family, tuple[tuple[float, float], ...]] = {
    "crank-rocker": (
        (math.log(0.04), math.log(0.97)),
        (math.log(1.01), math.log(8.0)),
        (-0.98, 0.98),
    ),
    "double-crank": (
        (math.log(1.03), math.log(25.0)),
        (math.log(1.01), math.log(8.0)),
        (-0.98, 0.98),
    ),
    "limited": ((math.log(0.08), math.log(12.0)),) * 3,
}
"""Bounds of the three numbers of a shape: see `lengths`."""
DEAD = 1e-6
"""Least sine of the angle at A for a derivative: at a limit it is infinite."""


@dataclass(frozen=True)
class Turn:
    """Coupler's direction at crank angles, (..., N); ``excess`` is that of the cosine of the angle
    at A over 1, where the dyad does not close, else 0. ``d_phi`` is the change of the direction
    with the crank's angle; ``d_shape`` and ``d_excess`` (3, ..., N), those of direction and excess
    with a, b, c, and ``d_excess_phi``."""

    u: Complexes
    excess: Array
    d_phi: Complexes
    d_shape: Complexes
    d_excess: Array
    d_excess_phi: Array


def direction(lengths: tuple[Array, Array, Array], phi: Array) -> tuple[Complexes, Array]:
    """Return the coupler's direction alone, and the cosine of the angle at A, for many shapes."""
    a, b, c = lengths
    r = 1.0 - a * np.exp(1j * phi)
    rho = np.abs(r)
    cosine = (b**2 + rho**2 - c**2) / (2.0 * b * rho)
    within = np.clip(cosine, -1.0, 1.0)
    return r / rho * (within + 1j * np.sqrt(1.0 - within**2)), cosine


def turn(lengths: tuple[float, float, float], phi: Array) -> Turn:
    """Return the coupler's direction and derivatives, by the cosine law in triangle A B O4."""
    a, b, c = lengths
    crank = np.exp(1j * phi)
    r = 1.0 - a * crank
    rho = np.abs(r)
    toward = r / rho
    cosine = (b**2 + rho**2 - c**2) / (2.0 * b * rho)
    within = np.clip(cosine, -1.0, 1.0)
    sine = np.sqrt(1.0 - within**2)
    u = toward * (within + 1j * sine)
    # Changes of r with phi and a, then of its angle, its length and the cosine.
    d_r = np.array([-1j * a * crank, -crank])
    d_angle, d_rho = (d_r / r).imag, (toward.conj() * d_r).real
    by_rho = 1.0 / b - cosine / rho
    d_cosine = np.array(
        [by_rho * d_rho[0], by_rho * d_rho[1], 1.0 / rho - cosine / b, -c / b / rho]
    )
    closes = np.abs(cosine) < 1.0
    d_beta = np.where(closes, -d_cosine / np.maximum(sine, DEAD), 0.0)
    d_beta[:2] += d_angle
    d_over = np.where(closes, 0.0, np.sign(cosine) * d_cosine)
    return Turn(
        u,
        np.maximum(np.abs(cosine) - 1.0, 0.0),
        1j * u * d_beta[0],
        1j * u * d_beta[1:],
        d_over[1:],
        d_over[0],
    )


def lengths(family: Family, x: Array) -> tuple[Array, Array, Array]:
    """Return the lengths a, b, c over the ground from the three numbers of a shape, (3, ...).

    With a crank that turns fully A is at distances |1 - a| to 1 + a from O4, within b - c to b + c:
    the numbers are log a, log (b + c)/(1 + a) and (b - c)/|1 - a|, in a box. With limits they are
    the logarithms of a, b and c.
    """
    a = np.exp(x[0])
    if family == "limited":
        return a, np.exp(x[1]), np.exp(x[2])
    sum_, difference = (1.0 + a) * np.exp(x[1]), np.abs(1.0 - a) * x[2]
    return a, 0.5 * (sum_ + difference), 0.5 * (sum_ - difference)


def lengths_jacobian(family: Family, x: Array) -> Array:
    """Return the changes of a, b, c (columns) with the numbers of a shape (rows), (3, 3)."""
    a, b, c = lengths(family, x)
    if family == "limited":
        return np.diag([a, b, c])
    stretch, side = 0.5 * a * np.exp(x[1]), 0.5 * a * np.sign(a - 1.0) * x[2]
    half, gap = 0.5 * (b + c), 0.5 * np.abs(1.0 - a)
    return np.array([[a, stretch + side, stretch - side], [0.0, half, half], [0.0, gap, -gap]])


def family_of(a: float, b: float, c: float) -> Family:
    """Return the family of a shape, by the reachable distances of A from O4."""
    if abs(b - c) < abs(1.0 - a) and b + c > 1.0 + a:
        return "crank-rocker" if a < 1.0 else "double-crank"
    return "limited"


def distances(a: float, low: float, high: float) -> Array:
    """Return the distances of A from O4 at both ends of crank angles [rad], and at extremes."""
    turns = np.arange(math.ceil(low / math.pi), math.floor(high / math.pi) + 1)
    phi = np.concatenate([[low, high], math.pi * turns])
    return np.abs(1.0 - a * np.exp(1j * phi))


def closes_between(shape: tuple[float, float, float], low: float, high: float) -> bool:
    """True if the dyad closes at all crank angles [rad] from one to another."""
    a, b, c = shape
    rho = distances(a, low, high)
    return bool(np.all((rho > abs(b - c)) & (rho < b + c)))


def least_sine(shape: tuple[float, float, float], low: float, high: float) -> float:
    """Return the least sine of the transmission angle at B, between crank angles [rad]."""
    a, b, c = shape
    cosine = (b**2 + c**2 - distances(a, low, high) ** 2) / (2.0 * b * c)
    return float(np.sqrt(np.min(np.maximum(1.0 - cosine**2, 0.0))))


LEAST, MOST = 4, 50
"""Numbers of points of a path. Through three, any four-bar can be scaled and moved; beyond fifty, a
fit of least squares gains nothing, and takes longer."""
SAME = 1e-9
"""Distance of coincident points, over the size of the path."""
DETERMINED = {True: 5, False: 9}
"""Numbers of points, with the crank's angles and without, that leave a four-bar no freedom.

Source: A. G. Erdman and G. N. Sandor, Mechanism Design, volume 1, table 8.1 (5 with prescribed
timing); C. W. Wampler, A. P. Morgan and A. J. Sommese, Journal of Mechanical Design 114 (1992) (9).
"""


@dataclass(frozen=True)
class UnitPath:
    """Points about their middle, over their mean radius; angles of the crank from the first on."""

    points: Complexes
    turned: Array | None

    @staticmethod
    def of(points: Complexes, turned: Array | None = None) -> tuple[UnitPath, complex, float]:
        """Return the unit path of points [m], their middle and their radius [m]."""
        middle = complex(np.mean(points))
        radius = float(np.sqrt(np.mean(np.abs(points - middle) ** 2)))
        return UnitPath((points - middle) / radius, turned), middle, radius

    @property
    def mirrored(self) -> UnitPath:
        """Mirror image, drawn by a mechanism of the other assembly."""
        return UnitPath(self.points.conj(), None if self.turned is None else -self.turned)

    def kept(self, most: int) -> NDArray[np.intp]:
        """Return the numbers of so many of the points, spread evenly."""
        return np.unique(np.round(np.linspace(0, len(self.points) - 1, most)).astype(np.intp))

    def only(self, keep: NDArray[np.intp]) -> UnitPath:
        """Return some of the points."""
        return UnitPath(self.points[keep], None if self.turned is None else self.turned[keep])


@dataclass(frozen=True)
class PathTask:
    """Points that a coupler point goes through, in their order.

    ``points`` are their places [m]. ``crank_rad`` are the crank's angles in them [rad], growing or
    falling throughout and within a turn: only their differences count, as the crank's angle at the
    start is free. None leaves all angles free. A ``closed`` path comes back to its first point,
    which is listed once, after a turn of the crank.

    Raises
    ------
    CrankcheckError
        Fewer points than `LEAST`, more than `MOST`; points that follow each other and coincide;
        angles that are not one for each point, or do not go one way within a turn.
    """

    points: tuple[complex, ...]
    crank_rad: tuple[float, ...] | None = None
    closed: bool = False

    def __post_init__(self) -> None:
        refuse_points(self.points, closed=self.closed, most=MOST)
        if self.crank_rad is not None:
            _refuse_angles(self.crank_rad, len(self.points))

    @property
    def array(self) -> Complexes:
        """The points, (N,)."""
        return np.array(self.points, dtype=np.complex128)

    @property
    def is_timed(self) -> bool:
        """True if the crank's angles are given."""
        return self.crank_rad is not None

    @property
    def turned_rad(self) -> Array | None:
        """Crank's angles from the first point on [rad], (N,); None without timing."""
        return None if self.crank_rad is None else np.array(self.crank_rad) - self.crank_rad[0]

    @property
    def middle(self) -> complex:
        """Mean of the points [m]."""
        return UnitPath.of(self.array)[1]

    @property
    def radius_m(self) -> float:
        """Root of the mean square of their distances from the middle [m]."""
        return UnitPath.of(self.array)[2]

    @property
    def unit(self) -> UnitPath:
        """Path about its middle, over its radius."""
        return UnitPath.of(self.array, self.turned_rad)[0]

    @property
    def freedom(self) -> int:
        """Number of a four-bar's values that the path leaves open; negative if nearly met."""
        free = DETERMINED[self.is_timed] - len(self.points)
        return 2 * free if self.is_timed else free


def refuse_points(points: Sequence[complex], *, closed: bool, most: float = math.inf) -> None:
    """Refuse an invalid path of points [m], or more than so many. Raises CrankcheckError."""
    count = len(points)
    if not LEAST <= count <= most:
        range_ = f"{LEAST} to {most}" if math.isfinite(most) else f"{LEAST} or more"
        raise CrankcheckError(f"a path of {count} points was requested; give {range_} points")
    places = np.array(points, dtype=np.complex128)
    if not np.isfinite(places).all():
        raise CrankcheckError("the points of a path have to be finite numbers [m]")
    size = float(np.ptp(places.real) + np.ptp(places.imag))
    pairs = list(itertools.pairwise(range(count)))
    for i, j in pairs + [(count - 1, 0)] * closed:
        if abs(points[j] - points[i]) <= SAME * size:
            at = points[i]
            last = "; a closed path lists its first point once" if j == 0 else ""
            raise CrankcheckError(
                f"points {i + 1} and {j + 1} of the path coincide at ({at.real:g}, {at.imag:g}) m; "
                f"leave one of them out{last}"
            )


def _refuse_angles(angles: Sequence[float], count: int) -> None:
    """Refuse angles [rad] that no turn of a crank goes through. Raises CrankcheckError."""
    if len(angles) != count:
        raise CrankcheckError(
            f"{len(angles)} angles of the crank were given for {count} points; give one for each, "
            "or none"
        )
    steps = np.diff(np.array(angles, dtype=np.float64))
    if not (np.all(steps > 0.0) or np.all(steps < 0.0)):
        raise CrankcheckError(
            "the angles of the crank turn back, or stay; give angles that grow, or fall, from each "
            "point to the next"
        )
    if not abs(float(np.sum(steps))) < math.tau:
        span = math.degrees(abs(float(np.sum(steps))))
        raise CrankcheckError(
            f"the angles of the crank span {span:.6g} deg; give angles within one turn, less than "
            "360 deg from the first to the last"
        )
