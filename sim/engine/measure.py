"""Motion, joint gaps and energy of a mechanism from the poses of an engine's bodies."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache, reduce

import numpy as np

from models.array import Array
from models.motion import LinkMotion, Motion, PointMotion, SliderMotion
from models.scene import GROUND, KEPT, Point, Same, Scene, Slider, loads
from models.scene import joints as pairs
from models.scene.cams import OscillatingFollower
from models.scene.pairs import CamPair
from sim.engine import BodyPose, Energy, Poses


@dataclass(frozen=True)
class BodyPath:
    """A body over time."""

    pose: BodyPose

    @cached_property
    def turn(self) -> tuple[Array, Array]:
        """Cosine and sine of its angle, (T,) each."""
        return np.cos(self.pose.theta), np.sin(self.pose.theta)


@dataclass(frozen=True)
class PointPath:
    """A point fixed to a body, over time in the plane, (T, 2); computed on access."""

    body: BodyPath
    local: Point

    @cached_property
    def _arm(self) -> Array:
        (c, s), (x, y) = self.body.turn, self.local
        return _pairs(c * x - s * y, s * x + c * y)

    @cached_property
    def _across(self) -> Array:
        return across(self._arm)

    @cached_property
    def position(self) -> Array:
        return self.body.pose.origin + self._arm

    @cached_property
    def velocity(self) -> Array:
        return self.body.pose.velocity + self.body.pose.omega[:, None] * self._across

    @cached_property
    def acceleration(self) -> Array:
        omega, alpha = self.body.pose.omega[:, None], self.body.pose.alpha[:, None]
        return self.body.pose.origin_acceleration + alpha * self._across - omega**2 * self._arm


@dataclass(frozen=True)
class _Seen:
    """Point of a slider in its guide, (T, 2): x along the line from ``through_m``, y off the line;
    computed on access."""

    slider: Slider
    guide: BodyPose
    track: PointPath

    @cached_property
    def _place(self) -> Array:
        return self.track.position - self.guide.origin

    @cached_property
    def _drift(self) -> Array:
        """Velocity against the guide, in the plane."""
        omega = self.guide.omega[:, None]
        return self.track.velocity - self.guide.velocity - omega * across(self._place)

    @cached_property
    def _axes(self) -> tuple[Array, Array]:
        """Directions along the line and to the left of it, (T, 2) each."""
        angle = self.guide.theta + self.slider.direction_rad
        along = directions(angle)
        return along, across(along)

    @property
    def position(self) -> Array:
        cos, sin = np.cos(self.slider.direction_rad), np.sin(self.slider.direction_rad)
        x, y = self.slider.through_m
        start = np.array([x * cos + y * sin, y * cos - x * sin])
        return np.asarray(self._split(self._place) - start)

    @property
    def velocity(self) -> Array:
        return self._split(self._drift)

    @property
    def acceleration(self) -> Array:
        omega, alpha = self.guide.omega[:, None], self.guide.alpha[:, None]
        push = self.track.acceleration - self.guide.origin_acceleration
        turning = alpha * across(self._place)
        return self._split(
            push - turning + omega**2 * self._place - 2 * omega * across(self._drift)
        )

    def _split(self, vector: Array) -> Array:
        along, left = self._axes
        return _pairs((vector * along).sum(axis=1), (vector * left).sum(axis=1))


def directions(angle_rad: Array) -> Array:
    """Return unit vectors at these angles, (T, 2)."""
    return _pairs(np.cos(angle_rad), np.sin(angle_rad))


def arms(theta: Array, local: Point) -> Array:
    """Return a vector of a body's frame over time in the plane, (T, 2)."""
    c, s = np.cos(theta), np.sin(theta)
    return _pairs(c * local[0] - s * local[1], s * local[0] + c * local[1])


def centred(
    place: Array, rate: Array, push: Array | None, centre: Point, lag_s: float = 0.0
) -> BodyPose:
    """Return the frame of a link whose body in an engine has its origin at ``centre`` of it.

    Parameters
    ----------
    place, rate, push : Array
        x, y, angle, their rates, which belong to ``lag_s`` later, and accelerations if known, (T,
        3) each.
    """
    theta, omega = place[:, 2], rate[:, 2]
    arm = arms(theta, centre)
    turned = across(arm if lag_s == 0.0 else arms(theta + lag_s * omega, centre))
    if push is None:
        pulled, alpha = np.full((len(theta), 2), np.nan), np.full(len(theta), np.nan)
    else:
        alpha = push[:, 2]
        pulled = push[:, :2] - alpha[:, None] * turned + omega[:, None] ** 2 * arm
    velocity = rate[:, :2] - omega[:, None] * turned
    return BodyPose(place[:, :2] - arm, theta, velocity, omega, pulled, alpha)


def across(vector: Array) -> Array:
    """Return the vectors (T, 2) turned by a quarter turn, counter-clockwise."""
    return _pairs(-vector[:, 1], vector[:, 0])


def moment(arm: Array, force: Array) -> Array:
    """Return the moment of forces at these arms, (T, 2) each, (T,)."""
    return np.asarray(arm[:, 0] * force[:, 1] - arm[:, 1] * force[:, 0])


def _pairs(x: Array, y: Array) -> Array:
    """Join components to vectors, (T, 2)."""
    pairs = np.empty((len(x), 2))
    pairs[:, 0], pairs[:, 1] = x, y
    return pairs


@np.errstate(all="ignore")  # open joints may overflow; they are judged, not warned of
def motion(scene: Scene, poses: Poses, *, rates: bool = True) -> Motion:
    """Compute the motion from the poses; without ``rates``, those of points and sliders are NaN.

    Points belong to the ground or the first link that lists them, else to the first block with
    mass. A slider's speed and acceleration are relative to its guide. Where the velocities lag,
    each level is computed at its own instant: velocities with the positions of then, accelerations
    with the velocities of now.
    """
    now, then = (_at_now(poses), at_velocities(poses)) if rates else (poses, poses)
    none = np.broadcast_to(np.nan, (len(poses.time_s), 2))
    tracks, later = _tracks(scene, now), _tracks(scene, then) if then is not now else None
    points, sliders = {}, {}
    for name, names in pairs.carriers(scene).items():
        if names:
            track = tracks[name][names[0]]
            sped = (later or tracks)[name][names[0]]
            own = (sped.velocity, track.acceleration) if rates else (none, none)
            points[name] = PointMotion(track.position, *own)
    for name, slider in scene.sliders.items():
        rider = _rider(scene, slider)
        seen = _Seen(slider, _guide(slider, now), tracks[slider.point][rider])
        fast = seen
        if later is not None:
            fast = _Seen(slider, _guide(slider, then), later[slider.point][rider])
        own = (fast.velocity, seen.acceleration) if rates else (none, none)
        sliders[name] = SliderMotion(seen.position[:, 0], *(each[:, 0] for each in own))
    turning = {name: poses.bodies[name] for name in scene.links}
    links = {n: LinkMotion(p.theta, p.omega, p.alpha) for n, p in turning.items()}
    return Motion(poses.time_s, links, points, sliders)


def _at_now(poses: Poses) -> Poses:
    """Return the poses with the velocities of their own instants, as far as accelerations allow."""
    lag = poses.lag_s

    def back(body: BodyPose) -> BodyPose:
        velocity = body.velocity - lag * body.origin_acceleration
        return replace(body, velocity=velocity, omega=body.omega - lag * body.alpha)

    return poses if lag == 0.0 else poses.changed(back)


def at_velocities(poses: Poses) -> Poses:
    """Return the poses moved on to the instants of their velocities."""
    lag = poses.lag_s

    def on(body: BodyPose) -> BodyPose:
        origin = body.origin + lag * body.velocity
        return replace(body, origin=origin, theta=body.theta + lag * body.omega)

    return poses if lag == 0.0 else poses.changed(on)


@np.errstate(all="ignore")
def gaps(scene: Scene, poses: Poses) -> Mapping[str, Array]:
    """Return the openings of joints between their bodies (T,) [m], by pin, slider and gear.

    For a pin: the largest distance between two bodies' copies of the point. For a slider: the
    distance of its point from the line, plus, for a body that must not turn against the line, the
    error of its angle times the longest length of the scene. For two gears: the slip of their pitch
    circles; for a cam: the way of its follower beside its law.
    """
    tracks = _tracks(scene, poses)
    openings = {}
    for point, copies in tracks.items():
        places = [t.position for t in copies.values()]
        apart = [np.hypot(*(a - b).T) for i, a in enumerate(places) for b in places[i + 1 :]]
        if apart:
            openings[point] = reduce(np.maximum, apart)
    for name, slider in scene.sliders.items():
        guide = _guide(slider, poses)
        seen = _Seen(slider, guide, tracks[slider.point][_rider(scene, slider)])
        off = np.abs(seen.position[:, 1])
        body = poses.bodies.get(slider.link or pairs.block_name(slider))
        if body is not None:  # else it is a point, which keeps no angle to the line
            turn = body.theta - guide.theta - pairs.sliding_angle(slider)
            off = off + np.abs(np.remainder(turn + np.pi, 2 * np.pi) - np.pi) * scene.longest_m
        openings[name] = np.maximum(off, openings[name]) if name in openings else off
    for gear in scene.gears.values():
        slip = np.full(len(poses.time_s), -gear.constant_rad)
        for name, factor in gear.relation.items():
            if name != GROUND:
                slip += factor * poses.bodies[name].theta
        openings[gear.name] = np.abs(slip) * gear.slip_m(scene.points_of)
    for cam in scene.cams.values():
        openings[cam.name] = np.abs(lifted(scene, poses, cam))
    return openings


def lifted(scene: Scene, poses: Poses, cam: CamPair) -> Array:
    """Return the way (T,) [m] of a follower beyond its law, away from the cam; of its tip, where it
    oscillates."""
    theta = {name: pose.theta for name, pose in poses.bodies.items()}
    lift, lowest = cam.law_at(theta).value, cam.lowest(scene.points_of, scene.sliders)
    follower = cam.profile.follower
    if isinstance(follower, OscillatingFollower):
        turned = cam.way * (theta[cam.follower] - theta.get(cam.carrier, 0.0) - lowest)
        beyond = np.remainder(turned - lift + np.pi, 2 * np.pi) - np.pi
        return np.asarray(beyond * (follower.arm_m or follower.pivot_m))
    slider = scene.sliders[cam.slider]
    track = _tracks(scene, poses)[slider.point][_rider(scene, slider)]
    place = _Seen(slider, _guide(slider, poses), track).position[:, 0]
    return np.asarray(place - lowest - lift)


def _tracks(scene: Scene, poses: Poses) -> dict[str, dict[str, PointPath]]:
    bodies = body_paths(poses)
    return {
        point: {body: PointPath(bodies[body], local) for body, local in copies.items()}
        for point, copies in _copies(Same(scene)).items()
    }


def body_paths(poses: Poses) -> dict[str, BodyPath]:
    """Return the paths of every body and the ground."""
    paths = {name: BodyPath(pose) for name, pose in poses.bodies.items()}
    paths[GROUND] = BodyPath(_still(len(poses.time_s)))
    return paths


@lru_cache(maxsize=KEPT)
def _copies(same: Same) -> Mapping[str, Mapping[str, Point]]:
    """Return every point in the frames of the bodies that list it."""
    scene = same.scene
    return {
        point: {body: pairs.local_point(scene, body, point) for body in names}
        for point, names in pairs.carriers(scene).items()
    }


def _rider(scene: Scene, slider: Slider) -> str:
    """Return the body whose copy of the slider's point counts."""
    if slider.link is not None:
        return slider.link
    if pairs.block_name(slider) in pairs.blocks(scene):
        return pairs.block_name(slider)
    return next(body for body in pairs.carriers(scene)[slider.point] if body != slider.on)


def _guide(slider: Slider, poses: Poses) -> BodyPose:
    return _still(len(poses.time_s)) if slider.on == GROUND else poses.bodies[slider.on]


def _still(samples: int) -> BodyPose:
    zero, pair = np.zeros(samples), np.zeros((samples, 2))
    return BodyPose(pair, zero, pair, zero, pair, zero)


def spring_lengths(scene: Scene, poses: Poses) -> Mapping[str, Array]:
    """Return the q (T,) [m or rad] of each spring at the poses; see `models.scene.loads`.

    The first sample is the start, from which whole turns in pins are counted.
    """
    paths, lengths = body_paths(poses), dict[str, Array]()
    for name, spring in scene.springs.items():
        if isinstance(spring, loads.LineSpring):
            a, b = (
                PointPath(paths[body], at).position for body, at in pairs.line_ends(scene, spring)
            )
            lengths[name] = np.hypot(*(b - a).T)
        elif isinstance(spring, loads.PinSpring):
            first, second = (paths[body].pose.theta for body in spring.bodies)
            opened = second - first
            lengths[name] = opened + pairs.whole_turns(spring, float(opened[0]))
        else:
            seen = motion(scene, replace(poses, lag_s=0.0)).sliders[spring.slider]
            lengths[name] = seen.displacement
    return lengths


def energy(scene: Scene, poses: Poses) -> Energy:
    """Compute the kinetic and potential energy [J] of all bodies and springs, both at the instants
    of the velocities.

    Where velocities lag, the positions are moved on to them, to the second order of the step.
    Heights count from the origin against gravity. A driven crank counts with the mass of its link.
    The work of loads, dampers and friction is in neither: with any of them the total changes.
    """
    then = at_velocities(poses)
    kinetic, potential = np.zeros(len(poses.time_s)), np.zeros(len(poses.time_s))
    gravity = np.array(scene.gravity_m_s2)
    with np.errstate(all="ignore"):  # open joints may overflow
        for body in pairs.bodies(scene):
            pose, (mass, inertia) = then.bodies[body], pairs.mass_of(scene, body)
            centre = PointPath(BodyPath(pose), pairs.centre_of(scene, body))
            square = (centre.velocity**2).sum(axis=1)
            kinetic += 0.5 * mass * square + 0.5 * inertia * pose.omega**2
            potential -= mass * centre.position @ gravity
        for name, length in spring_lengths(scene, then).items():
            spring = scene.springs[name]
            potential += 0.5 * spring.rate * (length - spring.free) ** 2
    return Energy(kinetic, potential)
