"""The constraint equations of a driven mechanism: those of its joints, and the driver's.

Nothing here knows of dyads. Every body has coordinates (x, y, theta) of its frame; every pin, every
prismatic pair and the driver gives its equations. Source: E. J. Haug, Computer Aided Kinematics and
Dynamics of Mechanical Systems, chapters 3 and 4.
"""

import math

import numpy as np

from analytic.multibody.as_motion import as_motion
from analytic.multibody.assembly import Assembly
from models.array import Array
from models.errors import CrankcheckError
from models.motion import Motion
from models.scene import GROUND, Scene
from models.scene.driver import Course, driver_course


class Constraints:
    """The constraint equations of a scene, as functions of the coordinates of its bodies.

    Coordinates q (3 n,): x, y [m], theta [rad] of each body in the order of ``bodies``. Equations
    (3 n,): two per pair, and the driver's last.
    """

    def __init__(self, scene: Scene) -> None:
        self.scene = scene
        self.assembly = Assembly(scene)
        self.bodies, self.at = self.assembly.bodies, self.assembly.at
        self.size = 3 * len(self.bodies)
        equations = self.assembly.joints.count + 1
        if equations != self.size:
            raise CrankcheckError(
                f"{scene.name}: {equations} constraint equations for {self.size} coordinates; "
                "a mechanism of mobility 1 has as many of each"
            )

    def motion(self, time_s: Array, q: Array, rates: Array, seconds: Array) -> Motion:
        """All links, points and sliders at coordinates with their rates and seconds, (T, 3 n)."""
        return as_motion(self.assembly, time_s, self.assembly.at_rates(q, rates), seconds)

    def _driver(self, q: Array, rates: Array) -> Course:
        """The driver's coordinate at coordinates and rates (T, 3 n) without second rates."""
        motion = self.motion(np.zeros(len(q)), q, rates, np.zeros_like(q))
        return driver_course(self.scene, motion)

    def phi(self, q: Array, theta: float) -> Array:
        """The violation of each equation [m or rad] at the driver's coordinate ``theta`` [rad or
        m]; the angle of two moving links counts but for whole turns."""
        rows = self.assembly.joints.gaps(self.assembly.at_rest(q[None]))[0]
        driver, off = self.scene.driver, float(self._driver(q[None], 0.0 * q[None])[0][0]) - theta
        turns = driver.slider is None and driver.base != GROUND
        return np.append(rows, math.remainder(off, math.tau) if turns else off)

    def jacobian(self, q: Array) -> Array:
        """Phi_q (3 n, 3 n); the driver's row has its rates by those of one coordinate each."""
        rows = self.assembly.joints.jacobian(self.assembly.at_rest(q[None]))[0]
        each = np.eye(self.size)
        return np.vstack([rows, self._driver(q + 0.0 * each, each)[1]])

    def gamma(self, q: Array, rates: Array, alpha: float) -> Array:
        """The right side of the acceleration equations: what q'' has to balance (3 n,)."""
        now = self.assembly.at_rates(q[None], rates[None])
        pull = float(self._driver(q[None], rates[None])[2][0])
        return np.append(self.assembly.joints.gamma(now)[0], alpha - pull)
