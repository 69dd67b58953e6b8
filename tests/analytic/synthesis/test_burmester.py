"""Burmester's points against a second method, and against mechanisms that have them."""

from __future__ import annotations

import cmath
import math

import numpy as np
import pytest

from analytic.synthesis.burmester import five_positions, four_positions
from analytic.synthesis.guided_body import Dyad
from analytic.synthesis.pose import Pose
from models.errors import CrankcheckError
from tests.analytic.assur.homotopy import Equation, finite_solutions
from tests.worlds.tiers import few

W, W_BAR, M, M_BAR = (1, 0, 0, 0), (0, 1, 0, 0), (0, 0, 1, 0), (0, 0, 0, 1)
ONE, W_M_BAR, W_BAR_M = (0, 0, 0, 0), (1, 0, 0, 1), (0, 1, 1, 0)
FINITE = 4


def random_poses(number: int, count: int) -> list[Pose]:
    draw = np.random.default_rng([7, number])
    return [
        Pose(complex(*draw.uniform(-1.0, 1.0, 2)), float(draw.uniform(-3.0, 3.0)))
        for _ in range(count)
    ]


def equation(first: Pose, pose: Pose) -> Equation:
    """The circle of a displacement in w, w', m and m', about the plane's own origin."""
    e = cmath.exp(1j * (pose.angle - first.angle))
    d = pose.point - e * first.point
    return {
        ONE: abs(d) ** 2,
        W: d.conjugate() * e,
        W_BAR: d * e.conjugate(),
        W_M_BAR: 1.0 - e,
        M_BAR: -d,
        W_BAR_M: 1.0 - e.conjugate(),
        M: -d.conjugate(),
    }


def by_homotopy(poses: list[Pose]) -> list[Dyad]:
    """All real solutions, by following paths to all four."""
    every = finite_solutions([equation(poses[0], pose) for pose in poses[1:]], FINITE)
    assert len(every) == FINITE
    off = np.abs(every[:, 1] - every[:, 0].conj()) + np.abs(every[:, 3] - every[:, 2].conj())
    own = every[off < 1e-8 * (1.0 + np.abs(every).max(axis=1))]
    return [Dyad(complex(m), poses[0].back(complex(w))) for w, _, m, _ in own]


def spread(poses: list[Pose], dyad: Dyad) -> float:
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
            nearest = min(abs(dyad.fixed - o.fixed) + abs(dyad.moving - o.moving) for o in others)
            assert nearest < 1e-6 * (1.0 + abs(dyad.fixed) + abs(dyad.moving))
        counts.add(len(found))
    assert counts <= {0, 2, 4}
    assert len(counts) > 1


def coupler_poses(angles: list[float]) -> tuple[list[Pose], list[Dyad]]:
    """A coupler with its two cranks: four-bar 0.4, 1.0, 0.8, 1.1."""
    a, b, c, d = 0.4, 1.0, 0.8, 1.1
    poses = []
    for angle in angles:
        pin = cmath.rect(a, angle)
        arm = d - pin
        turn = math.acos((abs(arm) ** 2 + b**2 - c**2) / (2.0 * abs(arm) * b))
        poses.append(Pose(pin, cmath.phase(arm) + turn))
    return poses, [Dyad(0j, 0j), Dyad(d + 0j, b + 0j)]


def test_the_cranks_of_a_four_bar_are_among_those_of_its_coupler() -> None:
    poses, cranks = coupler_poses([0.3, 1.0, 2.2, 3.5, 5.0])
    found = five_positions(poses)
    for crank in cranks:
        off = min(abs(one.fixed - crank.fixed) + abs(one.moving - crank.moving) for one in found)
        assert off < 1e-12


def test_curves_of_four_positions_hold_the_body_and_pass_its_cranks() -> None:
    poses, cranks = coupler_poses([0.3, 1.0, 2.2, 3.5])
    dyads = [dyad for piece in four_positions(poses, 2880) for dyad in piece]
    assert max(spread(poses, dyad) for dyad in dyads) < 1e-11
    for crank in cranks:
        off = min(abs(one.fixed - crank.fixed) + abs(one.moving - crank.moving) for one in dyads)
        assert off < 0.02


def test_a_crank_of_five_positions_lies_on_the_curves_of_four() -> None:
    poses = random_poses(3, 5)
    dyads = [dyad for piece in four_positions(poses[:4], 5760) for dyad in piece]
    found = five_positions(poses)
    assert found
    for crank in found:
        off = min(abs(one.fixed - crank.fixed) + abs(one.moving - crank.moving) for one in dyads)
        assert off < 0.05 * (1.0 + abs(crank.fixed) + abs(crank.moving))


def test_a_body_that_turns_about_a_pivot_has_too_many_cranks_to_list() -> None:
    poses = [Pose(0j, angle) for angle in (0.0, 0.3, 0.7, 1.0, 1.6)]
    with pytest.raises(CrankcheckError, match="so special"):
        five_positions(poses)
