"""The equilibrium of the five class II groups: reactions of a group from what acts on its bodies.

A group is statically determinate: two bodies, six equations, three pairs of two unknowns each. Its
bodies are solved one group after the other, in the reverse of the solving order, and leave what
their outer pairs need on the bodies that hold them; the driver is last. Of the six equations four
only take over what two have found: those of a 2 x 2 system with the determinant of the group's
kinematics (the transposed problem), which is why forces are singular where positions are.

Letters: e along a line, n = e turned by +90 deg; F the force on the first body in the inner pin, R
that in its outer pin; E and M what else acts on a body, with moments about the pin named.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping

from analytic.dyads.rounding import rounding_of_angles
from analytic.forces.bounded import NOWHERE, Bounded, BoundedVec
from analytic.forces.central_balance import balance_central
from analytic.forces.free_body import FreeBody
from analytic.structure.groups import Bridge, Group, Triad
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

    def torque(self) -> Bounded:
        """Solve all groups, the last one first; the torque on the driver that is left over, or the
        force along its line."""
        compound = self.structure.compound
        inner = set() if compound is None else {compound.name}
        for part in reversed(self.structure.order):
            if isinstance(part, Bridge):
                continue
            central = inner.intersection(part.bodies)
            self.standing.difference_update(part.bodies)
            if central and compound is not None:
                self.standing -= {compound.base, compound.link}
            if isinstance(part, Triad) or central:
                balance_central(self, part)
            else:
                _BALANCES[part.kind](self, part)
        return self._drive()

    def _drive(self) -> Bounded:
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


def _rrr(on: Balance, group: Group) -> None:
    """Moments about the outer pins: r1 x F + M1 = 0, r2 x F = M2."""
    one, other = on.free[group.first], on.free[group.second]
    r1 = on.span(group.first, group.outer1, group.inner)
    r2 = on.span(group.second, group.outer2, group.inner)
    m1, m2 = on.moment(group.first, group.outer1), on.moment(group.second, group.outer2)
    inverse = r2.cross(r1).inverse()
    force = r1 * (m2 * inverse) + r2 * (m1 * inverse)
    on.inner(group, force)
    on.hold(group.outer1, group.first, -(one.force + force))
    on.hold(group.outer2, group.second, force - other.force)


def _rrp(on: Balance, group: Group) -> None:
    """Along the line e F = e E2, and about the outer pin r x F + M1 = 0."""
    one, other = on.free[group.first], on.free[group.second]
    line = on.pair(group.outer2)
    r = on.span(group.first, group.outer1, group.inner)
    along = line.along.dot(other.force)
    turning = on.moment(group.first, group.outer1) + along * r.cross(line.along)
    force = line.along * along - line.across * (turning * r.dot(line.along).inverse())
    on.inner(group, force)
    on.hold(group.outer1, group.first, -(one.force + force))
    on.push(group.second, group.inner, -force)
    on.rest(group.outer2, group.second)


def _rpr(on: Balance, group: Group) -> None:
    """The force N n on the first body: with d from the second outer pin to the first, moments of
    both bodies about the second give (d e) N = M1 + M2."""
    one, other = on.free[group.first], on.free[group.second]
    line = on.pair(group.inner)
    near = line.arms[group.first] - on.arm(group.first, group.outer1)
    far = line.arms[group.second] - on.arm(group.second, group.outer2)
    m1, m2 = on.moment(group.first, group.outer1), on.moment(group.second, group.outer2)
    normal = (m1 + m2) * (far - near).dot(line.along).inverse()
    force = line.across * normal
    on.hold(group.outer1, group.first, -(one.force + force))
    on.hold(group.outer2, group.second, force - other.force)
    moment = -(m1 + normal * near.dot(line.along))
    on.sliders[line.name] = (normal, moment) if group.first == line.body else (-normal, -moment)


def _prp(on: Balance, group: Group) -> None:
    """Along the two lines e1 F = -e1 E1, e2 F = e2 E2."""
    one, other = on.free[group.first], on.free[group.second]
    line1, line2 = on.pair(group.outer1), on.pair(group.outer2)
    along1, along2 = -line1.along.dot(one.force), line2.along.dot(other.force)
    force = _crossing(line1, line2, along1, along2)
    on.inner(group, force)
    on.push(group.first, group.inner, force)
    on.push(group.second, group.inner, -force)
    on.rest(group.outer1, group.first)
    on.rest(group.outer2, group.second)


def _rpp(on: Balance, group: Group) -> None:
    """Along the inner line k R = -k E1, and of both bodies along the outer e R = -e (E1 + E2)."""
    one, other = on.free[group.first], on.free[group.second]
    inner, outer = on.pair(group.inner), on.pair(group.outer2)
    along1 = -inner.along.dot(one.force)
    along2 = -outer.along.dot(one.force + other.force)
    force = _crossing(inner, outer, along1, along2)
    on.hold(group.outer1, group.first, force)
    on.push(group.first, group.outer1, force)
    on.rest(group.inner, group.first)
    on.rest(group.outer2, group.second)


def _crossing(
    line1: PrismaticPair, line2: PrismaticPair, along1: Bounded, along2: Bounded
) -> BoundedVec:
    """The force with these components along two lines."""
    inverse = line1.along.cross(line2.along).inverse()
    return line1.across * (along2 * inverse) - line2.across * (along1 * inverse)


_BALANCES: Mapping[str, Callable[[Balance, Group], None]] = {
    "RRR": _rrr,
    "RRP": _rrp,
    "RPR": _rpr,
    "PRP": _prp,
    "RPP": _rpp,
}
