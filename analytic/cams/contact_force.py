"""Contact force of cam and follower, driving torque, and the speed at which the follower leaves.

The follower has an inertia I, a spring k with preload F0 at lift 0, and a weight W; without
friction and damping, at constant speed omega of the cam,

    N lever = I omega^2 s'' + k s + F0 + W        T omega = N lever s' omega

and contact is lost where the first right side falls to 0: omega*^2 = min (k s + F0 + W) / (-I s'')
over s'' < 0 (Norton, Design of Machinery, 5th ed. 2012, ch. 15).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from analytic.cams.profile import corners, largest, touch
from models.array import Array
from models.errors import CrankcheckError
from models.scene.cams import Cam, OscillatingFollower


@dataclass(frozen=True)
class FollowerLoad:
    """Inertia and closing loads of a follower: kg, N/m, N and N for one that translates; kg m^2,
    N m/rad, N m and N m about the pivot for one that oscillates.

    ``preload`` is the spring's at lift 0. ``weight`` presses on the cam; that of an oscillating
    follower is weight cos(psi - weight_angle_rad).
    """

    inertia: float
    stiffness: float = 0.0
    preload: float = 0.0
    weight: float = 0.0
    weight_angle_rad: float = 0.0

    def closing(self, cam: Cam, lift: Array) -> Array:
        """Return the generalised force of spring and weight towards the cam (T,)."""
        weight = np.full_like(lift, self.weight)
        if isinstance(cam.follower, OscillatingFollower):
            weight *= np.cos(cam.start + lift - self.weight_angle_rad)
        return np.asarray(self.stiffness * lift + self.preload + weight)


class CamForces(NamedTuple):
    """Contact force (T,) [N], below 0 where only a groove would give it, and driving torque (T,)
    [N m], counter-clockwise."""

    contact_n: Array
    torque_nm: Array


def contact_force(cam: Cam, load: FollowerLoad, omega_rad_s: float, phi: Array) -> CamForces:
    """Return contact force and driving torque at constant speed. Raises CrankcheckError as
    `touch`."""
    contact = touch(cam, phi)
    s, first, second, _ = contact.lift
    pressing = load.inertia * omega_rad_s**2 * second + load.closing(cam, s)
    return CamForces(pressing / contact.lever, cam.sense * pressing * first)


def lift_off(cam: Cam, load: FollowerLoad) -> tuple[float, float]:
    """Return the speed of the cam [rad/s] at which its follower leaves, infinite if never, and
    where [rad], exactly.

    Raises CrankcheckError for a follower that spring and weight do not close even at rest.
    """
    least, where = largest(cam.law.knots_rad, lambda phi: -load.closing(cam, cam.law.at(phi).value))
    if least >= 0.0:
        raise CrankcheckError(
            f"spring and weight close the follower with {-least:.6g} at "
            f"{math.degrees(where):.6g} deg of the cam, at rest; give a preload above "
            f"{load.preload + least:.6g}"
        )
    if load.inertia > 0.0 and (drops := corners(cam.law)):  # an impulse that nothing withstands
        return 0.0, drops[0]

    def lack(phi: Array) -> Array:
        lift = cam.law.at(phi)
        return np.asarray(-load.inertia * lift.second / load.closing(cam, lift.value))

    most, phi = largest(cam.law.knots_rad, lack)
    return 1.0 / math.sqrt(most) if most > 0.0 else math.inf, phi
