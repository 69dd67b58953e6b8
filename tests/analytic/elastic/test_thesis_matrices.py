"""The mass matrix and inertia forces of beam elements in a floating frame, from the closed forms of
the thesis (section 2.4: C, D, m, k, H of an element), against `Beam`, which integrates them.
"""

from __future__ import annotations

import numpy as np
import pytest

from analytic.elastic.elements import HermiteElements
from models.array import Array
from tests.analytic.elastic.beams import AXIAL_N, DENSITY_KG_M, FLEXURAL_N_M2, LENGTH_M, beam


def element(length: float) -> tuple[Array, Array, Array, Array]:
    """C (6,), D (6,), m (6, 6) and stiffness (6, 6) of an element."""
    e = length
    c = np.array([e / 2, e / 2, e**2 / 12, e / 2, e / 2, -(e**2) / 12])
    d = np.array([e**2 / 6, 3 * e**2 / 20, e**3 / 30, e**2 / 3, 7 * e**2 / 20, -(e**3) / 20])
    mass = {
        (1, 1): e / 3, (4, 4): e / 3, (1, 4): e / 6,
        (2, 2): 13 * e / 35, (5, 5): 13 * e / 35, (3, 3): e**3 / 105, (6, 6): e**3 / 105,
        (1, 2): 7 * e / 20, (4, 5): 7 * e / 20, (1, 5): 3 * e / 20, (2, 4): 3 * e / 20,
        (1, 3): e**2 / 20, (4, 6): -(e**2) / 20, (1, 6): -(e**2) / 30, (3, 4): e**2 / 30,
        (2, 3): 11 * e**2 / 210, (5, 6): -11 * e**2 / 210, (2, 5): 9 * e / 70,
        (2, 6): -13 * e**2 / 420, (3, 5): 13 * e**2 / 420, (3, 6): -(e**3) / 140,
    }  # fmt: skip
    bending, pull = FLEXURAL_N_M2, AXIAL_N
    stiffness = {
        (2, 2): 12 * bending / e**3, (5, 5): 12 * bending / e**3, (2, 5): -12 * bending / e**3,
        (3, 3): 4 * bending / e, (6, 6): 4 * bending / e, (3, 6): 2 * bending / e,
        (2, 3): 6 * bending / e**2, (2, 6): 6 * bending / e**2,
        (3, 5): -6 * bending / e**2, (5, 6): -6 * bending / e**2,
        (1, 1): pull / e, (4, 4): pull / e, (1, 4): -pull / e,
    }  # fmt: skip
    return c, d, _full(mass), _full(stiffness)


def _full(entries: dict[tuple[int, int], float]) -> Array:
    whole = np.zeros((6, 6))
    for (i, j), value in entries.items():
        whole[i - 1, j - 1] = whole[j - 1, i - 1] = value
    return whole


def assembled(count: int) -> tuple[Array, Array, Array, Array]:
    """C, D, m and stiffness of all nodes in the order of `Beam`'s coefficients: deflections and
    slopes within the pins, then displacements along."""
    own, size = LENGTH_M / count, 3 * (count + 1)
    c, d, mass, stiffness = np.zeros(size), np.zeros(size), *(np.zeros((2, size, size)))
    for k in range(count):
        at = np.arange(3 * k, 3 * k + 6)
        c_e, d_e, mass_e, stiffness_e = element(own)
        c[at] += c_e
        d[at] += d_e + k * own * c_e  # x is counted from the start of the link
        mass[np.ix_(at, at)] += mass_e
        stiffness[np.ix_(at, at)] += stiffness_e
    bent = [i for i in range(size) if i % 3 and i not in (1, size - 2)]
    order = bent + [i for i in range(3, size) if i % 3 == 0]
    return c[order], d[order], mass[np.ix_(order, order)], stiffness[np.ix_(order, order)]


def by_the_thesis(count: int, q: Array, rates: Array) -> tuple[Array, Array]:
    """The mass matrix (n, n) and the right side (n,) of the link at coordinates and rates (n,)."""
    c, d, mass, stiffness = assembled(count)
    m = 2 * count
    bent, drawn = np.arange(m), np.arange(m, 3 * count)
    b, a, b_rate, a_rate = q[3:][bent], q[3:][drawn], rates[3:][bent], rates[3:][drawn]
    c_w, c_u, d_w, d_u = c[bent], c[drawn], d[bent], d[drawn]
    ww, uu, uw = (mass[np.ix_(i, j)] for i, j in ((bent, bent), (drawn, drawn), (drawn, bent)))
    e = np.array([np.cos(q[2]), np.sin(q[2])])
    n = np.array([-e[1], e[0]])
    first_x, first_y = LENGTH_M**2 / 2 + c_u @ a, c_w @ b
    whole = np.zeros((3 + 3 * count, 3 + 3 * count))
    whole[0, 0] = whole[1, 1] = LENGTH_M
    whole[:2, 2] = first_x * n - first_y * e
    whole[2, 2] = LENGTH_M**3 / 3 + 2 * d_u @ a + a @ uu @ a + b @ ww @ b
    whole[:2, 3 + bent], whole[:2, 3 + drawn] = np.outer(n, c_w), np.outer(e, c_u)
    whole[2, 3 + bent], whole[2, 3 + drawn] = d_w + a @ uw, -(uw @ b)
    whole = np.triu(whole) + np.triu(whole, 1).T
    whole[np.ix_(3 + bent, 3 + bent)], whole[np.ix_(3 + drawn, 3 + drawn)] = ww, uu
    omega, right = rates[2], np.zeros(len(q))
    right[:2] = -2 * omega * ((c_u @ a_rate) * n - (c_w @ b_rate) * e)
    right[:2] += omega**2 * (first_x * e + first_y * n)
    right[2] = -2 * omega * (d_u @ a_rate + a @ uu @ a_rate + b @ ww @ b_rate)
    right[3 + bent] = -2 * omega * (a_rate @ uw) + omega**2 * (ww @ b)
    right[3 + drawn] = 2 * omega * (uw @ b_rate) + omega**2 * (d_u + uu @ a)
    right *= DENSITY_KG_M
    right[3:] -= stiffness @ q[3:]
    return DENSITY_KG_M * whole, right


@pytest.mark.parametrize("count", [1, 2])
def test_one_and_two_elements_are_those_of_the_thesis(count: int) -> None:
    own = beam(HermiteElements(LENGTH_M, count, bends=True, stretches=True), stiffened=False)
    rng = np.random.default_rng(count)
    for _ in range(5):
        q, rates = rng.standard_normal((2, own.size))
        q[3:] *= 0.1
        matrix, right = own.weigh(q[None], rates[None])
        thesis_matrix, thesis_right = by_the_thesis(count, q, rates)
        assert matrix[0] == pytest.approx(thesis_matrix, rel=1e-13, abs=1e-15)
        assert right[0] == pytest.approx(
            thesis_right, rel=1e-11, abs=1e-13 * np.abs(thesis_right).max()
        )
