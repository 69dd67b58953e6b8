"""Burmester's points against a second method, against mechanisms that have them, and pylinkage."""

import cmath
import math
from collections.abc import Iterable

import numpy as np
import pytest
from pylinkage.synthesis import Pose as TheirPose
from pylinkage.synthesis import compute_pole, function_generation, motion_generation

from analytic.lectures.synthesis.burmester import five_positions, four_positions
from analytic.lectures.synthesis.function.linkages import fourbars
from analytic.lectures.synthesis.pose import PlanePose, PoseDyad, about_circumcentre, pole
from models.errors import CrankcheckError
from tests.analytic.assur.homotopy import Equation, finite_solutions
from tests.worlds.tiers import few

W, W_BAR, M, M_BAR = (1, 0, 0, 0), (0, 1, 0, 0), (0, 0, 1, 0), (0, 0, 0, 1)
ONE, W_M_BAR, W_BAR_M = (0, 0, 0, 0), (1, 0, 0, 1), (0, 1, 1, 0)
FINITE = 4


def random_poses(number: int, count: int) -> list[PlanePose]:
    draw = np.random.default_rng([7, number]).uniform(-1.0, 1.0, (count, 3))
    return [PlanePose(complex(x, y), float(3.0 * turn)) for x, y, turn in draw]


def equation(first: PlanePose, pose: PlanePose) -> Equation:
    """The circle of a displacement in w, w', m and m', about the plane's own origin."""
    e = cmath.exp(1j * (pose.angle - first.angle))
    d = pose.point - e * first.point
    e_bar, d_bar = e.conjugate(), d.conjugate()
    single = {W: d_bar * e, W_BAR: d * e_bar, M_BAR: -d, M: -d_bar}
    return {ONE: abs(d) ** 2, W_M_BAR: 1.0 - e, W_BAR_M: 1.0 - e_bar, **single}


def by_homotopy(poses: list[PlanePose]) -> list[PoseDyad]:
    """All real solutions, by following paths to all four."""
    every = finite_solutions([equation(poses[0], pose) for pose in poses[1:]], FINITE)
    assert len(every) == FINITE
    off = np.abs(every[:, 1] - every[:, 0].conj()) + np.abs(every[:, 3] - every[:, 2].conj())
    own = every[off < 1e-8 * (1.0 + np.abs(every).max(axis=1))]
    return [PoseDyad(complex(m), poses[0].back(complex(w))) for w, _, m, _ in own]


def away(one: PoseDyad, others: Iterable[PoseDyad]) -> float:
    """How far the nearest of others is from a dyad."""
    return min(abs(one.fixed - o.fixed) + abs(one.moving - o.moving) for o in others)


def spread(poses: list[PlanePose], dyad: PoseDyad) -> float:
    """How far the moving pivot is from one circle, over the size."""
    radii = [abs(pose.at(dyad.moving) - dyad.fixed) for pose in poses]
    return (max(radii) - min(radii)) / (1.0 + max(radii))


@pytest.mark.parametrize("part", few(range(40), range(1), "random positions"))
def test_five_positions_have_all_their_cranks_and_no_others(part: int) -> None:
    counts = set()
    for number in range(25 * part, 25 * part + 25):
        poses = random_poses(number, 5)
        found, others = five_positions(poses), by_homotopy(poses)
        assert len(found) == len(others), number
        for dyad in found:
            assert spread(poses, dyad) < 1e-13
            assert away(dyad, others) < 1e-6 * (1.0 + abs(dyad.fixed) + abs(dyad.moving))
        counts.add(len(found))
    assert counts <= {0, 2, 4}
    assert len(counts) > 1


def coupler_poses(angles: list[float]) -> tuple[list[PlanePose], list[PoseDyad]]:
    """A coupler with its two cranks: four-bar 0.4, 1.0, 0.8, 1.1."""
    a, b, c, d = 0.4, 1.0, 0.8, 1.1
    poses = []
    for angle in angles:
        pin = cmath.rect(a, angle)
        arm = d - pin
        turn = math.acos((abs(arm) ** 2 + b**2 - c**2) / (2.0 * abs(arm) * b))
        poses.append(PlanePose(pin, cmath.phase(arm) + turn))
    return poses, [PoseDyad(0j, 0j), PoseDyad(d + 0j, b + 0j)]


def test_curves_of_four_positions_hold_the_body_and_pass_its_cranks_and_theirs_come_near() -> None:
    poses, cranks = coupler_poses([0.3, 1.0, 2.2, 3.5])
    dyads = [dyad for piece in four_positions(poses, 2880) for dyad in piece]
    assert max(spread(poses, dyad) for dyad in dyads) < 1e-11
    assert all(away(crank, dyads) < 0.02 for crank in cranks)
    assert min(spread(poses, other) for other in theirs(poses)) > 1e-4


def test_a_crank_of_five_positions_lies_on_the_curves_of_four() -> None:
    poses = random_poses(3, 5)
    dyads = [dyad for piece in four_positions(poses[:4], 5760) for dyad in piece]
    found = five_positions(poses)
    assert found
    for crank in found:
        assert away(crank, dyads) < 0.05 * (1.0 + abs(crank.fixed) + abs(crank.moving))


def test_a_body_that_turns_about_a_pivot_has_too_many_cranks_to_list() -> None:
    poses = [PlanePose(0j, angle) for angle in (0.0, 0.3, 0.7, 1.0, 1.6)]
    with pytest.raises(CrankcheckError, match="so special"):
        five_positions(poses)


def their(pose: PlanePose) -> TheirPose:
    return TheirPose(pose.point.real, pose.point.imag, pose.angle)


def theirs(poses: list[PlanePose]) -> list[PoseDyad]:
    """The cranks of all four-bars that pylinkage proposes for a body's positions."""
    own = [their(pose) for pose in poses]
    found = motion_generation(own, require_grashof=False, max_solutions=200).raw_solutions
    pairs = [(one.ground_pivot_a, one.crank_pivot_b) for one in found]
    pairs += [(one.ground_pivot_d, one.coupler_pivot_c) for one in found]
    return [PoseDyad(complex(*fixed), poses[0].back(complex(*pin))) for fixed, pin in pairs]


def test_three_positions_are_held_by_the_same_cranks() -> None:
    poses, _ = coupler_poses([0.3, 1.0, 2.2])
    others = theirs(poses)
    assert len(others) > 100
    for other in others:
        own = about_circumcentre(poses, other.moving, "A")
        assert own.fixed == pytest.approx(other.fixed, abs=1e-9 * (1.0 + abs(own.fixed)))


def test_of_five_positions_they_find_none_and_ours_meet_them_with_those_of_a_four_bar() -> None:
    coupler, cranks = coupler_poses([0.3, 1.0, 2.2, 3.5, 5.0])
    assert all(away(crank, five_positions(coupler)) < 1e-12 for crank in cranks)
    for poses in (coupler, random_poses(3, 5)):
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
    first, second = random_poses(5, 2)
    own = pole(first, second)
    assert abs(own - complex(compute_pole(their(first), their(second)))) < 1e-12 * (1.0 + abs(own))
    assert abs(first.back(own) - second.back(own)) < 1e-12
