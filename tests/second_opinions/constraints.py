"""The constraint equations of a driven mechanism: those of its joints, and the driver's.

Nothing here knows of dyads. Every body has coordinates (x, y, theta) of its frame; every pin, every
prismatic pair and the driver gives its equations. Source: E. J. Haug, Computer Aided Kinematics and
Dynamics of Mechanical Systems, chapters 3 and 4.
"""

from collections.abc import Iterator

import numpy as np

from analytic.multibody.assembly import Assembly
from models.array import Array
from models.errors import CrankcheckError
from models.scene import Point, Scene, Slider
from models.scene.joints import local_point, sliding_body
from tests.second_opinions.driver_row import DriverRow


class Constraints:
    """The constraint equations of a scene, as functions of the coordinates of its bodies.

    Coordinates q (3 n,): x, y [m], theta [rad] of each body in the order of ``bodies``. Equations
    (3 n,): two per pair, and the driver's last.
    """

    def __init__(self, scene: Scene) -> None:
        self.scene = scene
        self._assembly = Assembly(scene)
        self.bodies, self.at = self._assembly.bodies, self._assembly.at
        self.size = 3 * len(self.bodies)
        self._driver = DriverRow(scene, dict(self.at))
        equations = self._assembly.joints.count + 1
        if equations != self.size:
            raise CrankcheckError(
                f"{scene.name}: {equations} constraint equations for {self.size} coordinates; "
                "a mechanism of mobility 1 has as many of each"
            )

    def pin_pairs(self) -> Iterator[tuple[str, str, str]]:
        """The point and the two bodies of every two equations of pins, in the order of ``phi``."""
        return self._assembly.joints.pin_pairs()

    def tip(self, slider: Slider) -> tuple[str, Point]:
        """The body that slides and the place of its point on the line."""
        body = sliding_body(slider)
        return body, local_point(self.scene, body, slider.point)

    def phi(self, q: Array, theta: float) -> Array:
        """The violation of each equation [m or rad] at the driver's coordinate ``theta`` [rad or
        m]."""
        rows = self._assembly.joints.gaps(self._assembly.at_rest(q[None]))[0]
        return np.append(rows, self._driver.off(q, theta))

    def jacobian(self, q: Array) -> Array:
        """Phi_q (3 n, 3 n)."""
        rows = np.zeros((self.size, self.size))
        rows[:-1] = self._assembly.joints.jacobian(self._assembly.at_rest(q[None]))[0]
        rows[-1] = self._driver.gradient(q)
        return rows

    def gamma(self, q: Array, rates: Array, alpha: float) -> Array:
        """The right side of the acceleration equations: what q'' has to balance (3 n,)."""
        now = self._assembly.at_rates(q[None], rates[None])
        pull = self._driver.quadratic(q, rates)
        return np.append(self._assembly.joints.gamma(now)[0], alpha - pull)
