"""Equilibrium of a group of class III, and of a dyad with a compound.

Three unknowns hold the central link: one of each leg, which its own link leaves open, and two of a
joint to a known body. The matrix of its three equations is that of the wrenches of
`analytic.assur.platform`: forces are singular where positions are.

Letters: e along a line, n = e turned by +90 deg; K a known force and x the unknown factor of a
wrench u on the central link; M about its point O of reference.
"""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from typing import Protocol

from analytic.dyads.plane import Vec
from analytic.forces.bounded import NOUGHT, NOWHERE, Bounded, BoundedVec, Three, solved_three
from analytic.forces.free_body import Balance, PrismaticPair
from analytic.structure.groups import Group, JointKey, Leg, Triad, as_triad
from models.scene import Point
from models.scene.joints import local_point

ONE = Bounded(1.0)


@dataclass(frozen=True)
class Wrench:
    """A force on the central link, and its moment about O."""

    force: BoundedVec
    moment: Bounded

    @property
    def three(self) -> Three:
        x, y = self.force.v.x, self.force.v.y
        return Bounded(x, self.force.error), Bounded(y, self.force.error), self.moment


@dataclass(frozen=True)
class Central:
    """Central link: its bodies, and the ways from O to their places."""

    on: Balance
    bodies: tuple[str, ...]

    def part(self, joint: JointKey) -> str:
        """Return its body that has a joint."""
        kind, name = joint
        structure = self.on.structure
        ends = structure.pins[name] if kind == "R" else structure.prismatics[name]
        return next(body for body in self.bodies if body in ends)

    def way(self, body: str, place: Point) -> BoundedVec:
        """Return the vector from O to a place of one of the bodies: O is the centre of mass, or of
        a compound the driven pin, or the point of the driven slider."""
        own, compound = self.on.free[body], self.on.structure.compound
        if len(self.bodies) == 1 or compound is None:
            return own.vector(own.centre, place)
        if compound.pin is not None:
            return own.vector(local_point(self.on.scene, body, compound.pin), place)
        assert compound.slider is not None
        return own.vector(own.centre, place) - self.on.pair(compound.slider).arms[body]

    def to_point(self, body: str, point: str) -> BoundedVec:
        return self.way(body, local_point(self.on.scene, body, point))

    def given(self) -> Wrench:
        """Return the sum of all forces on it except those of its joints."""
        force, moment = NOWHERE, NOUGHT
        for body in self.bodies:
            own = self.on.free[body]
            force = force + own.force
            moment = moment + own.moment + self.way(body, own.centre).cross(own.force)
        return Wrench(force, moment)


class Hold(Protocol):
    """Leg, or joint to a known body: its wrench on the central link, with one unknown or two."""

    def known(self) -> Wrench:
        """Return the wrench that is independent of the unknowns."""
        ...

    def unknown(self) -> list[Wrench]:
        """Return the wrench of each unknown of 1."""
        ...

    def settle(self, found: Iterator[Bounded]) -> None:
        """Store the forces on its own bodies and joints."""
        ...


@dataclass(frozen=True)
class BarHold:
    """RR, r from the outer pin to the inner one: F = -x r - r' M / r^2 on the leg's end."""

    central: Central
    leg: Leg

    def _r(self) -> BoundedVec:
        return self.central.on.span(self.leg.body, self.leg.outer[1], self.leg.inner[1])

    def _at(self, force: BoundedVec) -> Wrench:
        part = self.central.part(self.leg.inner)
        return Wrench(force, self.central.to_point(part, self.leg.inner[1]).cross(force))

    def known(self) -> Wrench:
        r, turning = self._r(), self.central.on.moment(self.leg.body, self.leg.outer[1])
        return self._at(r.perp() * (turning * r.dot(r).inverse()))

    def unknown(self) -> list[Wrench]:
        return [self._at(self._r())]

    def settle(self, found: Iterator[Bounded]) -> None:
        on, leg = self.central.on, self.leg
        force = self.known().force + self._r() * next(found)
        own = on.free[leg.body].force
        _through_pin(self.central, leg, force)
        on.hold(leg.outer[1], leg.body, force - own)


@dataclass(frozen=True)
class DrivenBarHold:
    """RR of two bodies, which the driver keeps apart with any force: as `BarHold`."""

    central: Central
    leg: Leg
    own: Central

    def _end(self, joint: JointKey) -> BoundedVec:
        return self.own.to_point(self.own.part(joint), joint[1])

    def _r(self) -> BoundedVec:
        return self._end(self.leg.inner) - self._end(self.leg.outer)

    def _at(self, force: BoundedVec) -> Wrench:
        part = self.central.part(self.leg.inner)
        return Wrench(force, self.central.to_point(part, self.leg.inner[1]).cross(force))

    def known(self) -> Wrench:
        r, given = self._r(), self.own.given()
        turning = given.moment - self._end(self.leg.outer).cross(given.force)
        return self._at(r.perp() * (turning * r.dot(r).inverse()))

    def unknown(self) -> list[Wrench]:
        return [self._at(self._r())]

    def settle(self, found: Iterator[Bounded]) -> None:
        on, leg = self.central.on, self.leg
        force, given = self.known().force + self._r() * next(found), self.own.given().force
        near, far = self.own.part(leg.outer), self.own.part(leg.inner)
        pin, part = leg.inner[1], self.central.part(leg.inner)
        on.on_pin(pin, part, force)
        on.on_pin(pin, far, -force)
        on.push(part, pin, force)
        on.push(far, pin, -force)
        on.hold(leg.outer[1], near, force - given)
        on.push(near, leg.outer[1], force - given)


@dataclass(frozen=True)
class SlidingHold:
    """PR: along the known line the leg hands on its own force; across it, x n."""

    central: Central
    leg: Leg

    def _line(self) -> PrismaticPair:
        return self.central.on.pair(self.leg.outer[1])

    def _at(self, force: BoundedVec) -> Wrench:
        part = self.central.part(self.leg.inner)
        return Wrench(force, self.central.to_point(part, self.leg.inner[1]).cross(force))

    def known(self) -> Wrench:
        along = self._line().along
        return self._at(along * along.dot(self.central.on.free[self.leg.body].force))

    def unknown(self) -> list[Wrench]:
        return [self._at(self._line().across)]

    def settle(self, found: Iterator[Bounded]) -> None:
        on, leg = self.central.on, self.leg
        force = self.known().force + self._line().across * next(found)
        _through_pin(self.central, leg, force)
        on.push(leg.body, leg.inner[1], -force)
        on.rest(leg.outer[1], leg.body)


def _through_pin(central: Central, leg: Leg, force: BoundedVec) -> None:
    """Let the leg exert a force on the central link in their pin."""
    on, pin, part = central.on, leg.inner[1], central.part(leg.inner)
    on.on_pin(pin, part, force)
    on.on_pin(pin, leg.body, -force)
    on.push(part, pin, force)


@dataclass(frozen=True)
class GuidedHold:
    """RP: x n on the leg, in a line of action that balances it about its outer pin."""

    central: Central
    leg: Leg

    def _line(self) -> PrismaticPair:
        return self.central.on.pair(self.leg.inner[1])

    def _near(self) -> BoundedVec:
        """Return the vector from the outer pin to the slider's point."""
        on, leg = self.central.on, self.leg
        return self._line().arms[leg.body] - on.arm(leg.body, leg.outer[1])

    def known(self) -> Wrench:
        return Wrench(NOWHERE, self.central.on.moment(self.leg.body, self.leg.outer[1]))

    def unknown(self) -> list[Wrench]:
        line, part = self._line(), self.central.part(self.leg.inner)
        centre = self.central.on.free[part].centre
        pin = self.central.way(part, centre) + line.arms[part] - self._near()
        force = -line.across
        return [Wrench(force, pin.cross(force))]

    def settle(self, found: Iterator[Bounded]) -> None:
        on, leg, line, normal = self.central.on, self.leg, self._line(), next(found)
        turning = on.moment(leg.body, leg.outer[1])
        moment = -(turning + normal * self._near().dot(line.along))
        own = on.free[leg.body].force
        on.slide(line, leg.body, normal, moment)
        on.hold(leg.outer[1], leg.body, -(own + line.across * normal))


@dataclass(frozen=True)
class CoupleHold:
    """PP: the normal force of the inner line carries the leg along the outer one; x is a couple."""

    central: Central
    leg: Leg

    def _normal(self) -> Bounded:
        """Return the normal force of the inner line, on the leg."""
        on, leg = self.central.on, self.leg
        outer, inner = on.pair(leg.outer[1]), on.pair(leg.inner[1])
        along = outer.along.dot(on.free[leg.body].force)
        return -(along * inner.across.dot(outer.along).inverse())

    def known(self) -> Wrench:
        inner, part = self.central.on.pair(self.leg.inner[1]), self.central.part(self.leg.inner)
        force = -(inner.across * self._normal())
        way = self.central.way(part, self.central.on.free[part].centre) + inner.arms[part]
        return Wrench(force, way.cross(force))

    def unknown(self) -> list[Wrench]:
        return [Wrench(NOWHERE, ONE)]

    def settle(self, found: Iterator[Bounded]) -> None:
        on, leg, moment = self.central.on, self.leg, -next(found)
        inner, normal, own = on.pair(leg.inner[1]), self._normal(), on.free[leg.body]
        on.slide(inner, leg.body, normal, moment)
        own.push(inner.arms[leg.body], inner.across * normal)
        own.moment = own.moment + moment
        on.rest(leg.outer[1], leg.body)


@dataclass(frozen=True)
class PinHold:
    """R: a pin to a known body."""

    central: Central
    joint: JointKey

    def known(self) -> Wrench:
        return Wrench(NOWHERE, NOUGHT)

    def unknown(self) -> list[Wrench]:
        way = self.central.to_point(self.central.part(self.joint), self.joint[1])
        return [Wrench(axis, way.cross(axis)) for axis in _axes()]

    def settle(self, found: Iterator[Bounded]) -> None:
        x, y = _axes()
        force, part = x * next(found) + y * next(found), self.central.part(self.joint)
        self.central.on.hold(self.joint[1], part, force)
        self.central.on.push(part, self.joint[1], force)


@dataclass(frozen=True)
class SliderHold:
    """P: the line of a known body, or on one."""

    central: Central
    joint: JointKey

    def known(self) -> Wrench:
        return Wrench(NOWHERE, NOUGHT)

    def unknown(self) -> list[Wrench]:
        line, part = self.central.on.pair(self.joint[1]), self.central.part(self.joint)
        way = self.central.way(part, self.central.on.free[part].centre) + line.arms[part]
        return [Wrench(line.across, way.cross(line.across)), Wrench(NOWHERE, ONE)]

    def settle(self, found: Iterator[Bounded]) -> None:
        on, part = self.central.on, self.central.part(self.joint)
        line, normal, moment = on.pair(self.joint[1]), next(found), next(found)
        on.slide(line, part, normal, moment)
        own = on.free[part]
        own.push(line.arms[part], line.across * normal)
        own.moment = own.moment + moment


_OF_LEGS: Mapping[str, Callable[[Central, Leg], Hold]] = {
    "RR": BarHold,
    "PR": SlidingHold,
    "RP": GuidedHold,
    "PP": CoupleHold,
}


def balance_central(on: Balance, part: Triad | Group) -> None:
    """Solve a group about its central link, and its legs."""
    central_name, legs, joint = as_triad(part, on.structure.compound)
    compound = on.structure.compound
    own = compound is not None and compound.name == central_name
    bodies = (compound.base, compound.link) if own and compound is not None else (central_name,)
    central = Central(on, bodies)
    holds: list[Hold] = []
    for leg in legs:
        if compound is not None and leg.body == compound.name:
            driven = Central(on, (compound.base, compound.link))
            holds.append(DrivenBarHold(central, leg, driven))
        else:
            holds.append(_OF_LEGS[leg.kind](central, leg))
    if joint is not None:
        holds.append(PinHold(central, joint) if joint[0] == "R" else SliderHold(central, joint))
    given = central.given().three
    for hold in holds:
        known = hold.known().three
        given = given[0] + known[0], given[1] + known[1], given[2] + known[2]
    columns = [wrench.three for hold in holds for wrench in hold.unknown()]
    found = iter(solved_three((columns[0], columns[1], columns[2]), given))
    for hold in holds:
        hold.settle(found)


def _axes() -> tuple[BoundedVec, BoundedVec]:
    return BoundedVec(Vec(1.0, 0.0), 1.0, 0.0), BoundedVec(Vec(0.0, 1.0), 1.0, 0.0)
