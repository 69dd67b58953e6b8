"""The frame of a triad's central link, which may be two bodies that the driver moves.

The frame of a `Compound` is that of its base. Points and directions of the other body follow the
driver's coordinate q: turned by q about the driven pin, or shifted by it along the line.
"""

import math
import operator
from dataclasses import dataclass, replace

import numpy as np

from analytic.assur.sampled_rows import LocalPoint
from analytic.dyads import plane
from analytic.dyads.chunk import SINES, Chunk, driver_scale
from analytic.dyads.plane import EPS, EXACT_ANGLE, Vec, direction, rounding_of_angles
from analytic.structure.groups import Compound
from models.scene import Point, Scene, Slider
from models.scene.joints import less, local_point, sliding_angle


@dataclass(frozen=True, slots=True)
class Leaning:
    """Direction in the frame: a unit vector, its rotation there, and bounds."""

    along: Vec
    omega: plane.Real = 0.0
    alpha: plane.Real = 0.0
    error: plane.AngleError = EXACT_ANGLE


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
        if self.compound is None or part == self.body:
            return Leaning(along, error=EXACT_ANGLE._replace(theta=rounding))
        by = self._between(chunk, self.compound)
        total = by.error._replace(theta=by.error.theta + rounding)
        return Leaning(along.turned(by.along), by.omega, by.alpha, total)

    def _between(self, chunk: Chunk, compound: Compound) -> Leaning:
        """Return the x-axis of the other body."""
        if compound.slider is not None:
            slider = self.scene.sliders[compound.slider]
            angle = sliding_angle(slider)
            rounding = rounding_of_angles(slider.direction_rad, slider.angle_rad)
            return Leaning(direction(angle), error=EXACT_ANGLE._replace(theta=rounding))
        q = chunk.driver
        along = Vec(np.cos(q.theta), np.sin(q.theta))
        return Leaning(along, q.omega, q.alpha, q.error or EXACT_ANGLE)

    def local(self, chunk: Chunk, part: str, place: Point) -> LocalPoint:
        """Return a point of one of the bodies, given in its own frame, from the anchor."""
        compound = self.compound
        if compound is None or part == self.body:
            return LocalPoint(Vec(*less(place, self.origin)))
        if compound.pin is not None:
            return self._about_pin(chunk, place, compound, compound.pin)
        assert compound.slider is not None
        return self._along_line(chunk, place, compound, self.scene.sliders[compound.slider])

    def _about_pin(self, chunk: Chunk, place: Point, compound: Compound, pin: str) -> LocalPoint:
        base = less(local_point(self.scene, compound.base, pin), self.origin)
        arm = less(place, local_point(self.scene, compound.link, pin))
        by = self._between(chunk, compound)
        reach = Vec(*arm).turned(by.along)
        r, w, g, e = math.hypot(*arm), by.omega, by.alpha, by.error
        ww = np.abs(w) + e.omega
        error = plane.PointError(
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

    def _along_line(
        self, chunk: Chunk, place: Point, compound: Compound, slider: Slider
    ) -> LocalPoint:
        q = chunk.driver.sliding(driver_scale(self.scene))
        arm = less(place, local_point(self.scene, compound.link, slider.point))
        by, along = self._between(chunk, compound), direction(slider.direction_rad)
        reach = Vec(*arm).turned(by.along) + Vec(*less(slider.through_m, self.origin))
        lean = rounding_of_angles(slider.direction_rad) + 3 * EPS
        size = math.hypot(*arm) + math.hypot(*less(slider.through_m, self.origin))
        ends = (q.s, q.speed, q.acceleration)
        p, v, a = (along * one for one in ends)
        off = [lean * np.abs(one) for one in ends]
        off[0] = off[0] + (by.error.theta + 3 * EPS) * size
        if q.error is not None:
            off = [one + more for one, more in zip(off, q.error, strict=True)]
        return LocalPoint(reach + p, v, a, plane.PointError(*off), True)

    def place(self, chunk: Chunk, body: plane.BodyKinematics) -> None:
        """Add the bodies of the solved link, and its driven slider, to the chunk."""
        chunk.bodies[self.body] = replace(body, local=self.origin)
        compound = self.compound
        if compound is None:
            return
        by = self._between(chunk, compound)
        joint = compound.pin
        if compound.slider is not None:
            joint = self.scene.sliders[compound.slider].point
            chunk.sliders[compound.slider] = chunk.driver.sliding(driver_scale(self.scene))
        assert joint is not None
        own = local_point(self.scene, compound.link, joint)
        anchor = self.local(chunk, compound.link, own).on(body)
        error = body.error
        if error is not None:
            error = plane.AngleError(*map(operator.add, error, by.error))
            error = error._replace(theta=error.theta + SINES)
        turn = body.turn.turned(by.along)
        omega, alpha = body.omega + by.omega, body.alpha + by.alpha
        chunk.bodies[compound.link] = plane.BodyKinematics(own, anchor, turn, omega, alpha, error)
