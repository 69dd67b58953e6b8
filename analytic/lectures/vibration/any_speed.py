"""The linearised equations of one mechanism at any speed of its driver.

At the same angles of the driver M does not change with its speed, C and K and h are polynomials of
it, of the second degree where no load depends on speeds otherwise. So the equations at hundreds of
speeds follow from those at three, which is looked at in a fourth.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from analytic.elastic.discretisation import Discretisation
from analytic.elastic.elastic_motion import DrivenElasticMotion
from analytic.elastic.periodic import FIRST, LinearForm, check_periodic, instants, linearise
from analytic.elastic.reduced import ReducedForm
from models.array import Array
from models.errors import CrankcheckError
from models.laws import ConstantSpeed
from models.scene import Scene

INSTANTS = 65
"""Of a turn: orders up to half as many are told apart."""
SAME = 1e-6
"""What the polynomials may be off at a speed that they were not made of, over the largest entry."""
PARTS = ("mass", "damping", "stiffness", "force")


def at_speed(scene: Scene, speed_rad_s: float) -> Scene:
    """The scene with its driver at another speed, the way round that it has.

    Raises
    ------
    CrankcheckError
        The scene is not driven at a constant speed.
    """
    law = scene.driver.law
    if not isinstance(law, ConstantSpeed):
        raise CrankcheckError(
            f"{scene.name}: vibration over speeds is that of a driver at a constant one; found "
            'another law of motion: use [driver] law = "constant", with speed_rad_s'
        )
    speed = math.copysign(speed_rad_s, law.speed_rad_s)
    return replace(scene, driver=replace(scene.driver, law=replace(law, speed_rad_s=speed)))


@dataclass(frozen=True)
class AnySpeed:
    """A scene with elastic links at speeds from ``slowest`` to ``fastest`` [rad/s], both above
    0."""

    scene: Scene
    by: Discretisation
    slowest: float
    fastest: float
    stiffened: bool = True

    def form(self, speed_rad_s: float) -> ReducedForm:
        """The equations of motion at a speed."""
        scene = at_speed(self.scene, speed_rad_s)
        return DrivenElasticMotion(scene, 1.0, self.by, "periodic", self.stiffened).form

    def linear(self, speed_rad_s: float) -> LinearForm:
        """The linearised equations at a speed."""
        if self._series is None:
            return self._direct(speed_rad_s)
        return self._summed(self._series, speed_rad_s)

    def still(self) -> tuple[Array, Array]:
        """M and K (N, m, m) with the driver held still at the same angles: without what its turning
        adds."""
        some = self.linear(self.slowest)
        if self._series is not None:
            return some.mass, self._series["stiffness"][0]
        return some.mass, np.broadcast_to(self.form(self.slowest).stiffness, some.mass.shape)

    @cached_property
    def _series(self) -> Mapping[str, Array] | None:
        """Coefficients of the polynomials (3, N, ...), or None where they are none."""
        low, high = self.slowest, self.fastest
        if high - low < 0.2 * high:  # too near each other to make polynomials of
            low, high = 0.8 * high, 1.2 * high
        speeds = np.linspace(low, high, 3)
        forms = [self._direct(speed) for speed in speeds]
        inverse = np.linalg.inv(np.vander(speeds / high, 3, increasing=True))
        to_powers = (high ** -np.arange(3.0))[:, None] * inverse
        series = {
            part: np.tensordot(to_powers, np.stack([vars(each)[part] for each in forms]), 1)
            for part in PARTS
        }
        between = low + 0.3 * (high - low)
        off = apart(self._summed(series, between), self._direct(between))
        return None if off > SAME else series

    def _direct(self, speed: float) -> LinearForm:
        form = self.form(speed)
        check_periodic(form)
        time_s = instants(INSTANTS, form.period_s)
        return linearise(form, time_s, FIRST * self.scene.longest_m)

    def _summed(self, series: Mapping[str, Array], speed: float) -> LinearForm:
        powers = speed ** np.arange(3.0)
        parts = {part: np.tensordot(powers, series[part], 1) for part in PARTS}
        return LinearForm(instants(INSTANTS, math.tau / speed), **parts)


def apart(one: LinearForm, other: LinearForm) -> float:
    """What linearised equations differ by, each part over its largest entry; damping over what
    would be critical where it is but rounding."""
    largest = {part: float(np.abs(vars(other)[part]).max()) for part in PARTS}
    critical = math.sqrt(largest["mass"] * largest["stiffness"])
    largest["damping"] = max(largest["damping"], 1e-3 * critical)
    return max(
        float(np.abs(vars(one)[part] - vars(other)[part]).max()) / (largest[part] or 1.0)
        for part in PARTS
    )
