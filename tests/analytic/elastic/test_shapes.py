"""Elastic links without a mechanism around them (synthetic): shapes against closed forms, markers
against differences, a free one's momentum and energy, and the matrices of a thesis."""

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp  # type: ignore[import-untyped]

from analytic.elastic.beam import BeamBody, ElasticBody
from analytic.elastic.discretisation import SegmentChain, SegmentedBody
from analytic.elastic.shapes import (
    HermiteElements,
    LegendrePolynomials,
    Shapes,
    SineModes,
    places,
    shortening,
)
from models.array import Array
from models.scene.cut_links import LinkLine
from models.scene.elastic import ElasticLink

LENGTH_M, DENSITY_KG_M, FLEXURAL_N_M2, AXIAL_N = 0.75, 0.243, 4.725, 6.3e6
LINK = ElasticLink("rod", FLEXURAL_N_M2, AXIAL_N)
STRAIGHT = LinkLine(("A", "B"), (0.0, 0.0), 0.0, LENGTH_M, DENSITY_KG_M)
ASKEW = LinkLine(("A", "B"), (0.11, -0.07), 0.6, LENGTH_M, DENSITY_KG_M)
"""A line that does not start at the origin of the link's frame."""
MARKERS = [(None, 0.0), (ASKEW.at(0.3), 0.2), ((0.4, 0.25), 0.0), (ASKEW.at(LENGTH_M), 0.0)]
GRAVITY = (1.3, -9.81)

SHAPES: dict[str, Shapes] = {
    "modes": SineModes(LENGTH_M, 4, 3),
    "polynomials": LegendrePolynomials(LENGTH_M, 5, 3),
    "elements": HermiteElements(LENGTH_M, 3, bends=True, stretches=True),
}
Body = BeamBody | SegmentChain
BODIES: dict[str, Body] = {
    f"{kind} {'stiffened' if stiff else 'linear'}": ElasticBody(LINK, ASKEW, shapes, stiff).body(
        MARKERS, GRAVITY
    )
    for kind, shapes in SHAPES.items()
    for stiff in (True, False)
} | {"chain": SegmentedBody(ElasticLink("rod", FLEXURAL_N_M2), ASKEW, 5).body(MARKERS, GRAVITY)}


def beam(shapes: Shapes, pull_m_s2: float = 0.0, *, stiffened: bool = True) -> BeamBody:
    """A straight one, under a pull across it."""
    return ElasticBody(LINK, STRAIGHT, shapes, stiffened).body((), (0.0, -pull_m_s2))


def chain(count: int, pull_m_s2: float = 0.0, *, corrected: bool = False) -> SegmentChain:
    link = ElasticLink("rod", FLEXURAL_N_M2)
    return SegmentedBody(link, STRAIGHT, count, corrected).body((), (0.0, -pull_m_s2))


def across(own: Body) -> Array:
    """What leaves the line of a link where it is, a motion a column."""
    by = np.eye(own.size)[:, 3:]
    if isinstance(own, BeamBody):
        return by[:, : own.shapes.across]
    # The first segment turns so that the far end stays on the line: minus the mean of the others.
    n = own.own.count
    by[2] = -(n - 1 - np.arange(n - 1)) / n
    return by


def frequencies(own: Body, by: Array) -> Array:
    """Natural frequencies [rad/s] about the straight link of so many motions, the lowest first."""
    matrix, _ = own.weigh(np.zeros((1, own.size)), np.zeros((1, own.size)))
    mass, stiffness = by.T @ matrix[0] @ by, by[3:].T @ own.stiffness @ by[3:]
    return np.asarray(np.sqrt(np.sort(np.linalg.eigvals(np.linalg.solve(mass, stiffness)).real)))


def across_rad_s(own: Body) -> Array:
    return frequencies(own, across(own))


def along_rad_s(own: BeamBody) -> Array:
    return frequencies(own, np.eye(own.size)[:, 3 + own.shapes.across :])


def sag(own: Body) -> float:
    """Of the middle of a link that is held by its pins, over that of a beam under 1 m/s^2."""
    by, nothing = across(own), np.zeros((1, own.size))
    force = own.weigh(nothing, nothing)[1][0] @ by
    q = (by @ np.linalg.solve(by[3:].T @ own.stiffness @ by[3:], force))[None]
    beams = 5.0 * DENSITY_KG_M * LENGTH_M**4 / (384.0 * FLEXURAL_N_M2)
    return -float(own.deflections(q, np.array([0.5 * LENGTH_M]))[0, 0]) / beams


BENDING = (np.arange(1, 5) * math.pi / LENGTH_M) ** 2 * math.sqrt(FLEXURAL_N_M2 / DENSITY_KG_M)
AXIAL = (np.arange(1, 4) - 0.5) * math.pi / LENGTH_M * math.sqrt(AXIAL_N / DENSITY_KG_M)


def test_modes_have_the_frequencies_of_a_beam_between_pins_and_of_a_rod() -> None:
    own = beam(SineModes(LENGTH_M, 4, 3))
    assert across_rad_s(own) == pytest.approx(BENDING, rel=1e-12)
    assert along_rad_s(own) == pytest.approx(AXIAL, rel=1e-12)
    told = [LINK.bending_rad_s(LENGTH_M, DENSITY_KG_M, i) for i in (1, 2)]
    assert told == pytest.approx(BENDING[:2])
    assert LINK.axial_rad_s(LENGTH_M, DENSITY_KG_M, 2) == pytest.approx(AXIAL[1])


def test_polynomials_come_to_them_within_a_millionth() -> None:
    own = beam(LegendrePolynomials(LENGTH_M, 8, 7))
    assert across_rad_s(own)[:2] == pytest.approx(BENDING[:2], rel=1e-6)
    assert along_rad_s(own)[:2] == pytest.approx(AXIAL[:2], rel=1e-6)


def test_a_chain_comes_to_the_beam_as_one_over_the_square_of_its_segments() -> None:
    counts = np.array([8, 16, 32])
    plain, corrected = (
        np.array([across_rad_s(chain(n, corrected=each))[0] / BENDING[0] - 1.0 for n in counts])
        for each in (False, True)
    )
    assert plain * counts**4 == pytest.approx(-0.08, abs=0.02)
    assert corrected * counts**2 == pytest.approx(0.41, abs=0.01)


@pytest.mark.parametrize(
    ("own", "off", "most"),
    [
        (beam(HermiteElements(LENGTH_M, 2), 3.0), 0.0, 1e-12),
        (beam(LegendrePolynomials(LENGTH_M, 4), 3.0), 0.0, 1e-12),
        # Modes miss the series of those that are left out.
        (beam(SineModes(LENGTH_M, 1), 3.0), 3.86e-3, 0.02 * 3.86e-3),
        (beam(SineModes(LENGTH_M, 15), 3.0), 0.0, 1e-6),
        *((chain(n, 3.0), 0.80 / n**2, 0.03 / n**2) for n in (8, 16)),
        *((chain(n, 3.0, corrected=True), 0.0, 0.03 / n**2) for n in (8, 16)),
    ],
)
def test_the_sag_under_an_even_load(own: Body, off: float, most: float) -> None:
    assert sag(own) / 3.0 - 1.0 == pytest.approx(off, abs=most)


@pytest.mark.parametrize("kind", SHAPES)
def test_slopes_and_curvatures_are_derivatives_and_the_ends_are_held(kind: str) -> None:
    shapes = SHAPES[kind]
    ends = np.array([0.0, LENGTH_M])
    assert np.abs(shapes.deflections(ends, 0)).max() < 1e-12
    assert np.abs(shapes.extensions(ends[:1], 0)).max() < 1e-15
    x, by = places(shapes)[0], 1e-6
    for own, order in ((shapes.deflections, 0), (shapes.deflections, 1), (shapes.extensions, 0)):
        slope = (own(x + by, order) - own(x - by, order)) / (2.0 * by)
        assert own(x, order + 1) == pytest.approx(slope, abs=1e-7 * np.abs(slope).max())


@pytest.mark.parametrize("kind", SHAPES)
def test_a_bent_link_is_shorter_by_half_the_squares_of_its_slopes(kind: str) -> None:
    shapes = SHAPES[kind]
    q = np.random.default_rng(3).standard_normal(shapes.across)
    x = np.array([0.0, 0.21, 0.5 * LENGTH_M, LENGTH_M])
    fine = np.linspace(0.0, LENGTH_M, 20001)
    squares = (shapes.deflections(fine, 1) @ q) ** 2
    sums = np.concatenate([[0.0], np.cumsum(0.5 * (squares[1:] + squares[:-1]))]) * fine[1]
    expected = np.interp(x, fine, sums)
    found = np.einsum("xij,i,j->x", shortening(shapes, x), q, q)
    assert found == pytest.approx(expected, rel=1e-6, abs=1e-9)


@pytest.mark.parametrize("name", BODIES)
def test_markers_move_by_their_derivatives(name: str) -> None:
    own, rng = BODIES[name], np.random.default_rng(1)
    q, rates = 0.1 * rng.standard_normal((1, own.size)), rng.standard_normal((1, own.size))
    q[0, 2] = 0.8
    by, now = 1e-5, own.mark(q, rates)
    for k, one in enumerate(np.eye(own.size)):
        ahead, behind = (own.mark(q + sign * by * one, rates).place for sign in (1.0, -1.0))
        assert now.gradient[..., k] == pytest.approx((ahead - behind) / (2.0 * by), abs=1e-7)
    # Along a straight way through the coordinates the q'' are 0.
    ahead, behind = (own.mark(q + sign * 1e-4 * rates, rates).place for sign in (1.0, -1.0))
    drift = (ahead - 2.0 * now.place + behind) / 1e-8
    assert now.drift == pytest.approx(drift, abs=2e-5 * np.abs(drift).max())


@pytest.mark.parametrize("name", BODIES)
def test_a_body_that_flies_keeps_its_energy_and_gains_momentum_by_its_weight(name: str) -> None:
    own, rng = BODIES[name], np.random.default_rng(2)
    n = own.size
    rates, q = rng.standard_normal(n), np.zeros(n)
    q[3:] = 1e-3 * rng.standard_normal(n - 3)
    q[2], rates[3:] = 0.4, 1e-2 * rates[3:]

    def slope(_: float, state: np.ndarray) -> np.ndarray:
        matrix, right = own.weigh(state[None, :n], state[None, n:])
        return np.concatenate([state[n:], np.linalg.solve(matrix[0], right[0])])

    until = 2e-4
    start = np.concatenate([q, rates])
    run = solve_ivp(slope, (0.0, until), start, method="DOP853", rtol=1e-11, atol=1e-13)
    q, rates = run.y[:n].T, run.y[n:].T
    matrix, _ = own.weigh(q, rates)
    kinetic = 0.5 * np.einsum("ti,tij,tj->t", rates, matrix, rates)
    energy = kinetic + own.height_energy(q)
    assert np.ptp(energy) < 1e-10 * kinetic.max()
    momentum = np.einsum("tij,tj->ti", matrix, rates)[:, :2]
    gained = np.array(GRAVITY) * ASKEW.density_kg_m * LENGTH_M * until
    assert momentum[-1] - momentum[0] == pytest.approx(gained, rel=1e-9)


def element(length: float) -> tuple[Array, Array, Array, Array]:
    """C (6,), D (6,), m (6, 6) and stiffness (6, 6) of an element: the closed forms of section 2.4
    of the thesis."""
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
    """C, D, m and stiffness of all nodes in the order of `BeamBody`'s coefficients: deflections and
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
        least = 1e-13 * np.abs(thesis_right).max()
        assert right[0] == pytest.approx(thesis_right, rel=1e-11, abs=least)
