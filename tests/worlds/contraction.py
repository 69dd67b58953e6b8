"""How fast an engine that solves its joints one after the other comes to their solution.

Impulses at the joints are to make the relative velocities vanish: A x = b with A = J M^-1 J^T, the
rows of J one joint's after the other's. An engine like pymunk goes through the joints and solves
each exactly with the others held, which is the method of Gauss and Seidel in blocks: an iteration
multiplies the error by G = -(D + L)^-1 U, in the long run by its spectral radius.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import pymunk

from analytic.kinematics import solve
from models.array import Array
from models.motion import State
from models.scene import Scene
from sim.pymunk.space import build

LOOKS = 16


def contraction(scene: Scene) -> float:
    """The largest factor over a period that the error keeps in one iteration in the long run."""
    times = np.linspace(0.0, scene.driver.law.period_s, LOOKS, endpoint=False)
    motion = solve(scene, times, bound=False)
    return max(_radius(scene, motion.state(k)) for k in range(LOOKS))


def _radius(scene: Scene, state: State) -> float:
    """The spectral radius of an iteration, in one position."""
    model = build(scene, state)
    free = [b for b in model.bodies.values() if b.body_type == pymunk.Body.DYNAMIC]
    inverse = np.concatenate([[1 / b.mass, 1 / b.mass, 1 / b.moment] for b in free])
    column = {id(body): 3 * k for k, body in enumerate(free)}
    groups = [_rows(joint, column, len(inverse)) for joint in model.space.constraints]
    rows = np.concatenate(groups)
    matrix = (rows * inverse) @ rows.T
    group = np.repeat(np.arange(len(groups)), [len(part) for part in groups])
    done = group[:, None] >= group[None, :]
    iteration = np.linalg.solve(np.where(done, matrix, 0.0), np.where(done, 0.0, matrix))
    return float(np.max(np.abs(np.linalg.eigvals(iteration))))


def _rows(joint: pymunk.Constraint, column: dict[int, int], width: int) -> Array:
    """What a joint holds at rest, as rows that multiply the velocities of the bodies."""
    if isinstance(joint, pymunk.GearJoint):
        row = np.zeros((1, width))
        for body, sign in ((joint.a, -1.0), (joint.b, 1.0)):
            if id(body) in column:
                row[0, column[id(body)] + 2] += sign
        return row
    rows = np.zeros((2, width))
    for body, arm, sign in _arms(joint):
        if id(body) in column:
            k = column[id(body)]
            rows[:, k : k + 2] += sign * np.eye(2)
            rows[:, k + 2] += sign * np.array([-arm[1], arm[0]])
    if isinstance(joint, pymunk.PivotJoint):
        return rows
    return _across(joint)[None] @ rows


def _arms(joint: pymunk.Constraint) -> Iterator[tuple[pymunk.Body, pymunk.Vec2d, float]]:
    """The bodies of a joint, from each to the place that it holds, and the sign of its motion."""
    assert isinstance(joint, pymunk.PivotJoint | pymunk.PinJoint | pymunk.GrooveJoint)
    place = joint.b.local_to_world(joint.anchor_b)
    for body, sign in ((joint.a, -1.0), (joint.b, 1.0)):
        yield body, place - body.position, sign


def _across(joint: pymunk.Constraint) -> Array:
    """The direction that a joint of one row holds."""
    if isinstance(joint, pymunk.GrooveJoint):
        a, b = (joint.a.local_to_world(end) for end in (joint.groove_a, joint.groove_b))
        along = (b - a).normalized()
        return np.array([-along.y, along.x])
    assert isinstance(joint, pymunk.PinJoint)
    away = joint.b.local_to_world(joint.anchor_b) - joint.a.local_to_world(joint.anchor_a)
    return np.array(away.normalized())
