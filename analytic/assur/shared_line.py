"""Where the two rows that give the place say the same: at such an angle the third row decides.

Two rows u.P + k = 0 of one line leave a point to run on it,

    P = (-k u + q n) / g,      n = (-u_y, u_x),  g = u.u,  q any number,

and the third row is at most quadratic in q. What is 0 at a root is told from what is only small by
exact division by the polynomial of which it is the root, never by a ball.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from flint import arb, fmpq, fmpq_poly

from analytic.assur.eliminant import RowPolynomial, W
from models.errors import CrankcheckError

Place = tuple[arb, arb]


class ContinuumError(CrankcheckError):
    """The rows leave the link a motion of its own: it has assemblies without end."""

    def __init__(self) -> None:
        super().__init__(
            "the central link can move while all that it hangs on stands still; change a length"
        )


@dataclass(frozen=True)
class Root:
    """A real root in a ball, and the polynomial without rational factors that is 0 there."""

    ball: arb
    of: fmpq_poly

    @classmethod
    def rational(cls, t: fmpq) -> Root:
        """A rational number, the root of a polynomial of degree 1."""
        return cls(arb(t), fmpq_poly([-t, 1]))

    def zero(self, *polynomials: fmpq_poly) -> bool:
        """Whether all of them are exactly 0 there."""
        return all((each % self.of).degree() < 0 for each in polynomials)

    def at(self, polynomial: fmpq_poly) -> arb:
        """The value of a polynomial there."""
        return value(polynomial % self.of, self.ball)


def value(polynomial: fmpq_poly, t: arb) -> arb:
    """The value of a polynomial in a ball."""
    total = arb(0)
    for coefficient in reversed(polynomial.coeffs()):
        total = total * t + arb(coefficient)
    return total


def places_on_line(
    rows: Sequence[RowPolynomial], last: RowPolynomial, root: Root
) -> list[tuple[Place, int]]:
    """The places at an angle, t = ``root``, that are in rows of one line and in the ``last`` row.

    With each how often it is one: 2 where the line touches a circle.

    Raises
    ------
    ContinuumError
        These rows leave a line or a circle of places.
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
    """The real solutions of a q^2 + b q + c = 0 at a root, and how often each is one."""
    under, middle, twice = b * b - 4 * a * c, -root.at(b), 2 * root.at(a)
    if root.zero(under):
        return [(middle / twice, 2)]
    square = root.at(under)
    if square < 0:
        return []
    half = square.sqrt()
    return [((middle - half) / twice, 1), ((middle + half) / twice, 1)]
