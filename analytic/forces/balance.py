"""The bodies of a mechanism in equilibrium, and the reactions that are known of them.

Letters: e along a line, n = e turned by +90 deg.
"""

from __future__ import annotations

from collections.abc import Mapping

from analytic.dyads.rounding import rounding_of_angles
from analytic.forces.bounded import NOWHERE, Bounded, BoundedVec
from analytic.forces.free_body import FreeBody
from analytic.structure.groups import Group
from analytic.structure.mobility import Structure
from models.joints import local_point, sliding_body
from models.scene import GROUND, Scene, Slider

Displaced = Mapping[str, Bounded]
"""The displacement of each slider [m]."""


class PrismaticPair:
    """A prismatic pair: its directions, and the way to its point from the centre of each body."""

    def __init__(self, slider: Slider, scene: Scene, free: Mapping[str, FreeBody], s: Bounded):
        self.name, self.body, self.guide = slider.name, sliding_body(slider), slider.on
        guide, body = free[self.guide], free[self.body]
        angle = slider.direction_rad
        self.along = guide.unit(angle, rounding_of_angles(angle))
        self.across = self.along.perp()
        tip = local_point(scene, self.body, slider.point)
        self.arms = {
            self.body: body.vector(body.centre, tip),
            self.guide: guide.vector(guide.centre, slider.through_m) + self.along * s,
        }

    def other(self, body: str) -> str:
        return self.guide if body == self.body else self.body


class Balance:
    """The bodies of a chunk that still stand, and the reactions found so far.

    ``pins`` holds the force of each pin on each of its bodies, ``sliders`` what each guide exerts
    on what slides: the force along n, and the moment about the slider's point.
    """

    def __init__(
        self, scene: Scene, structure: Structure, free: dict[str, FreeBody], displaced: Displaced
    ) -> None:
        self.scene, self.structure, self.free = scene, structure, free
        self.displaced = displaced
        self.standing = {GROUND, *structure.bodies}
        self.pins = {
            point: dict.fromkeys(bodies, NOWHERE) for point, bodies in structure.pins.items()
        }
        self.sliders: dict[str, tuple[Bounded, Bounded]] = {}

    def drive(self) -> Bounded:
        """The driven joint bears what is left on its link; the torque, or the force along a line,
        that this takes."""
        driver = self.scene.driver
        if driver.slider is not None:
            line = self.pair(driver.slider)
            force = -line.along.dot(self.free[driver.link].force)
            self.rest(driver.slider, driver.link)
            return force
        link, pivot = driver.link, self.scene.driver_pivot
        body = self.free[link]
        self.on_pin(pivot, link, -body.force)
        self.on_pin(pivot, driver.base, body.force)
        return -body.moment_about(self.arm(link, pivot))

    def arm(self, body: str, point: str) -> BoundedVec:
        """From the centre of a body to one of its points."""
        own = self.free[body]
        return own.vector(own.centre, local_point(self.scene, body, point))

    def span(self, body: str, start: str, end: str) -> BoundedVec:
        """From one point of a body to another."""
        return self.free[body].vector(
            local_point(self.scene, body, start), local_point(self.scene, body, end)
        )

    def moment(self, body: str, point: str) -> Bounded:
        """The moment of what acts on a body about one of its points."""
        return self.free[body].moment_about(self.arm(body, point))

    def pair(self, slider: str) -> PrismaticPair:
        return PrismaticPair(
            self.scene.sliders[slider], self.scene, self.free, self.displaced[slider]
        )

    def push(self, body: str, point: str, force: BoundedVec) -> None:
        """A force of an inner pin on a body that needs it for its other pair."""
        self.free[body].push(self.arm(body, point), force)

    def on_pin(self, point: str, body: str, force: BoundedVec) -> None:
        """A pin exerts a force on a body."""
        self.pins[point][body] = self.pins[point][body] + force

    def inner(self, group: Group, force: BoundedVec) -> None:
        """The inner pin of a group exerts the force on its first body."""
        self.on_pin(group.inner, group.first, force)
        self.on_pin(group.inner, group.second, -force)

    def hold(self, point: str, body: str, force: BoundedVec) -> None:
        """An outer pin exerts the force on a body of a group, and the opposite on what holds it."""
        holder = next(name for name in self.structure.pins[point] if name in self.standing)
        self.on_pin(point, body, force)
        self.on_pin(point, holder, -force)
        if holder != GROUND:
            self.push(holder, point, -force)

    def slide(self, pair: PrismaticPair, body: str, normal: Bounded, moment: Bounded) -> None:
        """A prismatic pair exerts a force along n and a moment on a body, and the opposite on the
        other."""
        other = self.free[pair.other(body)]
        if pair.other(body) != GROUND:
            other.push(pair.arms[pair.other(body)], -(pair.across * normal))
            other.moment = other.moment - moment
        slides = body == pair.body
        self.sliders[pair.name] = (normal, moment) if slides else (-normal, -moment)

    def rest(self, slider: str, body: str) -> None:
        """A prismatic pair takes over all that acts on a body: along its line nothing is left."""
        pair, own = self.pair(slider), self.free[body]
        self.slide(pair, body, -pair.across.dot(own.force), -own.moment_about(pair.arms[body]))
