"""The motion of a mechanism that was let go: a high-precision integration, and no closed form."""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np

from analytic.free.integrated_law import IntegratedLaw
from analytic.kinematics import solve, solve_driven
from models.array import Array
from models.errors import CrankcheckError
from models.motion import Motion
from models.samples import samples
from models.scene import Driver, Scene


@dataclass(frozen=True)
class LimitPassage:
    """A limit of the driver's angle that the motion goes through: there the driver turns back, and
    the dyad of the inner joint ``dyad`` passes into its other assembly."""

    time_s: float
    dyad: str
    driver_rad: float


@dataclass(frozen=True)
class FreeMotion:
    """What a scene does from time 0, when it is let go, to ``until_s``.

    ``passages`` are the limit positions on the way, ``edges_s`` the instants at which what acts is
    not smooth.
    """

    scene: Scene
    until_s: float
    law: IntegratedLaw
    growth: tuple[Array, Array]
    off_rad: tuple[Array, Array]
    passages: tuple[LimitPassage, ...] = ()
    edges_s: tuple[float, ...] = ()
    _driven: Scene = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        driver = Driver(self.scene.driver.link, self.law)
        object.__setattr__(self, "_driven", replace(self.scene, driver=driver))

    @property
    def peak_speed_rad_s(self) -> float:
        """The largest angular velocity of the driver."""
        return self.law.peak_rad_s

    def at(self, time_s: Array, *, bound: bool = True) -> Motion:
        """The motion at times [s], (T,), from 0 to ``until_s``; bounds hold what the integration
        may be off by as well. Raises CrankcheckError for times beyond."""
        instants = samples(time_s, "time_s")
        self._check_within(instants)
        return solve(self._driven, instants, bound=bound)

    def beside(self, logged: Motion) -> Motion:
        """The reference, without rates and bounds, in the position that a run of this scene has at
        each of its instants: at the angle that it logged for the coordinate of that time, in the
        assembly of then."""
        theta = logged.links[self.scene.driver.link].theta
        still = np.zeros_like(theta)
        return solve_driven(self._driven, theta, still, still, logged.time_s, bound=False)

    def sensitivity(self, time_s: Array) -> Array:
        """G (T,): by how much a small change of the start has grown by then at most, at least 1."""
        return np.interp(time_s, *self.growth)

    def error_rad(self, time_s: Array) -> Array:
        """What the driver's angle may be off by [rad], (T,)."""
        return np.interp(time_s, *self.off_rad)

    def _check_within(self, time_s: Array) -> None:
        if time_s.min() < 0.0 or time_s.max() > self.until_s * (1.0 + 1e-12):
            raise CrankcheckError(
                f"{self.scene.name}: times from {time_s.min():g} to {time_s.max():g} s; it was let "
                f"go at 0, and integrated up to {self.until_s:g} s"
            )
