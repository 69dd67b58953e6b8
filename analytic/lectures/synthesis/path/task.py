"""Task of path generation: the points of a path, with or without the crank's angles."""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from analytic.lectures.synthesis.path.unit_four_bar import Complexes
from models.array import Array
from models.errors import CrankcheckError

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
        raise CrankcheckError(f"a path of {count} points was asked for; give {range_} points")
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
