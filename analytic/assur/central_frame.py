"""The frame of a triad's central link, which may be two bodies that the driver moves.

The frame of a `Compound` is that of its base. Points and directions of the other body follow the
driver's coordinate q: turned by q about the driven pin, or shifted by it along the line.
"""

import math
from dataclasses import dataclass, replace

import numpy as np

from analytic.assur.sampled_rows import LocalPoint
from analytic.dyads.chunk import SINES, Chunk, driver_scale
from analytic.dyads.plane import (
    EPS,
    EXACT_ANGLE,
    AngleError,
    BodyKinematics,
    PointError,
    Real,
    Vec,
    direction,
    rounding_of_angles,
)
from analytic.structure.groups import Compound
from models.scene import Point, Scene
from models.scene.joints import less, local_point, sliding_angle


@dataclass(frozen=True, slots=True)
class Leaning:
    """Direction in the frame: a unit vector, its rotation there, and bounds."""

    along: Vec
    omega: Real = 0.0
    alpha: Real = 0.0
    error: AngleError = EXACT_ANGLE


@dataclass(frozen=True)
class CentralFrame:
    """Frame of ``body``, with its anchor at ``origin`` [m] in it."""

    scene: Scene
    body: str
    origin: Point
    compound: Compound | None = None

    @property
    def bodies(self) -> tuple[str, ...]:
        """Bodies of the one link."""
        return (self.body,) if self.compound is None else (self.compound.base, self.compound.link)

    def leaning(self, chunk: Chunk, part: str, angle_rad: float) -> Leaning:
        """Return a direction at a constant angle in the frame of one of the bodies."""
        along, rounding = direction(angle_rad), rounding_of_angles(angle_rad)
        error = replace(EXACT_ANGLE, theta=rounding)
        if part == self.body:
            return Leaning(along, error=error)
        by = self._between(chunk)
        total = AngleError(by.error.theta + rounding, by.error.omega, by.error.alpha)
        return Leaning(along.turned(by.along), by.omega, by.alpha, total)

    def _between(self, chunk: Chunk) -> Leaning:
        """Return the x-axis of the other body."""
        assert self.compound is not None
        if self.compound.slider is not None:
            slider = self.scene.sliders[self.compound.slider]
            angle = sliding_angle(slider)
            rounding = rounding_of_angles(slider.direction_rad, slider.angle_rad)
            return Leaning(direction(angle), error=replace(EXACT_ANGLE, theta=rounding))
        q = chunk.driver
        along = Vec(np.cos(q.theta), np.sin(q.theta))
        return Leaning(along, q.omega, q.alpha, q.error or EXACT_ANGLE)

    def local(self, chunk: Chunk, part: str, place: Point) -> LocalPoint:
        """Return a point of one of the bodies, given in its own frame, from the anchor."""
        if part == self.body:
            return LocalPoint.at(less(place, self.origin))
        assert self.compound is not None
        if self.compound.pin is not None:
            return self._about_pin(chunk, place, self.compound.pin)
        return self._along_line(chunk, place)

    def _about_pin(self, chunk: Chunk, place: Point, pin: str) -> LocalPoint:
        assert self.compound is not None
        base = less(local_point(self.scene, self.compound.base, pin), self.origin)
        arm = less(place, local_point(self.scene, self.compound.link, pin))
        by = self._between(chunk)
        reach = Vec(*arm).turned(by.along)
        r, w, g, e = math.hypot(*arm), by.omega, by.alpha, by.error
        ww = np.abs(w) + e.omega
        error = PointError(
            r * (e.theta + 3 * EPS) + EPS * math.hypot(*base),
            r * (e.omega + ww * e.theta + 4 * EPS * np.abs(w)),
            r
            * (
                e.alpha + e.omega * 2.0 * ww + (np.abs(g) + e.alpha + ww * ww) * (e.theta + 5 * EPS)
            ),
        )
        return LocalPoint(
            reach + Vec(*base), reach.perp(w), reach.perp(g) + reach * -(w * w), error, True
        )

    def _along_line(self, chunk: Chunk, place: Point) -> LocalPoint:
        assert self.compound is not None
        assert self.compound.slider is not None
        slider = self.scene.sliders[self.compound.slider]
        q = chunk.driver.sliding(driver_scale(self.scene))
        arm = less(place, local_point(self.scene, self.compound.link, slider.point))
        by, along = self._between(chunk), direction(slider.direction_rad)
        reach = Vec(*arm).turned(by.along) + Vec(*less(slider.through_m, self.origin))
        lean = rounding_of_angles(slider.direction_rad) + 3 * EPS
        size = math.hypot(*arm) + math.hypot(*less(slider.through_m, self.origin))
        ends = (q.s, q.speed, q.acceleration)
        p, v, a = (along * one for one in ends)
        off = [lean * np.abs(one) for one in ends]
        off[0] = off[0] + (by.error.theta + 3 * EPS) * size
        if q.error is not None:
            own = (q.error.displacement, q.error.speed, q.error.acceleration)
            off = [one + more for one, more in zip(off, own, strict=True)]
        return LocalPoint(reach + p, v, a, PointError(*off), True)

    def place(self, chunk: Chunk, body: BodyKinematics) -> None:
        """Add the bodies of the solved link, and its driven slider, to the chunk."""
        chunk.bodies[self.body] = replace(body, local=self.origin)
        compound = self.compound
        if compound is None:
            return
        by = self._between(chunk)
        joint = compound.pin
        if compound.slider is not None:
            joint = self.scene.sliders[compound.slider].point
            chunk.sliders[compound.slider] = chunk.driver.sliding(driver_scale(self.scene))
        assert joint is not None
        own = local_point(self.scene, compound.link, joint)
        anchor = self.local(chunk, compound.link, own).on(body)
        error = body.error
        if error is not None:
            e = by.error
            error = AngleError(
                error.theta + e.theta + SINES, error.omega + e.omega, error.alpha + e.alpha
            )
        turn = body.turn.turned(by.along)
        omega, alpha = body.omega + by.omega, body.alpha + by.alpha
        chunk.bodies[compound.link] = BodyKinematics(own, anchor, turn, omega, alpha, error)
