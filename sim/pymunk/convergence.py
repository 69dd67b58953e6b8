"""Iterations in each step for the joints of a chain of light segments.

Chipmunk visits the joints one after the other and gives each the impulse that would close it alone:
the method of Gauss and Seidel for the errors e of their speeds,

    A = J M^-1 J^T = L + U        e <- -L^-1 U e        L with the blocks of each joint

so each iteration leaves a share rho of the slowest error, the spectral radius of L^-1 U, and k of
them g = rho^k. A step begins with the impulses of the last one, which also corrected the whole
position error (`error_bias` 0). Errors w of the speeds and c of the positions then follow

    c' = c + w dt        w' = -(1 - g) c' / dt + g (2 w - w'')        w'' of the step before

whose powers z of a step meet (1 - g) z^3 + g (z - 1)^3 = 0: they die off where g < 1/2 and grow
where it is larger, whatever the step is. So k has to be at least ln 2 / -ln rho. For a chain of n
segments that grows as n^2, and with the mass at its end over that of a segment.
"""

import math
from collections.abc import Mapping

import numpy as np
import pymunk

from models.array import Array
from models.errors import EngineError
from models.scene import Scene
from sim.engine import Settings
from sim.pymunk import bodies, native, space

HALVINGS = 3.0
"""Least number of halvings of an error in a step, in the position of the start. One is enough
there. Half as many again are needed elsewhere in a turn (six-bar: 1.44), and half as many again for
smooth accelerations; more gain nothing."""
MOST = 30_000
"""Largest number of iterations without a request: a step takes milliseconds with them."""
REDUNDANT = 1e-12
"""Largest part of an error that an iteration removes although no impulse can change it."""


def held_by_iterations(scene: Scene, settings: Settings) -> bool:
    """True if a scene has a chain that enough iterations hold: no number of them is enough for a
    bias that corrects little of an error in a step."""
    return float(settings["error_bias"]) == 0.0 and bool(bodies.chain_springs(scene))


def iterations(settings: Settings, model: space.SpaceModel) -> int:
    """Return the iterations of the settings, or more where the chain of a scene needs them.

    Raises EngineError where more than `MOST` are needed, and fewer requested.
    """
    asked = int(settings["iterations"])
    if not held_by_iterations(model.scene, settings):
        return asked
    needed = chain_iterations(model)
    if needed > max(asked, MOST):
        raise EngineError(
            f"{model.scene.name}: the joints of its segments need {needed} iterations in each "
            f"step of pymunk, and {MOST} are done at most: the bodies on the segments are too "
            "heavy; use fewer segments or another engine, or set so many iterations yourself"
        )
    return max(asked, needed)


def chain_iterations(model: space.SpaceModel) -> int:
    """Return the iterations that hold the joints of a space, in its present position."""
    return math.ceil(HALVINGS * math.log(2.0) / -math.log(left_over(model)))


def left_over(model: space.SpaceModel) -> float:
    """Return rho: the share of the slowest error of its joints after an iteration, which takes them
    in the order of the space. Friction and springs, which yield, do not count."""
    made = {model.motor, *model.hinges.values(), *model.lines.values(), *model.gears.values()}
    column = {body: 3 * k for k, body in enumerate(model.bodies.values())}
    blocks = [_rows(joint, column) for joint in model.space.constraints if joint in made]
    weight = np.concatenate([_inverse_masses(body) for body in model.bodies.values()])
    rows = np.concatenate(blocks)
    answers = (rows * weight) @ rows.T
    of = np.repeat(np.arange(len(blocks)), [len(block) for block in blocks])
    lower = np.where(of[:, None] >= of, answers, 0.0)
    shares = np.abs(1.0 - np.linalg.eigvals(np.linalg.solve(lower, answers)))
    return float(shares[shares < 1.0 - REDUNDANT].max(initial=REDUNDANT))


def _inverse_masses(body: pymunk.Body) -> Array:
    if not native.moves_freely(body):
        return np.zeros(3)
    return 1.0 / np.array([body.mass, body.mass, body.moment])


def _rows(joint: pymunk.Constraint, column: Mapping[pymunk.Body, int]) -> Array:
    """Return the speeds of a joint over those of all bodies, (1 or 2, 3 bodies)."""
    ways = _ways(joint)
    rows = np.zeros((len(ways), 3 * len(column)))
    for body, sign in ((joint.a, -1.0), (joint.b, 1.0)):
        if body not in column:
            continue
        at = column[body]
        if not ways.any():  # a gear or a motor: angles alone
            rows[0, at + 2] = sign
            continue
        arm = _place(joint, body) - body.position
        rows[:, at : at + 2] = sign * ways
        rows[:, at + 2] = sign * (arm.x * ways[:, 1] - arm.y * ways[:, 0])
    return rows


def _ways(joint: pymunk.Constraint) -> Array:
    """Return the constrained directions of a joint's two places; none for angles."""
    if isinstance(joint, pymunk.PivotJoint):
        return np.eye(2)
    if isinstance(joint, pymunk.GrooveJoint):
        along = (joint.groove_b - joint.groove_a).rotated(joint.a.angle).normalized()
        return np.array([along.perpendicular()])
    if isinstance(joint, pymunk.PinJoint):
        first, second = (
            joint.a.local_to_world(joint.anchor_a),
            joint.b.local_to_world(joint.anchor_b),
        )
        return np.array([(second - first).normalized()])
    return np.zeros((1, 2))


def _place(joint: pymunk.Constraint, body: pymunk.Body) -> pymunk.Vec2d:
    """Return the place of a joint on a body in the plane; for a groove, its point in it."""
    if body is joint.b or isinstance(joint, pymunk.GrooveJoint):
        return joint.b.local_to_world(joint.anchor_b)
    return joint.a.local_to_world(joint.anchor_a)
