"""The second opinion on friction: what rubs, in plain arrays over a motion.

The way a joint moves is taken from the velocities of its two bodies, at its place.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np

from models.array import Array
from models.motion import Forces, Motion
from models.scene import GROUND, Scene
from models.scene.driver import driver_course
from models.scene.joints import local_point, sliding_body
from models.scene.loads import CoulombFriction
from tests.second_opinions.body_samples import BodySamples

STILL = 1e-12
"""The share of the driver's rate below which a joint rests."""


@dataclass(frozen=True)
class RubbingSamples:
    """A joint: its two bodies by name, the place where friction acts, the line of a slider (T, 2)
    or None, and how fast the second body moves against the first [rad/s or m/s], (T,)."""

    first: str
    second: str
    place: Array
    line: Array | None
    rate: Array
    scale: float

    def friction(self, scene: Scene, joint: str, found: Forces) -> Array:
        """What the law of a joint says where it bears these forces, (T,)."""
        law = scene.friction[joint]
        size = np.full(len(self.rate), 0.0 if isinstance(law, CoulombFriction) else law.size)
        if isinstance(law, CoulombFriction) and self.line is not None:
            size = law.mu * np.abs(found.sliders[joint].normal)
        elif isinstance(law, CoulombFriction):
            lean = np.arctan(law.mu)  # of the reaction, from the normal of bore and pin
            arm = law.radius_m * np.sin(lean)
            size = arm * np.linalg.norm(found.pins[joint][self.second], axis=1)
        return np.where(np.abs(self.rate) > STILL * self.scale, -np.sign(self.rate) * size, 0.0)

    def pushes(self, friction: Array) -> Iterator[tuple[str, Array, Array]]:
        """Body, force (T, 2), and torque about the joint's place (T,)."""
        none = np.zeros_like(self.place)
        for body, sign in ((self.second, 1.0), (self.first, -1.0)):
            if body != GROUND and self.line is None:
                yield body, none, sign * friction
            elif body != GROUND and self.line is not None:
                yield body, sign * friction[:, None] * self.line, none[:, 0]


def rubbing_samples(
    scene: Scene, motion: Motion, bodies: Mapping[str, BodySamples]
) -> dict[str, RubbingSamples]:
    """The joints that rub, by name."""
    found = {}
    peak = float(np.max(np.abs(driver_course(scene, motion)[1]))) / scene.driver_arm_m
    for joint in scene.friction:
        if joint in scene.sliders:
            found[joint] = _slider(scene, joint, motion, bodies, peak)
            continue
        held = list(scene.pins.get(joint, ()))
        riding = (sliding_body(each) for each in scene.sliders.values() if each.point == joint)
        held += [body for body in riding if body not in scene.links]
        first, second = held
        rate = bodies[second].omega - (0.0 if first == GROUND else bodies[first].omega)
        place = motion.points[joint].position
        found[joint] = RubbingSamples(first, second, place, None, rate, peak)
    return found


def _slider(
    scene: Scene, joint: str, motion: Motion, bodies: Mapping[str, BodySamples], peak: float
) -> RubbingSamples:
    slider = scene.sliders[joint]
    body = sliding_body(slider)
    tip = local_point(scene, body, slider.point)
    place = bodies[body].origin + bodies[body].arm(tip)
    speed = bodies[body].velocity_at(tip)
    angle = np.full(len(place), slider.direction_rad)
    if slider.on != GROUND:
        guide = bodies[slider.on]
        away = place - guide.origin
        beside = np.stack([-away[:, 1], away[:, 0]], axis=1)
        speed = speed - guide.velocity - guide.omega[:, None] * beside
        angle = angle + guide.theta
    line = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    rate = np.asarray(np.sum(speed * line, axis=1))
    return RubbingSamples(slider.on, body, place, line, rate, peak * scene.longest_m)
