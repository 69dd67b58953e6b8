"""Free-body diagram of each body: the forces on it except those of its joints.

By d'Alembert's principle these are its weight, its loads, and its inertia::

    P = m (g - a_S) in the centre of mass S        M = -J alpha

Letters: e along a line, n = e turned by +90 deg.
"""

import math
from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from analytic.dyads import plane
from analytic.dyads.chunk import Chunk, driver_scale
from analytic.dyads.plane import EPS, Vec
from analytic.forces.bounded import NOUGHT, NOWHERE, Bounded, BoundedVec
from analytic.structure.groups import Group
from analytic.structure.mobility import Structure
from models.array import Array
from models.errors import CrankcheckError, few
from models.scene import GROUND, Point, Scene, Slider
from models.scene.joints import block_name, local_point, sliding_body
from models.scene.loads import Load

ROUGH = 4 * EPS
"""Rounding of a turned vector of a body, over its length."""


class FreeBody:
    """Body cut free, over a chunk: the force on it [N] and the moment about its centre [N m]."""

    def __init__(self, body: plane.BodyKinematics, centre: Point) -> None:
        self.body, self.centre = body, centre
        self.force: BoundedVec = NOWHERE
        self.moment: Bounded = NOUGHT

    def vector(self, start: Point, end: Point) -> BoundedVec:
        """Return the vector from one place of the body to another [m]."""
        x, y = end[0] - start[0], end[1] - start[1]
        if x == 0.0 and y == 0.0:
            return NOWHERE
        turn, length = self.body.turn, self.body.length
        if turn is plane.UNTURNED:
            v = Vec(x, y)
        elif y == 0.0:
            v = turn if x == length else turn * (x / length)
        else:
            v = turn.turned(Vec(x / length, y / length))
        if self.body.error is None:
            return BoundedVec(v, 0.0, None)
        size = math.hypot(x, y)
        apart = EPS * (math.hypot(*start) + math.hypot(*end))
        return BoundedVec(v, size, (size + apart) * (self.body.error.theta + ROUGH) + apart)

    def unit(self, angle_rad: float, rounding: float) -> BoundedVec:
        """Return the unit vector at an angle, known up to ``rounding``, to the body's frame."""
        v = self.body.unit(angle_rad)
        if self.body.error is None:
            return BoundedVec(v, 0.0, None)
        return BoundedVec(v, 1.0 + ROUGH, self.body.error.theta + rounding + ROUGH)

    def push(self, arm: BoundedVec, force: BoundedVec) -> None:
        """Add a force at the end of an arm from the centre."""
        self.force = self.force + force
        self.moment = self.moment + arm.cross(force)

    def moment_about(self, arm: BoundedVec) -> Bounded:
        """Return the moment of all forces, about the end of an arm from the centre."""
        return self.moment - arm.cross(self.force)


def free_bodies(scene: Scene, chunk: Chunk) -> dict[str, FreeBody]:
    """Return all bodies, and the ground, under their weight and inertia."""
    free = {GROUND: FreeBody(chunk.bodies[GROUND], (0.0, 0.0))}
    for link in scene.links.values():
        body = FreeBody(chunk.bodies[link.name], link.centre_m)
        if link.mass_kg or link.inertia_kg_m2:
            near = _nearest(scene, link.points, link.centre_m)
            anchor = chunk.point(link.name, near)
            about = replace(body.body, local=link.points[near], anchor=anchor)
            _weigh(scene, body, about.point(link.centre_m), (link.mass_kg, link.inertia_kg_m2))
        free[link.name] = body
    for slider in scene.sliders.values():
        if slider.link is None:
            name = block_name(slider)
            body = FreeBody(chunk.bodies[name], (0.0, 0.0))
            if slider.mass_kg or slider.inertia_kg_m2:
                masses = (slider.mass_kg, slider.inertia_kg_m2)
                _weigh(scene, body, chunk.point(name, slider.point), masses)
            free[name] = body
    return free


def _nearest(scene: Scene, points: Mapping[str, Point], centre: Point) -> str:
    """Return the point from which the centre's motion is taken: one at rest, or the nearest."""
    return min(points, key=lambda p: (p not in scene.ground, math.dist(points[p], centre)))


def _weigh(
    scene: Scene, body: FreeBody, centre: plane.PointKinematics, masses: tuple[float, float]
) -> None:
    mass, inertia = masses
    g = Vec(*scene.gravity_m_s2) if any(scene.gravity_m_s2) else plane.ZERO
    force = centre.a * -mass if g is plane.ZERO else (g - centre.a) * mass
    if centre.error is None:
        body.force = BoundedVec(force, 0.0, None)
    else:
        size = mass * (centre.a.norm() + math.hypot(*scene.gravity_m_s2))
        body.force = BoundedVec(force, size, mass * centre.error.acceleration + 2 * EPS * size)
    alpha = body.body.alpha
    if alpha is plane.STEADY or inertia == 0.0:
        return
    error = body.body.error
    lost = None if error is None else inertia * (error.alpha + EPS * np.abs(alpha))
    body.moment = Bounded(alpha * -inertia, lost)


def apply_loads(scene: Scene, chunk: Chunk, time_s: Array, free: Mapping[str, FreeBody]) -> None:
    """Put all loads of a scene on its bodies.

    Raises CrankcheckError for a load whose body, point or slider the scene lacks, and as
    `Load.magnitude`.
    """
    for load in scene.loads.values():
        _check_there(scene, load, free)
        body, magnitude = free[load.body], _magnitude(load, chunk, time_s)
        if load.point is None:
            body.moment = body.moment + magnitude
            continue
        frame = body if load.frame == "body" else free[GROUND]
        along = frame.unit(load.direction_rad, plane.rounding_of_angles(load.direction_rad))
        place = local_point(scene, load.body, load.point)
        body.push(body.vector(body.centre, place), along * magnitude)


def _check_there(scene: Scene, load: Load, free: Mapping[str, FreeBody]) -> None:
    """Check the references of a load: a scene may be made without the check of its file."""
    bodies = [name for name in free if name != GROUND]
    if load.body not in bodies:
        what, found, have = "body", load.body, bodies
    elif load.slider is not None and load.slider not in scene.sliders:
        what, found, have = "slider", load.slider, list(scene.sliders)
    elif load.slider is None and (load.over in ("displacement", "speed") or load.stroke != "both"):
        what, found, have = "slider", "none", list(scene.sliders)
    elif load.point is not None and load.body in scene.links:
        what, found, have = "point", load.point, list(scene.links[load.body].points)
    else:
        return
    if found not in have:
        names = few(have, 12) or "nothing: the scene has none"
        raise CrankcheckError(
            f"{scene.name}: loads.{load.name}.{what}: found {found}; use one of {names}"
        )


def _magnitude(load: Load, chunk: Chunk, time_s: Array) -> Bounded:
    x, by, speed, speed_by = time_s, 0.0, None, 0.0
    sliding = None if load.slider is None else chunk.sliders[load.slider]
    error = chunk.driver.error
    if load.over == "angle":
        scale = driver_scale(chunk.scene)
        x, by = chunk.theta * scale, 0.0 if error is None else error.theta * scale
    if load.over == "omega":
        body = chunk.bodies[load.body]
        x, by = _as_samples(body.omega, time_s), 0.0 if body.error is None else body.error.omega
    if sliding is not None:
        speed = _as_samples(sliding.speed, time_s)
        if load.over == "displacement":
            x = _as_samples(sliding.s, time_s)
        if sliding.error is not None:
            speed_by = sliding.error.speed
            by = sliding.error.displacement if load.over == "displacement" else by
        if load.over == "speed":
            x, by = speed, speed_by
    value = load.magnitude(x, speed)
    if error is None:
        return Bounded(value, None)
    return Bounded(value, load.uncertain(x, by, speed, speed_by))


def _as_samples(values: Array | float, like: Array) -> Array:
    return np.broadcast_to(np.asarray(values, dtype=np.float64), like.shape)


Displaced = Mapping[str, Bounded]
"""Displacement of each slider [m]."""


class PrismaticPair:
    """Prismatic pair: its directions, and the way to its point from the centre of each body."""

    def __init__(self, slider: Slider, scene: Scene, free: Mapping[str, FreeBody], s: Bounded):
        self.name, self.body, self.guide = slider.name, sliding_body(slider), slider.on
        guide, body = free[self.guide], free[self.body]
        angle = slider.direction_rad
        self.along = guide.unit(angle, plane.rounding_of_angles(angle))
        self.across = self.along.perp()
        tip = local_point(scene, self.body, slider.point)
        self.arms = {
            self.body: body.vector(body.centre, tip),
            self.guide: guide.vector(guide.centre, slider.through_m) + self.along * s,
        }

    def other(self, body: str) -> str:
        return self.guide if body == self.body else self.body


class Balance:
    """Unsolved bodies of a chunk, and the reactions found so far.

    ``pins`` holds the force of each pin on each of its bodies, ``sliders`` the force along n and
    the moment about the slider's point that each guide exerts on the sliding body.
    """

    def __init__(
        self, scene: Scene, structure: Structure, free: dict[str, FreeBody], displaced: Displaced
    ) -> None:
        self.scene, self.structure, self.free = scene, structure, free
        self.displaced = displaced
        self.standing = {GROUND, *structure.bodies}
        self.pins = {
            point: dict.fromkeys(bodies, NOWHERE) for point, bodies in structure.pins.items()
        }
        self.sliders: dict[str, tuple[Bounded, Bounded]] = {}

    def drive(self) -> Bounded:
        """Put the remaining force of its link on the driven joint; return the driving torque, or
        the force along a line."""
        driver = self.scene.driver
        if driver.slider is not None:
            line = self.pair(driver.slider)
            force = -line.along.dot(self.free[driver.link].force)
            self.rest(driver.slider, driver.link)
            return force
        link, pivot = driver.link, self.scene.driver_pivot
        body = self.free[link]
        self.on_pin(pivot, link, -body.force)
        self.on_pin(pivot, driver.base, body.force)
        return -body.moment_about(self.arm(link, pivot))

    def arm(self, body: str, point: str) -> BoundedVec:
        """Return the vector from the centre of a body to one of its points."""
        own = self.free[body]
        return own.vector(own.centre, local_point(self.scene, body, point))

    def span(self, body: str, start: str, end: str) -> BoundedVec:
        """Return the vector from one point of a body to another."""
        return self.free[body].vector(
            local_point(self.scene, body, start), local_point(self.scene, body, end)
        )

    def moment(self, body: str, point: str) -> Bounded:
        """Return the moment of the forces on a body about one of its points."""
        return self.free[body].moment_about(self.arm(body, point))

    def pair(self, slider: str) -> PrismaticPair:
        return PrismaticPair(
            self.scene.sliders[slider], self.scene, self.free, self.displaced[slider]
        )

    def push(self, body: str, point: str, force: BoundedVec) -> None:
        """Add the force of an inner pin to a body that needs it for its other pair."""
        self.free[body].push(self.arm(body, point), force)

    def on_pin(self, point: str, body: str, force: BoundedVec) -> None:
        """Let a pin exert a force on a body."""
        self.pins[point][body] = self.pins[point][body] + force

    def inner(self, group: Group, force: BoundedVec) -> None:
        """Let the inner pin of a group exert the force on its first body."""
        self.on_pin(group.inner, group.first, force)
        self.on_pin(group.inner, group.second, -force)

    def hold(self, point: str, body: str, force: BoundedVec) -> None:
        """Let an outer pin exert the force on a group's body, and the opposite on its holder."""
        holder = next(name for name in self.structure.pins[point] if name in self.standing)
        self.on_pin(point, body, force)
        self.on_pin(point, holder, -force)
        if holder != GROUND:
            self.push(holder, point, -force)

    def slide(self, pair: PrismaticPair, body: str, normal: Bounded, moment: Bounded) -> None:
        """Let a prismatic pair exert a force along n and a moment on a body, their opposites on the
        other."""
        other = self.free[pair.other(body)]
        if pair.other(body) != GROUND:
            other.push(pair.arms[pair.other(body)], -(pair.across * normal))
            other.moment = other.moment - moment
        slides = body == pair.body
        self.sliders[pair.name] = (normal, moment) if slides else (-normal, -moment)

    def rest(self, slider: str, body: str) -> None:
        """Let a prismatic pair take over all forces on a body: none is left along its line."""
        pair, own = self.pair(slider), self.free[body]
        self.slide(pair, body, -pair.across.dot(own.force), -own.moment_about(pair.arms[body]))
