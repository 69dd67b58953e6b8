"""The swing of a bead from rest, by Jacobi's elliptic functions; any textbook of mechanics."""

import math
from dataclasses import dataclass

import numpy as np
from scipy.special import ellipj, ellipk

from analytic.kinematics import solve_driven
from models.array import Array
from models.motion import Motion
from models.scene import Scene


@dataclass(frozen=True)
class Swing:
    """A bead whose spoke hangs at ``down_rad``, ``high_rad`` above it at time 0; ``pace_rad_s`` is
    the angular frequency of small swings."""

    down_rad: float
    high_rad: float
    pace_rad_s: float

    @property
    def period_s(self) -> float:
        """The time of a swing to and fro [s]."""
        return float(4.0 * ellipk(math.sin(0.5 * self.high_rad) ** 2)) / self.pace_rad_s

    def at(self, time_s: Array) -> tuple[Array, Array, Array]:
        """Angle of the spoke [rad], its speed and its acceleration, each (T,)."""
        k = math.sin(0.5 * self.high_rad)
        sn, cn, _, _ = ellipj(self.pace_rad_s * time_s + ellipk(k * k), k * k)
        off = 2.0 * np.arcsin(k * sn)
        return (
            self.down_rad + off,
            2.0 * k * self.pace_rad_s * cn,
            -(self.pace_rad_s**2) * np.sin(off),
        )


def swing_of(scene: Scene) -> Swing:
    (link,) = scene.links.values()
    arm = complex(*link.centre_m) - complex(*link.points[next(iter(scene.ground))])
    inertia = link.inertia_kg_m2 + link.mass_kg * abs(arm) ** 2
    pull = complex(*scene.gravity_m_s2)
    down = float(np.angle(pull / arm))
    start = float(scene.driver.law.at(0.0)[0])
    high = math.remainder(start - down, math.tau)
    pace = math.sqrt(link.mass_kg * abs(pull) * abs(arm) / inertia)
    return Swing(start - high, high, pace)


def moved(scene: Scene, swing: Swing, time_s: Array) -> Motion:
    return solve_driven(scene, *swing.at(time_s), time_s, bound=False)
