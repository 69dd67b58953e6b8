"""Where the frame of each body stands and how it moves, from a state of the mechanism."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

from models.joints import blocks, sliding_angle, turned
from models.motion import State
from models.scene import GROUND, Point, Scene, Slider


@dataclass(frozen=True)
class Frame:
    """A body's frame: origin [m], angle [rad], velocity of the origin [m/s], omega [rad/s]."""

    origin: Point
    theta: float
    velocity: Point
    omega: float

    def at(self, local: Point) -> Point:
        """A point of the body in the plane [m]."""
        x, y = turned(local, self.theta)
        return self.origin[0] + x, self.origin[1] + y

    def velocity_at(self, place: Point) -> Point:
        """Velocity of the body where ``place`` in the plane is [m/s]."""
        x, y = place[0] - self.origin[0], place[1] - self.origin[1]
        return self.velocity[0] - self.omega * y, self.velocity[1] + self.omega * x

    def into(self, place: Point) -> Point:
        """A point of the plane in the coordinates of the body [m]."""
        return turned((place[0] - self.origin[0], place[1] - self.origin[1]), -self.theta)


FIXED = Frame((0.0, 0.0), 0.0, (0.0, 0.0), 0.0)


def frames(scene: Scene, state: State) -> dict[str, Frame]:
    """The frames of the ground, the links and the blocks with mass at ``state``."""
    found = {GROUND: FIXED}
    for link in scene.links.values():
        point = next(iter(link.points))
        arm = turned(link.points[point], state.theta[link.name])
        place, velocity = state.position[point], state.velocity[point]
        omega = state.omega[link.name]
        found[link.name] = Frame(
            (place[0] - arm[0], place[1] - arm[1]),
            state.theta[link.name],
            (velocity[0] + omega * arm[1], velocity[1] - omega * arm[0]),
            omega,
        )
    for name, slider in blocks(scene).items():
        guide = found[slider.on]
        theta = guide.theta + sliding_angle(slider)
        place, velocity = state.position[slider.point], state.velocity[slider.point]
        found[name] = Frame(place, theta, velocity, guide.omega)
    return found


def along(slider: Slider, guide: Frame, place: Point, velocity: Point) -> tuple[float, float]:
    """Displacement [m] and speed [m/s] of a point along the line, against the guide."""
    x, y = guide.into(place)
    dx, dy = x - slider.through_m[0], y - slider.through_m[1]
    c, s = turned((1.0, 0.0), slider.direction_rad)
    carried = guide.velocity_at(place)
    drift = turned((velocity[0] - carried[0], velocity[1] - carried[1]), -guide.theta)
    return c * dx + s * dy, c * drift[0] + s * drift[1]


def launched(state: State, delay_s: float) -> State:
    """The state with its velocities advanced by ``delay_s``, positions unchanged.

    Engines that step positions and velocities by turns hold velocities half a step away from the
    positions; they start from such a state. Accurate to the second order of the delay.
    """
    return replace(
        state,
        omega={n: w + delay_s * state.alpha[n] for n, w in state.omega.items()},
        velocity={
            n: (vx + delay_s * state.acceleration[n][0], vy + delay_s * state.acceleration[n][1])
            for n, (vx, vy) in state.velocity.items()
        },
    )


def inertia_scale(scene: Scene) -> float:
    """Sum of m L^2 + I over the bodies [kg m^2]: what a drive has to be heavy against."""
    total = 0.0
    for link in scene.links.values():
        total += link.mass_kg * scene.longest_m**2 + link.inertia_kg_m2
    for slider in scene.sliders.values():
        total += slider.mass_kg * scene.longest_m**2 + slider.inertia_kg_m2
    return total


def centre_of(scene: Scene, body: str) -> Point:
    """Centre of mass in the body's own frame [m]; a block has it at its point."""
    return scene.links[body].centre_m if body in scene.links else (0.0, 0.0)


def mass_of(scene: Scene, body: str) -> tuple[float, float]:
    """Mass [kg] and inertia about the centre of mass [kg m^2] of a link or a block with mass."""
    holder: Mapping[str, Slider] = blocks(scene)
    if body in scene.links:
        link = scene.links[body]
        return link.mass_kg, link.inertia_kg_m2
    return holder[body].mass_kg, holder[body].inertia_kg_m2
