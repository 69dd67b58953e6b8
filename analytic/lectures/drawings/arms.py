"""The two kinds of ways to an image: about a pin of the link, or along the line of a slider.

::

    about a pin Q                       along a line u
    P = Q + rotation of the link        P = P' + sliding, P' the point of the other body under P
    a: normal towards Q, tangential     a: Coriolis' 2 omega x v_sliding, sliding
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from analytic.lectures.drawings.body_rates import BodyRates
from analytic.lectures.drawings.placed_mechanism import quarter_turn
from analytic.lectures.drawings.vector_equation import EquationSide, Kind, Term
from models.array import Array


@dataclass(frozen=True)
class NodeMotion:
    """What the crossings gave: velocity and acceleration of the node, (2,) each."""

    velocity: Array
    acceleration: Array


@dataclass(frozen=True)
class Origin:
    """Where a way begins: the point ``name`` of a body that is known, at a ``place`` [m]."""

    name: str
    place: Array
    body: BodyRates

    @property
    def velocity(self) -> Array:
        return self.body.velocity_at(self.place)

    @property
    def acceleration(self) -> Array:
        return self.body.acceleration_at(self.place)


@dataclass(frozen=True)
class RotatingArm:
    """From a pin over a link to the point ``node`` of it at ``place``."""

    origin: Origin
    node: str
    place: Array

    def velocity_way(self) -> EquationSide:
        return EquationSide(self.origin.name, self.origin.velocity, (), self._turning("rotation"))

    def acceleration_way(self, velocity: Array) -> EquationSide:
        """With the velocity of the node [m/s], (2,)."""
        towards = -(self.omega(velocity) ** 2) * self._arm
        normal = Term(self.node + self.origin.name, "normal", towards)
        return EquationSide(
            self.origin.name, self.origin.acceleration, (normal,), self._turning("tangential")
        )

    def omega(self, velocity: Array) -> float:
        """The rate of the link [rad/s]."""
        return self._rate(velocity - self.origin.velocity)

    def rates(self, node: NodeMotion) -> BodyRates:
        """How the link moves."""
        at = self.origin
        alpha = self._rate(node.acceleration - at.acceleration)
        return BodyRates(at.place, at.velocity, at.acceleration, self.omega(node.velocity), alpha)

    @property
    def _arm(self) -> Array:
        return np.asarray(self.place - self.origin.place)

    def _rate(self, relative: Array) -> float:
        """omega or alpha by the node's vector about the pin, (2,), of which it is across."""
        return float(quarter_turn(self._arm) @ relative) / float(self._arm @ self._arm)

    def _turning(self, kind: Kind) -> Term:
        across = quarter_turn(self._arm) / np.hypot(*self._arm)
        told = f"perpendicular to {self.origin.name}{self.node}"
        return Term(self.node + self.origin.name, kind, np.asarray(across), told)


@dataclass(frozen=True)
class SlidingArm:
    """From the point of another body under it to ``node``, along the unit vector ``along`` of the
    line of ``slider``; ``frame`` is how the line turns, or the arm that says so."""

    origin: Origin
    node: str
    along: Array
    slider: str
    frame: BodyRates | RotatingArm

    def velocity_way(self) -> EquationSide:
        return EquationSide(self.origin.name, self.origin.velocity, (), self._sliding())

    def acceleration_way(self, velocity: Array) -> EquationSide:
        """With the velocity of the node [m/s], (2,)."""
        omega = self.omega(velocity)
        turned = 2.0 * omega * quarter_turn(velocity - self.origin.velocity)
        known = (Term(self.node + self.origin.name, "coriolis", turned),) if omega else ()
        return EquationSide(self.origin.name, self.origin.acceleration, known, self._sliding())

    def omega(self, velocity: Array) -> float:
        """The rate of the line [rad/s]."""
        frame = self.frame
        return frame.omega if isinstance(frame, BodyRates) else frame.omega(velocity)

    def turning(self, node: NodeMotion) -> BodyRates:
        """How the line turns."""
        return self.frame if isinstance(self.frame, BodyRates) else self.frame.rates(node)

    def _sliding(self) -> Term:
        told = f"parallel to the line of {self.slider}"
        return Term(self.node + self.origin.name, "sliding", self.along, told)


Arm = RotatingArm | SlidingArm
