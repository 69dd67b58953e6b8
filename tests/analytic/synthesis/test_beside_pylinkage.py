"""pylinkage as a second opinion: where the two differ, the circle decides who is right."""

from __future__ import annotations

import cmath
import math

import numpy as np
import pytest
from pylinkage.synthesis import Pose as TheirPose
from pylinkage.synthesis import function_generation, motion_generation

from analytic.synthesis.burmester import five_positions, four_positions
from analytic.synthesis.function.fourbar import fourbars
from analytic.synthesis.guided_body import Dyad, about_circumcentre
from analytic.synthesis.pose import Pose
from tests.analytic.synthesis.test_burmester import coupler_poses, random_poses, spread


def theirs(poses: list[Pose]) -> list[Dyad]:
    """The cranks of all four-bars that pylinkage proposes for a body's positions."""
    found = motion_generation(
        [TheirPose(pose.point.real, pose.point.imag, pose.angle) for pose in poses],
        require_grashof=False,
        max_solutions=200,
    )
    pairs = [
        pair
        for one in found.raw_solutions
        for pair in (
            (one.ground_pivot_a, one.crank_pivot_b),
            (one.ground_pivot_d, one.coupler_pivot_c),
        )
    ]
    return [Dyad(complex(*fixed), poses[0].back(complex(*pin))) for fixed, pin in pairs]


def test_three_positions_are_held_by_the_same_cranks() -> None:
    poses, _ = coupler_poses([0.3, 1.0, 2.2])
    others = theirs(poses)
    assert len(others) > 100
    for other in others:
        own = about_circumcentre(poses, other.moving, "A")
        assert own.fixed == pytest.approx(other.fixed, abs=1e-9 * (1.0 + abs(own.fixed)))


def test_their_cranks_of_four_positions_come_near_and_ours_meet_them() -> None:
    poses, _ = coupler_poses([0.3, 1.0, 2.2, 3.5])
    others = theirs(poses)
    assert others
    assert min(spread(poses, other) for other in others) > 1e-4
    assert max(spread(poses, own) for piece in four_positions(poses) for own in piece) < 1e-11


def test_of_five_positions_they_find_none_and_ours_meet_them() -> None:
    for poses in (coupler_poses([0.3, 1.0, 2.2, 3.5, 5.0])[0], random_poses(3, 5)):
        assert not theirs(poses)
        own = five_positions(poses)
        assert len(own) >= 2
        assert max(spread(poses, dyad) for dyad in own) < 1e-12


def test_freudensteins_equation_gives_the_same_lengths() -> None:
    draw, compared = np.random.default_rng(2), 0
    while compared < 40:
        a, b, c = draw.uniform(0.3, 1.5, 3)
        phi = draw.uniform(0.0, math.tau) + np.array([0.0, 0.4, 0.8])
        arm = 1.0 - a * np.exp(1j * phi)
        if not np.all((abs(b - c) < np.abs(arm)) & (np.abs(arm) < b + c)):
            continue
        turn = np.arccos((np.abs(arm) ** 2 + b**2 - c**2) / (2.0 * np.abs(arm) * b))
        psi = np.angle(a * np.exp(1j * phi) + b * arm / np.abs(arm) * np.exp(1j * turn) - 1.0)
        pairs = list(zip(phi.tolist(), psi.tolist(), strict=True))
        (other,) = function_generation(pairs, require_grashof=False).raw_solutions
        own = fourbars(phi - phi[0], psi - psi[0], float(phi[0]), float(psi[0]))
        lengths = (other.crank_length, other.coupler_length, other.rocker_length)
        assert any(one.lengths[:3] == pytest.approx(lengths, rel=1e-6) for one in own)
        assert lengths == pytest.approx((a, b, c), rel=1e-6)
        compared += 1


def test_the_pole_is_the_point_that_both_say() -> None:
    from pylinkage.synthesis import compute_pole

    from analytic.synthesis.pose import pole

    first, second = random_poses(5, 2)
    other = compute_pole(
        TheirPose(first.point.real, first.point.imag, first.angle),
        TheirPose(second.point.real, second.point.imag, second.angle),
    )
    own = pole(first, second)
    assert own is not None
    assert abs(own - complex(other)) < 1e-12 * (1.0 + abs(own))
    assert abs(first.back(own) - second.back(own)) < 1e-12
    assert cmath.isfinite(own)
