"""Shapes of elastic links against closed forms: frequencies, and the sag under an even load."""

from __future__ import annotations

import math

import numpy as np
import pytest

from analytic.elastic.elements import HermiteElements
from analytic.elastic.modes import SineModes
from analytic.elastic.polynomials import LegendrePolynomials
from analytic.elastic.shapes import Shapes, places, shortening
from tests.analytic.elastic.beams import (
    AXIAL_N,
    DENSITY_KG_M,
    FLEXURAL_N_M2,
    LENGTH_M,
    LINK,
    SHAPES,
    beam,
    chain,
    frequencies,
    mass_between_pins,
)


def across_rad_s(shapes: Shapes) -> np.ndarray:
    own, m = beam(shapes), shapes.across
    return frequencies(mass_between_pins(own, m), own.stiffness[:m, :m])


def along_rad_s(shapes: Shapes) -> np.ndarray:
    own, m = beam(shapes), 3 + shapes.across
    nothing = np.zeros((1, own.size))
    return frequencies(own.weigh(nothing, nothing)[0][0, m:, m:], own.stiffness[m - 3 :, m - 3 :])


def sag_m(shapes: Shapes, pull_m_s2: float) -> float:
    """Of the middle, under a pull across a link that is held by its pins."""
    own, m = beam(shapes, gravity=(0.0, -pull_m_s2)), shapes.across
    nothing = np.zeros((1, own.size))
    q = nothing.copy()
    _, force = own.weigh(nothing, nothing)
    q[0, 3 : 3 + m] = np.linalg.solve(own.stiffness[:m, :m], force[0, 3 : 3 + m])
    return float(own.deflections(q, np.array([0.5 * LENGTH_M]))[0, 0])


BENDING = (np.arange(1, 5) * math.pi / LENGTH_M) ** 2 * math.sqrt(FLEXURAL_N_M2 / DENSITY_KG_M)
AXIAL = (np.arange(1, 4) - 0.5) * math.pi / LENGTH_M * math.sqrt(AXIAL_N / DENSITY_KG_M)


def test_modes_have_the_frequencies_of_a_beam_between_pins_and_of_a_rod() -> None:
    shapes = SineModes(LENGTH_M, 4, 3)
    assert across_rad_s(shapes) == pytest.approx(BENDING, rel=1e-12)
    assert along_rad_s(shapes) == pytest.approx(AXIAL, rel=1e-12)
    assert [LINK.bending_rad_s(LENGTH_M, DENSITY_KG_M, i) for i in (1, 2)] == pytest.approx(
        BENDING[:2]
    )
    assert LINK.axial_rad_s(LENGTH_M, DENSITY_KG_M, 2) == pytest.approx(AXIAL[1])


def test_polynomials_come_to_them_within_a_millionth() -> None:
    shapes = LegendrePolynomials(LENGTH_M, 8, 7)
    assert across_rad_s(shapes)[:2] == pytest.approx(BENDING[:2], rel=1e-6)
    assert along_rad_s(shapes)[:2] == pytest.approx(AXIAL[:2], rel=1e-6)


def test_elements_come_to_them_with_order_4_across_and_2_along() -> None:
    counts = np.array([4, 8, 16])
    across, along = [], []
    for count in counts:
        shapes = HermiteElements(LENGTH_M, int(count), bends=True, stretches=True)
        across.append(across_rad_s(shapes)[1] / BENDING[1] - 1.0)
        along.append(along_rad_s(shapes)[0] / AXIAL[0] - 1.0)
    assert min(across) > 0.0  # Ritz: from above
    orders = [-np.polyfit(np.log(counts), np.log(errors), 1)[0] for errors in (across, along)]
    assert orders == pytest.approx([4.0, 2.0], abs=0.1)
    assert across[-1] < 2e-5


@pytest.mark.parametrize("shapes", [HermiteElements(LENGTH_M, 2), LegendrePolynomials(LENGTH_M, 4)])
def test_the_sag_under_an_even_load_is_exact(shapes: Shapes) -> None:
    sag = 5.0 * DENSITY_KG_M * 3.0 * LENGTH_M**4 / (384.0 * FLEXURAL_N_M2)
    assert sag_m(shapes, 3.0) == pytest.approx(-sag, rel=1e-12)


def test_the_sag_by_modes_misses_the_series_of_those_left_out() -> None:
    sag = 5.0 * DENSITY_KG_M * 3.0 * LENGTH_M**4 / (384.0 * FLEXURAL_N_M2)
    for count, off in ((1, 3.86e-3), (3, -2.7e-4), (5, 4.71e-5)):
        assert -sag_m(SineModes(LENGTH_M, count), 3.0) / sag - 1.0 == pytest.approx(off, rel=0.02)
    assert -sag_m(SineModes(LENGTH_M, 15), 3.0) == pytest.approx(sag, rel=1e-6)


@pytest.mark.parametrize("kind", SHAPES)
def test_slopes_and_curvatures_are_derivatives_and_the_ends_are_held(kind: str) -> None:
    shapes = SHAPES[kind]
    ends = np.array([0.0, LENGTH_M])
    assert np.abs(shapes.deflections(ends, 0)).max() < 1e-12
    assert np.abs(shapes.extensions(ends[:1], 0)).max() < 1e-15
    x, by = places(shapes)[0], 1e-6
    for own, orders in ((shapes.deflections, (0, 1)), (shapes.extensions, (0,))):
        for order in orders:
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


def test_a_chain_comes_to_the_beam_as_one_over_the_square_of_its_segments() -> None:
    counts = np.array([8, 16, 32])
    low = [
        [
            frequencies(mass_between_pins(own, 0), own.stiffness)[0] / BENDING[0] - 1.0
            for own in (chain(int(n), corrected=corrected) for n in counts)
        ]
        for corrected in (False, True)
    ]
    assert np.array(low[0]) * counts**4 == pytest.approx(-0.08, abs=0.02)
    assert np.array(low[1]) * counts**2 == pytest.approx(0.41, abs=0.01)


@pytest.mark.parametrize(("corrected", "over"), [(False, 0.80), (True, 0.0)])
def test_the_sag_of_a_chain(corrected: bool, over: float) -> None:
    sag = 5.0 * DENSITY_KG_M * LENGTH_M**4 / (384.0 * FLEXURAL_N_M2)
    for n in (8, 16):
        own = chain(n, gravity=(0.0, -1.0), corrected=corrected)
        nothing = np.zeros((1, own.size))
        by = np.zeros((own.size, n - 1))
        by[3:] = np.eye(n - 1)
        by[2] = -(n - 1 - np.arange(n - 1)) / n
        force = own.weigh(nothing, nothing)[1][0] @ by
        q = (by @ np.linalg.solve(own.stiffness, force))[None]
        middle = own.deflections(q, np.array([0.5 * LENGTH_M]))[0, 0]
        assert (-middle / sag - 1.0) * n**2 == pytest.approx(over, abs=0.03)
