"""The five class II dyads in fifty digits, each by an explicit formula in angles.

The solvers under test use vectors, Heron's area, and one Jacobian per dyad. Here stand the law of
cosines, arcus functions, and coordinates in the frame of the turning line; derivatives come from
`tests.analytic.change_points.jets`. What cannot close is taken as stretched, without rates.
"""

from __future__ import annotations

from dataclasses import dataclass

from mpmath import mp

from tests.analytic.change_points.jets import Jet, Number, acos, atan2, cos_sin, sin, sqrt


@dataclass(frozen=True)
class Place:
    x: Jet
    y: Jet

    def __add__(self, other: Place) -> Place:
        return Place(self.x + other.x, self.y + other.y)

    def __sub__(self, other: Place) -> Place:
        return Place(self.x - other.x, self.y - other.y)

    def times(self, factor: Jet | Number) -> Place:
        return Place(self.x * factor, self.y * factor)

    def dot(self, other: Place) -> Jet:
        return self.x * other.x + self.y * other.y

    def cross(self, other: Place) -> Jet:
        return self.x * other.y - self.y * other.x

    @property
    def angle(self) -> Jet:
        return atan2(self.y, self.x)

    @property
    def length(self) -> Jet:
        return sqrt(self.dot(self))


def toward(angle: Jet) -> Place:
    return Place(*cos_sin(angle))


def at(x: Number, y: Number) -> Place:
    return Place(Jet(x), Jet(y))


@dataclass(frozen=True)
class Line:
    """A line that moves: a point of its body and its angle."""

    through: Place
    angle: Jet

    def coordinates(self, point: Place) -> tuple[Jet, Jet]:
        """Along the line, and to its left, as seen by who turns with it."""
        away, along = point - self.through, toward(self.angle)
        return away.dot(along), along.cross(away)

    def at(self, s: Jet | Number) -> Place:
        return self.through + toward(self.angle).times(s)


def rrr(p1: Place, p2: Place, l1: Number, l2: Number, branch: int) -> tuple[Jet, Jet]:
    """The angles of P1 C and of P2 C."""
    away = p2 - p1
    d, phi = away.length, away.angle
    l1, l2 = mp.mpf(l1), mp.mpf(l2)
    at_p1 = acos((d * d + (l1 * l1 - l2 * l2)) / (d * (2 * l1)))
    at_p2 = acos((d * d + (l2 * l2 - l1 * l1)) / (d * (2 * l2)))
    return phi + at_p1 * branch, phi - at_p2 * branch + mp.pi


def rrp(p1: Place, line: Line, length: Number, branch: int) -> tuple[Jet, Jet]:
    """The angle of P1 C, and the displacement of C."""
    x, y = line.coordinates(p1)
    # Against the line's normal the link leans by the angle whose cosine is its height over length.
    lean = acos(y / -mp.mpf(length))
    return line.angle + mp.pi / 2 - lean * branch, x + sin(lean) * (branch * mp.mpf(length))


def rrp_short(p1: Place, line: Line, length: Number) -> Number:
    """By how much the dyad is short of closing; negative where it closes."""
    return abs(line.coordinates(p1)[1].value) - length


def rpr(p1: Place, p2: Place, offset: Number, branch: int) -> tuple[Jet, Jet]:
    """The angle of the line, and the displacement of P1 from the foot of P2."""
    away = p1 - p2
    h = mp.mpf(offset)
    s = sqrt(away.dot(away) - h * h) * branch
    return away.angle - atan2(Jet(h), s), s


def rpr_short(p1: Place, p2: Place, offset: Number) -> Number:
    return abs(offset) - (p1 - p2).length.value


def prp(line1: Line, line2: Line) -> tuple[Jet, Jet]:
    """The displacements at which two lines cross, by the rule of sines."""
    away = line2.through - line1.through
    apart = sin(line2.angle - line1.angle)
    s1 = away.cross(toward(line2.angle)) / apart
    s2 = away.cross(toward(line1.angle)) / apart
    return s1, s2


def rpp(p1: Place, line: Line, inner: Number) -> tuple[Jet, Jet]:
    """The displacements along the line, and along the direction at angle ``inner`` to it."""
    x, y = line.coordinates(p1)
    c, s = mp.cos_sin(mp.mpf(inner))
    return x - y * (c / s), y / s


def sine_rrr(p1: Place, p2: Place, l1: Number, l2: Number) -> Number:
    d2 = (p2 - p1).dot(p2 - p1).value
    l1, l2 = mp.mpf(l1), mp.mpf(l2)
    cosine = (l1 * l1 + l2 * l2 - d2) / (2 * l1 * l2)
    return mp.sqrt(max(0, (1 - cosine) * (1 + cosine)))
