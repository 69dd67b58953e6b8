"""Friction in fifty digits: reactions are linear in it, and it is substituted until it stays."""

from __future__ import annotations

from collections.abc import Mapping

from mpmath import mp, mpf

from analytic.structure.mobility import analyse
from models.friction import CoulombFriction
from models.joints import block_name
from models.scene import GROUND, Scene
from tests.analytic.chain import Solved
from tests.analytic.change_points.jets import Number
from tests.analytic.forces.exact_forces import ExactForces, exact_forces

STAYS = mpf(10) ** -40
MOST = 3000


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
    friction = dict.fromkeys(scene.friction, mpf(0))
    for _ in range(MOST):
        after = {}
        for joint, law in scene.friction.items():
            if not isinstance(law, CoulombFriction):
                after[joint] = way[joint] * mpf(law.size)
                continue
            x, y = alone[joint]
            for other, size in friction.items():
                x += influence[other][joint][0] * size
                y += influence[other][joint][1] * size
            after[joint] = way[joint] * _factor(scene, joint, law) * mp.hypot(x, y)
        change = max(abs(after[joint] - friction[joint]) for joint in friction)
        friction = after
        if change <= STAYS * max(abs(size) for size in friction.values()):
            return exact_forces(scene, time_s, solved, friction), friction
    return None


def _factor(scene: Scene, joint: str, law: CoulombFriction) -> Number:
    if joint in scene.sliders:
        return mpf(law.mu)
    return mpf(law.radius_m) * mp.sin(mp.atan(mpf(law.mu)))


def _reactions(scene: Scene, found: ExactForces) -> dict[str, tuple[Number, Number]]:
    """What friction grows with, by joint; a normal force as (N, 0)."""
    return {
        joint: (found.sliders[joint][0], mpf(0))
        if joint in scene.sliders
        else list(found.pins[joint].values())[1]
        for joint in scene.friction
    }


def _less(
    one: Mapping[str, tuple[Number, Number]], other: Mapping[str, tuple[Number, Number]]
) -> dict[str, tuple[Number, Number]]:
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
