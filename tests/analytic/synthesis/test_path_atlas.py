"""The atlas of coupler curves: what its descriptors tell apart, and what they do not."""

from __future__ import annotations

import cmath
import math

import numpy as np
import pytest

from analytic.synthesis.path.arc_length import at_shares, shares, smooth
from analytic.synthesis.path.atlas import atlas, closed_starts, curves, similar
from analytic.synthesis.path.descriptors import descriptors, match
from analytic.synthesis.path.pieces import open_starts, pieces
from analytic.synthesis.path.unit_four_bar import FULL, Complexes
from models.errors import CrankcheckError
from tests.analytic.synthesis.random_paths import random_curve, random_path


def closed_curve(seed: int, count: int = 400, start: float = 0.0) -> Complexes:
    one = random_curve(np.random.default_rng(seed))
    curve = one.at(start + np.linspace(0.0, math.tau, count + 1))
    curve[-1] = curve[0]
    return curve


@pytest.mark.parametrize("seed", range(5))
def test_place_size_turn_and_start_do_not_change_a_descriptor_s_match(seed: int) -> None:
    curve = closed_curve(seed)
    moved = 7.3 * cmath.exp(1.9j) * closed_curve(seed, start=2.2) + (4.0 - 9.0j)
    other = closed_curve(seed + 50)
    one, two, three = descriptors(np.array([curve, moved, other]))
    same = match(one, two[None])
    # The start is found to half a place of 128, of which the highest harmonics see a little.
    assert same.similarity[0] > 0.998
    assert match(one, three[None]).similarity[0] < same.similarity[0] - 2e-4
    # What is lacking are the harmonics that are left out.
    assert 0.999 < match(one, one[None]).similarity[0] < 1.0 + 1e-6


def test_a_start_is_found_where_it_is() -> None:
    curve = closed_curve(3)
    share = shares(curve[None])[0]
    later = np.concatenate([curve[100:], curve[1:101]])
    found = match(
        *(
            descriptors(each[None])[0] if k == 0 else descriptors(each[None])
            for k, each in enumerate((later, curve))
        )
    )
    assert found.start[0] == pytest.approx(share[100], abs=1.0 / 64.0)


def test_a_descriptor_tells_the_sense_and_the_mirror_image() -> None:
    curve = closed_curve(4)
    one, back, mirror = descriptors(np.array([curve, curve[::-1], curve.conj()]))
    assert match(one, back[None]).similarity[0] < 0.9
    assert match(one, mirror[None]).similarity[0] < 0.9


def test_a_descriptor_does_not_depend_on_how_fast_a_curve_is_drawn() -> None:
    one = random_curve(np.random.default_rng(2))
    even = np.linspace(0.0, math.tau, 801)
    uneven = even + 0.5 * np.sin(even)
    first, second = descriptors(np.array([one.at(even), one.at(uneven)]))
    assert match(first, second[None]).similarity[0] > 0.9999


@pytest.mark.parametrize("family", FULL)
def test_an_entry_of_the_atlas_is_found_by_its_own_curve(family) -> None:  # type: ignore[no-untyped-def]
    book = atlas(family)
    for k in (11, 1234):
        curve = curves(family, book.x[:, [k]], book.arm[[k]])[0, :-1]
        found = similar((2.0 * cmath.exp(1j) * curve + 3.0).tolist(), 5)
        assert found[0].similarity > 0.998
        assert [one.similarity for one in found] == sorted(
            (o.similarity for o in found), reverse=True
        )


def test_similar_curves_lie_over_the_given_one() -> None:
    curve = closed_curve(1, 60)[:-1]
    found = similar(curve.tolist(), 3)
    size = float(np.std(curve))
    for one in found:
        assert one.similarity > 0.97
        drawn = one.four_bar.at(np.linspace(0.0, math.tau, 2000))
        off = np.min(np.abs(curve[:, None] - drawn[None]), axis=1)
        assert math.sqrt(float(np.mean(off**2))) < 0.2 * size


def test_no_curve_is_similar_to_a_zigzag() -> None:
    star = [cmath.exp(2j * math.pi * k / 20) * (1.0 if k % 2 else 0.3) for k in range(20)]
    assert similar(star, 1)[0].similarity < 0.95


def test_a_curve_of_three_points_is_refused() -> None:
    with pytest.raises(CrankcheckError, match="path of 3 points"):
        similar([0j, 1 + 0j, 1j])


def test_the_atlas_is_built_once_and_the_same() -> None:
    first = atlas("crank-rocker")
    assert atlas("crank-rocker") is first
    again = atlas.__wrapped__("crank-rocker")
    assert np.array_equal(again.descriptors, first.descriptors)
    assert len(first.arm) > 5000


@pytest.mark.parametrize("closed", [True, False])
def test_starts_lie_near_the_path(closed: bool) -> None:
    _, _, task = random_path(2, 25, timed=False, closed=closed)
    starts = (closed_starts if closed else open_starts)(task.unit, 6)
    assert len(starts) == 6
    for start in starts:
        steps = np.diff(start.phi)
        assert np.all(steps > 0.0) or np.all(steps < 0.0)
        assert abs(start.phi[-1] - start.phi[0]) < math.tau


def test_pieces_with_limits_close_all_along() -> None:
    book = pieces("limited")
    assert len(book.arm) > 5000
    assert np.isfinite(book.places).all()
    assert np.sum(np.abs(book.places) ** 2, axis=1) == pytest.approx(1.0)


def test_shares_are_those_of_the_length() -> None:
    line = np.array([[0.0, 1.0, 3.0, 4.0], [0.0, 2.0, 2.5, 10.0]]) * (1.0 + 1j)
    share = shares(line)
    assert share == pytest.approx(np.array([[0.0, 0.25, 0.75, 1.0], [0.0, 0.2, 0.25, 1.0]]))
    wanted = np.array([[0.0, 0.5, 1.0], [0.1, 0.225, 1.0]])
    places = at_shares(share, line, wanted)
    assert places == pytest.approx(np.array([[0.0, 2.0, 4.0], [1.0, 2.25, 10.0]]) * (1.0 + 1j))


def test_a_smooth_curve_of_a_circle_is_one() -> None:
    points = np.exp(2j * np.pi * np.arange(12) / 12)
    curve, share = smooth(points, closed=True)
    assert np.abs(curve) == pytest.approx(1.0, abs=1e-3)
    assert share == pytest.approx(np.arange(12) / 12, abs=1e-4)
    assert curve[-1] == pytest.approx(curve[0])
