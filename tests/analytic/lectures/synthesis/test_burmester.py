"""Burmester's points against a second method, and against mechanisms that have them."""

import cmath
import math
from collections.abc import Iterable

import numpy as np
import pytest

from analytic.lectures.synthesis.burmester import five_positions, four_positions
from analytic.lectures.synthesis.pose import PlanePose, PoseDyad, pole
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


def test_a_body_that_turns_about_a_pivot_has_too_many_cranks_to_list() -> None:
    poses = [PlanePose(0j, angle) for angle in (0.0, 0.3, 0.7, 1.0, 1.6)]
    with pytest.raises(CrankcheckError, match="so special"):
        five_positions(poses)


def test_the_pole_is_one_point_of_the_body_in_both_positions() -> None:
    first, second = random_poses(5, 2)
    own = pole(first, second)
    assert own is not None
    assert abs(first.back(own) - second.back(own)) < 1e-12
