"""Exact equation of a triad in one unknown: t = tan(phi/2) of the central link's angle."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from flint import arb, fmpq, fmpq_poly

from models.errors import CrankcheckError
from models.scene import Point


@dataclass(frozen=True)
class CircleRow:
    """|P + R a - A| = L: ``a`` in the link's frame [m], known pin ``A``, ``length`` L [m]."""

    a: Point
    pin: Point
    length: float


@dataclass(frozen=True)
class LineRow:
    """n . (P + R a - p) = 0: ``a`` runs on the known line through ``p`` with ``normal`` n."""

    a: Point
    normal: Point
    through: Point


@dataclass(frozen=True)
class ThroughRow:
    """(R m) . (A - P) = m . b: the link's own line, ``normal`` m through ``b`` in its frame, passes
    through the known pin ``A``."""

    normal: Point
    b: Point
    pin: Point


@dataclass(frozen=True)
class AngleRow:
    """R (1, 0) is ``along``, a unit vector."""

    along: Point


LegRow = CircleRow | LineRow | ThroughRow | AngleRow
LegRows = tuple[LegRow, LegRow, LegRow]


def lengths_of(row: LegRow) -> tuple[float, ...]:
    """Return the values of a row in metres."""
    if isinstance(row, CircleRow):
        return (*row.a, *row.pin, row.length)
    if isinstance(row, LineRow):
        return (*row.a, *row.through)
    return (*row.b, *row.pin) if isinstance(row, ThroughRow) else ()


W = fmpq_poly([1, 0, 1])
Turn = tuple[fmpq, fmpq]
"""Cosine and sine of an angle, both rational."""


@dataclass(frozen=True)
class RowPolynomial:
    """Row as (w P.P) + u.P + k: ``is_circle`` if it has the first term, u and k."""

    is_circle: bool
    u: tuple[fmpq_poly, fmpq_poly]
    k: fmpq_poly

    def less(self, other: RowPolynomial) -> RowPolynomial:
        """Return the difference of two circles."""
        u = (self.u[0] - other.u[0], self.u[1] - other.u[1])
        return RowPolynomial(False, u, self.k - other.k)


@dataclass(frozen=True)
class Eliminant:
    """Polynomial of all assemblies except where the two rows that give the place are parallel;
    these are at roots of ``parallel``.

    ``place`` is N, and ``over`` D; ``rows`` are the two that give it and, last, the third.
    """

    polynomial: fmpq_poly
    place: tuple[fmpq_poly, fmpq_poly]
    over: fmpq_poly
    parallel: fmpq_poly
    rows: tuple[RowPolynomial, RowPolynomial, RowPolynomial]


def rational(value: float) -> fmpq:
    """Return the exact rational value of a float."""
    return fmpq(*float(value).as_integer_ratio())


def row_polynomial(row: LegRow, turn: Turn) -> RowPolynomial:
    """Return a row whose link frame is first turned by a constant angle."""
    if isinstance(row, CircleRow):
        reach, pin = _turning(row.a, turn), _pair(row.pin)
        square = sum((c * c for c in (*_pair(row.a), *pin)), fmpq(0)) - rational(row.length) ** 2
        ux, uy = (2 * (r - W * p) for r, p in zip(reach, pin, strict=True))
        k = W * square - 2 * (reach[0] * pin[0] + reach[1] * pin[1])
        return RowPolynomial(True, (ux, uy), k)
    if isinstance(row, LineRow):
        reach, n, p = _turning(row.a, turn), _pair(row.normal), _pair(row.through)
        k = reach[0] * n[0] + reach[1] * n[1] - W * (n[0] * p[0] + n[1] * p[1])
        return RowPolynomial(False, (W * n[0], W * n[1]), k)
    assert isinstance(row, ThroughRow)
    normal, pin = _turning(row.normal, turn), _pair(row.pin)
    m, b = _pair(row.normal), _pair(row.b)
    k = normal[0] * pin[0] + normal[1] * pin[1] - W * (m[0] * b[0] + m[1] * b[1])
    return RowPolynomial(False, (-normal[0], -normal[1]), k)


def eliminant(rows: LegRows, turn: Turn) -> Eliminant:
    """Return the eliminant of three rows, none of which gives an angle."""
    assert not any(isinstance(row, AngleRow) for row in rows)
    own = sorted((row_polynomial(row, turn) for row in rows), key=lambda row: row.is_circle)
    last = own[2]
    one, other = (row.less(last) if row.is_circle else row for row in own[:2])
    over = one.u[0] * other.u[1] - one.u[1] * other.u[0]
    place = (one.u[1] * other.k - one.k * other.u[1], one.k * other.u[0] - one.u[0] * other.k)
    shared = _without_w(over.gcd(place[0]).gcd(place[1]))
    if not all(map(is_zero, (over, *place))):
        over, place = over / shared, (place[0] / shared, place[1] / shared)
    polynomial = last.u[0] * place[0] + last.u[1] * place[1] + last.k * over
    if is_zero(over) and not all(map(is_zero, place)):
        polynomial = fmpq_poly([1])  # parallel at every angle: they give no place
    elif last.is_circle:
        polynomial = W * (place[0] ** 2 + place[1] ** 2) + over * polynomial
    else:
        polynomial = _without(polynomial, over)  # there the place is infinitely far away
    return Eliminant(_without_w(polynomial), place, over, shared, (one, other, last))


def is_zero(polynomial: fmpq_poly) -> bool:
    """True if all its coefficients are 0."""
    return polynomial.degree() < 0


def _without_w(polynomial: fmpq_poly) -> fmpq_poly:
    """Return a polynomial without its factors 1 + t^2."""
    return polynomial if is_zero(polynomial) else _without(polynomial, W)


def _without(polynomial: fmpq_poly, factor: fmpq_poly) -> fmpq_poly:
    """Return a polynomial without its common factors with another."""
    while not is_zero(polynomial) and (common := polynomial.gcd(factor)).degree() > 0:
        polynomial = polynomial / common
    return polynomial


def _pair(vector: Point) -> tuple[fmpq, fmpq]:
    return rational(vector[0]), rational(vector[1])


def _turning(vector: Point, turn: Turn) -> tuple[fmpq_poly, fmpq_poly]:
    """Return w R a, a vector of the link's frame in the plane, as polynomials in t."""
    (x, y), (c, s) = _pair(vector), turn
    x, y = c * x - s * y, s * x + c * y
    return fmpq_poly([x, -2 * y, -x]), fmpq_poly([y, 2 * x, -y])


Place = tuple[arb, arb]


class ContinuumError(CrankcheckError):
    """The rows leave the link a motion of its own: it has infinitely many assemblies."""

    def __init__(self) -> None:
        super().__init__(
            "the central link can move while its neighbours stand still; change a length"
        )


@dataclass(frozen=True)
class Root:
    """Real root in a ball, and the polynomial without rational factors that is 0 there."""

    ball: arb
    of: fmpq_poly

    @classmethod
    def rational(cls, t: fmpq) -> Root:
        """Return a rational number as the root of a polynomial of degree 1."""
        return cls(arb(t), fmpq_poly([-t, 1]))

    def zero(self, *polynomials: fmpq_poly) -> bool:
        """True if all of them are exactly 0 there."""
        return all((each % self.of).degree() < 0 for each in polynomials)

    def at(self, polynomial: fmpq_poly) -> arb:
        """Return the value of a polynomial there."""
        return value(polynomial % self.of, self.ball)


def value(polynomial: fmpq_poly, t: arb) -> arb:
    """Return the value of a polynomial in a ball."""
    total = arb(0)
    for coefficient in reversed(polynomial.coeffs()):
        total = total * t + arb(coefficient)
    return total


def places_on_line(
    rows: Sequence[RowPolynomial], last: RowPolynomial, root: Root
) -> list[tuple[Place, int]]:
    """Return the places at an angle, t = ``root``, on rows of one line and on the ``last`` row.

    Each comes with its multiplicity: 2 where the line touches a circle.

    Raises
    ------
    ContinuumError
        These rows leave a line or a circle of places.

    Two rows u.P + k = 0 of one line leave a point to run on it,

        P = (-k u + q n) / g,      n = (-u_y, u_x),  g = u.u,  q any number,

    and the third row is at most quadratic in q. Exact division by the polynomial of the root, never
    a ball, separates zero from small values at a root.
    """
    lines = [row for row in rows if not root.zero(*row.u)]
    if not root.zero(*(row.k for row in rows if root.zero(*row.u))):
        return []  # 0 = k: two circles about one centre, say
    if not lines:
        raise ContinuumError
    (x, y), k = lines[0].u, lines[0].k
    g, (vx, vy) = x * x + y * y, last.u
    slope, level = vy * x - vx * y, last.k * g - k * (vx * x + vy * y)
    if last.is_circle:
        solutions = _quadratic(W, slope, level + W * k * k, root)
    elif not root.zero(slope):
        solutions = [(-root.at(level) / root.at(slope), 1)]
    elif root.zero(level):
        raise ContinuumError
    else:
        solutions = []
    ux, uy, k0, g0 = (root.at(each) for each in (x, y, k, g))
    return [(((-k0 * ux - q * uy) / g0, (q * ux - k0 * uy) / g0), n) for q, n in solutions]


def _quadratic(a: fmpq_poly, b: fmpq_poly, c: fmpq_poly, root: Root) -> list[tuple[arb, int]]:
    """Return the real solutions of a q^2 + b q + c = 0 at a root, with multiplicities."""
    under, middle, twice = b * b - 4 * a * c, -root.at(b), 2 * root.at(a)
    if root.zero(under):
        return [(middle / twice, 2)]
    square = root.at(under)
    if square < 0:
        return []
    half = square.sqrt()
    return [((middle - half) / twice, 1), ((middle + half) / twice, 1)]
