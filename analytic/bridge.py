"""A redundant link: its pins move without it, so its motion follows from two of them.

::

        P1 ------- P2          d = P2 - P1, as long as the link between these pins, l
                               omega = d x v / l^2,  alpha = d x a / l^2

v and a are the velocity and the acceleration of P2 against P1. Unless |d| = l at every angle of the
driver, and every further pin of the link lies where its other bodies have it, the mechanism is
rigid: that is checked, to within what the places of the pins may be wrong by.
"""

from __future__ import annotations

import itertools
import math

import numpy as np

from analytic.chunk import Chunk
from analytic.dyads.parts import Turning
from analytic.groups import Bridge
from analytic.plane import EPS, AngleError, BodyKinematics, PointKinematics, Real, Vec
from analytic.riding import known_at, turning_body
from analytic.structure import Structure
from models.errors import StructureError
from models.joints import less, local_point
from models.scene import Scene

ROUNDING = 16 * EPS
"""What a misfit may come to by rounding, over the lengths and coordinates that go into it."""
ROUGH = 1e-7
"""The same where places carry no bounds: near a singular position half of their digits are lost."""


class BridgeStep:
    """A link between two known pins, and further ones that have to agree."""

    def __init__(
        self, scene: Scene, structure: Structure, bridge: Bridge, known: frozenset[str]
    ) -> None:
        self.link, self.key = bridge.link, f"link {bridge.link}"
        self.scene, self.driver = scene.name, scene.driver.link
        self.holds = {pin: known_at(structure, known, pin) for pin in bridge.pins}
        self.locals = {pin: local_point(scene, bridge.link, pin) for pin in bridge.pins}
        spans = {
            pair: less(self.locals[pair[1]], self.locals[pair[0]])
            for pair in itertools.combinations(bridge.pins, 2)
        }
        self.pin1, self.pin2 = max(spans, key=lambda pair: math.hypot(*spans[pair]))
        span = spans[self.pin1, self.pin2]
        self.length = math.hypot(*span)
        self.back = Vec(span[0] / self.length, span[1] / self.length)

    def advance(self, chunk: Chunk) -> None:
        """Add the link to the chunk. Raises StructureError where it does not fit."""
        at = {pin: chunk.point(hold, pin) for pin, hold in self.holds.items()}
        p1, p2 = at.pop(self.pin1), at.pop(self.pin2)
        body = self._placed(p1, p2)
        chunk.bodies[self.link], chunk.sines[self.key] = body, np.ones_like(body.turn.x)
        off = np.abs(body.turn.norm() - self.length)
        self._check(chunk, self.pin2, off, self._room(p1, p2))
        for pin, seen in at.items():
            own = body.point(self.locals[pin])
            self._check(chunk, pin, (seen.p - own.p).norm(), self._room(own, seen))

    def _check(self, chunk: Chunk, pin: str, off: Real, room: Real) -> None:
        """Refuse a pin that is off by more than it may be; note by how much where stretching."""
        over = off - room
        if chunk.stretch:
            before = chunk.shortage.get(self.key, over)
            chunk.shortage[self.key] = np.maximum(before, over)
        elif np.max(over) > 0.0:
            raise StructureError(self._misfit(chunk, pin, off, int(np.argmax(over))))

    def _placed(self, p1: PointKinematics, p2: PointKinematics) -> BodyKinematics:
        """The link from the motion of its two pins."""
        d, v, a = p2.p - p1.p, p2.v - p1.v, p2.a - p1.a
        square = self.length**2
        omega, alpha = d.cross(v) / square, d.cross(a) / square
        error = _error(p1, p2, d, self.length, (omega, alpha))
        found = Turning(d, omega, alpha, error, self.length)
        return turning_body(found, self.back, self.locals[self.pin1], p1)

    def _room(self, one: PointKinematics, other: PointKinematics) -> Real:
        """What the distance of two points may be off by though the link fits [m]."""
        size = one.p.norm() + other.p.norm() + self.length
        if one.error is None or other.error is None:
            return ROUGH * size
        return one.error.position + other.error.position + ROUNDING * size

    def _misfit(self, chunk: Chunk, pin: str, off: Real, index: int) -> str:
        """By how much the link does not fit, where, and what would work."""
        theta = chunk.bodies[self.driver].theta
        assert theta is not None
        how = f"has {pin} {off[index]:.3g} m away from where {self.holds[pin]} has it"
        if pin == self.pin2:
            apart = chunk.bodies[self.link].turn.norm()[index]
            how = (
                f"is {self.length:.9g} m long from {self.pin1} to {pin}, which stand {apart:.9g} m "
                f"apart, {off[index]:.3g} m off,"
            )
        degrees = math.degrees(theta[index])
        angle = f"{self.driver} at {degrees:.6g} deg"
        return (
            f"{self.scene}: redundant link {self.link} {how} with {angle}; "
            "links that move without it hold all its pins, so it has to fit at every angle, or "
            "nothing moves: mend its length, or remove it"
        )


def _error(
    p1: PointKinematics, p2: PointKinematics, d: Vec, length: float, rates: tuple[Real, Real]
) -> AngleError | None:
    """Bounds of the angle, the rate and the acceleration, if the pins carry theirs.

    With the errors e of d, ev of v and l known: e / l, doubled, is more than the angle (half a turn
    is the most); d x v differs by at most e |v| + l ev, and d x a likewise.
    """
    if p1.error is None or p2.error is None:
        return None
    omega, alpha = rates
    off = np.abs(d.norm() - length)
    place = p1.error.position + p2.error.position + off
    place = place + ROUNDING * (p1.p.norm() + p2.p.norm() + length)
    speed = p1.error.velocity + p2.error.velocity + ROUNDING * (p1.v.norm() + p2.v.norm())
    push = p1.error.acceleration + p2.error.acceleration
    push = push + ROUNDING * (p1.a.norm() + p2.a.norm())
    v, a = (p2.v - p1.v).norm(), (p2.a - p1.a).norm()
    return AngleError(
        np.fmin(2.0 * place / length, np.pi) + 4 * EPS,
        (place * v / length + speed) / length + ROUNDING * np.abs(omega),
        (place * a / length + push) / length + ROUNDING * np.abs(alpha),
    )
