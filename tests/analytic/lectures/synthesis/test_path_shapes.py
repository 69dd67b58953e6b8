"""Random four-bars with a crank, their coupler curves, and what an atlas of these tells apart."""

import cmath
import math

import numpy as np
import pytest

from analytic.kinematics import solve_driven
from analytic.lectures.synthesis.path import task as unit
from analytic.lectures.synthesis.path.atlas import (
    at_shares,
    atlas,
    curves,
    descriptors,
    match,
    shares,
    similar,
    smooth,
)
from analytic.lectures.synthesis.path.candidate import FourBarCandidate, drafted, in_order
from analytic.lectures.synthesis.path.coupler_curve import CouplerCurve, cognates
from analytic.lectures.synthesis.path.fit import _Problem
from analytic.lectures.synthesis.path.task import FULL, Complexes, Family, PathTask, UnitPath
from models.errors import CrankcheckError

LEAST_TRANSMISSION = math.radians(15.0)
LARGEST = 10.0
"""Of a link, over the radius of the coupler curve, and of the points on it."""


def random_curve(rng: np.random.Generator) -> CouplerCurve:
    """A four-bar whose crank turns fully, with a transmission angle of 15 degrees or more and links
    that are no more than ten times as long as its curve is wide."""
    while True:
        a, b, c = np.exp(rng.uniform(math.log(0.1), math.log(5.0), 3)).tolist()
        angle, radius = rng.uniform(0.0, math.tau), 1.8 * math.sqrt(rng.random())
        arm = b * (0.5 + radius * complex(math.cos(angle), math.sin(angle)))
        one = CouplerCurve(0j, 1.0 + 0j, a, b, c, arm, 1 if rng.random() < 0.5 else -1)
        if one.family == "limited":
            continue
        turn = np.linspace(0.0, math.tau, 100)
        good = FourBarCandidate(one, turn, np.zeros(100)).least_sine > math.sin(LEAST_TRANSMISSION)
        if good and one.size < LARGEST * float(np.std(one.at(turn))):
            return one.moved(complex(*rng.normal(size=2)), complex(*rng.normal(size=2)))


def random_path(
    seed: int, count: int, *, timed: bool, closed: bool, noise: float = 0.0
) -> PathTask:
    """Points that a four-bar goes through, each moved by a share of their spread, with its crank's
    angles; its links are no longer than ten times the radius of these points."""
    rng = np.random.default_rng(seed)
    while True:
        one = random_curve(rng)
        span = math.tau * (1.0 - 1.0 / count) if closed else rng.uniform(1.0, 5.0)
        angles = rng.uniform(0.0, math.tau) + np.linspace(0.0, span, count)
        angles *= 1.0 if rng.random() < 0.5 else -1.0
        if one.size < LARGEST * float(np.std(one.at(angles))):
            break
    points = one.at(angles)
    off = rng.normal(size=count) + 1j * rng.normal(size=count)
    points += noise * np.std(points) * off
    crank = tuple((angles - 3.0).tolist()) if timed else None
    return PathTask(tuple(points.tolist()), crank, closed)


@pytest.mark.parametrize("family", [*FULL, "limited"])
@pytest.mark.parametrize("timed", [True, False])
def test_the_derivatives_are_those_of_the_residuals(family: Family, timed: bool) -> None:
    rng = np.random.default_rng(2)
    for _ in range(8):
        points = rng.normal(size=7) + 1j * rng.normal(size=7)
        path = UnitPath(points, np.linspace(0.0, 3.0, 7) if timed else None)
        problem = _Problem(family, path, transmission_rad=0.7)
        z = np.concatenate([0.4 * rng.normal(size=9), 6.0 * rng.random(1 if timed else 7)])
        step = 1e-6
        rows = [
            (problem.residuals(z + step * e) - problem.residuals(z - step * e)) / (2.0 * step)
            for e in np.eye(len(z))
        ]
        exact = problem.jacobian(z)
        near = np.abs(exact) < 1e3  # near a limit they are boundless
        assert exact.shape == (len(rows[0]), len(z))
        assert np.array(rows).T[near] == pytest.approx(exact[near], rel=1e-5, abs=2e-5)


def test_limits_and_transmission_angles_are_those_of_many_looks() -> None:
    rng, seen = np.random.default_rng(5), [0, 0]
    for _ in range(300):
        a, b, c = np.exp(rng.uniform(-1.5, 1.5, 3)).tolist()
        low = rng.uniform(-7.0, 7.0)
        high = low + rng.uniform(0.1, 5.0)
        look = np.linspace(low, high, 4001)
        rho = np.abs(1.0 - a * np.exp(1j * look))
        closes = bool(np.all((rho > abs(b - c)) & (rho < b + c)))
        assert unit.closes_between((a, b, c), low, high) == closes
        seen[closes] += 1
        if closes:
            cosine = (b**2 + c**2 - rho**2) / (2.0 * b * c)
            least = float(np.sqrt(np.min(1.0 - cosine**2)))
            assert unit.least_sine((a, b, c), low, high) == pytest.approx(least, abs=2e-3)
    assert min(seen) > 40


@pytest.mark.parametrize("seed", range(2))
def test_a_coupler_curve_is_that_of_the_reference(seed: int) -> None:
    one = random_curve(np.random.default_rng(seed))
    draft = drafted("curve", "a test", one).driven({"link": "input", "speed_rad_s": 1.0})
    found = []
    for sign in (1, -1):
        scene = draft.with_branch({next(iter(draft.scene.branch), "B"): sign}).scene
        angles = np.linspace(0.0, 6.0, 25)
        motion = solve_driven(scene, angles, np.ones(1), np.zeros(1), bound=False)
        place = motion.points["P"].position @ (1.0, 1j)
        found.append(float(np.max(np.abs(place - one.at(angles)))))
    assert min(found) < 1e-12 * max(1.0, one.size) < max(found)


def test_cognates_draw_the_same_curve_and_a_point_on_a_pin_has_none() -> None:
    rng = np.random.default_rng(8)
    for _ in range(20):
        one = random_curve(rng)
        for angle in (0.3, 2.0, 5.1):
            place = one.at(np.array([angle]))[0]
            found = cognates(one, angle)
            assert len(found) == 5
            for other, at in found:
                assert other.at(np.array([at]))[0] == pytest.approx(place, abs=1e-11)
        for (other, _), (again, _) in zip(cognates(one, 0.3), cognates(one, 2.0), strict=True):
            assert again.size == pytest.approx(other.size)
            assert again.sign == other.sign or other.family == "limited"
    on_a_pin = CouplerCurve(0j, 1.0 + 0j, 0.3, 0.8, 0.9, 0.8 + 0j, 1)
    assert not cognates(on_a_pin, 0.4)


def test_angles_in_order_are_the_nearest_ones() -> None:
    grows = np.array([0.0, 0.5, 1.0, 2.0])
    assert in_order(grows) == pytest.approx(grows, abs=1e-5)
    assert in_order(-grows) == pytest.approx(-grows, abs=1e-5)
    mended = in_order(np.array([0.0, 1.0, 0.6, 2.0]))
    assert mended == pytest.approx([0.0, 0.8, 0.8, 2.0], abs=1e-5)
    assert np.all(np.diff(mended) > 0.0)


def closed_curve(seed: int, count: int = 400, start: float = 0.0) -> Complexes:
    one = random_curve(np.random.default_rng(seed))
    curve = one.at(start + np.linspace(0.0, math.tau, count + 1))
    curve[-1] = curve[0]
    return curve


@pytest.mark.parametrize("seed", range(2))
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
    later = np.concatenate([curve[100:], curve[1:101]])
    found = match(descriptors(later[None])[0], one[None])
    assert found.start[0] == pytest.approx(shares(curve[None])[0, 100], abs=1.0 / 64.0)


def test_a_descriptor_tells_the_sense_and_the_mirror_image_and_not_how_fast_it_is_drawn() -> None:
    curve = closed_curve(4)
    one, back, mirror = descriptors(np.array([curve, curve[::-1], curve.conj()]))
    assert match(one, back[None]).similarity[0] < 0.9
    assert match(one, mirror[None]).similarity[0] < 0.9
    drawn, even = random_curve(np.random.default_rng(2)), np.linspace(0.0, math.tau, 801)
    first, second = descriptors(np.array([drawn.at(even), drawn.at(even + 0.5 * np.sin(even))]))
    assert match(first, second[None]).similarity[0] > 0.9999


@pytest.mark.parametrize("family", FULL)
def test_an_entry_of_the_atlas_is_found_by_its_own_curve(family: Family) -> None:
    book = atlas(family)
    for k in (11, 1234):
        curve = curves(family, book.x[:, [k]], book.arm[[k]])[0, :-1]
        found = similar((2.0 * cmath.exp(1j) * curve + 3.0).tolist(), 5)
        assert found[0].similarity > 0.998
        similarities = [one.similarity for one in found]
        assert similarities == sorted(similarities, reverse=True)


def test_similar_curves_lie_over_the_given_one() -> None:
    curve = closed_curve(1, 60)[:-1]
    found = similar(curve.tolist(), 3)
    size = float(np.std(curve))
    for one in found:
        assert one.similarity > 0.97
        drawn = one.four_bar.at(np.linspace(0.0, math.tau, 2000))
        off = np.min(np.abs(curve[:, None] - drawn[None]), axis=1)
        assert math.sqrt(float(np.mean(off**2))) < 0.2 * size


def test_no_curve_is_similar_to_a_zigzag_and_one_of_three_points_is_refused() -> None:
    star = [cmath.exp(2j * math.pi * k / 20) * (1.0 if k % 2 else 0.3) for k in range(20)]
    assert similar(star, 1)[0].similarity < 0.95
    with pytest.raises(CrankcheckError, match="path of 3 points"):
        similar([0j, 1 + 0j, 1j])


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
