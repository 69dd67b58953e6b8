"""Reactions of an engine with joint coordinates, from its accelerations.

An engine reports the forces of loops seldom, and those of joints with the rates of another instant.
The accelerations of a step show all of them at its start, where the rates are the means of those of
the steps about it. Friction is the engine's own, of constant size, in joints of the tree.
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from models.array import Array
from models.mjcf.forces import rubbing_freedom
from models.mjcf.tree import Limb
from models.motion import Forces
from models.scene import GROUND, Scene
from models.scene import joints as pairs
from models.scene.loads import ConstantFriction
from sim.engine import BodyPose, measure, tree_poses
from sim.engine.acting import Push
from sim.engine.momentum_balance import MomentumGain, forces_by_body, joint_pushes
from sim.engine.ties import block_guides, hinges, slide_of

STUCK = 1e-9
"""Largest rate of a joint, over the pace times the scene's length in a slider, that counts as
none."""


@dataclass(frozen=True)
class Rub:
    """Friction in a pin [N m] or slider [N]: the ``row`` of its joint coordinate, whose rate has
    the ``sense`` of the second body's against the first. In a slider the first is the guide; a
    block without mass turns with it."""

    joint: str
    size: float
    row: int
    sense: float
    bodies: tuple[str, str]
    slowest: float

    def on_second(self, rate: float, pace: float) -> float:
        """Return the action on the second body in a step that ended so; NaN where they stick."""
        stuck = abs(rate) <= self.slowest * pace
        return math.nan if stuck else -self.sense * math.copysign(self.size, rate)


def rubs(scene: Scene, limbs: Sequence[Limb], *, sliders: bool = True) -> list[Rub]:
    """Return the frictions of constant size, of pins alone without ``sliders``; their joints are in
    the tree (`models.mjcf.forces.planned`)."""
    found = []
    freedoms = [(limb, freedom) for limb in limbs for freedom in limb.freedoms]
    guides = block_guides(scene)
    for one in scene.friction.values():
        slides = one.joint in scene.sliders
        if not isinstance(one, ConstantFriction) or (slides and not sliders):
            continue
        row, limb = next(
            (row, limb)
            for row, (limb, freedom) in enumerate(freedoms)
            if rubbing_freedom(scene, limb, one.joint) is freedom
        )
        if slides:  # its coordinate is the slider's own
            slide = slide_of(scene, one.joint)
            first, second, slowest = slide.slider.on, pairs.riding_body(slide), scene.longest_m
        else:
            first, second = (guides.get(n, n) for n in pairs.joined_at(scene)[one.joint][:2])
            slowest = 1.0
        sense = 1.0 if slides or limb.body == second else -1.0
        bodies = first, second
        found.append(Rub(one.joint, one.size, row, sense, bodies, STUCK * slowest))
    return found


@dataclass(frozen=True)
class RateChange:
    """A state after a step: joint coordinates, rates and accelerations (3, n), NaN before the first
    step; actions on bodies and on blocks that the step was given, and friction by joint."""

    joints: Array
    on_bodies: Mapping[str, Push]
    on_blocks: Mapping[str, Push]
    rubbed: Mapping[str, float]


def forces_of(
    scene: Scene,
    limbs: Sequence[Limb],
    rubbing: Sequence[Rub],
    rows: Sequence[RateChange],
    time_s: Array,
    dt_s: float,
    *,
    driven: bool,
) -> Forces:
    """Return the forces at the start of the step before each row, where the places step with the
    new rates; ``time_s`` are the rows' own instants."""
    q, rate, push = np.stack([row.joints for row in rows], axis=1)
    poses = tree_poses.body_poses(limbs, q - dt_s * rate, rate - 0.5 * dt_s * push, push)
    poses = {GROUND: BodyPose(*_still(len(rows))), **poses}
    given = {name: np.array([row.on_bodies[name] for row in rows]) for name in poses}
    blocks = {name: np.array([row.on_blocks[name] for row in rows]) for name in rows[0].on_blocks}
    rubbed = {
        name: np.array([row.rubbed.get(name, math.nan) for row in rows]) for name in rows[-1].rubbed
    }
    for rub in rubbing:
        size = rubbed[rub.joint]
        if rub.joint not in scene.sliders:
            for body, sense in zip(rub.bodies, (-1.0, 1.0), strict=True):
                given[body][:, 2] += sense * size
            continue
        slider, (guide, rider) = scene.sliders[rub.joint], (poses[name] for name in rub.bodies)
        force = size[:, None] * measure.directions(guide.theta + slider.direction_rad)
        local = pairs.local_point(scene, rub.bodies[1], slider.point)
        place = rider.origin + measure.arms(rider.theta, local)
        for body, sense in zip(rub.bodies, (-1.0, 1.0), strict=True):
            arm = place - poses[body].origin
            given[body] += sense * np.column_stack([force, _moment(arm, force)])
        if rub.joint in blocks:
            blocks[rub.joint][:, :2] += force
    gains = {n: _gain(scene, n, poses[n], given[n]) for n in poses if n != GROUND}
    pushes = joint_pushes(scene, [*hinges(scene, GROUND)], gains, driven=driven)
    found = forces_by_body(scene, pushes, blocks, rubbed, time_s - dt_s)
    unknown = np.flatnonzero(~np.isfinite(push).all(axis=1))

    def told(series: Array) -> Array:
        series = np.array(series)
        series[unknown] = np.nan
        return series

    return found.each_series(told)


def _gain(scene: Scene, name: str, pose: BodyPose, given: Array) -> MomentumGain:
    """Return the action of joints and drive on a body, less what it was given at its origin."""
    mass, inertia = pairs.mass_of(scene, name)
    centre = pairs.centre_of(scene, name)
    arm = measure.arms(pose.theta, centre)
    turning = pose.alpha[:, None] * measure.across(arm) - pose.omega[:, None] ** 2 * arm
    pull = pose.origin_acceleration + turning - np.array(scene.gravity_m_s2)
    moment = inertia * pose.alpha - given[:, 2] + _moment(arm, given[:, :2])
    force = mass * pull - given[:, :2]
    return MomentumGain(centre, pose.origin + arm, pose.theta, force, moment)


def _moment(arm: Array, force: Array) -> Array:
    return np.asarray(arm[:, 0] * force[:, 1] - arm[:, 1] * force[:, 0])


def _still(samples: int) -> tuple[Array, ...]:
    zero, pair = np.zeros(samples), np.zeros((samples, 2))
    return pair, zero, pair, zero, pair, zero
