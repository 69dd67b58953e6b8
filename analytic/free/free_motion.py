"""Interface of the free motion of a mechanism, whichever integration it comes from."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Protocol

import numpy as np

from analytic.kinematics import in_assembly, solve
from analytic.multibody.bodies import EnergyBalance
from models.array import Array
from models.errors import CrankcheckError
from models.motion import Motion
from models.scene import Driver, Scene
from models.scene.driver import Released, let_go
from models.scene.laws import ConstantSpeed, Law


@dataclass(frozen=True)
class LimitPassage:
    """Limit of the driver's angle that the motion goes through: there the driver turns back, and
    the dyad of the inner joint ``dyad`` passes into its other assembly."""

    time_s: float
    dyad: str
    driver_rad: float


class FreeMotion(Protocol):
    """Free motion of a scene from its release at time 0 to ``until_s``.

    ``passages`` are the limit positions on the way, ``edges_s`` the instants at which the forces
    are not smooth. ``freedoms`` is its mobility; ``by_dyads`` says that this is 1 and its positions
    have a closed form: then the driver's angle and the branch determine the position.
    """

    @property
    def scene(self) -> Scene: ...

    @property
    def until_s(self) -> float: ...

    @property
    def passages(self) -> Sequence[LimitPassage]: ...

    @property
    def edges_s(self) -> Sequence[float]: ...

    @property
    def freedoms(self) -> int: ...

    @property
    def by_dyads(self) -> bool: ...

    @property
    def driver_tells(self) -> bool:
        """True if the driver's angle alone determines the position, all along the motion."""

    @property
    def peak_speed_rad_s(self) -> float:
        """The largest angular velocity of the driver; with several freedoms of any link."""

    @property
    def range_rad(self) -> float:
        """Range of the driver's angle, from its smallest to its largest."""

    @property
    def law(self) -> IntegratedLaw:
        """The driver's motion as a law."""

    def at(self, time_s: Array, *, bound: bool = True) -> Motion:
        """Return the motion at times [s], (T,), from 0 to ``until_s``; bounds include the error of
        the integration. Raises CrankcheckError for times beyond."""

    def outside(self, time_s: Array, *, bound: bool = True) -> Motion:
        """Return the motion that leads to the start, at times below 0 [s], (T,), or that goes on
        from the end, at times above ``until_s``: within a step of it, where some engines have the
        velocities of their first or last sample."""

    def with_forces(self, motion: Motion, *, bound: bool = True) -> Motion:
        """Return a motion of `at` with the forces in its joints; they are NaN in dead points."""

    def beside(self, logged: Motion) -> Motion:
        """Return the positions of the mechanism, without rates and bounds, next to a run of this
        scene at each of its instants, whatever time the true motion has them at."""

    def energy(self, time_s: Array) -> EnergyBalance:
        """Return the energies at times [s], (T,). Raises CrankcheckError for times beyond."""

    def sensitivity(self, time_s: Array) -> Array:
        """Return G (T,): the largest growth of a small change of the start by then, at least 1."""

    def error_rad(self, time_s: Array) -> Array:
        """Error of the driver's angle [rad], (T,); with several freedoms, of any link."""


@dataclass(frozen=True, eq=False)
class IntegratedLaw(Law):
    """Motion of a free driver from ``start_s`` to ``end_s``: ``history`` has its angle [rad], rate
    [rad/s] and acceleration [rad/s^2] at times [s]."""

    history: Callable[[Array], tuple[Array, Array, Array]]
    start_s: float
    end_s: float
    peak_rad_s: float
    ahead_rad: float = 0.0

    def __post_init__(self) -> None:  # a history is no number
        assert np.isfinite([self.start_s, self.end_s, self.peak_rad_s]).all()

    @property
    def offset_rad(self) -> float:
        return abs(float(self.history(np.array([self.start_s]))[0][0]))

    @property
    def period_s(self) -> float:
        return self.end_s - self.start_s

    @property
    def peak_speed_rad_s(self) -> float:
        return self.peak_rad_s

    def at(self, time_s: Array) -> tuple[Array, Array, Array]:
        theta, omega, alpha = self.history(time_s)
        return theta + self.ahead_rad, omega, alpha

    def turned(self, angle_rad: float) -> IntegratedLaw:
        return replace(self, ahead_rad=self.ahead_rad + angle_rad)


STILL = 1e-9
"""Rate over that of the fastest link, below which a link is at rest at the start."""


def loosened(scene: Scene, duration_s: float | None = None) -> Scene:
    """Return the scene released, as by `models.scene.driver.let_go`, whatever joint its driver is.

    Raises
    ------
    CrankcheckError
        No link at the ground can lead: none has groups that are solved, or moves at the start.

    Any link may lead a free motion. A crank keeps its own angle; a slider, or the pin of two moving
    links, is replaced by a link at the ground, at its angle and speed of the start, in the assembly
    of the start.
    """
    free = let_go(scene, duration_s)
    if scene.driver.is_crank:
        return free
    start = solve(scene, np.zeros(1), bound=False)
    law = free.driver.law
    assert isinstance(law, Released)
    for link in _by_speed(scene, start):
        theta, omega = (float(s[0]) for s in (start.links[link].theta, start.links[link].omega))
        told = Driver(link, ConstantSpeed(theta, 1.0))
        held = in_assembly(replace(scene, driver=told), start)
        if held is not None:
            told = Driver(link, Released(theta, omega, law.duration_s))
            return replace(held, driver=told, start=free.start)
    raise CrankcheckError(
        f"{scene.name}: it is driven at {scene.driver.joint}, which is not a link pinned to the "
        "ground: free motion needs one as its coordinate; drive it at a link"
    )


def _by_speed(scene: Scene, start: Motion) -> list[str]:
    """Return the links that are pinned to the ground, the fastest first: a link near a limit of its
    own determines the others badly."""
    speeds = {
        name: abs(float(start.links[name].omega[0]))
        for name, link in scene.links.items()
        if any(point in scene.ground for point in link.points)
    }
    most = max((abs(float(m.omega[0])) for m in start.links.values()), default=0.0)
    moving = [name for name, speed in speeds.items() if speed > STILL * most]
    return sorted(moving or speeds, key=lambda name: -speeds[name])
