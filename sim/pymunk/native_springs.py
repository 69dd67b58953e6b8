"""The springs of a scene as pymunk has them: `DampedSpring` and `DampedRotarySpring`.

Both pull with the length at the end of a step, as `sim.pymunk.spring_steps` does. What they damp is
the velocity before the joints of the step have corrected it, by turns with them, so that damping is
of first order (numbers: the reason in `sim.pymunk.settings`); by an exponential, so that a damper
however stiff is stable.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import pymunk

from models.joints import (
    End,
    Prism,
    Slot,
    joints,
    less,
    line_ends,
    local_point,
    riding_body,
    turned,
    whole_turns,
)
from models.loads import LineSpring, PinSpring, SlideSpring
from models.motion import State
from models.poses import Frame
from models.scene import Point, Scene
from sim.pymunk.pushes import Pushes, moves_freely


@dataclass(frozen=True)
class NativeSpring:
    """A spring between two bodies of a space, by name: pymunk's length is the spring's q less
    ``q_at_zero`` [m or rad]. Along a line, ``block`` is the slider whose block without mass it is
    that is pulled."""

    constraint: pymunk.DampedSpring | pymunk.DampedRotarySpring
    first: str
    second: str
    q_at_zero: float = 0.0
    block: str | None = None

    @property
    def numbers(self) -> tuple[float, float, float]:
        """Rate, damping and the q at which it is slack, as pymunk holds them."""
        own = self.constraint
        slack = own.rest_length if isinstance(own, pymunk.DampedSpring) else own.rest_angle
        return own.stiffness, own.damping, slack + self.q_at_zero

    def push(self, dt_s: float, frames: Mapping[str, Frame], pushes: Pushes) -> None:
        """What it did in the step that was made, in which the bodies came to these frames."""
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
    """The springs of a scene between its bodies in the space, by name, the ground among them.

    One between two bodies that do not move freely is left out: pymunk takes none there. One along a
    line hangs on a place of it ``far_m`` behind the slider, so far that the slider never comes
    there.
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
    """The displacement of a place of the line behind the slider, and a spring's ends there and at
    the slider."""
    slider, rider = slide.slider, riding_body(slide)
    behind = state.displacement[slider.name] - far_m
    ux, uy = turned((behind, 0.0), slider.direction_rad)
    x, y = slider.through_m
    start = slider.on, (x + ux, y + uy)
    return behind, (start, (rider, local_point(scene, rider, slider.point)))
