"""Equilibrium of a group of class III, and of a dyad with a compound.

Three unknowns hold the central link: one of each leg, which its own link leaves open, and two of a
joint to a known body. The matrix of its three equations is that of the wrenches of
`analytic.assur.platform`: forces are singular where positions are.

Letters: e along a line, n = e turned by +90 deg; K a known force and x the unknown factor of a
wrench u on the central link; M about its point O of reference.
"""

from abc import ABC, abstractmethod
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass

from analytic.dyads.plane import Vec
from analytic.forces.bounded import NOUGHT, NOWHERE, Bounded, BoundedVec, Three, solved_three
from analytic.forces.free_body import Balance, PrismaticPair
from analytic.structure.groups import Group, JointKey, Leg, Triad, as_triad
from models.scene import Point
from models.scene.joints import local_point

ONE = Bounded(1.0)
AXES = BoundedVec(Vec(1.0, 0.0), 1.0, 0.0), BoundedVec(Vec(0.0, 1.0), 1.0, 0.0)


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

    def to_pin(self, joint: JointKey) -> BoundedVec:
        """Return the vector from O to one of its pins."""
        body = self.part(joint)
        return self.way(body, local_point(self.on.scene, body, joint[1]))

    def to_slider(self, joint: JointKey) -> BoundedVec:
        """Return the vector from O to the point of one of its sliders."""
        body = self.part(joint)
        return self.way(body, self.on.free[body].centre) + self.on.pair(joint[1]).arms[body]

    def in_pin(self, joint: JointKey, force: BoundedVec) -> Wrench:
        """Return the wrench of a force in one of its pins."""
        return Wrench(force, self.to_pin(joint).cross(force))

    def given(self) -> Wrench:
        """Return the sum of all forces on it except those of its joints."""
        force, moment = NOWHERE, NOUGHT
        for body in self.bodies:
            own = self.on.free[body]
            force = force + own.force
            moment = moment + own.moment + self.way(body, own.centre).cross(own.force)
        return Wrench(force, moment)


@dataclass(frozen=True)
class Hold(ABC):
    """Leg, or joint to a known body: its wrench on the central link, with one unknown or two."""

    central: Central

    def known(self) -> Wrench:
        """Return the wrench that is independent of the unknowns."""
        return Wrench(NOWHERE, NOUGHT)

    @abstractmethod
    def unknown(self) -> list[Wrench]:
        """Return the wrench of each unknown of 1."""

    @abstractmethod
    def settle(self, found: Iterator[Bounded]) -> None:
        """Store the forces on its own bodies and joints."""


@dataclass(frozen=True)
class LegHold(Hold):
    """Hold by a leg."""

    leg: Leg

    def through_pin(self, body: str, force: BoundedVec) -> None:
        """Let a body of the leg exert a force on the central link in their pin."""
        on, pin, part = self.central.on, self.leg.inner[1], self.central.part(self.leg.inner)
        on.on_pin(pin, part, force)
        on.on_pin(pin, body, -force)
        on.push(part, pin, force)


@dataclass(frozen=True)
class BarHold(LegHold):
    """RR, r from the outer pin to the inner one: F = -x r - r' M / r^2 on the leg's end."""

    def _r(self) -> BoundedVec:
        return self.central.on.span(self.leg.body, self.leg.outer[1], self.leg.inner[1])

    def _turning(self) -> Bounded:
        """Return the moment of the given forces about the outer pin."""
        return self.central.on.moment(self.leg.body, self.leg.outer[1])

    def known(self) -> Wrench:
        r = self._r()
        force = r.perp() * (self._turning() * r.dot(r).inverse())
        return self.central.in_pin(self.leg.inner, force)

    def unknown(self) -> list[Wrench]:
        return [self.central.in_pin(self.leg.inner, self._r())]

    def settle(self, found: Iterator[Bounded]) -> None:
        on, leg = self.central.on, self.leg
        force = self.known().force + self._r() * next(found)
        own = on.free[leg.body].force
        self.through_pin(leg.body, force)
        on.hold(leg.outer[1], leg.body, force - own)


@dataclass(frozen=True)
class DrivenBarHold(BarHold):
    """RR of two bodies, which the driver keeps apart with any force: as `BarHold`."""

    own: Central

    def _r(self) -> BoundedVec:
        return self.own.to_pin(self.leg.inner) - self.own.to_pin(self.leg.outer)

    def _turning(self) -> Bounded:
        given = self.own.given()
        return given.moment - self.own.to_pin(self.leg.outer).cross(given.force)

    def settle(self, found: Iterator[Bounded]) -> None:
        on, leg = self.central.on, self.leg
        force, given = self.known().force + self._r() * next(found), self.own.given().force
        near, far = self.own.part(leg.outer), self.own.part(leg.inner)
        self.through_pin(far, force)
        on.push(far, leg.inner[1], -force)
        on.hold(leg.outer[1], near, force - given)
        on.push(near, leg.outer[1], force - given)


@dataclass(frozen=True)
class SlidingHold(LegHold):
    """PR: along the known line the leg hands on its own force; across it, x n."""

    def _line(self) -> PrismaticPair:
        return self.central.on.pair(self.leg.outer[1])

    def known(self) -> Wrench:
        along, own = self._line().along, self.central.on.free[self.leg.body].force
        return self.central.in_pin(self.leg.inner, along * along.dot(own))

    def unknown(self) -> list[Wrench]:
        return [self.central.in_pin(self.leg.inner, self._line().across)]

    def settle(self, found: Iterator[Bounded]) -> None:
        on, leg = self.central.on, self.leg
        force = self.known().force + self._line().across * next(found)
        self.through_pin(leg.body, force)
        on.push(leg.body, leg.inner[1], -force)
        on.rest(leg.outer[1], leg.body)


@dataclass(frozen=True)
class GuidedHold(LegHold):
    """RP: x n on the leg, in a line of action that balances it about its outer pin."""

    def _line(self) -> PrismaticPair:
        return self.central.on.pair(self.leg.inner[1])

    def _near(self) -> BoundedVec:
        """Return the vector from the outer pin to the slider's point."""
        on, leg = self.central.on, self.leg
        return self._line().arms[leg.body] - on.arm(leg.body, leg.outer[1])

    def known(self) -> Wrench:
        return Wrench(NOWHERE, self.central.on.moment(self.leg.body, self.leg.outer[1]))

    def unknown(self) -> list[Wrench]:
        pin = self.central.to_slider(self.leg.inner) - self._near()
        force = -self._line().across
        return [Wrench(force, pin.cross(force))]

    def settle(self, found: Iterator[Bounded]) -> None:
        on, leg, line, normal = self.central.on, self.leg, self._line(), next(found)
        turning = on.moment(leg.body, leg.outer[1])
        moment = -(turning + normal * self._near().dot(line.along))
        own = on.free[leg.body].force
        on.slide(line, leg.body, normal, moment)
        on.hold(leg.outer[1], leg.body, -(own + line.across * normal))


@dataclass(frozen=True)
class CoupleHold(LegHold):
    """PP: the normal force of the inner line carries the leg along the outer one; x is a couple."""

    def _normal(self) -> Bounded:
        """Return the normal force of the inner line, on the leg."""
        on, leg = self.central.on, self.leg
        outer, inner = on.pair(leg.outer[1]), on.pair(leg.inner[1])
        along = outer.along.dot(on.free[leg.body].force)
        return -(along * inner.across.dot(outer.along).inverse())

    def known(self) -> Wrench:
        force = -(self.central.on.pair(self.leg.inner[1]).across * self._normal())
        return Wrench(force, self.central.to_slider(self.leg.inner).cross(force))

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
class PinHold(Hold):
    """R: a pin to a known body."""

    joint: JointKey

    def unknown(self) -> list[Wrench]:
        return [self.central.in_pin(self.joint, axis) for axis in AXES]

    def settle(self, found: Iterator[Bounded]) -> None:
        x, y = AXES
        force, part = x * next(found) + y * next(found), self.central.part(self.joint)
        self.central.on.hold(self.joint[1], part, force)
        self.central.on.push(part, self.joint[1], force)


@dataclass(frozen=True)
class SliderHold(Hold):
    """P: the line of a known body, or on one."""

    joint: JointKey

    def unknown(self) -> list[Wrench]:
        across = self.central.on.pair(self.joint[1]).across
        way = self.central.to_slider(self.joint)
        return [Wrench(across, way.cross(across)), Wrench(NOWHERE, ONE)]

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
    central = Central(on, (central_name,))
    if compound is not None and compound.name == central_name:
        central = Central(on, (compound.base, compound.link))
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
