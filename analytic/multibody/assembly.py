"""The bodies of a scene, their markers, and the constraint equations of its joints.

Nothing here knows of dyads or of an order of solving. Every pin and every prismatic pair gives two
equations, whatever they leave free::

    pin      r_a - r_b = 0
    slider   n . (r - r_guide) = 0          n across the line, which turns with its guide
             angle - angle of the line = 0

The equations and their derivatives come from those of markers. Source: E. J. Haug, Computer Aided
Kinematics and Dynamics of Mechanical Systems, chapters 3, 4 and 6.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np

from analytic.multibody.body_set import BodySet
from analytic.multibody.rigid import RigidBodies, inertias
from models.array import Array, Mask
from models.joints import joined_at, local_point, sliding_angle, sliding_body
from models.scene import GROUND, Point, Scene, Slider


@dataclass(frozen=True)
class Configuration:
    """Coordinates with their rates at T samples, (T, n), and what they make of K markers: places
    and velocities (T, K, 3), derivatives of places by coordinates (T, K, 3, n), and accelerations
    where the q'' are 0 (T, K, 3)."""

    q: Array
    rates: Array
    place: Array
    gradient: Array
    velocity: Array
    drift: Array

    def some(self, samples: Mask) -> Configuration:
        """Those of some of the samples."""
        return Configuration(*(own[samples] for own in vars(self).values()))


@dataclass
class _MarkerList:
    """The markers that are asked for: a place of a body, and an angle against it."""

    ground: dict[tuple[Point, float], int] = field(default_factory=dict)
    moving: dict[tuple[str, Point, float], int] = field(default_factory=dict)


class Assembly:
    """The equations of all bodies and joints of a scene.

    ``bodies`` are those with coordinates, each from ``at`` on in q; ``size`` is n, the number of
    all coordinates, ``equations`` m, that of the constraints. ``parts`` do the work, each with a
    slice of the coordinates and of the markers.
    """

    def __init__(self, scene: Scene) -> None:
        self.scene = scene
        own = inertias(scene)
        self.bodies = tuple(own)
        self.at = {body: 3 * i for i, body in enumerate(self.bodies)}
        self._list = _MarkerList()
        self._held = {
            point: {body: self._ask(body, local_point(scene, body, point)) for body in names}
            for point, names in joined_at(scene).items()
        }
        self.frames = {body: self._ask(body, (0.0, 0.0)) for body in (GROUND, *self.bodies)}
        self.tips, self.guides = {}, {}
        for name, slider in scene.sliders.items():
            body = sliding_body(slider)
            self.tips[name] = self._ask(body, local_point(scene, body, slider.point))
            line = slider.direction_rad
            self.guides[name] = self._ask(slider.on, slider.through_m, line)
        self.carriers = {
            point: (names[0], self._ask(names[0], local_point(scene, names[0], point)))
            for point, names in self._named_points()
        }
        self._number_markers()
        numbers = {name: i for i, name in enumerate(self.bodies)}
        rigid = RigidBodies(
            own,
            [(numbers[body], place, angle) for body, place, angle in self._list.moving],
            scene.gravity_m_s2,
        )
        self.parts: tuple[tuple[BodySet, slice, slice], ...] = (
            (rigid, slice(0, rigid.size), slice(0, len(self._list.moving))),
        )
        self.size = sum(part.size for part, _, _ in self.parts)
        self._joints()

    def _ask(self, body: str, place: Point, angle_rad: float = 0.0) -> int:
        """The number of a marker; those of the ground are below 0, until all are known."""
        if body == GROUND:
            ground = self._list.ground
            return -1 - ground.setdefault((place, angle_rad), len(ground))
        moving = self._list.moving
        return moving.setdefault((body, place, angle_rad), len(moving))

    def _named_points(self) -> Iterator[tuple[str, tuple[str, ...]]]:
        """Every named point with the bodies that carry it; those of blocks alone last."""
        yield from self.scene.pins.items()
        for slider in self.scene.sliders.values():
            if slider.point not in self.scene.pins:
                yield slider.point, (sliding_body(slider),)

    def _number_markers(self) -> None:
        """Those of the ground after all others, where they hold still."""
        still = len(self._list.moving)

        def number(marker: int) -> int:
            return marker if marker >= 0 else still - 1 - marker

        self._held = {
            point: {body: number(marker) for body, marker in each.items()}
            for point, each in self._held.items()
        }
        for numbers in (self.frames, self.tips, self.guides):
            numbers.update({name: number(marker) for name, marker in numbers.items()})
        self.carriers = {
            point: (body, number(marker)) for point, (body, marker) in self.carriers.items()
        }
        places = [(*place, angle) for place, angle in self._list.ground]
        self._still = np.zeros((still + len(places), 3))
        self._still[still:] = np.array(places).reshape(-1, 3)

    def _joints(self) -> None:
        """The markers of all pairs, in the order of their equations."""
        pairs = list(self.pin_pairs())
        self._first = np.array([self._held[p][a] for p, a, _ in pairs], dtype=int)
        self._other = np.array([self._held[p][b] for p, _, b in pairs], dtype=int)
        sliders: list[Slider] = list(self.scene.sliders.values())
        self._tip = np.array([self.tips[s.name] for s in sliders], dtype=int)
        self._turning = np.array([self.frames[sliding_body(s)] for s in sliders], dtype=int)
        self._guide = np.array([self.guides[s.name] for s in sliders], dtype=int)
        self._lean = np.array([sliding_angle(s) - s.direction_rad for s in sliders])
        self.equations = 2 * len(pairs) + 2 * len(sliders)

    def pin_pairs(self) -> Iterator[tuple[str, str, str]]:
        """The point and the two bodies of every two equations of pins, in their order."""
        for point, held in self._held.items():
            first, *others = held
            for other in others:
                yield point, first, other

    def marker(self, body: str, point: str) -> int:
        """The number of the marker at a named point of a body."""
        held = self._held.get(point, {})
        return held[body] if body in held else self.carriers[point][1]

    @property
    def markers(self) -> int:
        """How many markers there are."""
        return len(self._still)

    def at_rates(self, q: Array, rates: Array) -> Configuration:
        """All markers at coordinates and rates (T, n)."""
        count, markers = len(q), len(self._still)
        place = np.repeat(self._still[None], count, axis=0)
        gradient = np.zeros((count, markers, 3, self.size))
        drift = np.zeros_like(place)
        for part, own, marked in self.parts:
            each = part.mark(q[:, own], rates[:, own])
            place[:, marked], gradient[:, marked, :, own] = each.place, each.gradient
            drift[:, marked] = each.drift
        flat = gradient.reshape(count, 3 * markers, self.size)
        velocity = (flat @ rates[:, :, None]).reshape(place.shape)
        return Configuration(q, rates, place, gradient, velocity, drift)

    def at_rest(self, q: Array) -> Configuration:
        """All markers at coordinates (T, n) alone."""
        return self.at_rates(q, np.zeros_like(q))

    def gaps(self, now: Configuration) -> Array:
        """The violation of each equation [m or rad], (T, m); angles but for whole turns."""
        place = now.place
        pins = place[:, self._first, :2] - place[:, self._other, :2]
        rows = np.empty((len(place), self.equations))
        pinned = 2 * len(self._first)
        rows[:, :pinned] = pins.reshape(len(place), -1)
        if len(self._tip):
            _, across, away = self._lines(now)
            lean = place[:, self._turning, 2] - place[:, self._guide, 2] - self._lean
            rows[:, pinned::2] = _dot(across, away)
            rows[:, pinned + 1 :: 2] = lean - math.tau * np.round(lean / math.tau)
        return rows

    def jacobian(self, now: Configuration) -> Array:
        """Their derivatives by the coordinates, (T, m, n)."""
        gradient = now.gradient
        rows = np.empty((len(gradient), self.equations, self.size))
        pinned = 2 * len(self._first)
        pins = gradient[:, self._first, :2] - gradient[:, self._other, :2]
        rows[:, :pinned] = pins.reshape(len(gradient), pinned, self.size)
        if len(self._tip):
            along, across, away = self._lines(now)
            guide = gradient[:, self._guide]
            drawn = gradient[:, self._tip, :2] - guide[:, :, :2]
            turned = _dot(along, away)[:, :, None] * guide[:, :, 2]
            rows[:, pinned::2] = np.einsum("tsk,tskn->tsn", across, drawn) - turned
            rows[:, pinned + 1 :: 2] = gradient[:, self._turning, 2] - guide[:, :, 2]
        return rows

    def gamma(self, now: Configuration) -> Array:
        """The right side of the equations of accelerations, Phi_q q'' = gamma, (T, m)."""
        drift = now.drift
        rows = np.empty((len(drift), self.equations))
        pinned = 2 * len(self._first)
        pins = drift[:, self._other, :2] - drift[:, self._first, :2]
        rows[:, :pinned] = pins.reshape(len(drift), -1)
        if len(self._tip):
            along, across, away = self._lines(now)
            velocity, guide = now.velocity, drift[:, self._guide]
            omega = velocity[:, self._guide, 2]
            drawn = velocity[:, self._tip, :2] - velocity[:, self._guide, :2]
            bent = _dot(across, drift[:, self._tip, :2] - guide[:, :, :2])
            turned = 2.0 * omega * _dot(along, drawn) + omega**2 * _dot(across, away)
            rows[:, pinned::2] = turned + guide[:, :, 2] * _dot(along, away) - bent
            rows[:, pinned + 1 :: 2] = guide[:, :, 2] - drift[:, self._turning, 2]
        return rows

    def _lines(self, now: Configuration) -> tuple[Array, Array, Array]:
        """Along and across the line of every slider, and from guide to what slides (T, S, 2)."""
        angle = now.place[:, self._guide, 2]
        c, s = np.cos(angle), np.sin(angle)
        away = now.place[:, self._tip, :2] - now.place[:, self._guide, :2]
        return np.stack([c, s], axis=2), np.stack([-s, c], axis=2), away

    def weigh(self, q: Array, rates: Array) -> tuple[Array, Array]:
        """The mass matrix of all bodies (T, n, n); weights, and inertia that goes with the squares
        of rates, on the right side (T, n)."""
        matrix = np.zeros((len(q), self.size, self.size))
        right = np.empty_like(q)
        for part, own, _ in self.parts:
            matrix[:, own, own], right[:, own] = part.weigh(q[:, own], rates[:, own])
        return matrix, right

    @property
    def units(self) -> Array:
        """What each coordinate counts as one of: the longest link [m], or a radian."""
        unit = np.ones(self.size)
        for at in self.at.values():
            unit[at : at + 2] = self.scene.longest_m
        return unit

    def scaled(self, rows: Array) -> Array:
        """Rows of derivatives by coordinates (m, n) that count in their units, each of the largest
        entry 1."""
        scaled = rows * self.units
        size = np.abs(scaled).max(axis=1, keepdims=True, initial=0.0)
        return np.asarray(scaled / np.where(size > 0.0, size, 1.0))

    def mass(self, q: Array) -> Array:
        """The mass matrix alone."""
        return self.weigh(q, np.zeros_like(q))[0]

    def height_energy(self, q: Array) -> Array:
        """The potential energy of all bodies [J], (T,)."""
        return np.asarray(sum(part.height_energy(q[:, own]) for part, own, _ in self.parts))


def _dot(a: Array, b: Array) -> Array:
    return np.asarray((a * b).sum(axis=2))
