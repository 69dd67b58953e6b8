"""All assemblies of a triad, with certainty: none is lost, none is counted twice.

The eliminant is exact, and its real roots are isolated by balls that are proven to hold one each
(Arb, by python-flint). The numbers of the rows are taken as they are.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

from flint import acb, arb, ctx, fmpq, fmpq_poly

from analytic.assur.eliminant import (
    Eliminant,
    RowPolynomial,
    Turn,
    eliminant,
    is_zero,
    rational,
    row_polynomial,
)
from analytic.assur.leg_rows import AngleRow, LegRow, LegRows
from models.errors import CrankcheckError
from models.scene import Point

BITS = 320
"""Of the balls: what is left of 53-bit numbers after products of ten of them."""
LOOSE = "the central link can move while all that it hangs on stands still"
TURNS: tuple[Turn, ...] = (
    (fmpq(1), fmpq(0)),
    (fmpq(3, 5), fmpq(4, 5)),
    (fmpq(-5, 13), fmpq(12, 13)),
    (fmpq(-15, 17), fmpq(-8, 17)),
    (fmpq(20, 29), fmpq(-21, 29)),
)
"""By which the frame may be turned, so that no assembly is at phi = pi, where t is infinite."""


@dataclass(frozen=True)
class Assembly:
    """One of them: the angle of the central link in (-pi, pi] [rad] and the place of its origin
    [m]; ``count`` is 2 or more where so many fall together (a limit position or a change point)."""

    angle_rad: float
    place: Point
    count: int = 1


class ContinuumError(CrankcheckError):
    """The rows leave the link a motion of its own: it has assemblies without end."""


def assemblies(rows: LegRows) -> tuple[Assembly, ...]:
    """All real assemblies, by increasing angle.

    Raises
    ------
    ContinuumError
        The link can move while all that it hangs on stands still.
    """
    with ctx.workprec(BITS):
        angles = [row for row in rows if isinstance(row, AngleRow)]
        if len(angles) > 1:
            raise CrankcheckError("two legs hold the angle of the central link, and none its place")
        if angles:
            others = [row for row in rows if row is not angles[0]]
            found = list(_at_angle(angles[0], others))
        else:
            found = _at_roots(rows)
    return tuple(sorted(found, key=lambda one: (one.angle_rad, one.place)))


def _at_roots(rows: LegRows) -> list[Assembly]:
    """Those at the roots of the eliminant, in a frame in which none is at half a turn."""
    for turn in TURNS:
        own = eliminant(rows, turn)
        if is_zero(own.polynomial) or is_zero(own.parallel):
            raise ContinuumError(
                "the central link can move while all that it hangs on stands still"
            )
        if not _may_be_at_half_a_turn(rows, turn):
            break
    else:
        raise CrankcheckError("the assemblies of the central link could not be told apart")
    ahead = math.atan2(_float(arb(turn[1])), _float(arb(turn[0])))
    found = []
    for t, count in _real_roots(own.polynomial):
        over = _at(own.over, t)
        x, y = (_at(n, t) / over for n in own.place)
        found.append(Assembly(_angle(t, ahead), (_float(x), _float(y)), count))
    for t, _ in _real_roots(own.parallel):
        found += [
            Assembly(_angle(t, ahead), place, count) for place, count in _where_parallel(own, t)
        ]
    return found


def _real_roots(polynomial: fmpq_poly) -> Iterator[tuple[arb, int]]:
    """The real roots with their multiplicity."""
    # Of what its stubs say of roots, python-flint keeps nothing: they are pairs.
    roots: list[tuple[acb, int]] = polynomial.complex_roots()  # type: ignore[assignment]
    for root, count in roots if polynomial.degree() > 0 else ():
        if acb(root).imag == 0:
            yield acb(root).real, count


def _may_be_at_half_a_turn(rows: LegRows, turn: Turn) -> bool:
    """Whether the rows agree at t = infinity, or may: the leading coefficients are theirs there."""
    own = sorted((row_polynomial(row, turn) for row in rows), key=lambda row: row.is_circle)
    last = own[2]
    one, other = (row.less(last) if row.is_circle else row for row in own[:2])
    (a, b), (c, d) = ([_second(u) for u in row.u] for row in (one, other))
    over, k1, k2 = a * d - b * c, _second(one.k), _second(other.k)
    if over == 0:
        return True
    x, y = (b * k2 - k1 * d) / over, (k1 * c - a * k2) / over
    left = x * _second(last.u[0]) + y * _second(last.u[1]) + _second(last.k)
    return bool(left + (x * x + y * y if last.is_circle else 0) == 0)


def _second(polynomial: fmpq_poly) -> fmpq:
    return polynomial[2]


def _where_parallel(own: Eliminant, t: arb) -> Iterator[tuple[Point, int]]:
    """The places at an angle at which the two rows say the same: on their line, and in the third.

    Raises ContinuumError where that says nothing more either.
    """
    one, other, last = own.rows
    row = max((one, other), key=lambda each: float(_length(each, t).mid()))
    (ux, uy), k = ((_at(u, t)) for u in row.u), _at(row.k, t)
    yield from _on_line((ux, uy), k, last, t)


def _length(row: RowPolynomial, t: arb) -> arb:
    return sum((_at(u, t) ** 2 for u in row.u), arb(0)).sqrt()


def _on_line(
    u: tuple[arb, arb], k: arb, last: RowPolynomial, t: arb
) -> Iterator[tuple[Point, int]]:
    """The places on the line u.P + k = 0 that are in another row."""
    square = u[0] * u[0] + u[1] * u[1]
    if square.contains(0):
        raise ContinuumError(LOOSE)
    foot, along = (-u[0] * k / square, -u[1] * k / square), (-u[1], u[0])
    v, c = [_at(each, t) for each in last.u], _at(last.k, t)
    slope = v[0] * along[0] + v[1] * along[1]
    level = v[0] * foot[0] + v[1] * foot[1] + c
    if not last.is_circle:
        if slope.contains(0):
            raise ContinuumError("two legs hold the central link on the same line, or on none")
        ways = [(-level / slope, 1)]
    else:
        w = 1 + t * t
        a, b = w * square, slope + 2 * w * (foot[0] * along[0] + foot[1] * along[1])
        d = level + w * (foot[0] ** 2 + foot[1] ** 2)
        ways = _quadratic(a, b, d)
    for way, count in ways:
        yield (_float(foot[0] + along[0] * way), _float(foot[1] + along[1] * way)), count


def _quadratic(a: arb, b: arb, c: arb) -> list[tuple[arb, int]]:
    """The real roots of a x^2 + b x + c; two that can not be told apart are one of count 2."""
    under = b * b - 4 * a * c
    if under.contains(0):
        return [(-b / (2 * a), 2)]
    if under < 0:
        return []
    root = under.sqrt()
    return [((-b - root) / (2 * a), 1), ((-b + root) / (2 * a), 1)]


def _at_angle(angle: AngleRow, others: list[LegRow]) -> Iterator[Assembly]:
    """Those of a link whose angle is given: two rows at one t, or at half a turn."""
    c, s = angle.along
    half = c < 0.0  # in a frame that is turned by half a turn t is small
    turn = (fmpq(-1), fmpq(0)) if half else (fmpq(1), fmpq(0))
    t = arb(rational(-s if half else s)) / arb(1 + rational(abs(c)))
    rows = sorted((row_polynomial(row, turn) for row in others), key=lambda row: row.is_circle)
    one, last = rows
    if one.is_circle:
        one = one.less(last)
    u, k = (_at(one.u[0], t), _at(one.u[1], t)), _at(one.k, t)
    for place, count in _on_line(u, k, last, t):
        yield Assembly(math.atan2(s, c), place, count)


def _angle(t: arb, ahead: float) -> float:
    """The angle of the link [rad] in (-pi, pi]."""
    angle = 2.0 * math.atan(_float(t)) + ahead
    return angle - math.tau * math.ceil((angle - math.pi) / math.tau)


def _at(polynomial: fmpq_poly, t: arb) -> arb:
    """Its value in a ball."""
    value = arb(0)
    for coefficient in reversed(polynomial.coeffs()):
        value = value * t + arb(coefficient)
    return value


def _float(ball: arb) -> float:
    return float(ball.mid())
