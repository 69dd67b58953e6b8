"""A chunk of samples while its groups are solved one after the other."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Protocol

from analytic.dyads.driven import SINES, driver_scale, sliding_driver, turning_driver
from analytic.dyads.parts import Closure, Dyad, First, Second, SlideError, Sliding
from analytic.dyads.plane import (
    AngleError,
    BodyKinematics,
    PointKinematics,
    Real,
    fixed_body,
    fixed_point,
)
from models.array import Array
from models.joints import local_point
from models.scene import GROUND, Scene


class Passage(Protocol):
    """The change points that a dyad goes through (`analytic.change_points.sign`)."""

    def sign(self, theta: Array) -> Array:
        """What the branch of the scene is multiplied by at driver angles [rad], (T,)."""
        ...

    def mend(self, chunk: Chunk, dyad: Dyad[First, Second]) -> Dyad[First, Second]:
        """The dyad without what is lost in and beside its change points. Raises OpenError."""
        ...


@dataclass(frozen=True, slots=True)
class DrivenCoordinate:
    """The driver's angle, rate and acceleration as the reference has them (`driver_scale`), and
    their bounds if asked for."""

    theta: Array
    omega: Real
    alpha: Real
    error: AngleError | None

    def sliding(self, scale_m: float) -> Sliding:
        """The displacement of a slider that is driven."""
        e, error = self.error, None
        if e is not None:
            error = SlideError(e.theta * scale_m, e.omega * scale_m, e.alpha * scale_m)
        return Sliding(self.theta * scale_m, self.omega * scale_m, self.alpha * scale_m, error)


@dataclass(slots=True)
class Chunk:
    """What is known so far of a chunk of samples; ``passages`` by the key of the dyad, and
    ``roots`` where these are known beforehand."""

    scene: Scene
    certified: bool
    stretch: bool
    bodies: dict[str, BodyKinematics]
    driver: DrivenCoordinate
    passages: Mapping[str, Passage] = field(default_factory=dict)
    sliders: dict[str, Sliding] = field(default_factory=dict)
    sines: dict[str, Real] = field(default_factory=dict)
    shortage: dict[str, Real] = field(default_factory=dict)
    closures: dict[str, Closure] = field(default_factory=dict)
    points: dict[str, PointKinematics] = field(default_factory=dict)
    roots: Mapping[str, Real] = field(default_factory=dict)

    @staticmethod
    def begin(
        scene: Scene,
        theta: Array,
        omega: Real,
        alpha: Real,
        error: AngleError | None = None,
        *,
        stretch: bool = False,
        passages: Mapping[str, Passage] | None = None,
        roots: Mapping[str, Real] | None = None,
    ) -> Chunk:
        """A chunk in which the ground and what the driver moves against it are known; certified
        where ``error`` is."""
        certified = error is not None
        if error is not None and scene.driver.slider is None:
            error = replace(error, theta=error.theta + SINES)
        driver = DrivenCoordinate(theta, omega, alpha, error)
        bodies = {GROUND: fixed_body(certified=certified)}
        chunk = Chunk(scene, certified, stretch, bodies, driver, passages or {}, roots=roots or {})
        chunk._place_driver()
        return chunk

    def _place_driver(self) -> None:
        """Add the body that is driven against the ground; two that are driven against each other
        wait for the group that they are in."""
        driver, link, own = self.scene.driver, self.scene.driver.link, self.driver
        if driver.is_inner:
            return
        if driver.slider is not None:
            self.sliders[driver.slider] = found = own.sliding(driver_scale(self.scene))
            self.bodies[link] = sliding_driver(self.scene, found)
            return
        pivot = self.scene.driver_pivot
        self.bodies[link] = turning_driver(
            self.scene, pivot, own.theta, own.omega, own.alpha, own.error
        )
        self.points[pivot] = self.bodies[link].anchor

    @property
    def theta(self) -> Array:
        """The driver's angles [rad], (T,)."""
        return self.driver.theta

    def point(self, body: str, name: str) -> PointKinematics:
        """A named point by way of ``body``, worked out once."""
        if name not in self.points:
            local = local_point(self.scene, body, name)
            self.points[name] = (
                fixed_point(local) if body == GROUND else self.bodies[body].point(local)
            )
        return self.points[name]

    def assembly(self, key: str) -> tuple[Real, bool]:
        """The branch of a dyad at every sample, and whether it is stretched where it is open.

        In a change point it may be open by rounding, which is mended afterwards.
        """
        branch, passage = self.scene.branch.get(key, 1), self.passages.get(key)
        if passage is None:
            return branch, self.stretch
        return branch * passage.sign(self.theta), True

    def keep(self, key: str, dyad: Dyad[First, Second]) -> Dyad[First, Second]:
        """The solved dyad, mended in its change points, after noting how it is conditioned."""
        passage = self.passages.get(key)
        if passage is not None:
            dyad = passage.mend(self, dyad)
        self.sines[key] = dyad.sine
        if dyad.closure.short_m is not None:  # else nobody asks, and its memory is used again
            self.closures[key], self.shortage[key] = dyad.closure, dyad.closure.short_m
        return dyad
