"""All assemblies of a triad by following paths: a second method, by POLSYS_PLP.

The link's place and its turn are complex numbers z and tau; with their conjugates as unknowns of
their own, each row is of degree 1 in (z, tau) and in (z', tau'), and so is tau tau' = 1. Four such
equations have six solutions, some of them infinitely far away, and a path is followed to each.
Those with z' and tau' the conjugates of z and tau are real.

Source: S. Wise, A. Sommese, L. Watson, Algorithm 801: POLSYS_PLP, ACM Transactions on Mathematical
Software 26, 2000.
"""

import itertools
import math
from collections.abc import Sequence

import numpy as np
from pypolsys import polsys, utils

from analytic.assur.eliminant import AngleRow, CircleRow, LegRow, LegRows, LineRow
from models.array import Array

Powers = tuple[int, int, int, int]
Equation = dict[Powers, complex]
ONE, Z, TAU = (0, 0, 0, 0), (1, 0, 0, 0), (0, 1, 0, 0)
UNIT: Equation = {(0, 1, 0, 1): 1.0, ONE: -1.0}
FAR = 1e6
"""Beyond it, in lengths of the rows, a path has gone to infinity."""
CLOSE = 1e-9
"""Below it two solutions are not told apart."""


def solutions(rows: LegRows, number: int) -> Array:
    """All finite solutions (z, tau, z', tau'), as rows (K, 4): so many, or what was found of them.

    Where paths end badly the equations are multiplied by other complex numbers, which leads to the
    same ends by other paths; beside ends that lie close together Newton's method starts anew.
    """
    return finite_solutions(system(rows), number)


def finite_solutions(equations: Sequence[Equation], number: int) -> Array:
    """The same of four equations, of degree 1 in the first two unknowns and in the others."""
    draw = np.random.default_rng(1)
    every = np.zeros((0, 4), complex)
    for attempt in range(8):
        factors = np.exp(1j * draw.uniform(0.0, math.tau, 4)) if attempt else np.ones(4)
        pairs = zip(equations, factors, strict=True)
        ends = _followed([{k: factor * v for k, v in each.items()} for each, factor in pairs])
        every = once([*every, *corrected(equations, ends)])
        if attempt and len(every) < number:
            aside = np.repeat(ends, 4, axis=0)
            aside += 1e-3 * (draw.normal(size=aside.shape) + 1j * draw.normal(size=aside.shape))
            every = once([*every, *corrected(equations, aside)])
        if len(every) >= number:
            break
    return every


def _followed(equations: Sequence[Equation]) -> Array:
    """The finite ends of the paths (K, 4)."""
    polsys.init_poly(
        4,
        np.array([len(each) for each in equations], dtype=np.int32),
        np.array([value for each in equations for value in each.values()], dtype=complex),
        np.array([powers for each in equations for powers in each], dtype=np.int32),
    )
    polsys.init_partition(*utils.make_mh_part(4, [[1, 2], [3, 4]]))
    polsys.solve(1e-8, 1e-14, 0.0)
    ends = polsys.myroots[:4].T.copy()
    return ends[np.maximum(np.abs(ends.real), np.abs(ends.imag)).max(axis=1) < FAR]


def once(ends: Sequence[Array]) -> Array:
    every: list[Array] = []
    for end in ends:
        if not any(np.abs(end - other).max() < CLOSE * (1.0 + np.abs(end[0])) for other in every):
            every.append(end)
    return np.array(every).reshape(-1, 4)


def real(ends: Array) -> Array:
    """The real ones as angle [rad] and place [m] of the link, (K, 3), by increasing angle."""
    z, tau, z_bar, tau_bar = ends.T
    off = np.abs(z - z_bar.conj()) + np.abs(tau - tau_bar.conj())
    own = ends[off < CLOSE * (1.0 + np.abs(z))]
    every = np.stack([np.angle(own[:, 1]), own[:, 0].real, own[:, 0].imag], axis=1)
    return every[np.argsort(every[:, 0])]


def corrected(equations: Sequence[Equation], ends: Array) -> Array:
    """Where Newton's method ends, of ends at which it does (K, 4)."""
    step = np.full(len(ends), np.inf)
    for _ in range(12):
        left, slopes = _left(equations, ends)
        regular = (np.abs(np.linalg.det(slopes)) > 0.0) & (np.abs(ends).max(axis=1) < FAR)
        change = np.linalg.solve(slopes[regular], left[regular][:, :, None])[:, :, 0]
        ends, step = ends[regular] - change, np.abs(change).max(axis=1)
        if (step < 1e-13).all():
            break
    return ends[step < 0.1 * CLOSE * (1.0 + np.abs(ends).max(axis=1))]


def _left(equations: Sequence[Equation], at: Array) -> tuple[Array, Array]:
    """What points (K, 4) leave of the equations, (K, 4), and its slopes, (K, 4, 4)."""
    left, slopes = np.zeros((len(at), 4), complex), np.zeros((len(at), 4, 4), complex)
    for row, equation in enumerate(equations):
        for powers, factor in equation.items():
            left[:, row] += factor * np.prod(at ** np.array(powers), axis=1)
            for column, power in enumerate(powers):
                if power:  # it is 1: no unknown comes twice in a term
                    less = np.array(powers) - np.eye(4, dtype=int)[column]
                    slopes[:, row, column] += factor * np.prod(at**less, axis=1)
    return left, slopes


def system(rows: LegRows) -> list[Equation]:
    equations = [equation for row in rows for equation in equations_of(row)]
    return equations if len(equations) == 4 else [*equations, UNIT]  # of an angle there are two


def equations_of(row: LegRow) -> list[Equation]:
    """A row as an equation of the four unknowns, or two for an angle."""
    if isinstance(row, AngleRow):
        along = complex(*row.along)
        own: Equation = {TAU: 1.0, ONE: -along}
        return [own, conjugate(own)]
    if isinstance(row, CircleRow):
        own = {Z: 1.0, TAU: complex(*row.a), ONE: -complex(*row.pin)}
        return [total(product(own, conjugate(own)), {ONE: -(row.length**2)})]
    across = complex(*row.normal).conjugate()
    if isinstance(row, LineRow):
        own = {Z: across, TAU: across * complex(*row.a), ONE: -across * complex(*row.through)}
    else:
        own = product({(0, 0, 0, 1): across}, {Z: -1.0, ONE: complex(*row.pin)})
        own = total(own, {ONE: -across * complex(*row.b)})
    return [total(own, conjugate(own))]


def conjugate(one: Equation) -> Equation:
    return {(k[2], k[3], k[0], k[1]): complex(value).conjugate() for k, value in one.items()}


def product(one: Equation, other: Equation) -> Equation:
    every: Equation = {}
    for (k, left), (m, right) in itertools.product(one.items(), other.items()):
        powers = tuple(map(sum, zip(k, m, strict=True)))
        every[powers] = every.get(powers, 0.0) + left * right
    return every


def total(one: Equation, other: Equation) -> Equation:
    return {powers: one.get(powers, 0.0) + other.get(powers, 0.0) for powers in {**one, **other}}
