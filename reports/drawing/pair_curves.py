"""Curves of gears and cams on a drawn mechanism: pitch circles, profiles, rollers and faces.

::

    gear: pitch circle        ring: pitch circle           cam: profile     (+) roller   ___ face
          and spokes                and a rim with ticks
"""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from analytic.cams.outline import touched
from models.array import Array
from models.motion import Motion
from models.scene import GROUND, KEPT, Same, Scene, Slider
from models.scene.cams import OscillatingFollower
from models.scene.joints import local_point
from models.scene.pairs import CamPair

AROUND = 72
"""Corners of a circle: on 200 pixels of radius it is off by 0.2."""
FACETS = 240
"""Corners of a profile."""
SPOKES, TICKS = 3, 24
RIM = 1.08
"""Outer radius of a ring, over that of its pitch circle."""
BEYOND, THICK = 0.3, 0.08
"""Ends of a face beyond its contact, and its thickness, over the base radius of the cam."""


@dataclass(frozen=True, eq=False)
class BodyCurves:
    """Closed curves (n, 2) of a body [m], about its ``point``, of the ground about the origin.

    Their axes turn with the body ``on``, by ``angle_rad`` ahead of it: with the body itself, or of
    a follower that slides with the guide, whose line is their x-axis. Holes run clockwise.
    """

    body: str
    point: str
    on: str
    angle_rad: float
    curves: tuple[Array, ...]

    def at(self, motion: Motion, index: int | slice) -> list[Array]:
        """Return the curves in the ground's frame at a sample (n, 2), or at several (T, n, 2)."""
        angle = self.angle_rad * np.ones_like(motion.time_s[index])
        if self.on != GROUND:
            angle = angle + motion.links[self.on].theta[index]
        c, s = np.cos(angle), np.sin(angle)
        axes = np.stack([np.stack([c, s], axis=-1), np.stack([-s, c], axis=-1)], axis=-2)
        if not self.point:
            return [curve @ axes for curve in self.curves]
        middle = motion.points[self.point].position[index]
        return [middle[..., None, :] + curve @ axes for curve in self.curves]

    def embedded(self) -> dict[str, object]:
        """Return the curves for a page."""
        place = {"body": self.body, "point": self.point, "on": self.on, "angle": self.angle_rad}
        return {**place, "curves": self.curves}


def pair_curves(scene: Scene) -> tuple[BodyCurves, ...]:
    """Return the curves of all gears and cams of a scene, none of other bodies. Raises
    CrankcheckError for a cam that has no profile."""
    return _pair_curves(Same(scene))


@lru_cache(maxsize=KEPT)
def _pair_curves(same: Same) -> tuple[BodyCurves, ...]:
    cams = [each for pair in same.scene.cams.values() for each in _cam(same.scene, pair)]
    return (*_gears(same.scene), *cams)


def blocks_of(scene: Scene) -> list[Slider]:
    """Return the sliders that are drawn with a block: a link that a cam lifts has its roller or
    its face there."""
    lifted = {pair.slider for pair in scene.cams.values()}
    every = scene.sliders.values()
    return [slider for slider in every if slider.link is None or slider.name not in lifted]


def places_of(scene: Scene, motion: Motion) -> Array:
    """Return the places (n, 2) [m] of all points and curves at all samples."""
    curves = [each for own in pair_curves(scene) for each in own.at(motion, slice(None))]
    points = [point.position for point in motion.points.values()]
    return np.concatenate([*points, *(each.reshape(-1, 2) for each in curves)])


def _gears(scene: Scene) -> Iterator[BodyCurves]:
    """Yield the wheels and rings, each once; two gears about one centre have no pitch circle."""
    points = scene.points_of
    wheels: dict[tuple[str, str, float, bool], BodyCurves] = {}
    for gear in scene.gears.values():
        if gear.module(points) is None:
            continue
        rings = (False, gear.internal)
        for body, teeth, centre, ring in zip(
            gear.bodies, gear.teeth, gear.pivots(points), rings, strict=True
        ):
            radius = float(f"{teeth * gear.slip_m(points):.9g}")
            curves = _ring(radius) if ring else _wheel(radius)
            wheels[body, centre, radius, ring] = BodyCurves(body, centre, body, 0.0, curves)
    yield from wheels.values()


def _circle(radius: float, corners: int = AROUND) -> Array:
    angle = np.linspace(0.0, 2.0 * np.pi, corners, endpoint=False)
    return radius * np.column_stack([np.cos(angle), np.sin(angle)])


def _wheel(radius: float) -> tuple[Array, ...]:
    return (_circle(radius), *(np.array([[0.0, 0.0], end]) for end in _circle(radius, SPOKES)))


def _ring(radius: float) -> tuple[Array, ...]:
    ticks = (np.array([end, RIM * end]) for end in _circle(radius, TICKS))
    return (_circle(RIM * radius), _circle(radius)[::-1], *ticks)


def _cam(scene: Scene, pair: CamPair) -> Iterator[BodyCurves]:
    """Yield the profile of a cam, and the roller or the face of its follower if it has one."""
    contact, profile = touched(scene, pair, FACETS)
    centre, pivot = pair.pivots(scene.points_of)
    own = np.column_stack([profile.real, profile.imag])
    curve = own[:: pair.profile.sense] - np.array(local_point(scene, pair.cam, centre))
    yield BodyCurves(pair.cam, centre, pair.cam, 0.0, (curve,))
    follower, base = pair.profile.follower, pair.profile.base_m
    spare, thick = BEYOND * base, THICK * base
    point, on, angle = pivot, pair.follower, 0.0
    if pair.slider:
        slider = scene.sliders[pair.slider]
        point, on, angle = slider.point, slider.on, slider.direction_rad
    if follower.roller_m > 0.0:
        yield BodyCurves(pair.follower, pair.tip or point, on, angle, (_circle(follower.roller_m),))
    elif not follower.is_flat:
        return
    elif isinstance(follower, OscillatingFollower):
        way = np.subtract(local_point(scene, on, pair.tip), local_point(scene, on, pivot))
        along = way / np.hypot(*way)
        away = pair.side * np.array([along[1], -along[0]])
        ends = np.array([min(0.0, contact.lever.min()), contact.lever.max() + spare])
        face = _plate(ends, thick)[:, :1] * away + _plate(ends, thick)[:, 1:] * along
        yield BodyCurves(pair.follower, point, on, angle, (face + follower.face_m * away,))
    else:
        aside = follower.offset_m - contact.contact.real
        ends = np.array([aside.min() - spare, aside.max() + spare])
        yield BodyCurves(pair.follower, point, on, angle, (_plate(ends, thick),))


def _plate(ends: Array, thick: float) -> Array:
    """Return a face on the y-axis between two ends, and its back."""
    (low, high) = ends
    return np.array([[0.0, low], [thick, low], [thick, high], [0.0, high]])
