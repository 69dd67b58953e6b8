"""The bodies of a scene and the markers that they carry, in one set of coordinates."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np

from analytic.multibody.body_set import BodySet
from analytic.multibody.configuration import Configuration
from analytic.multibody.joint_equations import JointEquations, JointMarkers
from analytic.multibody.rigid import RigidBodies, inertias
from models.array import Array
from models.joints import joined_at, local_point, sliding_body
from models.scene import GROUND, Point, Scene


@dataclass
class _MarkerList:
    """The markers that are asked for: a place of a body, and an angle against it."""

    ground: dict[tuple[Point, float], int] = field(default_factory=dict)
    moving: dict[tuple[str, Point, float], int] = field(default_factory=dict)


class Assembly:
    """All bodies of a scene, and the equations of its ``joints``.

    ``bodies`` are those with coordinates, each from ``at`` on in q; ``size`` is n, the number of
    all coordinates. ``parts`` do the work, each with a slice of the coordinates and of the markers.
    ``held`` are the markers at each pin, by body.
    """

    def __init__(self, scene: Scene) -> None:
        self.scene = scene
        own = inertias(scene)
        self.bodies = tuple(own)
        self.at = {body: 3 * i for i, body in enumerate(self.bodies)}
        self._list = _MarkerList()
        self.held = {
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
        self.joints = JointEquations(
            scene, self.size, JointMarkers(self.held, self.frames, self.tips, self.guides)
        )

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

        self.held = {
            point: {body: number(marker) for body, marker in each.items()}
            for point, each in self.held.items()
        }
        for numbers in (self.frames, self.tips, self.guides):
            numbers.update({name: number(marker) for name, marker in numbers.items()})
        self.carriers = {
            point: (body, number(marker)) for point, (body, marker) in self.carriers.items()
        }
        places = [(*place, angle) for place, angle in self._list.ground]
        self._still = np.zeros((still + len(places), 3))
        self._still[still:] = np.array(places).reshape(-1, 3)

    def marker(self, body: str, point: str) -> int:
        """The number of the marker at a named point of a body."""
        held = self.held.get(point, {})
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
