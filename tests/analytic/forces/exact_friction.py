"""Friction in fifty digits: reactions are linear in it, and its law holds to forty of them."""

from __future__ import annotations

from collections.abc import Mapping

from mpmath import matrix, mp, mpf

from analytic.structure.mobility import analyse
from models.friction import CoulombFriction
from models.joints import block_name
from models.scene import GROUND, Scene
from tests.analytic.chain import Solved
from tests.analytic.change_points.jets import Number
from tests.analytic.forces.exact_forces import ExactForces, exact_forces

STAYS = mpf(10) ** -40
FIRST, MOST = 40, 80
"""Plain substitutions, and Newton's steps after them."""
Pair = tuple[Number, Number]


def exact_rubbed(
    scene: Scene, time_s: float, solved: Solved
) -> tuple[ExactForces, Mapping[str, Number]] | None:
    """The forces with friction, and the friction; None where it does not settle."""
    way = {joint: -mp.sign(_rate(scene, joint, solved)) for joint in scene.friction}
    alone = _reactions(scene, exact_forces(scene, time_s, solved))
    influence = {
        joint: _less(_reactions(scene, exact_forces(scene, time_s, solved, {joint: mpf(1)})), alone)
        for joint in scene.friction
    }
    given = {
        joint: way[joint] * mpf(law.size)
        for joint, law in scene.friction.items()
        if not isinstance(law, CoulombFriction)
    }
    friction = {joint: given.get(joint, mpf(0)) for joint in scene.friction}
    for step in range(MOST):
        bears = {
            joint: _sum(
                [alone[joint], *(_times(influence[k][joint], friction[k]) for k in friction)]
            )
            for joint in friction
        }
        factors = {j: way[j] * _factor(scene, j, law) for j, law in scene.friction.items()
                   if isinstance(law, CoulombFriction)}  # fmt: skip
        after = given | {j: factor * mp.hypot(*bears[j]) for j, factor in factors.items()}
        change = max(abs(after[joint] - friction[joint]) for joint in friction)
        if change <= STAYS * max(abs(size) for size in friction.values()):
            return exact_forces(scene, time_s, solved, friction), friction
        friction = after if step < FIRST else _newton(alone, influence, bears, factors, given)
    return None


def _newton(
    alone: Mapping[str, Pair],
    influence: Mapping[str, Mapping[str, Pair]],
    bears: Mapping[str, Pair],
    factors: Mapping[str, Number],
    given: Mapping[str, Number],
) -> dict[str, Number]:
    """The friction where the reactions keep their directions, which makes it linear."""
    names = list(factors)
    if not names:
        return dict(given)
    a, b = mp.eye(len(names)), matrix(len(names), 1)
    for row, joint in enumerate(names):
        size = mp.hypot(*bears[joint]) or mpf(1)
        u = _times(bears[joint], factors[joint] / size)
        b[row] = _dot(u, alone[joint])
        b[row] += sum(_dot(u, influence[k][joint]) * size for k, size in given.items())
        for column, other in enumerate(names):
            a[row, column] -= _dot(u, influence[other][joint])
    return dict(zip(names, mp.lu_solve(a, b), strict=True)) | dict(given)


def _dot(one: Pair, other: Pair) -> Number:
    return one[0] * other[0] + one[1] * other[1]


def _times(one: Pair, factor: Number) -> Pair:
    return one[0] * factor, one[1] * factor


def _sum(pairs: list[Pair]) -> Pair:
    return sum(x for x, _ in pairs), sum(y for _, y in pairs)


def _factor(scene: Scene, joint: str, law: CoulombFriction) -> Number:
    if joint in scene.sliders:
        return mpf(law.mu)
    return mpf(law.radius_m) * mp.sin(mp.atan(mpf(law.mu)))


def _reactions(scene: Scene, found: ExactForces) -> dict[str, Pair]:
    """What friction grows with, by joint; a normal force as (N, 0)."""
    return {
        joint: (found.sliders[joint][0], mpf(0))
        if joint in scene.sliders
        else list(found.pins[joint].values())[1]
        for joint in scene.friction
    }


def _less(one: Mapping[str, Pair], other: Mapping[str, Pair]) -> dict[str, Pair]:
    return {n: (one[n][0] - other[n][0], one[n][1] - other[n][1]) for n in one}


def _rate(scene: Scene, joint: str, solved: Solved) -> Number:
    """How fast the second body of a joint moves against the first."""
    if joint in scene.sliders:
        return solved.sliders[joint].rate
    turning = {GROUND: mpf(0)} | {name: link.rate for name, link in solved.links.items()}
    for slider in scene.sliders.values():
        if slider.link is None:
            turning[block_name(slider)] = turning[slider.on]
    first, second = analyse(scene).pins[joint]
    return turning[second] - turning[first]
