"""Burmester's points: pivots of a crank that holds a body in four and in five of its positions.

A point of the body that lies on one circle in all positions is a circle point, the middle of that
circle its centre point; the two are the moving and the fixed pivot of a crank, here a `PoseDyad`.
With e_j = exp(i alpha_j) and d_j the displacements from the first position, the point w is at
e_j w + d_j, and with its centre m

    |d|^2 + d' e w + d e' w' - m' ((e - 1) w + d) - m ((e' - 1) w' + d') = 0      (' conjugates)

for j = 2, 3 ...: three such equations leave a curve, four leave at most four pairs.

Source: A. S. Hall, Kinematics and Linkage Design, chapter 5 (circle and centre points); G. N.
Sandor and A. G. Erdman, Advanced Mechanism Design, volume 2, chapter 3 (compatibility linkage).
"""

from collections.abc import Sequence

import numpy as np
from flint import acb, acb_mat, acb_poly, arb, ctx

from analytic.lectures.synthesis.pose import PlanePose, PoseDyad
from models.array import Array
from models.errors import CrankcheckError

BITS = 300
"""Bits of the arithmetic in which the quartic's real roots are separated from complex ones."""
MOST_BITS = 5000
SHARP = 1e-40
"""Required precision of roots, over their size: far beyond floats, so that all values from them are
exact to rounding."""
SPECIAL = 1e-9
"""Size of vanishing sides of the compatibility linkage, over those that make them."""
SWEEP = 720
"""Positions of the compatibility linkage's first link that the curves are drawn by."""


def five_positions(poses: Sequence[PlanePose]) -> list[PoseDyad]:
    """Return all real dyads of five positions: none, two or four, in no order.

    Linear in w m', m', m and w, the four equations leave a quartic in w'. Its roots are isolated in
    ball arithmetic. Conjugation maps solutions to solutions; its fixed points are the real ones,
    which isolated balls decide.

    Raises
    ------
    CrankcheckError
        Positions so special that the quartic has a multiple root, or that a curve of dyads fits.
    """
    for bits in (BITS, 3 * BITS, MOST_BITS):
        with ctx.workprec(bits):
            found = _real_dyads(poses)
        if found is not None:
            return found
    raise CrankcheckError(
        "the five positions are so special that two of their solutions fall together, or a whole "
        "curve of pivots fits; change one of them a little"
    )


def _real_dyads(poses: Sequence[PlanePose]) -> list[PoseDyad] | None:
    """Return the real dyads; None where balls of this size leave them open."""
    rows = [_row(poses[0], pose) for pose in poses[1:]]
    quartic, numerators, over = _quartic(rows)
    while quartic.degree() >= 0 and quartic[quartic.degree()].contains(0):
        quartic = acb_poly(list(quartic)[: quartic.degree()])  # a pivot at infinity
    if quartic.degree() < 1:
        return None
    try:
        roots = quartic.roots(tol=SHARP)
    except ValueError:
        return None
    places = [tuple(each(root) / over(root) for each in numerators) for root in roots]
    dyads = []
    for k, (w, m, _) in enumerate(places):
        meets = [n for n, root in enumerate(roots) if w.conjugate().overlaps(root)]
        if len(meets) > 1:
            return None
        if meets == [k]:
            origin = poses[0].point
            place, centre = complex(w) + origin, complex(m) + origin
            dyads.append(PoseDyad(centre, poses[0].back(place)))
    return dyads


Row = tuple[acb, ...]


def _row(first: PlanePose, pose: PlanePose) -> Row:
    """Return for one displacement, about the first reference point, the coefficients of w m', m', m
    (of degree 0 and 1 in w'), w, and the right side (of degree 0 and 1)."""
    angle = arb(pose.angle) - arb(first.angle)
    e = acb(angle.cos(), angle.sin())
    d = acb(pose.point) - acb(first.point)
    one, e_bar, d_bar = acb(1), e.conjugate(), d.conjugate()
    return one - e, -d, -d_bar, one - e_bar, d_bar * e, -d * d_bar, -d * e_bar


def _quartic(rows: Sequence[Row]) -> tuple[acb_poly, tuple[acb_poly, ...], acb_poly]:
    """Return the quartic in w', the numerators of w, m and m', and their denominator."""
    wm, mc, m0, m1, w, right0, right1 = (list(column) for column in zip(*rows, strict=True))
    m, right = (m0, m1), (right0, right1)

    def determinant(*columns: list[acb] | tuple[list[acb], list[acb]]) -> acb_poly:
        """Return the determinant of columns that are constant, or linear in w'."""
        coefficients = [acb(0)] * 3
        linear = [k for k, column in enumerate(columns) if isinstance(column, tuple)]
        for choice in np.ndindex(*(2,) * len(linear)):
            taken = [
                column[choice[linear.index(k)]] if isinstance(column, tuple) else column
                for k, column in enumerate(columns)
            ]
            matrix = acb_mat([[column[row] for column in taken] for row in range(4)])
            coefficients[sum(choice)] += matrix.det()
        return acb_poly(coefficients)

    over = determinant(wm, mc, m, w)
    of_wm = determinant(right, mc, m, w)
    of_mc = determinant(wm, right, m, w)
    of_m = determinant(wm, mc, right, w)
    of_w = determinant(wm, mc, m, right)
    return of_wm * over - of_mc * of_w, (of_w, of_m, of_mc), over


def four_positions(poses: Sequence[PlanePose], count: int = SWEEP) -> list[list[PoseDyad]]:
    """Return dyads of four positions along Burmester's curves: pieces of them, in order.

    A crank of vector v, turned by beta_j, has v (exp(i beta_j) - e_j) + m (1 - e_j) = d_j. Two of
    the three equations give v and m; the third one is the closure of a four-bar with the sides
    Delta_j, the compatibility linkage, which is turned through ``count`` angles beta_2.
    """
    first = poses[0]
    e = np.exp(1j * np.array([pose.angle - first.angle for pose in poses[1:]]))
    d = np.array([pose.point - first.point for pose in poses[1:]])
    a = 1.0 - e
    delta = np.array(
        [a[1] * d[2] - a[2] * d[1], a[2] * d[0] - a[0] * d[2], a[0] * d[1] - a[1] * d[0]]
    )
    turned, moved = float(np.max(np.abs(a))), float(np.max(np.abs(d)))
    if np.max(np.abs(delta)) <= SPECIAL * max(turned, SPECIAL) * moved:
        raise CrankcheckError(
            "the four positions are so special (turns about one point, or none at all) that they "
            "have no curves; take three of them, or change one a little"
        )
    ground = -np.sum(delta * e)
    # The shortest side turns further than the others: it leads.
    lead = int(np.argmin(np.abs(delta)))
    order = [lead, (lead + 1) % 3, (lead + 2) % 3]
    sides = np.array([e, d, a, delta])[:, order]
    beta = np.exp(2j * np.pi * np.arange(count + 1) / count)
    sheets = (_sheet(first, sides, ground, beta, sign) for sign in (1.0, -1.0))
    return [piece for sheet in sheets for piece in sheet]


def _sheet(
    first: PlanePose, sides: Array, ground: complex, beta: Array, sign: float
) -> list[list[PoseDyad]]:
    """Return the pieces of the curves in one of the compatibility linkage's two assemblies;
    ``sides`` (4, 3) are e, d, 1 - e and Delta, those of the leading side first."""
    e, d, a, delta = sides
    rest = -(ground + delta[0] * beta)
    p, q, r = abs(delta[1]), abs(delta[2]), np.abs(rest)
    with np.errstate(divide="ignore", invalid="ignore"):
        cosine = (p**2 + r**2 - q**2) / (2.0 * p * r)
        side = rest / r * p * (cosine + 1j * sign * np.sqrt(1.0 - cosine**2))
        turned = side / delta[1]
        # Of the three equations, the two of the best condition.
        x, y = beta - e[0], turned - e[1]
        det = x * a[1] - y * a[0]
        v = (d[0] * a[1] - d[1] * a[0]) / det
        m = (x * d[1] - y * d[0]) / det
        w = v + m
    good = np.isfinite(w) & np.isfinite(m) & (np.abs(det) > 1e-9)
    pieces: list[list[PoseDyad]] = [[]]
    for place, centre, is_one in zip(w, m, good, strict=True):
        if is_one:
            dyad = PoseDyad(complex(centre) + first.point, first.back(complex(place) + first.point))
            pieces[-1].append(dyad)
        elif pieces[-1]:
            pieces.append([])
    return [piece for piece in pieces if piece]
