"""Law of motion of a follower on a given profile: the inverse of `analytic.cams.profile`.

Each point of the profile touches the follower at one angle of the cam, which follows from the
point and its normal in closed form; the angle is then solved for the point. A roller follows a
concave profile only if its radius is below the profile's, and a flat face only a convex one
(Norton, Design of Machinery, 5th ed. 2012, ch. 8).
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.interpolate import make_interp_spline  # type: ignore[import-untyped]  # ships no stubs

from analytic.cams.profile import Plane, largest
from models.array import Array
from models.errors import CrankcheckError
from models.scene.cam_laws import CamLaw, CamSegment
from models.scene.cams import Cam, Follower, OscillatingFollower

ProfileCurve = Callable[[Array], tuple[Plane, Plane]]
"""Points x + iy [m], and tangents of any length, by a parameter from 0 to 1 round the cam (T,)."""
PARTS = 4096
FEWEST = 24


def interpolated(points: Array, order: int = 5) -> ProfileCurve:
    """Return the curve through points (N, 2) [m] round a cam, the first not repeated: a periodic
    spline over the lengths of the chords. Raises CrankcheckError."""
    rows = np.asarray(points, dtype=np.float64)
    if rows.ndim != 2 or rows.shape[1] != 2 or len(rows) < FEWEST or not np.isfinite(rows).all():
        raise CrankcheckError(
            f"found a profile of shape {rows.shape}; give x and y of {FEWEST} or more points"
        )
    if np.allclose(rows[0], rows[-1], rtol=0.0, atol=1e-12 * np.abs(rows).max()):
        rows = rows[:-1]
    closed = np.vstack([rows, rows[:1]])
    chords = np.hypot(*np.diff(closed, axis=0).T)
    if chords.min() == 0.0:
        k = int(np.argmin(chords))
        raise CrankcheckError(f"points {k + 1} and {k + 2} of the profile are one; leave one out")
    length = np.append(0.0, np.cumsum(chords)) / chords.sum()
    spline = make_interp_spline(length, closed, order, bc_type="periodic")
    rate = spline.derivative()

    def curve(u: Array) -> tuple[Plane, Plane]:
        folded = np.mod(u, 1.0)
        (x, y), (dx, dy) = spline(folded).T, rate(folded).T
        return x + 1j * y, dx + 1j * dy

    return curve


@dataclass(frozen=True, eq=False)
class GivenProfile:
    """A profile round the cam's centre and the follower on it. Raises CrankcheckError for a roller
    that is too large for its concave parts, and a flat face on them."""

    curve: ProfileCurve
    follower: Follower
    sense: int = 1

    def __post_init__(self) -> None:
        self._refuse_concave()
        steps = self._turning(np.diff(self._grid[1]))
        if steps.min() * steps.max() < 0.0:
            k = int(np.argmin(steps * np.sign(steps.sum())))
            point = self.curve(self._grid[0][k : k + 1])[0][0]
            raise CrankcheckError(
                f"the profile near ({point.real:.6g}, {point.imag:.6g}) m is not touched: the "
                "follower jumps over it; give one closed curve round the cam's centre, without "
                "corners"
            )

    @staticmethod
    def _turning(angle: Array) -> Array:
        """Angles folded to -pi to pi."""
        return np.asarray(np.angle(np.exp(1j * angle)))

    @cached_property
    def _outward(self) -> complex:
        """Factor from the tangent to the outward normal, by the sense of the curve."""
        points, tangents = self.curve(np.arange(PARTS) / PARTS)
        return -1j if float(np.sum((points.conj() * tangents).imag)) > 0.0 else 1j

    @cached_property
    def _grid(self) -> tuple[Array, Array]:
        """Parameters round the profile, the first repeated, and angles of the cam (N,)."""
        u = np.linspace(0.0, 1.0, PARTS + 1)
        return u, self._coordinate(u)[0]

    def _coordinate(self, u: Array) -> tuple[Array, Array]:
        """Angle of the cam [rad] and coordinate of the follower at which a point is touched."""
        point, tangent = self.curve(u)
        normal = self._outward * tangent / np.abs(tangent)
        follower, sense = self.follower, self.sense
        oscillates = isinstance(follower, OscillatingFollower)
        with np.errstate(invalid="ignore"):
            if follower.is_flat:
                place = (normal.conj() * point).real
                beta = np.full_like(place, 0.5 * math.pi)
                if isinstance(follower, OscillatingFollower):
                    place = np.arcsin((place - follower.face_m) / follower.pivot_m)
                    beta = beta - place
                found = sense * (beta - np.angle(normal)), place
            else:
                pitch = point + follower.roller_m * normal
                reach = np.abs(pitch)
                if isinstance(follower, OscillatingFollower):
                    d, arm = follower.pivot_m, follower.arm_m
                    square = (reach - d + arm) * (reach + d - arm)
                    place = 2.0 * np.arctan(np.sqrt(square / ((d + arm) ** 2 - reach**2)))
                    tip = d - arm * np.exp(-1j * place)
                else:
                    e = follower.offset_m
                    place = np.sqrt((reach - e) * (reach + e))
                    tip = e + 1j * place
                found = sense * np.angle(tip * pitch.conj()), place
        if not np.isfinite(found[1]).all():
            raise CrankcheckError(
                "the follower does not reach all of the profile; give "
                + ("another arm or pivot" if oscillates else "a smaller offset")
            )
        return found

    def _refuse_concave(self) -> None:
        """Refuse a roller not below the least concave radius of the profile, or a flat face."""
        sign = 1.0 if self._outward == -1j else -1.0
        step = 1e-5

        def concave(u: Array) -> Array:
            (first, before), (last, after) = (self.curve(u + x) for x in (-step, step))
            # Turning of the tangent over the arc; where the contact rests it has none.
            arc, turning = np.abs(last - first), np.angle(after * before.conj())
            return np.asarray(-sign * turning / np.where(arc > 0.0, arc, math.inf))

        most, u = largest(np.linspace(0.0, 1.0, 65).tolist(), concave)
        # Rounding of the differences: a straight part is no fault.
        limit = 1e-6 / float(np.abs(self.curve(np.zeros(1))[0][0]))
        roller = self.follower.roller_m
        if most <= limit or (not self.follower.is_flat and most * roller < 1.0):
            return
        point = self.curve(np.array([u]))[0][0]
        touching = "a flat face touches" if self.follower.is_flat else f"a roller of {roller:.6g} m"
        raise CrankcheckError(
            f"the profile is concave at ({point.real:.6g}, {point.imag:.6g}) m with a radius of "
            f"{1.0 / most:.6g} m; {touching} does not fit: "
            + ("give a roller" if self.follower.is_flat else f"give one below {1.0 / most:.6g} m")
        )

    @cached_property
    def start(self) -> float:
        """Lowest coordinate of the follower [m or rad]."""
        knots = np.linspace(0.0, 1.0, 65).tolist()
        return -largest(knots, lambda u: -self._coordinate(u)[1])[0]

    @property
    def base_m(self) -> float:
        """Base radius of the profile."""
        return self.follower.base(self.start)

    def lift(self, phi: Array) -> Array:
        """Return the lift above its lowest place (T,) at angles of the cam (T,) [rad]. Accurate to
        rounding where the curve is. Raises CrankcheckError at a corner of the profile."""
        u, angles = self._grid
        steps = self._turning(np.diff(angles))
        travelled = np.append(0.0, np.cumsum(steps))
        sign = float(np.sign(travelled[-1]))
        target = np.mod(sign * (np.asarray(phi) - angles[0]), math.tau)
        k = np.clip(np.searchsorted(sign * travelled, target, side="right") - 1, 0, PARTS - 1)
        low, high = u[k], u[k + 1]
        for _ in range(48):
            middle = 0.5 * (low + high)
            before = sign * self._turning(self._coordinate(middle)[0] - phi) < 0.0
            low, high = np.where(before, middle, low), np.where(before, high, middle)
        found, place = self._coordinate(0.5 * (low + high))
        if np.abs(self._turning(found - phi)).max() > 1e-6:
            raise CrankcheckError("the profile has a corner, which has no normal; round it off")
        return np.asarray(place - self.start)

    def law(self, rows: int = 720, order: int = 5) -> CamLaw:
        """Return the law as a table of a turn. Raises CrankcheckError as `lift`."""
        phi = np.linspace(0.0, math.tau, rows + 1)
        lift = self.lift(phi[:-1])
        rise = (*(lift - lift[0]).tolist(), 0.0)
        points = tuple(zip(phi.tolist(), rise, strict=True))
        return CamLaw((CamSegment("table", math.tau, 0.0, points, order),))

    def cam(self, rows: int = 720) -> Cam:
        """Return the cam with that law; its lift counts from angle 0, and its base radius is the
        profile's there. Raises CrankcheckError as `lift`."""
        base = self.follower.base(self.start + float(self.lift(np.zeros(1))[0]))
        return Cam(self.law(rows), base, self.follower, self.sense)
