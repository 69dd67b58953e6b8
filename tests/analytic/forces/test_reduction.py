"""Inertia as one force or two masses: numbers worked by hand, and the link's own force and moment.

The source gives the formulas; the numbers are ours.
"""

from __future__ import annotations

import math

import numpy as np
import pytest

from analytic.forces.reduction import oscillation_length, plane_motion, rotation, two_masses
from models.array import Array
from models.errors import CrankcheckError


def cross(a: Array, b: Array) -> Array:
    return np.asarray(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0])


def perp(a: Array) -> Array:
    return np.stack([-a[:, 1], a[:, 0]], axis=1)


def test_a_slender_rod_about_its_end_swings_about_two_thirds() -> None:
    """l_AK = l/2 + (m l^2 / 12) / (m l / 2) = 2 l / 3."""
    assert oscillation_length(3.0, 3.0 * 0.6**2 / 12, 0.3) == pytest.approx(0.4, rel=1e-15)


def test_a_rod_in_rotation_worked_by_hand() -> None:
    """2 kg, S at 0.3 m on x, J = 0.06, omega = 10, alpha = 50: a_S = (-30, 15), P = (60, -30) in
    K at 0.3 + 0.06 / (2 0.3) = 0.4 m, of moment -12 N m = -(0.06 + 2 0.09) 50."""
    found = rotation(2.0, 0.06, np.array([[0.3, 0.0]]), np.array([10.0]), np.array([50.0]))
    assert found.force == pytest.approx(np.array([[60.0, -30.0]]))
    assert found.place == pytest.approx(np.array([[0.4, 0.0]]))
    assert cross(found.place, found.force) == pytest.approx([-12.0])


def test_a_link_in_plane_motion_worked_by_hand() -> None:
    """2 kg, S at 0.3 m on x, J = 0.06, a_A = (0, 10), omega = 10, alpha = 0: a_SA = (-30, 0) in K
    = (0.4, 0), a_A through S: T = S, as the parallel through K is the x-axis itself."""
    found = plane_motion(
        2.0, 0.06, np.array([[0.3, 0.0]]), np.array([[0.0, 10.0]]), np.array([10.0]), np.zeros(1)
    )
    assert found.force == pytest.approx(np.array([[60.0, -20.0]]))
    assert found.place == pytest.approx(np.array([[0.3, 0.0]]))
    # With alpha = 50, a_SA = (-30, 15): from K = (0.4, 0) back to x = 0.3 it rises by 0.05.
    found = plane_motion(
        2.0, 0.06, np.array([[0.3, 0.0]]), np.array([[0.0, 10.0]]), np.array([10.0]),
        np.array([50.0]),
    )  # fmt: skip
    assert found.force == pytest.approx(np.array([[60.0, -50.0]]))
    assert found.place == pytest.approx(np.array([[0.3, 0.05]]))


def test_a_link_in_translation_has_its_inertia_in_the_centre() -> None:
    """3 kg, a_A = a_S = (2, -1) and no turning: P = -3 (2, -1) = (-6, 3) through S."""
    found = plane_motion(
        3.0, 0.06, np.array([[0.3, 0.2]]), np.array([[2.0, -1.0]]), np.zeros(1), np.zeros(1)
    )
    assert found.force == pytest.approx(np.array([[-6.0, 3.0]]))
    assert found.place == pytest.approx(np.array([[0.3, 0.2]]))


def test_from_the_other_pin_the_inertia_has_the_same_line_of_action() -> None:
    """The link above from B = (0.5, 0): S at -0.2 m, K at 0.2 + 0.06 / (2 0.2) = 0.35 m from B, so
    at 0.15; a_B = (0, 10) + 50 (0, 0.5) - 100 (0.5, 0) = (-50, 35), a_SB = (-30, 25) - a_B = (20,
    -10). S + u a_B = K + w a_SB: 0.3 - 50 u = 0.15 + 20 w, 35 u = -10 w give u = -0.0075, so
    T' = (0.675, -0.2625); from T = (0.3, 0.05) that is (0.375, -0.3125) = P / 160, along P."""
    one = plane_motion(
        2.0, 0.06, np.array([[0.3, 0.0]]), np.array([[0.0, 10.0]]), np.array([10.0]),
        np.array([50.0]),
    )  # fmt: skip
    other = plane_motion(
        2.0, 0.06, np.array([[-0.2, 0.0]]), np.array([[-50.0, 35.0]]), np.array([10.0]),
        np.array([50.0]),
    )  # fmt: skip
    assert other.force == pytest.approx(one.force)
    place = other.place + np.array([[0.5, 0.0]])
    assert place == pytest.approx(np.array([[0.675, -0.2625]]))
    assert place - one.place == pytest.approx(one.force / 160.0)


@pytest.mark.parametrize("parallel", [False, True])
def test_one_force_has_the_force_and_moment_of_the_link(parallel: bool) -> None:
    """About A: -m a_S, and r x (-m a_S) - J alpha; where a_A is parallel to a_SA too."""
    rng = np.random.default_rng(7)
    centre = rng.uniform(0.1, 0.5) * np.stack([np.cos(a := rng.uniform(0, 7, 50)), np.sin(a)], 1)
    omega, alpha, a_a = rng.normal(0, 9, 50), rng.normal(0, 99, 50), rng.normal(0, 50, (50, 2))
    of_s = alpha[:, None] * perp(centre) - omega[:, None] ** 2 * centre
    if parallel:
        a_a = 0.5 * of_s
    mass, inertia = 1.7, 0.03
    found = plane_motion(mass, inertia, centre, a_a, omega, alpha)
    force = -mass * (a_a + of_s)
    moment = cross(centre, force) - inertia * alpha
    scale = np.hypot(*found.place.T) * np.hypot(*force.T)
    np.testing.assert_array_equal(found.force, force)
    assert np.all(np.abs(cross(found.place, found.force) - moment) <= 1e-13 * (1.0 + scale))
    turning = rotation(mass, inertia, centre, omega, alpha)
    about = -(inertia + mass * np.sum(centre**2, axis=1)) * alpha
    assert cross(turning.place, turning.force) == pytest.approx(about, rel=1e-12, abs=1e-12)


def test_two_masses_of_a_rod_worked_by_hand() -> None:
    """3 kg, J = 0.09 (k^2 = 0.03): at 0.3 and 0.1 m they are the link, 0.75 and 2.25 kg; at 0.3
    and 0.3 m they have 3 (0.09 - 0.03) = 0.18 kg m^2 too much."""
    alike = two_masses(3.0, 0.09, 0.3, 0.1)
    assert (alike.first, alike.second) == pytest.approx((0.75, 2.25))
    assert alike.excess == pytest.approx(0.0, abs=1e-16)
    ends = two_masses(3.0, 0.09, 0.3, 0.3)
    assert (ends.first, ends.second, ends.excess) == pytest.approx((1.5, 1.5, 0.18))


def test_two_masses_and_their_couple_have_the_inertia_of_the_link() -> None:
    """Force, and moment about S, at any motion: sum r x (-m_i a_i) + excess alpha = -J alpha."""
    rng = np.random.default_rng(3)
    for _ in range(20):
        mass, inertia, l1, l2 = rng.uniform(0.1, 2.0, 4)
        omega, alpha, lean = rng.normal(0, 9, 3)
        a_s = rng.normal(0, 9, 2)
        found = two_masses(mass, inertia, l1, l2)
        along = np.array([math.cos(lean), math.sin(lean)])
        force, moment = np.zeros(2), found.excess * alpha
        for part, at in ((found.first, -l1 * along), (found.second, l2 * along)):
            a = a_s + alpha * np.array([-at[1], at[0]]) - omega**2 * at
            force -= part * a
            moment -= part * (at[0] * a[1] - at[1] * a[0])
        assert force == pytest.approx(-mass * a_s, rel=1e-12, abs=1e-11)
        assert moment == pytest.approx(-inertia * alpha, rel=1e-12, abs=1e-11)


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda: oscillation_length(0.0, 0.1, 0.2), "mass is 0 kg"),
        (lambda: oscillation_length(1.0, 0.1, 0.0), "the centre of mass lies in the pivot"),
        (lambda: two_masses(1.0, 0.1, 0.0, 0.2), "give distances above 0"),
        (lambda: two_masses(0.0, 0.1, 0.1, 0.2), "mass is 0 kg"),
    ],
)
def test_what_has_no_reduction_is_refused(make: object, words: str) -> None:
    with pytest.raises(CrankcheckError, match=words):
        make()  # type: ignore[operator]
