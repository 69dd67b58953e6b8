"""Where the frame of each body stands and how it moves, from a state of the mechanism."""

from __future__ import annotations

from dataclasses import dataclass

from models.joints import blocks, sliding_angle, turned
from models.motion import State
from models.scene import GROUND, Link, Point, Scene, Slider


@dataclass(frozen=True)
class Frame:
    """A body's frame: origin [m], angle [rad], velocity of the origin [m/s], omega [rad/s].

    The velocities may belong to a later (or earlier) instant than the position; ``ahead_rad`` is
    how far the body turns until then.
    """

    origin: Point
    theta: float
    velocity: Point
    omega: float
    ahead_rad: float = 0.0

    def at(self, local: Point) -> Point:
        """A point of the body in the plane [m]."""
        x, y = turned(local, self.theta)
        return self.origin[0] + x, self.origin[1] + y

    def velocity_at(self, place: Point) -> Point:
        """Velocity of the point of the body that is at ``place`` in the plane [m/s]."""
        x, y = turned((place[0] - self.origin[0], place[1] - self.origin[1]), self.ahead_rad)
        return self.velocity[0] - self.omega * y, self.velocity[1] + self.omega * x

    def into(self, place: Point) -> Point:
        """A point of the plane in the coordinates of the body [m]."""
        return turned((place[0] - self.origin[0], place[1] - self.origin[1]), -self.theta)


FIXED = Frame((0.0, 0.0), 0.0, (0.0, 0.0), 0.0)


def frames(scene: Scene, state: State, delay_s: float = 0.0) -> dict[str, Frame]:
    """The frames of the ground, the links and the blocks with mass at ``state``.

    Velocities are those of ``delay_s`` later, as engines want them that step positions and
    velocities by turns; accurate to the second order of the delay.
    """
    placed = {GROUND: FIXED}
    for link in scene.links.values():
        point = next(iter(link.points))
        theta, alpha = state.theta[link.name], state.alpha[link.name]
        omega = state.omega[link.name] + delay_s * alpha
        ahead = delay_s * (state.omega[link.name] + 0.5 * delay_s * alpha)
        arm, later = turned(link.points[point], theta), turned(link.points[point], theta + ahead)
        place, velocity = state.position[point], _later(state, point, delay_s)
        placed[link.name] = Frame(
            (place[0] - arm[0], place[1] - arm[1]),
            theta,
            (velocity[0] + omega * later[1], velocity[1] - omega * later[0]),
            omega,
            ahead,
        )
    for name, slider in blocks(scene).items():
        guide = placed[slider.on]
        theta = guide.theta + sliding_angle(slider)
        place, velocity = state.position[slider.point], _later(state, slider.point, delay_s)
        placed[name] = Frame(place, theta, velocity, guide.omega, guide.ahead_rad)
    return placed


def _later(state: State, point: str, delay_s: float) -> Point:
    """The velocity of a point ``delay_s`` later [m/s]."""
    (vx, vy), (ax, ay) = state.velocity[point], state.acceleration[point]
    return vx + delay_s * ax, vy + delay_s * ay


def along(slider: Slider, guide: Frame, place: Point, velocity: Point) -> tuple[float, float]:
    """Displacement [m] and speed [m/s] of a point along the line, against the guide."""
    x, y = guide.into(place)
    dx, dy = x - slider.through_m[0], y - slider.through_m[1]
    c, s = turned((1.0, 0.0), slider.direction_rad)
    carried = guide.velocity_at(place)
    turn = -guide.theta - guide.ahead_rad
    drift = turned((velocity[0] - carried[0], velocity[1] - carried[1]), turn)
    return c * dx + s * dy, c * drift[0] + s * drift[1]


def inertia_scale(scene: Scene) -> float:
    """Sum of m L^2 + I over the bodies [kg m^2]: what a drive has to be heavy against."""
    total = 0.0  # not `sum`, which adds otherwise from Python 3.12 on
    bodies: list[Link | Slider] = [*scene.links.values(), *scene.sliders.values()]
    for body in bodies:
        total += body.mass_kg * scene.longest_m**2 + body.inertia_kg_m2
    return total


def mass_ratio(scene: Scene) -> float:
    """The mass of the heaviest body over that of the lightest that has one."""
    masses = [link.mass_kg for link in scene.links.values()]
    masses += [slider.mass_kg for slider in scene.sliders.values()]
    given = [mass for mass in masses if mass > 0.0]
    return max(given, default=1.0) / min(given, default=1.0)


def centre_of(scene: Scene, body: str) -> Point:
    """Centre of mass in the body's own frame [m]; a block has it at its point."""
    return scene.links[body].centre_m if body in scene.links else (0.0, 0.0)


def mass_of(scene: Scene, body: str) -> tuple[float, float]:
    """Mass [kg] and inertia about the centre of mass [kg m^2] of a link or a block with mass."""
    holder = scene.links[body] if body in scene.links else blocks(scene)[body]
    return holder.mass_kg, holder.inertia_kg_m2
