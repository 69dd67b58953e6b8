"""The frames of all bodies and what acts on them from outside, in plain arrays over a motion.

Shares nothing with the free-body diagrams of `analytic.forces`.
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from models.array import Array
from models.motion import Motion
from models.scene import GROUND, Point, Scene
from models.scene.driver import driver_course
from models.scene.joints import block_name, local_point


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


def weights_and_loads(scene: Scene, motion: Motion) -> Iterator[tuple[str, Point, Array, Array]]:
    """Weights and loads: body, place on it, force (T, 2) and torque (T,)."""
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
