"""Springs with their dampers over a chunk, their forces, and joints with friction.

A spring between two points pulls at the first body that has each of them: the ground, else the
first link in the order of the scene, else a block.
"""

import math
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from analytic.dyads.chunk import Chunk
from analytic.dyads.plane import EPS, Real, Vec
from analytic.forces.bounded import Bounded, BoundedVec
from analytic.forces.free_body import Balance, Displaced, FreeBody, PrismaticPair
from analytic.kinematics import counted_angle, unit_chunk
from analytic.prepared import prepared
from analytic.structure.mobility import Structure
from models.array import Array
from models.errors import CrankcheckError, few
from models.scene import GROUND, KEPT, Same, Scene
from models.scene.joints import block_name, local_point, whole_turns
from models.scene.loads import ConstantFriction, Friction, LineSpring, PinSpring, Spring

Stretch = tuple[Bounded, Bounded]
"""Deflection q of a spring [m or rad] and its rate q' [m/s or rad/s]."""


def spring_lengths(
    scene: Scene, chunk: Chunk, *, counted: bool = False
) -> Iterator[tuple[Spring, Array, Array]]:
    """Yield every spring with its q [m or rad] and its rate q' [m/s or rad/s], (T,) each.

    The q of a spring in a pin is in (-pi, pi] of its free angle, or ``counted`` on from the start.
    """
    like = np.zeros_like(chunk.theta)
    for spring in scene.springs.values():
        if isinstance(spring, LineSpring):
            q, rate = _line_stretch(*_way(scene, chunk, spring))
        elif isinstance(spring, PinSpring):
            first, second = (chunk.bodies[name] for name in spring.bodies)
            rate = Bounded(second.omega - first.omega, None)
            q = _pin_stretch(chunk, spring)[0] if counted else _within_half_a_turn(chunk, spring)
        else:
            q, rate = slide_stretch(chunk, spring.slider)
        yield spring, like + q.value, like + rate.value


def apply_springs(scene: Scene, chunk: Chunk, free: Mapping[str, FreeBody]) -> None:
    """Put the forces of all springs and dampers of a scene on its bodies."""
    for spring in scene.springs.values():
        if isinstance(spring, LineSpring):
            _pull_points(scene, chunk, spring, free)
        elif isinstance(spring, PinSpring):
            couple = _pull(spring, *_pin_stretch(chunk, spring))
            for body, own in zip(spring.bodies, (couple, -couple), strict=True):
                if body != GROUND:
                    free[body].moment = free[body].moment + own
        else:
            q, rate = slide_stretch(chunk, spring.slider)
            pair = PrismaticPair(scene.sliders[spring.slider], scene, free, q)
            force = pair.along * _pull(spring, q, rate)
            for body, push in ((pair.body, -force), (pair.guide, force)):
                if body != GROUND:
                    free[body].push(pair.arms[body], push)


def _pull_points(
    scene: Scene, chunk: Chunk, spring: LineSpring, free: Mapping[str, FreeBody]
) -> None:
    way, drift = _way(scene, chunk, spring)
    force = way * Bounded(spring.rate)
    slack_m = spring.free
    if slack_m or spring.damping:  # without, its direction does not count: it may have none
        length, speed = _line_stretch(way, drift)
        slack = Bounded(spring.damping) * speed - Bounded(spring.rate) * Bounded(slack_m)
        force = force + way * (slack * length.inverse())
    for point, push in zip(spring.points, (force, -force), strict=True):
        body = _holder(scene, point)
        if body != GROUND:
            own = free[body]
            own.push(own.vector(own.centre, local_point(scene, body, point)), push)


def _pull(spring: Spring, q: Bounded, rate: Bounded) -> Bounded:
    """Return the force that pulls q back [N or N m]."""
    held = Bounded(spring.rate) * (q - Bounded(spring.free))
    return held + Bounded(spring.damping) * rate


def _way(scene: Scene, chunk: Chunk, spring: LineSpring) -> tuple[BoundedVec, BoundedVec]:
    """Return the vector from the first point to the second [m], and its velocity."""
    a, b = (chunk.point(_holder(scene, name), name) for name in spring.points)
    p, v = b.p - a.p, b.v - a.v
    if a.error is None or b.error is None:
        return BoundedVec(p, 0.0, None), BoundedVec(v, 0.0, None)
    place, drift = a.error.position + b.error.position, a.error.velocity + b.error.velocity
    return _difference(p, place), _difference(v, drift)


def _difference(v: Vec, error: Real) -> BoundedVec:
    """Return a difference of vectors with a common error ``error``."""
    size = v.norm()
    return BoundedVec(v, size, error + EPS * size)


def _line_stretch(way: BoundedVec, drift: BoundedVec) -> Stretch:
    size = way.v.norm()
    length = Bounded(size, None if way.error is None else way.error + 2 * EPS * size)
    return length, way.dot(drift) * length.inverse()


def _pin_stretch(chunk: Chunk, spring: PinSpring) -> Stretch:
    """Return the angle between two bodies; at the start within half a turn of the free one."""
    first, second = (chunk.bodies[name] for name in spring.bodies)
    one, other = (_angle(chunk, name) for name in spring.bodies)
    q = other - one + _turns_at_start(Same(chunk.scene), spring)
    rate = np.asarray(second.omega - first.omega)
    if first.error is None or second.error is None:
        return Bounded(q, None), Bounded(rate, None)
    rounded = 4 * EPS * (np.abs(one) + np.abs(other) + np.abs(q) + 2.0)
    return (
        Bounded(q, first.error.theta + second.error.theta + rounded),
        Bounded(rate, first.error.omega + second.error.omega + EPS * np.abs(rate)),
    )


def _within_half_a_turn(chunk: Chunk, spring: PinSpring) -> Bounded:
    """Return the angle between two bodies, within half a turn of the free one."""
    first, second = (chunk.bodies[name] for name in spring.bodies)
    x, y = first.turn.dot(second.turn), first.turn.cross(second.turn)
    c, s = math.cos(spring.free), math.sin(spring.free)
    return Bounded(spring.free + np.arctan2(c * y - s * x, c * x + s * y), None)


def _angle(chunk: Chunk, body: str) -> Array:
    """Return the angle of a link, or of the ground, with its whole turns [rad], (T,)."""
    return np.zeros_like(chunk.theta) if body == GROUND else counted_angle(chunk, body)


@lru_cache(maxsize=4 * KEPT)
def _turns_at_start(same: Same, spring: PinSpring) -> float:
    """Return the whole turns [rad] that bring the bodies' angle near its free one at time 0."""
    chunk = unit_chunk(same.scene, np.array([prepared(same.scene).start]), bound=False)
    one, other = (_angle(chunk, name) for name in spring.bodies)
    return whole_turns(spring, float((other - one)[0]))


def slide_stretch(chunk: Chunk, slider: str) -> Stretch:
    """Return the displacement of a slider, and its speed."""
    sliding = chunk.sliders[slider]
    displacement, speed, _ = sliding.error or (None, None, None)
    return Bounded(sliding.s, displacement), Bounded(sliding.speed, speed)


def _holder(scene: Scene, point: str) -> str:
    """Return the body that a spring's end is fixed to."""
    if point in scene.pins:
        return scene.pins[point][0]
    return next(  # the point of blocks alone
        block_name(s) for s in scene.sliders.values() if s.link is None and s.point == point
    )


STILL = 1e-12
"""Share of the driver's rate (and of the longest link) below which a joint does not move: the rest
is rounding, and its friction, anywhere within its limits, is taken as 0."""


@dataclass(frozen=True)
class Rubbing:
    """Joint with friction: ``pair`` where it is a slider, the bodies ``first`` and ``second``.

    ``against`` is the direction of friction, -1, 0 or 1, against that of the motion; its error is
    up to 2 where rounding hides the direction of the motion.

    ::

        pin     second body turns at w = omega2 - omega1  the first exerts a couple c, c w <= 0
        slider  the body moves at v along e               the guide exerts f e on it, f v <= 0

    Friction in a slider acts at its point, along the line. For a block or link that its guide holds
    by two edges, with a moment, it is the classical friction of the resultant normal force alone.
    """

    law: Friction
    first: str
    second: str
    against: Bounded
    pair: PrismaticPair | None

    def put(self, free: Mapping[str, FreeBody], friction: Bounded) -> None:
        """Put the friction, with its sign, on both bodies."""
        if self.pair is None:
            free[self.second].moment = free[self.second].moment + friction
            if self.first != GROUND:
                free[self.first].moment = free[self.first].moment - friction
            return
        force = self.pair.along * friction
        free[self.second].push(self.pair.arms[self.second], force)
        if self.first != GROUND:
            free[self.first].push(self.pair.arms[self.first], -force)

    def reaction(self, balance: Balance) -> BoundedVec | Bounded:
        """Return the reaction behind the friction: the force in the pin, or the normal force."""
        if self.pair is None:
            return balance.pins[self.law.joint][self.second]
        return balance.sliders[self.pair.name][0]


def rubbing_joints(
    scene: Scene,
    structure: Structure,
    chunk: Chunk,
    free: Mapping[str, FreeBody],
    displaced: Displaced,
) -> Iterator[Rubbing]:
    """Yield the joints of a chunk that have friction. Raises CrankcheckError for a missing joint,
    or one in which more than two bodies meet."""
    for joint, law in scene.friction.items():
        if joint in scene.sliders:
            pair = PrismaticPair(scene.sliders[joint], scene, free, displaced[joint])
            against = _against(chunk, slide_stretch(chunk, joint)[1], scene.longest_m)
            yield Rubbing(law, pair.guide, pair.body, against, pair)
            continue
        first, second = _bodies_of_pin(scene, structure, joint)
        one, other = chunk.bodies[first], chunk.bodies[second]
        error = None
        if one.error is not None and other.error is not None:
            error = one.error.omega + other.error.omega
        against = _against(chunk, Bounded(other.omega - one.omega, error), 1.0)
        yield Rubbing(law, first, second, against, None)


def put_constant_friction(
    joints: Iterable[Rubbing], free: Mapping[str, FreeBody]
) -> dict[str, Bounded]:
    """Put friction that is independent of the reactions on the bodies; return it by joint."""
    friction = {}
    for rubbing in joints:
        if isinstance(rubbing.law, ConstantFriction):
            size = rubbing.against * Bounded(rubbing.law.size)
            rubbing.put(free, size)
            friction[rubbing.law.joint] = size
    return friction


def _bodies_of_pin(scene: Scene, structure: Structure, joint: str) -> tuple[str, str]:
    """Check the bodies of a pin: a scene may be made without the check of its file."""
    bodies = structure.pins.get(joint, ())
    if len(bodies) != 2:
        names = [n for n, held in structure.pins.items() if len(held) == 2] + list(scene.sliders)
        raise CrankcheckError(
            f"{scene.name}: friction.{joint}: {len(bodies)} bodies meet there, and two rub on one "
            f"another; use one of {few(names, 12)}"
        )
    return bodies[0], bodies[1]


def _against(chunk: Chunk, moving: Bounded, length_m: float) -> Bounded:
    """Return the opposite direction of a rate; none for a rate that is 0 up to rounding."""
    least = STILL * length_m * np.abs(chunk.driver.omega)
    rate = np.broadcast_to(np.asarray(moving.value, dtype=np.float64), chunk.theta.shape)
    sign = np.where(np.abs(rate) > least, -np.sign(rate), 0.0)
    if moving.error is None:
        return Bounded(sign, None)
    open_ = np.abs(rate) <= np.maximum(least, moving.error)
    return Bounded(sign, np.where(open_, 1.0 + np.abs(sign), 0.0))
