"""From the poses of an engine's bodies to the motion of the mechanism, and its joint gaps."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace

import numpy as np

from models.array import Array
from models.joints import block_name, blocks, carriers, local_point, sliding_angle
from models.motion import LinkMotion, Motion, PointMotion, SliderMotion
from models.scene import GROUND, Point, Scene, Slider
from sim.engine import BodyPose, Poses


@dataclass(frozen=True)
class _PointPath:
    """A point over time in the plane: position, velocity, acceleration, each (T, 2)."""

    position: Array
    velocity: Array
    acceleration: Array


def motion(scene: Scene, poses: Poses) -> Motion:
    """The motion that the poses show.

    Points are taken as carried by the ground or the first link that lists them, else by the first
    block with mass. A slider's speed and acceleration are those seen from its guide. Where the
    velocities lag, each level is worked out at its own instant: velocities with the positions of
    then, accelerations with the velocities of now.
    """
    with np.errstate(all="ignore"):  # what has come apart may overflow; it is judged, not warned of
        return _motion(scene, poses, _at_now(poses), at_velocities(poses))


def _motion(scene: Scene, poses: Poses, now: Poses, then: Poses) -> Motion:
    """The motion from the poses at their own instants."""
    tracks, later = _tracks(scene, now), _tracks(scene, then) if then is not now else None
    points, sliders = {}, {}
    for name, held in carriers(scene).items():
        if held:
            track = tracks[name][held[0]]
            velocity = (later or tracks)[name][held[0]].velocity
            points[name] = PointMotion(track.position, velocity, track.acceleration)
    for name, slider in scene.sliders.items():
        rider = _rider(scene, slider)
        seen = _seen(slider, _guide(slider, now), tracks[slider.point][rider])
        speed = seen.velocity
        if later is not None:
            speed = _seen(slider, _guide(slider, then), later[slider.point][rider]).velocity
        sliders[name] = SliderMotion(seen.position[:, 0], speed[:, 0], seen.acceleration[:, 0])
    links = {n: LinkMotion(p.theta, p.omega, p.alpha) for n, p in poses.links.items()}
    return Motion(poses.time_s, links, points, sliders)


def _at_now(poses: Poses) -> Poses:
    """The poses with the velocities of their own instants, as far as accelerations tell them."""
    lag = poses.lag_s

    def back(body: BodyPose) -> BodyPose:
        velocity = body.velocity - lag * body.origin_acceleration
        return replace(body, velocity=velocity, omega=body.omega - lag * body.alpha)

    return poses if lag == 0.0 else _each(poses, back)


def at_velocities(poses: Poses) -> Poses:
    """The poses moved on to the instants of their velocities."""
    lag = poses.lag_s

    def on(body: BodyPose) -> BodyPose:
        origin = body.origin + lag * body.velocity
        return replace(body, origin=origin, theta=body.theta + lag * body.omega)

    return poses if lag == 0.0 else _each(poses, on)


def _each(poses: Poses, change: Callable[[BodyPose], BodyPose]) -> Poses:
    """The poses with every body changed."""
    return replace(
        poses,
        links={name: change(body) for name, body in poses.links.items()},
        blocks={name: change(body) for name, body in poses.blocks.items()},
    )


def gaps(scene: Scene, poses: Poses) -> Mapping[str, Array]:
    """How far the bodies that share a joint have come apart (T,) [m], by pin and by slider.

    For a pin: the largest distance between two bodies' copies of the point. For a slider: the
    distance of its point from the line, plus, for a body that must not turn against the line, the
    fault of its angle times the longest length of the scene.
    """
    with np.errstate(all="ignore"):
        return _gaps(scene, poses)


def _gaps(scene: Scene, poses: Poses) -> Mapping[str, Array]:
    """The gaps by pin and by slider."""
    tracks = _tracks(scene, poses)
    found = {}
    for point, copies in tracks.items():
        places = [t.position for t in copies.values()]
        apart = [np.hypot(*(a - b).T) for i, a in enumerate(places) for b in places[i + 1 :]]
        if apart:
            found[point] = np.max(apart, axis=0)
    for name, slider in scene.sliders.items():
        guide = _guide(slider, poses)
        seen = _seen(slider, guide, tracks[slider.point][_rider(scene, slider)])
        off = np.abs(seen.position[:, 1])
        body = _sliding_body(slider, poses)
        if body is not None:
            turn = body.theta - guide.theta - sliding_angle(slider)
            off = off + np.abs(np.remainder(turn + np.pi, 2 * np.pi) - np.pi) * scene.longest_m
        found[name] = np.maximum(off, found[name]) if name in found else off
    return found


def _tracks(scene: Scene, poses: Poses) -> dict[str, dict[str, _PointPath]]:
    """Every point as each of the bodies that list it carries it."""
    still = _still(len(poses.time_s))
    bodies = {GROUND: still, **poses.links}
    bodies |= {block_name(scene.sliders[n]): pose for n, pose in poses.blocks.items()}
    return {
        point: {body: _carried(bodies[body], local_point(scene, body, point)) for body in names}
        for point, names in carriers(scene).items()
    }


def _rider(scene: Scene, slider: Slider) -> str:
    """The body whose copy of the slider's point counts."""
    if slider.link is not None:
        return slider.link
    if block_name(slider) in blocks(scene):
        return block_name(slider)
    return next(body for body in carriers(scene)[slider.point] if body != slider.on)


def _sliding_body(slider: Slider, poses: Poses) -> BodyPose | None:
    """The body that keeps its angle to the line, if the slider has one."""
    if slider.link is not None:
        return poses.links[slider.link]
    return poses.blocks.get(slider.name)


def _guide(slider: Slider, poses: Poses) -> BodyPose:
    """The body that the line belongs to."""
    return _still(len(poses.time_s)) if slider.on == GROUND else poses.links[slider.on]


def _still(samples: int) -> BodyPose:
    """The ground."""
    zero, pair = np.zeros(samples), np.zeros((samples, 2))
    return BodyPose(pair, zero, pair, zero, pair, zero)


def _carried(body: BodyPose, local: Point) -> _PointPath:
    """A point fixed to a body."""
    c, s = np.cos(body.theta), np.sin(body.theta)
    arm = np.stack([c * local[0] - s * local[1], s * local[0] + c * local[1]], axis=-1)
    across = np.stack([-arm[:, 1], arm[:, 0]], axis=-1)
    omega, alpha = body.omega[:, None], body.alpha[:, None]
    return _PointPath(
        body.origin + arm,
        body.velocity + omega * across,
        body.origin_acceleration + alpha * across - omega**2 * arm,
    )


def _seen(slider: Slider, guide: BodyPose, track: _PointPath) -> _PointPath:
    """The point as seen from the guide: x along the line from ``through_m``, y off the line."""
    place = track.position - guide.origin
    across = np.stack([-place[:, 1], place[:, 0]], axis=-1)
    omega, alpha = guide.omega[:, None], guide.alpha[:, None]
    drift = track.velocity - guide.velocity - omega * across
    turn = np.stack([-drift[:, 1], drift[:, 0]], axis=-1)
    push = track.acceleration - guide.origin_acceleration
    push = push - alpha * across + omega**2 * place - 2 * omega * turn
    angle = guide.theta + slider.direction_rad
    c, s = np.cos(angle), np.sin(angle)
    u, n = np.stack([c, s], axis=-1), np.stack([-s, c], axis=-1)
    cos, sin = np.cos(slider.direction_rad), np.sin(slider.direction_rad)
    x, y = slider.through_m
    start = np.array([x * cos + y * sin, y * cos - x * sin])

    def split(vector: Array) -> Array:
        return np.stack([(vector * u).sum(axis=1), (vector * n).sum(axis=1)], axis=-1)

    return _PointPath(split(place) - start, split(drift), split(push))
