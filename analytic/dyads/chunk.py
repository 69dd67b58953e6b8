"""A chunk of samples while its groups are solved one after the other."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from typing import Protocol

import numpy as np

from analytic.dyads import plane
from analytic.dyads.parts import Closure, Dyad, First, MovingLine, Second, SlideError, Sliding
from analytic.dyads.plane import EPS, BodyKinematics, PointKinematics, Real
from models.array import Array
from models.scene import GROUND, Point, Scene, span
from models.scene.joints import local_point, sliding_angle


class Passage(Protocol):
    """Change points that a dyad goes through (`analytic.change_points.sign`)."""

    @property
    def period(self) -> float:
        """Driver angle after which the signs repeat [rad]."""

    def sign(self, theta: Array) -> Array:
        """Return the factor of the scene's branch at driver angles [rad], (T,)."""

    def mend(self, chunk: Chunk, dyad: Dyad[First, Second]) -> Dyad[First, Second]:
        """Restore the lost values of a dyad in and beside its change points. Raises OpenError."""


@dataclass(frozen=True, slots=True)
class DrivenCoordinate:
    """Driver's angle, rate and acceleration in the units of the reference (`driver_scale`), and
    their bounds if required."""

    theta: Array
    omega: Real
    alpha: Real
    error: plane.AngleError | None

    def sliding(self, scale_m: float) -> Sliding:
        """Return the displacement of a driven slider."""
        error = None
        if self.error is not None:
            error = SlideError(*(bound * scale_m for bound in self.error))
        return Sliding(self.theta * scale_m, self.omega * scale_m, self.alpha * scale_m, error)


@dataclass(slots=True)
class Chunk:
    """Known part of a chunk of samples; ``passages`` by the key of the dyad, and ``roots`` where
    these are known beforehand."""

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
        error: plane.AngleError | None = None,
        *,
        stretch: bool = False,
        passages: Mapping[str, Passage] | None = None,
        roots: Mapping[str, Real] | None = None,
    ) -> Chunk:
        """Return a chunk with the ground and the body driven against it; certified with
        ``error``."""
        certified = error is not None
        if error is not None and scene.driver.slider is None:
            error = error._replace(theta=error.theta + SINES)
        driver = DrivenCoordinate(theta, omega, alpha, error)
        bodies = {GROUND: plane.fixed_body(certified=certified)}
        chunk = Chunk(scene, certified, stretch, bodies, driver, passages or {}, roots=roots or {})
        chunk._place_driver()
        return chunk

    def _place_driver(self) -> None:
        """Add the body that is driven against the ground; two that are driven against each other
        wait for their group."""
        driver, link, own = self.scene.driver, self.scene.driver.link, self.driver
        if driver.is_inner:
            return
        if driver.slider is not None:
            self.sliders[driver.slider] = found = own.sliding(driver_scale(self.scene))
            self.bodies[link] = sliding_driver(self.scene, found)
            return
        pivot = self.scene.driver_pivot
        self.points[pivot] = anchor = plane.fixed_point(self.scene.ground[pivot])
        local, theta = self.scene.links[link].points[pivot], own.theta
        turn = plane.Vec(np.cos(theta), np.sin(theta))
        self.bodies[link] = BodyKinematics(
            local, anchor, turn, own.omega, own.alpha, own.error, theta
        )

    @property
    def theta(self) -> Array:
        """Driver's angles [rad], (T,)."""
        return self.driver.theta

    def point(self, body: str, name: str) -> PointKinematics:
        """Return a named point by way of ``body``, computed once."""
        if name not in self.points:
            local = local_point(self.scene, body, name)
            self.points[name] = (
                plane.fixed_point(local) if body == GROUND else self.bodies[body].point(local)
            )
        return self.points[name]

    def closed(
        self,
        key: str,
        solve: Callable[..., Dyad[First, Second]],
        *geometry: PointKinematics | MovingLine | float,
        side: int = 1,
    ) -> Dyad[First, Second]:
        """Return a dyad of two assemblies on the scene's branch, times ``side``.

        In a change point it may be open by rounding, which `keep` corrects.
        """
        branch: Real = self.scene.branch.get(key, 1) * side
        stretch = self.stretch
        if key in self.passages:
            branch, stretch = branch * self.passages[key].sign(self.theta), True
        root = self.roots.get(key)
        free = solve(*geometry, branch, certified=self.certified, stretch=stretch, root=root)
        return self.keep(key, free)

    def keep(self, key: str, dyad: Dyad[First, Second]) -> Dyad[First, Second]:
        """Return the solved dyad, corrected in its change points, and note its conditioning."""
        passage = self.passages.get(key)
        if passage is not None:
            dyad = passage.mend(self, dyad)
        self.sines[key] = dyad.sine
        if dyad.closure.short_m is not None:  # else it is not needed, and its memory is used again
            self.closures[key], self.shortage[key] = dyad.closure, dyad.closure.short_m
        return dyad


SINES = 2 * EPS
"""Error of the driver's direction by rounding of sine and cosine [rad]."""


def driver_scale(scene: Scene) -> float:
    """Return the driver's coordinate over the reference's driver angle: 1 for a pin; for a slider a
    power of two [m], more than a third of all lengths of the scene together.

    The reference has one driver's angle psi [rad] throughout. For a pin it is the coordinate
    itself. For a slider it is the displacement over a scale, s = scale psi, so large that the
    mechanism closes only within half a turn of 0, and a power of two, so that nothing is rounded:
    the search over a turn of a crank (limit positions, change points, whole turns) covers all
    places of a slider.
    """
    if scene.driver.slider is None:
        return 1.0
    lengths = [span(link.points) for link in scene.links.values()]
    lengths += [math.hypot(*place) for place in scene.ground.values()]
    lengths += [math.hypot(*slider.through_m) for slider in scene.sliders.values()]
    start = abs(float(scene.driver.law.at(np.zeros(1))[0][0]))
    return float(2.0 ** math.ceil(math.log2((2.0 * sum(lengths) + start) / math.pi)))


def told(scene: Scene, theta: float) -> str:
    """Return a driver angle of the reference in words: degrees, or metres of a driven slider."""
    if scene.driver.slider is not None:
        return f"{theta * driver_scale(scene):.6g} m"
    return f"{math.degrees(theta):.6g} deg"


def sliding_driver(scene: Scene, found: Sliding) -> BodyKinematics:
    """Return a body at a displacement along a line of the ground."""
    driver = scene.driver
    assert driver.slider is not None
    slider = scene.sliders[driver.slider]
    along = plane.direction(slider.direction_rad)
    anchor = PointKinematics(
        along * found.s + plane.Vec(*slider.through_m),
        along * found.speed,
        along * found.acceleration,
        None,
    )
    angle = sliding_angle(slider)
    own = None
    if found.error is not None:
        leaning = plane.rounding_of_angles(slider.direction_rad) + 2 * EPS
        anchor = replace(anchor, error=_along_line(slider.through_m, found, leaning))
        own = plane.EXACT_ANGLE._replace(
            theta=plane.rounding_of_angles(slider.direction_rad, slider.angle_rad)
        )
    local = local_point(scene, driver.link, slider.point)
    return BodyKinematics(local, anchor, plane.direction(angle), 0.0, plane.STEADY, own, angle)


def _along_line(base: Point, found: Sliding, leaning: float) -> plane.PointError:
    """Return bounds of a point on a ground line with a direction error of ``leaning``."""
    assert found.error is not None
    e, way = found.error, np.abs(found.s)
    return plane.PointError(
        e.displacement + leaning * way + EPS * (way + math.hypot(*base)),
        e.speed + (leaning + EPS) * np.abs(found.speed),
        e.acceleration + (leaning + EPS) * np.abs(found.acceleration),
    )
