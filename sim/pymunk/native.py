"""Actions on bodies in a step, and a space's own springs and friction in pins."""

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass

import numpy as np
import pymunk

from models.array import Array
from models.errors import EngineError
from models.motion import State
from models.scene import Point, Scene
from models.scene.joints import (
    End,
    Frame,
    Prism,
    Slot,
    block_name,
    joined_at,
    joints,
    less,
    line_ends,
    local_point,
    riding_body,
    turned,
    whole_turns,
)
from models.scene.loads import ConstantFriction, LineSpring, PinSpring, SlideSpring

Push = tuple[float, float, float]
"""A force [N] and a moment [N m]."""
NONE: Push = (0.0, 0.0, 0.0)


def moves_freely(body: pymunk.Body) -> bool:
    """True if pushes move a body: it is neither the ground nor driven."""
    return bool(body.body_type == pymunk.Body.DYNAMIC)


class Pushes:
    """Forces at the origins of bodies with moments about them, by body, and their part on slider
    blocks without mass, which transfer it, by slider."""

    def __init__(self, bodies: Iterable[str], blocks: Iterable[str]) -> None:
        self.on_bodies = dict.fromkeys(bodies, NONE)
        self.on_blocks = dict.fromkeys(blocks, NONE)

    def torque(self, body: str, size: float) -> None:
        """Add a torque [N m]."""
        self.on_bodies[body] = _sum(self.on_bodies[body], (0.0, 0.0, size))

    def force(self, body: str, frame: Frame, place: Point, force: Point) -> None:
        """Add a force [N] on a body with that frame, at a place of the plane [m]."""
        x, y = less(place, frame.origin)
        push = force[0], force[1], x * force[1] - y * force[0]
        self.on_bodies[body] = _sum(self.on_bodies[body], push)

    def note(self, slider: str, push: Push) -> None:
        """Note an action on a block without mass, beside the bodies that take it."""
        self.on_blocks[slider] = _sum(self.on_blocks[slider], push)


def _sum(a: Push, b: Push) -> Push:
    return a[0] + b[0], a[1] + b[1], a[2] + b[2]


WHOLE = 1.0 - 1e-9
"""Share of its largest couple from which on a motor counts as overcome."""


@dataclass(frozen=True)
class PinFriction:
    """Friction of a pin, of constant size: a motor of speed 0 with a limited couple.

    ``first`` and ``second`` are its bodies in the space; a block without mass counts as its guide.
    Chipmunk's motor of rate 0 brings their turning to rest, by an impulse of at most ``max_force *
    dt``: it is as large as that while the mechanism goes on turning, and holds where it would stop.
    ``motor`` is None where neither can be braked, a kinematic crank or the ground: their friction
    is added to the drive's torque.
    """

    joint: str
    first: str
    second: str
    size: float
    motor: pymunk.SimpleMotor | None

    def couple(self, impulse: Array, before: Array, after: Array, dt_s: float) -> Array:
        """Return the couple of the first body on the second over each step [N m], (T,).

        Parameters
        ----------
        impulse : Array
            Impulse of the motor; empty without one.
        before, after : Array
            The angular velocity of the second body against the first [rad/s] before and after the
            step: a motor that was overcome acts against the speed after, another brought the body
            to rest, against the speed before.
        """
        if self.motor is None:
            return np.asarray(-self.size * np.sign(after))
        magnitude = impulse / dt_s
        return np.asarray(
            -magnitude * np.sign(np.where(magnitude >= WHOLE * self.size, after, before))
        )


def pin_friction(scene: Scene, made: Mapping[str, pymunk.Body]) -> tuple[PinFriction, ...]:
    """Make the constant friction of the pins of a scene, for its bodies in the space, by name, with
    the ground. Raises EngineError for a pin without exactly two."""
    guides = {
        block_name(slide.slider): slide.slider.on
        for slide in joints(scene).slides
        if isinstance(slide, Slot)
    }
    rubs = []
    for joint, law in scene.friction.items():
        if isinstance(law, ConstantFriction) and joint not in scene.sliders:
            first, second = _two(scene, joint, guides)
            ends = made[first], made[second]
            motor = None
            if any(map(moves_freely, ends)):
                motor = pymunk.SimpleMotor(*ends, 0.0)
                motor.max_force = law.size
            rubs.append(PinFriction(joint, first, second, law.size, motor))
    return tuple(rubs)


def _two(scene: Scene, joint: str, guides: Mapping[str, str]) -> tuple[str, str]:
    """Return the two bodies in the space that a pin joins."""
    names = joined_at(scene).get(joint, ())
    if len(names) != 2:
        raise EngineError(
            f"{scene.name}: friction.{joint}: {len(names)} bodies meet there, and two rub on one "
            "another; use a pin of two, or a slider"
        )
    return guides.get(names[0], names[0]), guides.get(names[1], names[1])


@dataclass(frozen=True)
class NativeSpring:
    """A spring between two bodies of a space, by name: pymunk's length is the spring's q less
    ``q_at_zero`` [m or rad]. Along a line, ``block`` is the slider of a pulled block without mass.

    It pulls with the length at the end of a step, as `sim.pymunk.spring_steps` does. It damps the
    velocity before the joints of the step have corrected it, by turns with them, so that damping is
    of first order (numbers: the reason in `sim.pymunk.settings`); by an exponential, so that a
    damper of any stiffness is stable.
    """

    constraint: pymunk.DampedSpring | pymunk.DampedRotarySpring
    first: str
    second: str
    q_at_zero: float = 0.0
    block: str | None = None

    @property
    def numbers(self) -> tuple[float, float, float]:
        """Rate, damping and slack q, as pymunk holds them."""
        own = self.constraint
        slack = own.rest_length if isinstance(own, pymunk.DampedSpring) else own.rest_angle
        return own.stiffness, own.damping, slack + self.q_at_zero

    def push(self, dt_s: float, frames: Mapping[str, Frame], pushes: Pushes) -> None:
        """Add its forces in the last step, which brought the bodies to these frames."""
        own, impulse = self.constraint, float(self.constraint.impulse)
        if isinstance(own, pymunk.DampedRotarySpring):
            pushes.torque(self.first, impulse / dt_s)
            pushes.torque(self.second, -impulse / dt_s)
            return
        here = frames[self.first].at((own.anchor_a.x, own.anchor_a.y))
        there = frames[self.second].at((own.anchor_b.x, own.anchor_b.y))
        way = less(there, here)
        size = impulse / dt_s / (math.hypot(*way) or math.inf)
        fx, fy = size * way[0], size * way[1]
        pushes.force(self.first, frames[self.first], here, (-fx, -fy))
        pushes.force(self.second, frames[self.second], there, (fx, fy))
        if self.block is not None:
            pushes.note(self.block, (fx, fy, 0.0))


def native_springs(
    scene: Scene,
    state: State,
    made: Mapping[str, pymunk.Body],
    centre: Mapping[str, Point],
    far_m: float,
) -> dict[str, NativeSpring]:
    """Make the springs of a scene between its bodies in the space, by name, with the ground.

    A spring between two bodies that do not move freely is left out: pymunk takes none there. A
    spring along a line hangs on a place of it ``far_m`` behind the slider, out of its reach.
    """
    slides = {slide.slider.name: slide for slide in joints(scene).slides}
    springs = {}
    for name, spring in scene.springs.items():
        if isinstance(spring, PinSpring):
            own = _in_pin(spring, made)
        elif isinstance(spring, LineSpring):
            own = _between(spring, line_ends(scene, spring), made, centre)
        else:
            slide = slides[spring.slider]
            behind, ends = _behind(scene, slide, state, far_m)
            block = spring.slider if isinstance(slide, Slot) else None
            own = _between(spring, ends, made, centre, behind, block)
        if own is not None:
            springs[name] = own
    return springs


def _in_pin(spring: PinSpring, made: Mapping[str, pymunk.Body]) -> NativeSpring | None:
    first, second = spring.bodies
    if not (moves_freely(made[first]) or moves_freely(made[second])):
        return None
    turns = whole_turns(spring, made[second].angle - made[first].angle)
    # Chipmunk counts the angle of its first body against its second.
    own = pymunk.DampedRotarySpring(
        made[second], made[first], spring.free - turns, spring.rate, spring.damping
    )
    return NativeSpring(own, first, second, turns)


def _between(
    spring: LineSpring | SlideSpring,
    ends: tuple[End, End],
    made: Mapping[str, pymunk.Body],
    centre: Mapping[str, Point],
    q_at_zero: float = 0.0,
    block: str | None = None,
) -> NativeSpring | None:
    (first, here), (second, there) = ends
    if not (moves_freely(made[first]) or moves_freely(made[second])):
        return None
    own = pymunk.DampedSpring(
        made[first],
        made[second],
        less(here, centre[first]),
        less(there, centre[second]),
        spring.free - q_at_zero,
        spring.rate,
        spring.damping,
    )
    return NativeSpring(own, first, second, q_at_zero, block)


def _behind(
    scene: Scene, slide: Prism | Slot, state: State, far_m: float
) -> tuple[float, tuple[End, End]]:
    """Return the displacement of a place of the line behind the slider, and a spring's ends there
    and at the slider."""
    slider, rider = slide.slider, riding_body(slide)
    behind = state.displacement[slider.name] - far_m
    ux, uy = turned((behind, 0.0), slider.direction_rad)
    x, y = slider.through_m
    start = slider.on, (x + ux, y + uy)
    return behind, (start, (rider, local_point(scene, rider, slider.point)))
