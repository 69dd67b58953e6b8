"""All assemblies of a triad, with certainty: none is lost, none is counted twice.

The eliminant is exact, and its real roots are isolated by balls that are proven to hold one each
(Arb, by python-flint). The numbers of the rows count as exact.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace

from flint import acb, arb, ctx, fmpq, fmpq_poly

from analytic.assur.eliminant import (
    AngleRow,
    ContinuumError,
    Eliminant,
    LegRows,
    Place,
    Root,
    Turn,
    eliminant,
    is_zero,
    lengths_of,
    places_on_line,
    rational,
    row_polynomial,
    value,
)
from models.errors import CrankcheckError
from models.scene import Point

BITS = (320, 1280, 5120)
"""Precisions of the balls, raised until all places are known to ``SHARP``: the first is enough for
products of ten 53-bit numbers; numbers of very different sizes take more."""
SHARP = 2.0**-60
TURNS: tuple[Turn, ...] = tuple(
    (fmpq(c, r), fmpq(s, r))
    for c, s, r in (
        *((1, 0, 1), (3, 4, 5), (-5, 12, 13), (-15, -8, 17), (20, -21, 29)),
        *((12, 35, 37), (-9, 40, 41), (28, -45, 53)),
    )
)
"""Turns of the frame, so that no assembly is at phi = pi, where t is infinite: more turns than
there are assemblies."""


@dataclass(frozen=True)
class TriadAssembly:
    """Assembly of a triad: the angle of the central link in (-pi, pi] [rad] and the place of its
    origin [m]; ``count`` is above 1 where so many coincide (limit position, change point)."""

    angle_rad: float
    place: Point
    count: int = 1


@dataclass(frozen=True)
class _Solution:
    """Assembly in balls: angle ahead of the frame's turn, place, and number of coincident ones."""

    t: arb
    place: Place
    count: int

    def falls_on(self, other: _Solution) -> bool:
        """True if the balls of the two overlap."""
        pairs = zip((self.t, *self.place), (other.t, *other.place), strict=True)
        return all(one.overlaps(two) for one, two in pairs)

    def is_sharp(self, size: float) -> bool:
        """True if the place is known to a small part of itself, or is 0 beside a length."""
        wide = max(float(one.rad()) for one in self.place)
        far = max(abs(float(one.mid())) for one in self.place)
        return wide <= max(SHARP * far, SHARP**3 * size)


class _BluntError(ArithmeticError):
    """Balls are too wide."""


def assemblies(rows: LegRows) -> tuple[TriadAssembly, ...]:
    """Return all real assemblies, by increasing angle.

    Each is right to rounding: the balls of angle and place are far below the last digit.

    Raises
    ------
    ContinuumError
        The link can move while its supports stand still.
    CrankcheckError
        Two rows give an angle.
    """
    angles = [row for row in rows if isinstance(row, AngleRow)]
    if len(angles) > 1:
        raise CrankcheckError("two legs hold the angle of the central link, and none its place")
    size = _size(rows)
    for bits in BITS:
        with ctx.workprec(bits):
            try:
                every = _at_angle(angles[0], rows, size) if angles else _at_roots(rows, size)
            except _BluntError:
                continue
            return tuple(sorted(every, key=lambda one: (one.angle_rad, one.place)))
    raise CrankcheckError("the assemblies of the central link could not be distinguished")


def _at_roots(rows: LegRows, size: float) -> list[TriadAssembly]:
    """Return the assemblies at the roots of the eliminant, in a frame with none at half a turn."""
    for turn in TURNS:
        own = eliminant(rows, turn)
        if is_zero(own.polynomial):
            raise ContinuumError
        if not _may_be_at_half_a_turn(own):
            break
    else:
        raise _BluntError
    alone = [_alone(own, t, count) for t, count in _real_roots(own.polynomial)]
    return [_assembly(one, turn, size) for one in _joined(own, alone)]


def _alone(own: Eliminant, t: arb, count: int) -> _Solution:
    """Return the solution of two rows that are not parallel."""
    over = value(own.over, t)
    x, y = (value(n, t) / over for n in own.place)
    return _Solution(t, (x, y), count)


def _joined(own: Eliminant, alone: list[_Solution]) -> list[_Solution]:
    """Join these with the solutions where the two rows coincide."""
    every, (one, other, last) = list(alone), own.rows
    factors = own.parallel.factor()[1] if own.parallel.degree() > 0 else []
    for factor, power in factors:
        for t, _ in _real_roots(factor):
            root = Root(t, factor)
            for place, count in places_on_line((one, other), last, root):
                here = _Solution(t, place, power * count)
                if root.zero(own.polynomial):  # one of those alone comes to this angle as well
                    twins = [twin for twin in every if twin.falls_on(here)]
                    every = [each for each in every if not each.falls_on(here)]
                    here = replace(here, count=here.count + sum(twin.count for twin in twins))
                every.append(here)
    return every


def _real_roots(polynomial: fmpq_poly) -> Iterator[tuple[arb, int]]:
    """Yield the real roots with their multiplicity."""
    # python-flint's stubs are wrong: roots are pairs.
    roots: list[tuple[acb, int]] = polynomial.complex_roots()  # type: ignore[assignment]
    for root, count in roots if polynomial.degree() > 0 else ():
        if acb(root).imag == 0:
            yield acb(root).real, count


def _may_be_at_half_a_turn(own: Eliminant) -> bool:
    """True if the rows agree, or may agree, at t = infinity: their leading coefficients decide."""
    (a, b, k1), (c, d, k2), (u, v, k) = ([p[2] for p in (*row.u, row.k)] for row in own.rows)
    over, x, y = a * d - b * c, b * k2 - k1 * d, k1 * c - a * k2
    if over == 0:
        return bool(x == 0 and y == 0)  # two lines: the same one, or apart
    left = over * (x * u + y * v + over * k)
    return bool(left + (x * x + y * y if own.rows[2].is_circle else 0) == 0)


def _at_angle(angle: AngleRow, rows: LegRows, size: float) -> list[TriadAssembly]:
    """Return the assemblies of a link with a given angle: two rows at one t, or at half a turn."""
    c, s = angle.along
    half = c < 0.0  # in a frame that is turned by half a turn t is small
    turn = (fmpq(-1), fmpq(0)) if half else (fmpq(1), fmpq(0))
    root = Root.rational(rational(-s if half else s) / (1 + rational(abs(c))))
    one, last = sorted(
        (row_polynomial(row, turn) for row in rows if row is not angle),
        key=lambda row: row.is_circle,
    )
    if one.is_circle:
        one = one.less(last)
    found = (_Solution(root.ball, *each) for each in places_on_line((one,), last, root))
    at = math.atan2(s, c)
    return [replace(_assembly(each, turn, size), angle_rad=at) for each in found]


def _assembly(one: _Solution, turn: Turn, size: float) -> TriadAssembly:
    """Return a solution in floats, its angle in (-pi, pi]."""
    if not one.is_sharp(size):
        raise _BluntError
    ahead = arb.atan2(arb(turn[1]), arb(turn[0]))
    angle = float(2 * one.t.atan() + ahead)
    angle -= math.tau * math.ceil((angle - math.pi) / math.tau)
    x, y = one.place
    return TriadAssembly(angle, (float(x), float(y)), one.count)


def _size(rows: LegRows) -> float:
    """Return the smallest length in the rows but 0 [m]."""
    return min((abs(each) for row in rows for each in lengths_of(row) if each), default=1.0)
