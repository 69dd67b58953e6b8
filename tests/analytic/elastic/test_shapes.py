"""Elastic links without a mechanism around them (synthetic): shapes against closed forms, markers
against differences, and a free one's momentum and energy."""

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


def test_modes_have_the_frequencies_of_beam_and_rod_and_others_come_to_them() -> None:
    own = beam(SineModes(LENGTH_M, 4, 3))
    assert across_rad_s(own) == pytest.approx(BENDING, rel=1e-12)
    assert along_rad_s(own) == pytest.approx(AXIAL, rel=1e-12)
    told = [LINK.bending_rad_s(LENGTH_M, DENSITY_KG_M, i) for i in (1, 2)]
    assert told == pytest.approx(BENDING[:2])
    assert LINK.axial_rad_s(LENGTH_M, DENSITY_KG_M, 2) == pytest.approx(AXIAL[1])
    # Polynomials come to them within a millionth, and elements with order 4 and 2.
    own = beam(LegendrePolynomials(LENGTH_M, 8, 7))
    assert across_rad_s(own)[:2] == pytest.approx(BENDING[:2], rel=1e-6)
    assert along_rad_s(own)[:2] == pytest.approx(AXIAL[:2], rel=1e-6)
    own = beam(HermiteElements(LENGTH_M, 8, bends=True, stretches=True), stiffened=False)
    assert across_rad_s(own)[0] / BENDING[0] - 1.0 == pytest.approx(0.0, abs=2e-5)
    assert along_rad_s(own)[0] / AXIAL[0] - 1.0 == pytest.approx(0.0, abs=2e-3)


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
def test_shapes_have_their_slopes_and_shortening_and_are_held_at_both_ends(kind: str) -> None:
    shapes = SHAPES[kind]
    ends = np.array([0.0, LENGTH_M])
    assert np.abs(shapes.deflections(ends, 0)).max() < 1e-12
    assert np.abs(shapes.extensions(ends[:1], 0)).max() < 1e-15
    x, by = places(shapes)[0], 1e-6
    for own, order in ((shapes.deflections, 0), (shapes.deflections, 1), (shapes.extensions, 0)):
        slope = (own(x + by, order) - own(x - by, order)) / (2.0 * by)
        assert own(x, order + 1) == pytest.approx(slope, abs=1e-7 * np.abs(slope).max())
    # Shorter by half the squares of its slopes.
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

    until = 1e-4
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
