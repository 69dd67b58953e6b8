"""Redundant link: its pins move without it, so its motion follows from two of them.

::

        P1 ------- P2          d = P2 - P1, as long as the link between these pins, l
                               omega = d x v / d^2,  alpha = d x a / d^2

v and a are the velocity and the acceleration of P2 against P1. Unless |d| = l at every angle of the
driver, and every further pin of the link lies where its other bodies have it, the mechanism is
rigid. A sample shows it in the places of the pins and in the rates of their distance, d . v = 0 and
d . a + v . v = 0, all to within their bounds and `FIT`: lengths are written with some ten digits. A
misfit within `FIT` is part of the bounds of the link.
"""

import itertools
import math
from collections.abc import Sequence

import numpy as np

from analytic.dyads.chunk import Chunk
from analytic.dyads.parts import Turning
from analytic.dyads.plane import EPS, AngleError, PointKinematics, Real, sample
from analytic.dyads.riding import Bar, PlacedBodies
from analytic.structure.groups import Bridge
from models.errors import StructureError

FIT = 1e-9
"""Allowed misfit of a redundant link, over its length, and of its rates over those of its pins."""
ROUNDING = 16 * EPS
"""Misfit by rounding, over the lengths and coordinates that go into it."""
ROUGH = 1e-7
"""Largest misfit by rounding without bounds: a singular position loses half of the digits."""

Levels = tuple[Real, Real, Real]
"""Values of place [m], velocity [m/s] and acceleration [m/s^2]."""


class BridgeStep:
    """Link between two known pins, and further ones that have to agree."""

    def __init__(self, placed: PlacedBodies, bridge: Bridge) -> None:
        self.link, self.key = bridge.link, f"link {bridge.link}"
        self.scene, self.driver = placed.scene.name, placed.scene.driver.link
        self.holds = {pin: placed.holder(pin) for pin in bridge.pins}
        self.locals = {pin: placed.local(bridge.link, pin) for pin in bridge.pins}
        pairs = itertools.combinations(bridge.pins, 2)
        bars = {pair: Bar(placed, bridge.link, *pair) for pair in pairs}
        self.pin1, self.pin2 = max(bars, key=lambda pair: bars[pair].length)
        self.bar = bars[self.pin1, self.pin2]
        self.length = self.bar.length

    def advance(self, chunk: Chunk) -> None:
        """Add the link to the chunk. Raises StructureError where it does not fit."""
        at = {pin: chunk.point(hold, pin) for pin, hold in self.holds.items()}
        p1, p2 = at.pop(self.pin1), at.pop(self.pin2)
        d, v, a = p2.p - p1.p, p2.v - p1.v, p2.a - p1.a
        square = d.square()
        omega, alpha = d.cross(v) / square, d.cross(a) / square
        error = _error(p1, p2, self.length, (omega, alpha))
        body = self.bar.body(Turning(d, omega, alpha, error, self.length), p1)
        off = (
            np.abs(d.norm() - self.length),
            np.abs(d.dot(v)) / self.length,
            np.abs(d.dot(a) + v.square()) / self.length,
        )
        e0, ev, ea, *room = self._rooms(chunk, p1, p2)
        fast, push = v.norm(), a.norm()
        room[1] = room[1] + e0 * (fast + ev) / self.length
        room[2] = room[2] + (e0 * (push + ea) + ev * (2.0 * fast + ev)) / self.length
        self._check(chunk, self.pin2, off, room)
        chunk.bodies[self.link], chunk.sines[self.key] = body, np.ones_like(body.turn.x)
        for pin, seen in at.items():
            own = body.point(self.locals[pin])
            apart = (seen.p - own.p).norm(), (seen.v - own.v).norm(), (seen.a - own.a).norm()
            self._check(chunk, pin, apart, self._rooms(chunk, own, seen)[3:])

    def _check(self, chunk: Chunk, pin: str, off: Levels, room: Sequence[Real]) -> None:
        """Refuse a pin with too large a misfit; note the misfit where stretching."""
        if chunk.stretch:
            over = off[0] - room[0]
            before = chunk.shortage.get(self.key, over)
            chunk.shortage[self.key] = np.maximum(before, over)
            return
        for level in range(3):
            over = np.broadcast_to(off[level] - room[level], chunk.theta.shape)
            if np.any(over > 0.0):
                index = int(np.nanargmax(over))
                misfit = sample(off[level], index)
                raise StructureError(self._misfit(chunk, pin, level, misfit, index))

    def _rooms(
        self, chunk: Chunk, one: PointKinematics, other: PointKinematics
    ) -> tuple[Real, Real, Real, Real, Real, Real]:
        """Return the errors of the difference of two points, and the allowed misfits.

        Each is for place, velocity and acceleration. Without bounds, rounding grows with the
        inverse of the smallest sine of the dyads so far, and with its powers in the rates.
        """
        w, g = np.abs(chunk.driver.omega), np.abs(chunk.driver.alpha)
        size = one.p.norm() + other.p.norm() + self.length
        fast = one.v.norm() + other.v.norm() + self.length * w
        push = one.a.norm() + other.a.norm() + self.length * (w * w + g)
        if one.error is None or other.error is None:
            s = _smallest(chunk)
            e0 = np.minimum(ROUNDING / s, ROUGH) * size
            ev = (ROUNDING + e0 / self.length) * fast / s
            ea = (ROUNDING + e0 / self.length) * push / s**2
        else:
            levels = zip(one.error, other.error, (size, fast, push), strict=True)
            e0, ev, ea = (e + more + ROUNDING * most for e, more, most in levels)
        return e0, ev, ea, e0 + FIT * self.length, ev + FIT * fast, ea + FIT * push

    def _misfit(self, chunk: Chunk, pin: str, level: int, off: float, index: int) -> str:
        how = f"has {pin} {off:.3g} m away from where {self.holds[pin]} has it"
        if pin == self.pin2:
            p1, p2 = (chunk.point(self.holds[pin], pin).p for pin in (self.pin1, self.pin2))
            apart = np.hypot(sample((p2 - p1).x, index), sample((p2 - p1).y, index))
            how = (
                f"is {self.length:.12g} m long from {self.pin1} to {pin}, which stand "
                f"{apart:.12g} m apart, {off:.3g} m off,"
            )
        if level:
            unit = ("m/s", "m/s^2")[level - 1]
            away = f"{self.pin1} and {pin} part" if pin == self.pin2 else f"{pin} parts from it"
            how = f"fits in place only: {away} at {off:.3g} {unit}"
        angle = f"{self.driver} at {math.degrees(chunk.theta[index]):.6g} deg"
        return (
            f"{self.scene}: redundant link {self.link} {how} with {angle}; links that move "
            "without it hold all its pins, so it has to fit at every angle, or nothing moves: "
            f"correct its length (to within {FIT:g} of it: ten digits and more), or remove it"
        )


def _smallest(chunk: Chunk) -> Real:
    """Return the smallest sine of the dyads so far at every sample, rounding at least (0/0)."""
    smallest: Real = 1.0
    for sine in chunk.sines.values():
        smallest = np.minimum(smallest, np.nan_to_num(np.abs(sine), nan=0.0))
    return np.maximum(smallest, EPS)


def _error(
    p1: PointKinematics, p2: PointKinematics, length: float, rates: tuple[Real, Real]
) -> AngleError | None:
    """Return bounds of the angle, the rate and the acceleration, if the pins carry theirs.

    With the errors e of d, the misfit in it, and ev of v: e / l, doubled, is more than the angle
    (half a turn is the most); d / d^2 differs by e over both its lengths, and d x a likewise.
    """
    if p1.error is None or p2.error is None:
        return None
    omega, alpha = rates
    apart = (p2.p - p1.p).norm()
    off, least = np.abs(apart - length), np.minimum(apart, length)
    place = p1.error.position + p2.error.position + off
    place = place + ROUNDING * (p1.p.norm() + p2.p.norm() + length)
    speed = p1.error.velocity + p2.error.velocity + ROUNDING * (p1.v.norm() + p2.v.norm())
    push = p1.error.acceleration + p2.error.acceleration
    push = push + ROUNDING * (p1.a.norm() + p2.a.norm())
    v, a = (p2.v - p1.v).norm(), (p2.a - p1.a).norm()
    return AngleError(
        np.fmin(2.0 * place / length, np.pi) + 4 * EPS,
        (place * v / least + speed) / least + ROUNDING * np.abs(omega),
        (place * a / least + push) / least + ROUNDING * np.abs(alpha),
    )
