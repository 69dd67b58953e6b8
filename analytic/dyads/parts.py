"""What every dyad solver takes and gives: turning and sliding unknowns, moving lines, closure."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any, Generic, TypeVar

import numpy as np

from analytic.dyads.plane import EPS, AngleError, PointKinematics, Real, Vec
from models.array import Array

CLOSED = 16 * EPS
"""A dyad open by no more than this, over the lengths in its closure, is closed but for rounding."""


@dataclass(frozen=True, slots=True)
class Turning:
    """An unknown rotation: a vector of constant ``length`` at its angle, its rate [rad/s] and
    acceleration [rad/s^2], bounds if asked for."""

    turn: Vec
    omega: Real
    alpha: Real
    error: AngleError | None = None
    length: float = 1.0


@dataclass(frozen=True, slots=True)
class SlideError:
    """Bounds on a slider's displacement [m], speed [m/s], acceleration [m/s^2]."""

    displacement: Real
    speed: Real
    acceleration: Real


@dataclass(frozen=True, slots=True)
class Sliding:
    """An unknown displacement [m], its rate [m/s] and acceleration [m/s^2], bounds if asked."""

    s: Real
    speed: Real
    acceleration: Real
    error: SlideError | None = None


First = TypeVar("First", Turning, Sliding)
Second = TypeVar("Second", Turning, Sliding)


@dataclass(frozen=True, slots=True)
class MovingLine:
    """A line of a known body: a point of it, its direction, and the rotation of the body."""

    point: PointKinematics
    along: Vec
    omega: Real
    alpha: Real
    error: AngleError | None

    def at(self, s: Real) -> Vec:
        """The place at displacement ``s`` from the point."""
        ahead: Vec = self.along * s
        return self.point.p + ahead

    def velocity(self, s: Real) -> Vec:
        """The velocity of the body's own point there."""
        return self.along.perp(self.omega * s) + self.point.v

    def acceleration(self, s: Real, speed: Real) -> Vec:
        """The acceleration of what slides there at ``speed``, Coriolis in, without its own."""
        across = self.alpha * s + 2.0 * self.omega * speed
        return (self.point.a + self.along.perp(across)).less(self.along, self.omega**2 * s)

    def errors(self, s: Real, speed: Real, es: Real, ev: Real) -> tuple[Real, Real, Real]:
        """Bounds on the errors of `at`, `velocity`, `acceleration` where s, speed have es, ev."""
        assert self.point.error is not None
        assert self.error is not None
        e, p = self.error, self.point.error
        w, g, d, v = abs(self.omega), abs(self.alpha), np.abs(s), np.abs(speed)
        shift = d * e.theta + es
        gain = e.alpha + e.omega * (2.0 * w + e.omega)
        position = p.position + d * e.theta
        velocity = p.velocity + d * e.omega + (w + e.omega) * shift
        coriolis = v * e.omega + (w + e.omega) * ev + w * v * e.theta
        acceleration = p.acceleration + d * gain + (g + w * w + gain) * shift + 2.0 * coriolis
        return position, velocity, acceleration

    def sizes(self, s: Real, speed: Real) -> tuple[Real, Real, Real]:
        """The sums of the lengths of the terms of `at`, `velocity`, `acceleration`."""
        w, d = abs(self.omega), np.abs(s)
        return (
            self.point.p.norm() + d,
            self.point.v.norm() + w * d,
            self.point.a.norm() + (abs(self.alpha) + w * w) * d + 2.0 * w * np.abs(speed),
        )


@dataclass(frozen=True, slots=True)
class Closure:
    """How a dyad closes.

    ``root`` is what its branch is the sign of, None for a dyad of one assembly; 0 where it is
    singular. ``short_m``, given for a stretched solution only, is by how much the dyad is short of
    closing [m] (negative: it closes), less half of ``rounding_m``, what rounding may open it by.
    Short by more than ``slack_m`` it closes nowhere within the bounds of its inputs. ``square``,
    given for such a solution too, is that of the root, below 0 where the dyad is open.
    """

    root: Real | None
    short_m: Real | None = None
    rounding_m: Real = 0.0
    slack_m: Real = 0.0
    square: Real | None = None


@dataclass(frozen=True, slots=True)
class Dyad(Generic[First, Second]):
    """The solved dyad; ``sine`` is its conditioning (1 best, 0 singular)."""

    first: First
    second: Second
    sine: Real
    closure: Closure

    def bounded(self, first: Any, second: Any) -> Dyad[First, Second]:
        """The dyad with the bounds of its two unknowns, of the kind that each of them has."""
        one, other = replace(self.first, error=first), replace(self.second, error=second)
        return replace(self, first=one, second=other)


def uncertain(one: PointKinematics, other: PointKinematics) -> Real:
    """What the distance of two points may be wrong by [m]; 0 where they carry no bounds."""
    if one.error is None or other.error is None:
        return 0.0
    return one.error.position + other.error.position


class OpenError(Exception):
    """The dyad cannot be assembled at some samples.

    ``short_m`` says by how much the closure fails at each sample (positive where it does) [m].
    """

    def __init__(self, short_m: Array) -> None:
        self.short_m = short_m
        super().__init__(f"the dyad is open by up to {np.max(short_m):.3g} m")


def closing_root(
    square: Real,
    shortage: Callable[[], tuple[Real, Real, Real]],
    stretch: bool,
    root: Real | None = None,
) -> tuple[Real, Closure]:
    """The square root of what closure leaves, 0 where rounding has taken it below 0.

    Parameters
    ----------
    square : Array or float
        Positive where the dyad closes.
    shortage : Callable
        By how much the dyad is short of closing [m] (negative: it closes), the sum of the lengths
        and coordinates that this is the difference of, and what the errors of its inputs may change
        it by; asked for only where it matters.
    stretch : bool
        Solve the dyad as if stretched where it is open, instead of raising.
    root : Array or None
        The root, where it is known better than the difference that ``square`` is.

    Returns
    -------
    tuple
        The root, and how the dyad closes.

    Raises
    ------
    OpenError
        Where the dyad is open by more than rounding.
    """
    if stretch:
        # A little less is let pass than when solving, so that the ends of a range can be solved.
        short, scale, slack = shortage()
        rounding = CLOSED * scale
        if root is None:
            root = np.sqrt(np.maximum(square, 0.0))
        return root, Closure(root, short - 0.5 * rounding, rounding, slack + rounding, square)
    if np.min(square) < 0.0:
        short, scale, _ = shortage()
        if np.any(short > CLOSED * scale):
            raise OpenError(np.broadcast_to(np.asarray(short), np.shape(square)))
        root = np.sqrt(np.maximum(square, 0.0))
    else:
        root = np.sqrt(square)
    return root, Closure(root)
