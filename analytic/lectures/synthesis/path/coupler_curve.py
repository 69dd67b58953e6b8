"""Four-bar of real size with a point of its coupler, and its cognates.

::

              P              O2 and O4 are pivots, A and B the pins, P the coupler point,
            /   \\            at `arm` in the frame of the coupler (A at 0, B at its length).
        A --------- B        `sign` is 1 where B is to the left of the line from A to O4.
       /             \\
     O2 ------------- O4
"""

from __future__ import annotations

import cmath
import math
from dataclasses import dataclass, replace

import numpy as np

from analytic.lectures.synthesis.path import task
from analytic.lectures.synthesis.path.fit import Fitted
from models.array import Array


@dataclass(frozen=True)
class CouplerCurve:
    """Four-bar driven at O2: its pivots, lengths and coupler point [m]."""

    o2: complex
    o4: complex
    crank: float
    coupler: float
    rocker: float
    arm: complex
    sign: int

    @property
    def ground(self) -> float:
        """Distance of the pivots [m]."""
        return abs(self.o4 - self.o2)

    @property
    def shape(self) -> tuple[float, float, float]:
        """Crank, coupler and rocker over the ground."""
        return self.crank / self.ground, self.coupler / self.ground, self.rocker / self.ground

    @property
    def family(self) -> task.Family:
        """Family by the rotation of its crank."""
        return task.family_of(*self.shape)

    @property
    def size(self) -> float:
        """Longest of its links, the ground and the arms of P [m]."""
        arms = abs(self.arm), abs(self.arm - self.coupler)
        return max(self.ground, self.crank, self.coupler, self.rocker, *arms)

    def pins(self, crank_rad: Array) -> tuple[task.Complexes, task.Complexes]:
        """Return A and B at angles of the crank [rad]; the dyad stretched where it is open."""
        toward = (self.o4 - self.o2) / self.ground
        phi = self.sign * (crank_rad - cmath.phase(toward))
        a, b, c = (np.array(each) for each in self.shape)
        u, _ = task.direction((a, b, c), phi)
        turned = toward * (u if self.sign > 0 else u.conj())
        at = self.o2 + self.crank * np.exp(1j * crank_rad)
        return at, at + self.coupler * turned

    def at(self, crank_rad: Array) -> task.Complexes:
        """Return P at angles of the crank [rad]."""
        first, second = self.pins(crank_rad)
        return np.asarray(first + self.arm / self.coupler * (second - first))

    def leads_through(self, crank_rad: Array) -> bool:
        """True if the crank leads through its angles [rad], in order and within one turn."""
        steps = np.diff(crank_rad)
        one_way = bool(np.all(steps > 0.0) or np.all(steps < 0.0))
        if not one_way or abs(float(np.sum(steps))) >= math.tau:
            return False
        if self.family != "limited":
            return True
        phi = crank_rad - cmath.phase(self.o4 - self.o2)
        return task.closes_between(self.shape, float(np.min(phi)), float(np.max(phi)))

    def moved(self, by: complex, onto: complex) -> CouplerCurve:
        """Return it turned and scaled by one complex number, then moved by another [m]."""
        size = abs(by)
        return CouplerCurve(
            by * self.o2 + onto,
            by * self.o4 + onto,
            size * self.crank,
            size * self.coupler,
            size * self.rocker,
            size * self.arm,
            self.sign,
        )


def real_size(fit: Fitted) -> tuple[CouplerCurve, Array]:
    """Return the four-bar of a fit, in the unit of its path, and the crank's angles [rad]."""
    a, b, c = (float(each) for each in task.lengths(fit.family, fit.x))
    origin, ground, arm = (complex(each) for each in fit.placing)
    length, turn = abs(ground), cmath.phase(ground)
    own = CouplerCurve(
        origin, origin + ground, a * length, b * length, c * length, arm / ground * length, 1
    )
    angles = fit.phi + turn
    if not fit.mirrored:
        return own, angles
    o2, o4, arm = (place.conjugate() for place in (own.o2, own.o4, own.arm))
    return replace(own, o2=o2, o4=o4, arm=arm, sign=-1), -angles


def assembled(
    o2: complex, a: complex, b: complex, o4: complex, p: complex
) -> tuple[CouplerCurve, float]:
    """Return the four-bar of given pins and coupler point [m], and its crank's angle [rad]."""
    along = (b - a) / abs(b - a)
    left = ((o4 - a).conjugate() * (b - a)).imag > 0.0
    lengths_m = abs(a - o2), abs(b - a), abs(o4 - b)
    arm = (p - a) / along
    return CouplerCurve(o2, o4, *lengths_m, arm, 1 if left else -1), cmath.phase(a - o2)


def cognates(one: CouplerCurve, crank_rad: float) -> list[tuple[CouplerCurve, float]]:
    """Return the four-bars that draw the same curve, driven at each of their pivots, with their
    crank's angles [rad] at an angle of the given one's crank: five, and the one driven at O4.

    With p = AP/AB the third pivot is at O2 + p (O4 - O2), and every link of a cognate is a link of
    the given one, or one turned and scaled by p or 1 - p. Empty where P is on A or on B, for which
    the cognates have a link of no length.

    Source: theorem of Roberts and Chebyshev; R. L. Norton, Design of Machinery, section 3.7.
    """
    angle = np.array([crank_rad])
    (a,), (b,) = (pin.tolist() for pin in one.pins(angle))
    p = one.arm / one.coupler
    if min(abs(p), abs(1.0 - p)) < 1e-6:
        return []
    point = a + p * (b - a)
    third = one.o2 + p * (one.o4 - one.o2)
    left, right = one.o2 + p * (b - a), third + p * (b - one.o4)
    near, far = one.o4 + (1.0 - p) * (a - b), third + (1.0 - p) * (a - one.o2)
    loops = [
        (one.o2, a, b, one.o4),
        (one.o2, left, right, third),
        (one.o4, near, far, third),
    ]
    both = [way for loop in loops for way in (loop, loop[::-1])]
    return [assembled(*way, point) for way in both[1:]]
