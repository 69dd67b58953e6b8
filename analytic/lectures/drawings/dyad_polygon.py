"""Two ways of every Assur group to the image that it is drawn by, and the rates of its bodies.

======  ======================================  =========================
group   the node                                its two ways
======  ======================================  =========================
RRR     the inner pin                           about both outer pins
RRP     the inner pin                           about a pin; along a line
RPR     the guide's point under the other pin   about a pin; along a line
PRP     the inner pin                           along two lines
RPP     the inner body's point under the pin    along two lines
======  ======================================  =========================

::

    about a pin Q                       along a line u
    P = Q + rotation of the link        P = P' + sliding, P' the point of the other body under P
    a: normal towards Q, tangential     a: Coriolis' 2 omega x v_sliding, sliding
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from analytic.lectures.drawings.polygon import (
    BodyRates,
    EquationSide,
    Kind,
    PlacedMechanism,
    Term,
    quarter_turn,
)
from analytic.structure.groups import Group
from models.array import Array
from models.scene import GROUND
from models.scene.joints import sliding_body


@dataclass(frozen=True)
class NodeMotion:
    """Result of the crossings: velocity and acceleration of the node, (2,) each."""

    velocity: Array
    acceleration: Array


@dataclass(frozen=True)
class Origin:
    """Start of a way: the point ``name`` of a known body, at a ``place`` [m]."""

    name: str
    place: Array
    body: BodyRates

    @property
    def velocity(self) -> Array:
        return self.body.velocity_at(self.place)

    @property
    def acceleration(self) -> Array:
        return self.body.acceleration_at(self.place)

    def on(self, rates: BodyRates) -> BodyRates:
        """Return the rates of a body that turns as another one, and is pinned here."""
        return replace(
            rates, place=self.place, velocity=self.velocity, acceleration=self.acceleration
        )


@dataclass(frozen=True)
class RotatingArm:
    """Arm from a pin over a link to the point ``node`` of it at ``place``."""

    origin: Origin
    node: str
    place: Array

    def velocity_way(self) -> EquationSide:
        return EquationSide(self.origin.velocity, (), self._turning("rotation"))

    def acceleration_way(self, velocity: Array) -> EquationSide:
        """Return the way for the velocity of the node [m/s], (2,)."""
        towards = -(self.omega(velocity) ** 2) * self._arm
        normal = Term(self.node + self.origin.name, "normal", towards)
        return EquationSide(self.origin.acceleration, (normal,), self._turning("tangential"))

    def omega(self, velocity: Array) -> float:
        """Return the rate of the link [rad/s]."""
        return self._rate(velocity - self.origin.velocity)

    def rates(self, node: NodeMotion) -> BodyRates:
        """Return the rates of the link."""
        at = self.origin
        alpha = self._rate(node.acceleration - at.acceleration)
        return BodyRates(at.place, at.velocity, at.acceleration, self.omega(node.velocity), alpha)

    @property
    def _arm(self) -> Array:
        return np.asarray(self.place - self.origin.place)

    def _rate(self, relative: Array) -> float:
        """Return omega or alpha by the node's vector about the pin, (2,), from its part across."""
        return float(quarter_turn(self._arm) @ relative) / float(self._arm @ self._arm)

    def _turning(self, kind: Kind) -> Term:
        across = quarter_turn(self._arm) / np.hypot(*self._arm)
        told = f"perpendicular to {self.origin.name}{self.node}"
        return Term(self.node + self.origin.name, kind, np.asarray(across), told)


@dataclass(frozen=True)
class SlidingArm:
    """Arm from the point of another body under it to ``node``, along the unit vector ``along`` of
    the line of ``slider``; ``frame`` has the rates of the line, or the arm that gives them."""

    origin: Origin
    node: str
    along: Array
    slider: str
    frame: BodyRates | RotatingArm

    def velocity_way(self) -> EquationSide:
        return EquationSide(self.origin.velocity, (), self._sliding())

    def acceleration_way(self, velocity: Array) -> EquationSide:
        """Return the way for the velocity of the node [m/s], (2,)."""
        omega = self.omega(velocity)
        turned = 2.0 * omega * quarter_turn(velocity - self.origin.velocity)
        known = (Term(self.node + self.origin.name, "coriolis", turned),) if omega else ()
        return EquationSide(self.origin.acceleration, known, self._sliding())

    def omega(self, velocity: Array) -> float:
        """Return the rate of the line [rad/s]."""
        frame = self.frame
        return frame.omega if isinstance(frame, BodyRates) else frame.omega(velocity)

    def rates(self, node: NodeMotion) -> BodyRates:
        """Return the rates of a body that turns as the line does, by its point at the node."""
        frame = self.frame if isinstance(self.frame, BodyRates) else self.frame.rates(node)
        return replace(
            frame, place=self.origin.place, velocity=node.velocity, acceleration=node.acceleration
        )

    def _sliding(self) -> Term:
        told = f"parallel to the line of {self.slider}"
        return Term(self.node + self.origin.name, "sliding", self.along, told)


Arm = RotatingArm | SlidingArm


@dataclass(frozen=True)
class DyadPolygon:
    """Group and its two arms to ``node``."""

    group: Group
    arms: tuple[Arm, Arm]

    @property
    def node(self) -> str:
        return self.arms[0].node

    def rates(self, placement: PlacedMechanism, node: NodeMotion) -> dict[str, BodyRates]:
        """Return the rates of the group's bodies."""
        group, (one, other) = self.group, self.arms
        first, second = one.rates(node), other.rates(node)
        if group.kind == "RPR":
            slider = placement.scene.sliders[group.inner]
            return {slider.on: first, sliding_body(slider): other.origin.on(first)}
        if group.kind == "RPP":
            first = one.origin.on(second)
        return {group.first: first, group.second: second}


class Known:
    """Bodies that are drawn already."""

    def __init__(self, placement: PlacedMechanism, rates: Mapping[str, BodyRates]) -> None:
        self.placement, self.rates = placement, rates

    def has(self, point: str) -> bool:
        """True if a pin is on one of them."""
        return any(body in self.rates for body in self.placement.structure.pins[point])

    def pin(self, point: str) -> Origin:
        """Return a pin of one of them."""
        body = next(b for b in self.placement.structure.pins[point] if b in self.rates)
        return Origin(point, self.placement.points[point], self.rates[body])

    def under(self, point: str, slider: str) -> tuple[Origin, BodyRates]:
        """Return the known body of a slider's pair: its point under a named one, and its rates."""
        ends = self.placement.structure.prismatics[slider]
        body = next(b for b in ends if b in self.rates)
        rates = self.rates[body]
        name = "" if body == GROUND else f"{point}({body})"  # the ground's image is the pole
        return Origin(name, self.placement.points[point], rates), rates

    def rotating(self, outer: str, inner: str) -> RotatingArm:
        return RotatingArm(self.pin(outer), inner, self.placement.points[inner])

    def sliding(self, inner: str, slider: str, node: str = "") -> SlidingArm:
        origin, body = self.under(inner, slider)
        along = self.placement.along(slider)
        return SlidingArm(origin, node or inner, along, slider, body)


def dyad_polygon(
    placement: PlacedMechanism, rates: Mapping[str, BodyRates], group: Group
) -> DyadPolygon:
    """Return the group with its arms, from the known ``rates`` of its supports."""
    known = Known(placement, rates)
    if group.kind == "RPR":
        return DyadPolygon(group, _rpr(known, group))
    if group.kind == "RPP":
        return DyadPolygon(group, _rpp(known, group))
    one, other = (
        known.rotating(outer, group.inner) if kind == "R" else known.sliding(group.inner, outer)
        for kind, outer in zip(group.kind[::2], (group.outer1, group.outer2), strict=True)
    )
    return DyadPolygon(group, (one, other))


def _rpr(known: Known, g: Group) -> tuple[Arm, Arm]:
    """Return the arms from the guide's own pin, and from the pin of the body that slides on it."""
    guide = known.placement.scene.sliders[g.inner].on
    pin, pivot = (g.outer1, g.outer2) if guide == g.second else (g.outer2, g.outer1)
    origin = known.pin(pin)
    node = f"{pin}({guide})"
    about = RotatingArm(known.pin(pivot), node, origin.place)
    return about, SlidingArm(origin, node, known.placement.along(g.inner), g.inner, about)


def _rpp(known: Known, g: Group) -> tuple[Arm, Arm]:
    node = f"{g.outer1}({g.second})"
    outer = known.sliding(g.outer1, g.outer2, node)
    along = known.placement.along(g.inner)
    return SlidingArm(known.pin(g.outer1), node, along, g.inner, outer.frame), outer
