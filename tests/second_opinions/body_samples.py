"""The frames of all bodies and what acts on them from outside, springs and dampers too, in plain
arrays over a motion.

Shares nothing with the free-body diagrams and the force elements of `analytic.forces`.
"""

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from models.array import Array
from models.motion import Motion
from models.scene import GROUND, Point, Scene
from models.scene.driver import driver_course
from models.scene.joints import block_name, local_point, sliding_body
from models.scene.loads import LineSpring, PinSpring, SlideSpring

Push = tuple[str, Point, Array, Array]
"""A body, a place on it, a force (T, 2) and a torque (T,)."""


@dataclass(frozen=True)
class BodySamples:
    """A body: its frame's origin with its rates (T, 2), its angle with its rates (T,), its masses.

    ``acceleration`` and ``alpha`` are those of the motion.
    """

    origin: Array
    velocity: Array
    acceleration: Array
    theta: Array
    omega: Array
    alpha: Array
    centre: Point
    mass: float
    inertia: float

    def arm(self, local: Point) -> Array:
        """From the origin to a place of the body, (T, 2)."""
        c, s = np.cos(self.theta), np.sin(self.theta)
        return np.stack([c * local[0] - s * local[1], s * local[0] + c * local[1]], axis=1)

    def velocity_at(self, local: Point) -> Array:
        return self.velocity + self.omega[:, None] * quarter(self.arm(local))

    def acceleration_at(self, local: Point) -> Array:
        arm = self.arm(local)
        return (
            self.acceleration + self.alpha[:, None] * quarter(arm) - self.omega[:, None] ** 2 * arm
        )


def quarter(vectors: Array) -> Array:
    """The vectors (T, 2) turned by +90 deg."""
    return np.stack([-vectors[:, 1], vectors[:, 0]], axis=1)


def cross(a: Array, b: Array) -> Array:
    """The components of cross products out of the plane, (T,)."""
    return np.asarray(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0])


def body_samples(scene: Scene, motion: Motion) -> dict[str, BodySamples]:
    """All moving bodies, slider blocks included, by name."""
    found: dict[str, BodySamples] = {}
    for name, link in scene.links.items():
        point, local = next(iter(link.points.items()))
        at, turning = motion.points[point], motion.links[name]
        own = BodySamples(
            at.position, at.velocity, at.acceleration,
            turning.theta, turning.omega, turning.alpha,
            link.centre_m, link.mass_kg, link.inertia_kg_m2,
        )  # fmt: skip
        back = (-local[0], -local[1])
        found[name] = BodySamples(
            at.position + own.arm(back), own.velocity_at(back), own.acceleration_at(back),
            own.theta, own.omega, own.alpha, own.centre, own.mass, own.inertia,
        )  # fmt: skip
    rest = np.zeros(len(motion.time_s))
    for slider in scene.sliders.values():
        if slider.link is None:
            at = motion.points[slider.point]
            on = None if slider.on == GROUND else motion.links[slider.on]
            angles = (rest, rest, rest) if on is None else (on.theta, on.omega, on.alpha)
            found[block_name(slider)] = BodySamples(
                at.position, at.velocity, at.acceleration,
                angles[0] + slider.direction_rad, angles[1], angles[2],
                (0.0, 0.0), slider.mass_kg, slider.inertia_kg_m2,
            )  # fmt: skip
    return found


def weights_and_loads(scene: Scene, motion: Motion) -> Iterator[Push]:
    bodies = body_samples(scene, motion)
    rest = np.zeros((len(motion.time_s), 2))
    for name, body in bodies.items():
        yield name, body.centre, rest + body.mass * np.array(scene.gravity_m_s2), rest[:, 0]
    for load in scene.loads.values():
        slider = None if load.slider is None else motion.sliders[load.slider]
        x = {"time": motion.time_s, "angle": driver_course(scene, motion)[0]}.get(load.over)
        if load.over == "omega":
            x = bodies[load.body].omega
        elif x is None:
            assert slider is not None
            x = slider.displacement if load.over == "displacement" else slider.speed
        size = load.magnitude(x, None if slider is None else slider.speed)
        if load.point is None:
            yield load.body, (0.0, 0.0), rest, size
            continue
        turned = bodies[load.body].theta if load.frame == "body" else rest[:, 0]
        angle = turned + load.direction_rad
        force = size[:, None] * np.stack([np.cos(angle), np.sin(angle)], axis=1)
        yield load.body, local_point(scene, load.body, load.point), force, rest[:, 0]


def springs_on_bodies(scene: Scene, motion: Motion) -> Iterator[Push]:
    for spring in scene.springs.values():
        if isinstance(spring, LineSpring):
            pushes = _between_points(scene, motion, spring)
        elif isinstance(spring, PinSpring):
            pushes = _in_pin(motion, spring)
        else:
            pushes = _along_line(scene, motion, spring)
        yield from (push for push in pushes if push[0] != GROUND)


def _between_points(scene: Scene, motion: Motion, spring: LineSpring) -> Iterator[Push]:
    one, other = (motion.points[name] for name in spring.points)
    way, drift = other.position - one.position, other.velocity - one.velocity
    length = np.hypot(*way.T)
    pull = spring.pull(length, np.sum(way * drift, axis=1) / length)
    force = way * (pull / length)[:, None]
    for name, sign in zip(spring.points, (1.0, -1.0), strict=True):
        blocks = [block_name(s) for s in scene.sliders.values() if s.point == name]
        body = scene.pins[name][0] if name in scene.pins else blocks[0]
        yield body, local_point(scene, body, name), sign * force, np.zeros_like(length)


def _in_pin(motion: Motion, spring: PinSpring) -> Iterator[Push]:
    """Which turn q is in, the sample nearest to time 0 says."""
    rest = np.zeros_like(motion.time_s)
    angles = [rest if n == GROUND else motion.links[n].theta for n in spring.bodies]
    rates = [rest if n == GROUND else motion.links[n].omega for n in spring.bodies]
    away = angles[1] - angles[0] - spring.free
    off = away - math.tau * np.round(away[np.argmin(np.abs(motion.time_s))] / math.tau)
    couple = spring.rate * off + spring.damping * (rates[1] - rates[0])
    for body, sign in zip(spring.bodies, (1.0, -1.0), strict=True):
        yield body, (0.0, 0.0), np.zeros((len(rest), 2)), sign * couple


def _along_line(scene: Scene, motion: Motion, spring: SlideSpring) -> Iterator[Push]:
    slider, sliding = scene.sliders[spring.slider], motion.sliders[spring.slider]
    guide = None if slider.on == GROUND else body_samples(scene, motion)[slider.on]
    angle = slider.direction_rad + (0.0 * sliding.speed if guide is None else guide.theta)
    pull = spring.pull(sliding.displacement, sliding.speed)  # type: ignore[arg-type]  # arrays as well
    force = -pull * np.stack([np.cos(angle), np.sin(angle)])
    body = sliding_body(slider)
    yield body, local_point(scene, body, slider.point), force.T, np.zeros_like(pull)
    if guide is not None:
        arm = motion.points[slider.point].position - guide.origin
        yield slider.on, (0.0, 0.0), -force.T, -cross(arm, force.T)
