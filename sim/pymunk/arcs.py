"""Joints in free motion, closed for the arcs of their points in a step, not for its chords.

::

        o r           Chipmunk turns a body by omega dt and moves its middle straight on, but gives
       /|             a joint the speeds that close it along the tangents, r x omega: after the step
      / | arc         its points are apart by the arcs' bend, (1 - cos omega dt) r of each body. An
     /  |             anchor at r cos(omega dt) corrects that beforehand, with the rest of the
    o   o             joint's opening: an error of dt^2 in every joint becomes one of dt^3.

omega of the next step is extrapolated from the last two; where it jumps, it is the last. The idea
is SHAKE: J.-P. Ryckaert, G. Ciccotti and H. J. C. Berendsen, Journal of Computational Physics 23
(1977): constraints hold at the end of a step, whatever the way there.
"""

import math
from collections.abc import Iterable

import pymunk

from models.scene import Point

JUMP_RAD = 0.02
"""Least change of a body's turn from one step to the next that counts as a jump of its speed."""


class Arcs:
    """Pins of a space, and the angular velocities of their bodies in the step before."""

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
    a, b = pin.anchor_a, pin.anchor_b
    return pin, (a.x, a.y), (b.x, b.y)
