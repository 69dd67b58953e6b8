"""Bodies of a scene in a space, actions on them in a step, and the space's own springs and friction
in pins."""

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
import pymunk

from models.array import Array
from models.scene import GROUND, Point
from models.scene import joints as pairs
from models.scene.joints import End, Frame
from models.scene.loads import LineSpring, PinSpring, SlideSpring
from sim.engine.acting import EngineBodies, Pushes
from sim.engine.ties import rubbing_joints, slide_of, spring_ends


def moves_freely(body: pymunk.Body) -> bool:
    """True if pushes move a body: it is neither the ground nor driven."""
    return bool(body.body_type == pymunk.Body.DYNAMIC)


@dataclass(frozen=True)
class SpaceBodies(EngineBodies):
    """Moving bodies of a scene in a space, by name in the order they were added."""

    space: pymunk.Space
    bodies: dict[str, pymunk.Body] = field(default_factory=dict)

    def body(self, name: str) -> pymunk.Body:
        """Return a body or the ground."""
        return self.space.static_body if name == GROUND else self.bodies[name]

    def at(self, name: str, point: str) -> Point:
        """Return a point of a body in the plane [m]."""
        local = self.from_centre(name, pairs.local_point(self.scene, name, point))
        place = self.body(name).local_to_world(local)
        return place.x, place.y


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


def pin_friction(placed: SpaceBodies) -> tuple[PinFriction, ...]:
    """Make the constant friction of the pins of a scene. Raises EngineError: `rubbing_joints`."""
    rubs = []
    for rub in rubbing_joints(placed.scene, sliders=False):
        ends = placed.body(rub.first), placed.body(rub.second)
        motor = None
        if any(map(moves_freely, ends)):
            motor = pymunk.SimpleMotor(*ends, 0.0)
            motor.max_force = rub.size
        rubs.append(PinFriction(rub.joint, rub.first, rub.second, rub.size, motor))
    return tuple(rubs)


@dataclass(frozen=True)
class NativeSpring:
    """A spring between two bodies of a space, by name: pymunk's length is the spring's q less
    ``q_at_zero`` [m or rad]. Along a line, ``block`` is the slider of a pulled block without mass.

    It pulls with the length at the end of a step, as `sim.pymunk.bodies` does. It damps the
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
        first = self.first, (own.anchor_a.x, own.anchor_a.y)
        second = self.second, (own.anchor_b.x, own.anchor_b.y)
        fx, fy = pushes.pull(first, second, frames, -impulse / dt_s)
        if self.block is not None:
            pushes.note(self.block, (-fx, -fy, 0.0))


def native_springs(placed: SpaceBodies, far_m: float) -> dict[str, NativeSpring]:
    """Make the springs of a scene, by name.

    A spring between two bodies that do not move freely is left out: pymunk takes none there. A
    spring along a line hangs on a place of it ``far_m`` behind the slider, out of its reach.
    """
    springs = {}
    for name, spring in placed.scene.springs.items():
        ends = spring_ends(placed.scene, spring)
        if any(moves_freely(placed.body(body)) for body, _ in ends):
            if isinstance(spring, PinSpring):
                springs[name] = _in_pin(placed, spring)
            else:
                springs[name] = _between(placed, spring, ends, far_m)
    return springs


def _in_pin(placed: SpaceBodies, spring: PinSpring) -> NativeSpring:
    first, second = (placed.body(name) for name in spring.bodies)
    turns = pairs.whole_turns(spring, second.angle - first.angle)
    # Chipmunk counts the angle of its first body against its second.
    own = pymunk.DampedRotarySpring(second, first, spring.free - turns, spring.rate, spring.damping)
    return NativeSpring(own, *spring.bodies, turns)


def _between(
    placed: SpaceBodies, spring: LineSpring | SlideSpring, ends: tuple[End, End], far_m: float
) -> NativeSpring:
    (first, here), (second, there) = ends
    q_at_zero, block = 0.0, None
    if isinstance(spring, SlideSpring):
        slide = slide_of(placed.scene, spring.slider)
        q_at_zero = placed.state.displacement[spring.slider] - far_m
        x, y = pairs.turned((q_at_zero, 0.0), slide.slider.direction_rad)
        here = here[0] + x, here[1] + y
        block = spring.slider if isinstance(slide, pairs.Slot) else None
    own = pymunk.DampedSpring(
        placed.body(first),
        placed.body(second),
        placed.from_centre(first, here),
        placed.from_centre(second, there),
        spring.free - q_at_zero,
        spring.rate,
        spring.damping,
    )
    return NativeSpring(own, first, second, q_at_zero, block)
