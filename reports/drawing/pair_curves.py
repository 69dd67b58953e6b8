"""Curves of gears and cams on a drawn mechanism: pitch circles, profiles, rollers and faces."""

import math
from collections.abc import Iterable, Iterator
from dataclasses import dataclass

import numpy as np

from analytic.cams.outline import touched
from models.array import Array
from models.motion import Motion
from models.scene import GROUND, Scene, Slider
from models.scene.cams import OscillatingFollower
from models.scene.pairs import CamPair

AROUND, FACETS = 72, 240
"""Corners of a circle, and of a profile."""
SPOKES, TICKS, RIM = 3, 24, 1.08
"""Spokes of a wheel; ticks of a ring, and its outer radius over that of its pitch circle."""
BEYOND, THICK = 0.3, 0.08
"""Ends of a face beyond its contact, and its thickness, over the base radius of the cam."""


@dataclass(frozen=True, eq=False)
class BodyCurves:
    """Closed curves (n, 2) of a body [m], about its ``point``. Their axes turn with the body
    ``on``, by ``angle_rad`` ahead of it: with their own, or with the guide of one that slides."""

    body: str
    point: str
    on: str
    angle_rad: float
    curves: tuple[Array, ...]

    def at(self, motion: Motion, index: int | slice) -> list[Array]:
        """Return the curves in the ground's frame at a sample (n, 2), or at several (T, n, 2)."""
        turned = 0.0 * motion.time_s if self.on == GROUND else motion.links[self.on].theta
        c, s = (each(turned[index] + self.angle_rad) for each in (np.cos, np.sin))
        axes = np.stack([c, s, -s, c], axis=-1).reshape(*np.shape(c), 2, 2)
        middle = motion.points[self.point].position[index]
        return [middle[..., None, :] + curve @ axes for curve in self.curves]


def pair_curves(scene: Scene) -> list[BodyCurves]:
    """Return the curves of all gears and cams of a scene, none of other bodies. Raises
    CrankcheckError for a cam that has no profile."""
    return [*_gears(scene), *(own for pair in scene.cams.values() for own in _cam(scene, pair))]


def blocks_of(scene: Scene) -> list[Slider]:
    """Return the sliders with a block: a link on a cam has its roller or its face there."""
    lifted = {pair.slider for pair in scene.cams.values()}
    return [each for each in scene.sliders.values() if each.link is None or each.name not in lifted]


def places_of(scene: Scene, motion: Motion) -> Array:
    """Return the places (n, 2) [m] of all points and curves at all samples."""
    curves = [each for own in pair_curves(scene) for each in own.at(motion, slice(None))]
    points = [point.position for point in motion.points.values()]
    return np.concatenate([*points, *(each.reshape(-1, 2) for each in curves)])


def _gears(scene: Scene) -> Iterable[BodyCurves]:
    """Return wheels and rings, each once; two gears about one centre have no pitch circles."""
    at, wheels = scene.points_of, dict[tuple[object, ...], BodyCurves]()
    for gear in scene.gears.values():
        sides = zip(gear.bodies, gear.teeth, gear.pivots(at), (False, gear.internal), strict=True)
        for body, teeth, centre, is_ring in sides if gear.module(at) is not None else ():
            radius = teeth * gear.slip_m(at)
            wheel = BodyCurves(body, centre, body, 0.0, _wheel(radius, is_ring))
            wheels.setdefault((body, centre, f"{radius:.9g}", is_ring), wheel)
    return wheels.values()


def _circle(radius: float, corners: int = AROUND) -> Array:
    angle = np.linspace(0.0, 2.0 * np.pi, corners, endpoint=False)
    return radius * np.column_stack([np.cos(angle), np.sin(angle)])


def _wheel(radius: float, is_ring: bool) -> tuple[Array, ...]:
    """Return a pitch circle with spokes; of a ring a rim, round outside and back inside, and ticks
    on it."""
    inner = np.vstack([_circle(radius), [[radius, 0.0]]])
    rim = np.vstack([RIM * inner, inner[::-1]]) if is_ring else inner
    start, end, count = (1.0, RIM, TICKS) if is_ring else (0.0, 1.0, SPOKES)
    return (rim, *(np.array([start * tip, end * tip]) for tip in _circle(radius, count)))


def _cam(scene: Scene, pair: CamPair) -> Iterator[BodyCurves]:
    """Yield the profile of a cam, and the roller or the face of its follower if it has one."""
    contact, profile = touched(scene, pair, FACETS)
    centre, pivot = pair.pivots(scene.points_of)
    own = np.column_stack([profile.real, profile.imag]) - scene.links[pair.cam].points[centre]
    yield BodyCurves(pair.cam, centre, pair.cam, 0.0, (own,))
    follower, base = pair.profile.follower, pair.profile.base_m
    if isinstance(follower, OscillatingFollower):
        (px, py), (x, y) = (scene.links[pair.follower].points[name] for name in (pivot, pair.tip))
        away = math.atan2(y - py, x - px) - 0.5 * math.pi * pair.side
        frame = pivot if follower.is_flat else pair.tip, pair.follower, away
        front, along = follower.face_m, pair.side * contact.lever
    else:
        slider = scene.sliders[pair.slider]
        frame = slider.point, slider.on, slider.direction_rad
        front, along = 0.0, follower.offset_m - contact.contact.real
    back, low, high = front + THICK * base, along.min() - BEYOND * base, along.max() + BEYOND * base
    if follower.is_flat:
        face = np.array([[front, low], [back, low], [back, high], [front, high]])
        yield BodyCurves(pair.follower, *frame, (face,))
    elif follower.roller_m > 0.0:
        yield BodyCurves(pair.follower, *frame, (_circle(follower.roller_m),))
