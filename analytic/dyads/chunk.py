"""A chunk of samples while its groups are solved one after the other."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Protocol

import numpy as np

from analytic.dyads.parts import Closure, Dyad, First, Second, Sliding
from analytic.dyads.plane import (
    EPS,
    AngleError,
    BodyKinematics,
    PointKinematics,
    Real,
    Vec,
    fixed_body,
    fixed_point,
)
from models.array import Array
from models.joints import local_point
from models.scene import GROUND, Scene

SINES = 2 * EPS
"""What the driver's direction is off by for the rounding of sine and cosine [rad]."""


class Passage(Protocol):
    """The change points that a dyad goes through (`analytic.change_points.sign`)."""

    def sign(self, theta: Array) -> Array:
        """What the branch of the scene is multiplied by at driver angles [rad], (T,)."""
        ...

    def mend(self, chunk: Chunk, dyad: Dyad[First, Second]) -> Dyad[First, Second]:
        """The dyad without what is lost in and beside its change points. Raises OpenError."""
        ...


@dataclass(slots=True)
class Chunk:
    """What is known so far of a chunk of samples; ``passages`` by the key of the dyad, and
    ``roots`` where these are known beforehand."""

    scene: Scene
    certified: bool
    stretch: bool
    bodies: dict[str, BodyKinematics]
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
        """A chunk in which the ground and the driver are known; certified where ``error`` is."""
        pivot = scene.driver_pivot
        local = scene.links[scene.driver.link].points[pivot]
        anchor = fixed_point(scene.ground[pivot])
        if error is not None:
            error = replace(error, theta=error.theta + SINES)
        driver = BodyKinematics(
            local, anchor, Vec(np.cos(theta), np.sin(theta)), omega, alpha, error, theta
        )
        certified = error is not None
        bodies = {GROUND: fixed_body(certified=certified), scene.driver.link: driver}
        chunk = Chunk(scene, certified, stretch, bodies, passages or {}, roots=roots or {})
        chunk.points[pivot] = anchor
        return chunk

    @property
    def driver(self) -> BodyKinematics:
        return self.bodies[self.scene.driver.link]

    @property
    def theta(self) -> Array:
        """The driver's angles [rad], (T,)."""
        theta = self.driver.theta
        assert theta is not None
        return np.asarray(theta)

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
