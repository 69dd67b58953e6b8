"""Design of a cam by limits of its base circle, and the numbers that it is judged by."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from analytic.cams.base_circle import (
    curvature_margin,
    least_base,
    pressure_margin,
    refuse_corners,
    steepest,
)
from analytic.cams.contact_force import CamForces, FollowerLoad, LiftOff, contact_force, lift_off
from analytic.cams.profile import largest, touch, turn_of
from models.array import Array
from models.scene.cam_laws import CamLaw
from models.scene.cams import Cam, Follower

ROUNDING = 1e-9
"""Share by which a cam may exceed a limit, as one that was designed by it does."""


@dataclass(frozen=True)
class CamLimits:
    """Permitted pressure angles [rad] of rise and return, and the least convex radius of curvature
    of the profile [m]; None: no limit."""

    pressure_rad: float | None = None
    return_rad: float | None = None
    least_m: float = 0.0

    def margin(self, cam: Cam) -> float:
        """Return a number above 0 where a cam keeps all of them, and does not undercut."""
        margins = []
        if self.least_m > 0.0 or cam.follower.contact != "knife":
            margins.append(curvature_margin(self.least_m)(cam))
        if self.pressure_rad is not None:
            margins.append(pressure_margin(self.pressure_rad, self.return_rad)(cam))
        return min(margins, default=math.inf)


def smallest_cam(law: CamLaw, follower: Follower, sense: int, limits: CamLimits) -> Cam:
    """Return the cam of the smallest base circle that keeps the limits. Raises CrankcheckError
    where none does."""
    refuse_corners(law, follower)
    return Cam(law, least_base(law, follower, sense, limits.margin), follower, sense)


@dataclass(frozen=True)
class ExaminedCam:
    """A cam with its load and speed [rad/s]. Extremes come with the angle [rad] where they are."""

    cam: Cam
    speed_rad_s: float
    load: FollowerLoad | None = None

    @cached_property
    def rise_pressure(self) -> tuple[float, float]:
        """Largest magnitude of the pressure angle [rad] while the follower rises or rests."""
        return steepest(self.cam, rising=True)

    @cached_property
    def return_pressure(self) -> tuple[float, float]:
        """The same while it returns."""
        return steepest(self.cam, rising=False)

    def _bend(self, sign: float) -> tuple[float, float]:
        for one in self.cam.law.jumps:
            if sign * one.velocity < 0.0:  # a corner
                return 0.0, one.angle_rad
        most, phi = largest(turn_of(self.cam), lambda at: sign / touch(self.cam, at).radius_m)
        return (1.0 / most if most > 0.0 else math.inf), phi

    @cached_property
    def convex_radius(self) -> tuple[float, float]:
        """Least convex radius of curvature of the profile [m]."""
        return self._bend(1.0)

    @cached_property
    def concave_radius(self) -> tuple[float, float]:
        """Least concave radius [m], which a grinding wheel stays below; infinite if none is."""
        return self._bend(-1.0)

    @cached_property
    def lift_off(self) -> LiftOff | None:
        """Speed at which the follower leaves; None without a load."""
        return None if self.load is None else lift_off(self.cam, self.load)

    def forces(self, phi: Array) -> CamForces | None:
        """Return contact force and torque at the speed; None without a load."""
        if self.load is None:
            return None
        return contact_force(self.cam, self.load, self.speed_rad_s, phi)

    @cached_property
    def force_range_n(self) -> tuple[float, float] | None:
        """Least and largest contact force over a turn [N]."""
        if self.load is None:
            return None
        load, knots = self.load, turn_of(self.cam)

        def force(phi: Array) -> Array:
            return contact_force(self.cam, load, self.speed_rad_s, phi).contact_n

        return -largest(knots, lambda phi: -force(phi))[0], largest(knots, force)[0]

    def exceeded(self, limits: CamLimits) -> list[str]:
        """Return the limits that the cam does not keep, and contact that it loses, in words."""
        faults = []
        for limit, (angle, phi), part in (
            (limits.pressure_rad, self.rise_pressure, "rise"),
            (limits.return_rad, self.return_pressure, "return"),
        ):
            if limit is not None and angle > limit * (1.0 + ROUNDING):
                found, at, most = np.degrees([angle, phi, limit])
                faults.append(
                    f"pressure angle of the {part}: {found:.6g} deg at {at:.6g} deg, permitted are "
                    f"{most:.6g}"
                )
        if self.convex_radius[0] < limits.least_m * (1.0 - ROUNDING):
            faults.append(
                f"convex radius of curvature: {self.convex_radius[0]:.6g} m at "
                f"{math.degrees(self.convex_radius[1]):.6g} deg, the least is {limits.least_m:.6g}"
            )
        if self.lift_off is not None and self.lift_off.omega_rad_s <= self.speed_rad_s:
            faults.append(
                f"the follower leaves at {self.lift_off.omega_rad_s:.6g} rad/s, and the cam turns "
                f"with {self.speed_rad_s:.6g}"
            )
        return faults
