"""Joints of what is let go, closed for the arcs that their points go in a step, not for its chords.

::

        o r           Chipmunk turns a body by omega dt and moves its middle straight on, but gives
       /|             a joint the speeds that close it along the tangents, r x omega: after the step
      / | arc         its points are apart by what arcs bend, (1 - cos omega dt) r of each body. An
     /  |             anchor at r cos(omega dt) has the joint mend that beforehand, with the rest of
    o   o             what it is open by: what goes as dt^2 in every joint goes as dt^3 then.

omega is that of the step to come, so it is taken to go on as it did; where it jumps, it is the
last. The idea is that of SHAKE: J.-P. Ryckaert, G. Ciccotti and H. J. C. Berendsen, Journal of
Computational Physics 23 (1977): constraints hold at the end of a step, whatever the way there.
"""

import math
from collections.abc import Iterable

import pymunk

from models.scene import Point

JUMP_RAD = 0.02
"""What a body turns more in a step than in the one before, from which on its speed jumps."""


class Arcs:
    """The pins of a space, and how its bodies turned in the step before."""

    def __init__(self, constraints: Iterable[pymunk.Constraint], dt_s: float) -> None:
        self._dt = dt_s
        self._pins = [
            _anchored(each) for each in constraints if isinstance(each, pymunk.PivotJoint)
        ]
        bodies = dict.fromkeys(body for pin, _, _ in self._pins for body in (pin.a, pin.b))
        self._before = {body: body.angular_velocity for body in bodies}

    def move(self, joint: pymunk.PivotJoint, by: Point) -> None:
        """Move the anchor of a joint on its second body [m]."""
        for k, (pin, a, b) in enumerate(self._pins):
            if pin is joint:
                self._pins[k] = pin, a, (b[0] + by[0], b[1] + by[1])

    def bend(self) -> None:
        """Set the anchors for the next step."""
        shares = {}
        for body, before in self._before.items():
            omega = body.angular_velocity
            self._before[body] = omega
            more = omega - before
            going_on = omega + more if abs(more) * self._dt < JUMP_RAD else omega
            shares[body] = math.cos(going_on * self._dt)
        for pin, a, b in self._pins:
            first, second = shares[pin.a], shares[pin.b]
            pin.anchor_a = (a[0] * first, a[1] * first)
            pin.anchor_b = (b[0] * second, b[1] * second)


def _anchored(pin: pymunk.PivotJoint) -> tuple[pymunk.PivotJoint, Point, Point]:
    """A pin with its anchors as they are."""
    a, b = pin.anchor_a, pin.anchor_b
    return pin, (a.x, a.y), (b.x, b.y)
