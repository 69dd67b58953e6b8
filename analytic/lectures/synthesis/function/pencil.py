"""Linear equations that leave one vector, or two of which a form chooses: how Freudenstein's
equation is solved whatever of it is given.

n points give n linear equations in products of lengths and starts. Three points have four such
products: one vector fits, up to its length. Where starts are found there are two more products than
equations, and x = u p + v q fits for all u, v; that the products belong together is one equation
more, homogeneous, quadratic in u, v of four points, cubic of five. So there are at most two
solutions and at most three, and the roots of one polynomial are all of them.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from models.array import Array
from models.errors import CrankcheckError

RANK = 1e-13
"""Of the largest singular value: equations that are nearer to each other are one."""
REAL = 1e-7
"""A root with a smaller imaginary part is a double one: its two parts are that far apart by
rounding. Roots that are nearer are one."""
LOOKS = 24
"""Directions among which the one is chosen that a root is furthest from."""

Form = Callable[[Array], float]


def one_vector(equations: Array) -> Array:
    """The unit vector that n equations (n, n + 1) leave. Raises CrankcheckError for several."""
    return np.asarray(_null_space(equations, 1)[0])


def vectors_of(equations: Array, form: Form, degree: int) -> list[Array]:
    """The vectors, up to their length, that n equations (n, n + 2) leave and a homogeneous form of
    a degree vanishes at: all of them, at most as many as the degree.

    Raises
    ------
    CrankcheckError
        Equations of which some are one, or a form that vanishes at every vector.
    """
    p, q = _null_space(equations, 2)
    turns = np.pi * np.arange(LOOKS) / LOOKS
    sizes = np.array([abs(form(np.cos(t) * p + np.sin(t) * q)) for t in turns])
    k = int(np.argmax(sizes))
    if sizes[k] <= RANK:
        raise _special()
    # The direction with the largest value leads: no root is at infinity, nor near it.
    lead = np.cos(turns[k]) * p + np.sin(turns[k]) * q
    rest = np.cos(turns[k]) * q - np.sin(turns[k]) * p
    nodes = np.cos(np.pi * (np.arange(degree + 1) + 0.5) / (degree + 1))
    values = [form(t * lead + rest) for t in nodes]
    return [t * lead + rest for t in _real_roots(np.polyfit(nodes, values, degree))]


def _null_space(equations: Array, dimension: int) -> Array:
    """An orthonormal basis of what equations leave (dimension, m)."""
    scaled = equations / np.linalg.norm(equations, axis=1, keepdims=True)
    _, sizes, rows = np.linalg.svd(scaled)
    if sizes[-1] <= RANK * sizes[0]:
        raise _special()
    return np.asarray(rows[-dimension:])


def _real_roots(polynomial: Array) -> list[float]:
    """Those of a polynomial, double ones once, in order."""
    roots: list[float] = []
    for root in sorted(np.roots(polynomial), key=lambda each: float(each.real)):
        near = REAL * (1.0 + abs(root))
        if abs(root.imag) <= near and not (roots and root.real - roots[-1] <= near):
            roots.append(float(root.real))
    return roots


def _special() -> CrankcheckError:
    return CrankcheckError(
        "the precision points are so special that a whole family of mechanisms meets them, as with "
        "an output in proportion to the input; ask for fewer points, or change a range"
    )
