"""Joints of a scene: its bodies, the pairs between them, and their frames.

::

    bodies   ground, every link, every slider block that has a mass
    pin      point P shared by k bodies: k - 1 binary hinges
    prism    a block with mass, or a sliding link, on the line of another body
    slot     a block without mass: point P of a body runs on the line of another body
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache

from models.errors import EngineError
from models.motion import State
from models.scene import GROUND, KEPT, FixedMapping, Link, Point, Same, Scene, Slider
from models.scene.loads import LineSpring, PinSpring


@dataclass(frozen=True)
class Pin:
    """Point ``point`` is shared by all of ``bodies`` (two or more)."""

    point: str
    bodies: tuple[str, ...]


@dataclass(frozen=True)
class Prism:
    """``body`` slides along the line of ``slider.on`` and does not turn against it."""

    slider: Slider
    body: str


@dataclass(frozen=True)
class Slot:
    """``slider.point`` of one of ``bodies`` runs along the line of ``slider.on``; both may turn."""

    slider: Slider
    bodies: tuple[str, ...]


@dataclass(frozen=True)
class Joints:
    """All joints of a scene, in the order of the file."""

    pins: tuple[Pin, ...]
    prisms: tuple[Prism, ...]
    slots: tuple[Slot, ...]

    @property
    def slides(self) -> tuple[Prism | Slot, ...]:
        """All joints with a line."""
        return (*self.prisms, *self.slots)


def block_name(slider: Slider) -> str:
    """The name of the body of a slider block; no link can have it, as link names hold no space."""
    return f"block {slider.name}"


def blocks(scene: Scene) -> dict[str, Slider]:
    """Slider blocks that have a mass, and are bodies, by body name."""
    return {block_name(s): s for s in scene.sliders.values() if s.link is None and s.mass_kg > 0.0}


def bodies(scene: Scene) -> tuple[str, ...]:
    """Every moving body: the links in the order of the file, then the blocks with mass."""
    return (*scene.links, *blocks(scene))


def carriers(scene: Scene) -> Mapping[str, tuple[str, ...]]:
    """Every named point with the bodies that carry it, blocks with mass included."""
    return _carriers(Same(scene))


@lru_cache(maxsize=KEPT)
def _carriers(same: Same) -> Mapping[str, tuple[str, ...]]:
    scene = same.scene
    names_by_point = {point: list(names) for point, names in scene.pins.items()}
    for name, slider in blocks(scene).items():
        names_by_point.setdefault(slider.point, []).append(name)
    for slider in scene.sliders.values():
        names_by_point.setdefault(slider.point, [])
    return FixedMapping({point: tuple(names) for point, names in names_by_point.items()})


def joined_at(scene: Scene) -> dict[str, tuple[str, ...]]:
    """Return every pin with its bodies: the ground first, then links, then slider blocks, with mass
    or without."""
    names_by_point = {point: list(names) for point, names in scene.pins.items()}
    for slider in scene.sliders.values():
        if slider.link is None:
            names_by_point.setdefault(slider.point, []).append(block_name(slider))
    return {point: tuple(names) for point, names in names_by_point.items() if len(names) > 1}


def has_loops(scene: Scene) -> bool:
    """True if some joint closes a loop: there are more pairs than bodies. An open chain is placed
    by its joint coordinates, and an engine with these solves no constraint."""
    pairs = sum(len(names) - 1 for names in joined_at(scene).values()) + len(scene.sliders)
    count = len(scene.links) + sum(slider.link is None for slider in scene.sliders.values())
    return pairs > count


def joints(scene: Scene) -> Joints:
    """Return the joints of the scene; a slot has no bodies if only its guide carries the point."""
    return _joints(Same(scene))


@lru_cache(maxsize=KEPT)
def _joints(same: Same) -> Joints:
    scene = same.scene
    points = carriers(scene)
    pins = tuple(Pin(point, names) for point, names in points.items() if len(names) > 1)
    prisms, slots = [], []
    for slider in scene.sliders.values():
        if slider.link is not None:
            prisms.append(Prism(slider, slider.link))
        elif slider.mass_kg > 0.0:
            prisms.append(Prism(slider, block_name(slider)))
        else:
            held = tuple(name for name in points[slider.point] if name != slider.on)
            slots.append(Slot(slider, held))
    return Joints(pins, tuple(prisms), tuple(slots))


def riding_body(slide: Prism | Slot) -> str:
    """The body whose point runs on the line. Raises EngineError where there is none."""
    if isinstance(slide, Prism):
        return slide.body
    if not slide.bodies:
        raise EngineError(
            f"slider {slide.slider.name}: no body carries point {slide.slider.point}; give "
            f"sliders.{slide.slider.name} a mass_kg above 0"
        )
    return slide.bodies[0]


def local_point(scene: Scene, body: str, point: str) -> Point:
    """A point in the frame of a body that carries it [m]; a block has its point at its origin."""
    if body == GROUND:
        return scene.ground[point]
    if body in scene.links:
        return scene.links[body].points[point]
    return 0.0, 0.0


def sliding_body(slider: Slider) -> str:
    """Return the body of a slider: its link, or a block of its own, with mass or without."""
    return slider.link or block_name(slider)


def sliding_angle(slider: Slider) -> float:
    """Angle of a sliding body against the frame of its guide [rad]; constant."""
    return slider.direction_rad + (slider.angle_rad if slider.link is not None else 0.0)


def turned(vector: Point, angle_rad: float) -> Point:
    """The vector turned counter-clockwise by the angle."""
    c, s = math.cos(angle_rad), math.sin(angle_rad)
    return c * vector[0] - s * vector[1], s * vector[0] + c * vector[1]


def less(a: Point, b: Point) -> Point:
    """The vector from ``b`` to ``a``."""
    return a[0] - b[0], a[1] - b[1]


End = tuple[str, Point]
"""A body, or the ground, and a place in its frame [m]."""


def line_ends(scene: Scene, spring: LineSpring) -> tuple[End, End]:
    """The two ends of a spring between points, each on the first body that carries the point.
    Raises EngineError for a point that only a slider block without mass (no body) has."""
    first, second = spring.points
    return _end(scene, spring, first), _end(scene, spring, second)


def _end(scene: Scene, spring: LineSpring, point: str) -> End:
    bodies = carriers(scene).get(point, ())
    if not bodies:
        raise EngineError(
            f"springs.{spring.name}: no body carries point {point}; give its slider a mass_kg "
            "above 0"
        )
    return bodies[0], local_point(scene, bodies[0], point)


def whole_turns(spring: PinSpring, angle_rad: float) -> float:
    """Return the whole turns [rad] to add to the second body's angle less the first's at the start,
    so that the q of a spring in a pin begins within half a turn of its free angle."""
    return -math.tau * round((angle_rad - spring.free) / math.tau)


@dataclass(frozen=True)
class Frame:
    """A body's frame: origin [m], angle [rad], velocity of the origin [m/s], omega [rad/s].

    The velocities may belong to a later (or earlier) instant than the position; ``ahead_rad`` is
    the turn of the body until then.
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

    Velocities belong to ``delay_s`` later, for engines that step positions and velocities in turn;
    accurate to the second order of the delay.
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
    """Sum of m L^2 + I over the bodies [kg m^2]: the scale of a drive's inertia."""
    total = 0.0  # not `sum`, which adds otherwise from Python 3.12 on
    bodies: list[Link | Slider] = [*scene.links.values(), *scene.sliders.values()]
    for body in bodies:
        total += body.mass_kg * scene.longest_m**2 + body.inertia_kg_m2
    return total


def mass_ratio(scene: Scene) -> float:
    """Mass of the heaviest body over the mass of the lightest that has one."""
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
