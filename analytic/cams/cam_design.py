"""Design of a cam: its limits, the base circle that keeps them, and how a given cam keeps them.

A profile undercuts where the radius of curvature of the pitch curve is convex and not above the
roller's, or where that of a flat-faced cam is not above 0 (Norton, Design of Machinery, 5th ed.
2012, ch. 8). A knife edge undercuts nothing.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from analytic.cams.contact_force import CamForces, FollowerLoad, contact_force, lift_off
from analytic.cams.profile import corners, largest, touch
from models.array import Array
from models.errors import CrankcheckError
from models.scene.cam_laws import CamLaw
from models.scene.cams import Cam, Follower, OscillatingFollower

LADDER = 40
"""Number of base radii that are tried before the smallest one is refined."""
ROUNDING = 1e-9
"""Share by which a cam may exceed a limit, as one that was designed by it does."""
Extreme = tuple[float, float]
"""A largest or least value over a turn, and the angle of the cam [rad] where it is."""


def sharpest(cam: Cam) -> Extreme:
    """Return the largest convex curvature [1/m] of the pitch curve; for a flat face minus the least
    radius of curvature of the profile [m], which may pass 0 there."""
    if cam.follower.is_flat:
        return largest(cam.law.knots_rad, lambda phi: -touch(cam, phi).radius_m)
    return largest(cam.law.knots_rad, lambda phi: 1.0 / touch(cam, phi).pitch_radius_m)


def steepest(cam: Cam, *, rising: bool) -> Extreme:
    """Return the largest magnitude of the pressure angle [rad] where the follower rises or rests,
    or where it returns."""

    def quantity(phi: Array) -> Array:
        contact = touch(cam, phi)
        counts = (contact.lift.first >= 0.0) if rising else (contact.lift.first < 0.0)
        return np.where(counts, np.abs(contact.pressure_rad), 0.0)

    return largest(cam.law.knots_rad, quantity)


@dataclass(frozen=True)
class CamLimits:
    """Permitted pressure angles [rad] of rise and return, and the least convex radius of curvature
    of the profile [m]; without one for the return, a spring drives it."""

    pressure_rad: float = math.inf
    return_rad: float = math.inf
    least_m: float = 0.0

    def margin(self, cam: Cam) -> float:
        """Return a number above 0 where a cam keeps all of them, and does not undercut."""
        margins = [math.inf]
        if self.least_m > 0.0 or cam.follower.contact != "knife":
            most, limit = sharpest(cam)[0], cam.follower.roller_m + self.least_m
            margins.append(-most - limit if cam.follower.is_flat else 1.0 - most * limit)
        for limit, rising in ((self.pressure_rad, True), (self.return_rad, False)):
            if limit < math.inf:
                margins.append(limit - steepest(cam, rising=rising)[0])
        return min(margins)


def least_cam(
    law: CamLaw, follower: Follower, sense: int, limits: CamLimits, *, above_m: float = 0.0
) -> Cam:
    """Return the cam of the smallest base radius above ``above_m`` that keeps the limits.

    Raises CrankcheckError where none does. Found on a ladder of radii, and refined to 1e-14 of
    itself.
    """
    _refuse_corners(law, follower)

    def margin(start: float) -> float:
        try:
            return limits.margin(Cam(law, follower.base(start), follower, sense))
        except (CrankcheckError, ValueError):
            return -math.inf

    tried: list[tuple[float, float]] = []
    for start in _starts(law, follower, above_m):
        tried.append((float(start), margin(start)))
        if tried[-1][1] > 0.0:
            break
    else:
        best = max(tried, key=lambda each: each[1], default=(0.0, -math.inf))
        nearest = f"; the nearest to it is {follower.base(best[0]):.6g} m" if best[0] else ""
        raise CrankcheckError(
            f"no base radius keeps the limit{nearest}: change the stroke, the spans or the follower"
        )
    high = tried[-1][0]
    if len(tried) > 1 and math.isfinite(tried[-2][1]):
        # scipy is slow to import, and few need it
        from scipy.optimize import brentq  # type: ignore[import-untyped]  # ships no stubs

        high = brentq(margin, tried[-2][0], high, xtol=1e-15, rtol=1e-14)
    return Cam(law, float(follower.base(high)), follower, sense)


def _starts(law: CamLaw, follower: Follower, above_m: float) -> Array:
    """Return starts of the follower to try, of growing base radius."""
    top, flat = law.extremes[0][1], follower.is_flat
    if isinstance(follower, OscillatingFollower):
        size, share = follower.pivot_m, np.linspace(-1.0 if flat else 0.0, 1.0, LADDER)[1:-1]
        starts = ((0.5 if flat else 1.0) * math.pi - top) * share
    else:
        size = max(top, abs(follower.offset_m), follower.roller_m)
        starts = size * np.geomspace(1e-3, 1e3, LADDER)
    bases = np.array([follower.base(start) for start in starts])
    kept = starts[bases > max(above_m, 1e-3 * size)]
    return np.concatenate([[follower.start(above_m)], kept]) if above_m > 0.0 else kept


def _refuse_corners(law: CamLaw, follower: Follower) -> None:
    if follower.contact != "knife" and (drops := corners(law)):
        raise CrankcheckError(
            f"the profile undercuts with every base radius: the velocity of its law drops at "
            f"{math.degrees(drops[0]):.6g} deg, where only a knife edge follows; give a law with "
            "continuous velocity"
        )


def refuse_undercut(cam: Cam) -> None:
    """Refuse a cam that undercuts. Raises CrankcheckError that says from which base radius on it
    does not."""
    _refuse_corners(cam.law, cam.follower)
    if CamLimits().margin(cam) > 0.0:
        return
    most, phi = sharpest(cam)
    found = (
        f"its radius of curvature is {-most:.6g} m"
        if cam.follower.is_flat
        else f"the pitch curve's convex radius of curvature is {1.0 / most:.6g} m, the roller's "
        f"{cam.follower.roller_m:.6g} m"
    )
    try:
        least = least_cam(cam.law, cam.follower, cam.sense, CamLimits(), above_m=cam.base_m)
        cure = f"from a base radius of {least.base_m:.9g} m on it does not"
    except CrankcheckError as error:
        cure = str(error)
    raise CrankcheckError(
        f"the profile undercuts at {math.degrees(phi):.6g} deg with a base radius of "
        f"{cam.base_m:.6g} m: {found}; {cure}"
    )


@dataclass(frozen=True)
class ExaminedCam:
    """A cam against its limits, at a speed [rad/s] under the load of its follower."""

    cam: Cam
    limits: CamLimits
    speed_rad_s: float
    load: FollowerLoad | None = None

    @cached_property
    def pressures(self) -> tuple[Extreme, Extreme]:
        """Largest magnitudes of the pressure angle [rad]: while the follower rises or rests, and
        while it returns."""
        return steepest(self.cam, rising=True), steepest(self.cam, rising=False)

    @cached_property
    def radii(self) -> tuple[Extreme, Extreme]:
        """Least convex and least concave radius of curvature of the profile [m], 0 at a corner; a
        grinding wheel stays below the concave one, which is infinite if there is none."""
        return self._least_radius(1), self._least_radius(-1)

    def _least_radius(self, sign: int) -> Extreme:
        if at_corners := corners(self.cam.law, sign):
            return 0.0, at_corners[0]
        most, phi = largest(self.cam.law.knots_rad, lambda at: sign / touch(self.cam, at).radius_m)
        return (1.0 / most if most > 0.0 else math.inf), phi

    @cached_property
    def lift_off(self) -> Extreme | None:
        """Speed [rad/s] at which the follower leaves; None without a load."""
        return None if self.load is None else lift_off(self.cam, self.load)

    def forces(self, phi: Array) -> CamForces:
        """Return contact force and torque at the speed, of a cam with a load."""
        assert self.load is not None
        return contact_force(self.cam, self.load, self.speed_rad_s, phi)

    def force_range_n(self) -> tuple[float, float]:
        """Return the least and largest contact force over a turn [N], of a cam with a load."""
        knots = self.cam.law.knots_rad
        least = -largest(knots, lambda phi: -self.forces(phi).contact_n)[0]
        return least, largest(knots, lambda phi: self.forces(phi).contact_n)[0]

    @cached_property
    def exceeded(self) -> list[str]:
        """The limits that the cam does not keep, and contact that it loses, in words."""
        faults, limits, (radius, at) = [], self.limits, self.radii[0]
        rise, back = self.pressures
        for part, limit, extreme in (
            ("rise", limits.pressure_rad, rise),
            ("return", limits.return_rad, back),
        ):
            if extreme[0] > limit * (1.0 + ROUNDING):
                angle, phi, most = np.degrees([*extreme, limit])
                faults.append(
                    f"pressure angle of the {part}: {angle:.6g} deg at {phi:.6g} deg, permitted "
                    f"are {most:.6g}"
                )
        if radius < limits.least_m * (1.0 - ROUNDING):
            faults.append(
                f"convex radius of curvature: {radius:.6g} m at {math.degrees(at):.6g} deg, the "
                f"least is {limits.least_m:.6g}"
            )
        if self.lift_off is not None and self.lift_off[0] <= self.speed_rad_s:
            faults.append(
                f"the follower leaves at {self.lift_off[0]:.6g} rad/s, and the cam turns "
                f"with {self.speed_rad_s:.6g}"
            )
        return faults
