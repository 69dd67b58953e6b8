"""The bodies of a scene and the markers that they carry, in one set of coordinates.

Dyads and a solving order play no part. Every pin and every prismatic pair gives two equations::

    pin      r_a - r_b = 0
    slider   n . (r - r_guide) = 0          n across the line, which turns with its guide
             angle - angle of the line = 0

The equations and their derivatives come from those of markers. Source: E. J. Haug, Computer Aided
Kinematics and Dynamics of Mechanical Systems, chapters 3, 4 and 6.
"""

import math
from collections.abc import Iterator, Mapping
from functools import cached_property
from types import MappingProxyType

import numpy as np
from numpy.typing import NDArray

from analytic.multibody import bodies
from analytic.multibody.bodies import Configuration, Flexible
from models.array import Array
from models.scene import GROUND, Point, Scene
from models.scene.joints import joined_at, local_point, sliding_angle, sliding_body

RIGID: Mapping[str, Flexible] = MappingProxyType({})
"""No link is flexible."""


class Assembly:
    """All bodies of a scene, and the equations of its ``joints``.

    ``bodies`` have coordinates, each from ``at`` on in q; ``size`` is n, the number of all
    coordinates. ``parts`` compute, each with a slice of the coordinates and of the markers.
    ``held`` are the markers at each pin, by body; ``elastic`` the bodies of elastic links, by name,
    each with its slice of the coordinates.
    """

    def __init__(self, scene: Scene, flexible: Mapping[str, Flexible] = RIGID) -> None:
        self.scene = scene
        own = bodies.inertias(scene)
        self.bodies = tuple(own)
        # Requested markers, numbered: a place (None for the frame of a body), and an angle.
        self._fixed: dict[tuple[Point, float], int] = {}
        self._moving: dict[tuple[str, Point | None, float], int] = {}
        self.held = {
            point: {body: self._ask(body, local_point(scene, body, point)) for body in names}
            for point, names in joined_at(scene).items()
        }
        self.frames = {
            body: self._ask(body, None if body in flexible else (0.0, 0.0))
            for body in (GROUND, *self.bodies)
        }
        self.tips, self.guides, carried = {}, {}, dict(scene.pins)
        for name, slider in scene.sliders.items():
            body = sliding_body(slider)
            self.tips[name] = self._ask(body, local_point(scene, body, slider.point))
            line = slider.direction_rad
            self.guides[name] = self._ask(slider.on, slider.through_m, line)
            if slider.point not in scene.pins:
                carried[slider.point] = (body,)
        self.carriers = {
            point: (names[0], self._ask(names[0], local_point(scene, names[0], point)))
            for point, names in carried.items()
        }
        self._number_markers(flexible)
        self._make_parts({name: one for name, one in own.items() if name not in flexible}, flexible)
        self.size = sum(part.size for part, _, _ in self.parts)
        self.joints = JointEquations(self)

    def _make_parts(
        self, rigid: Mapping[str, bodies.Inertia], flexible: Mapping[str, Flexible]
    ) -> None:
        """Make the computing parts: all rigid bodies at once, then each elastic one."""
        gravity, moving = self.scene.gravity_m_s2, self._moving
        numbers = {name: i for i, name in enumerate(rigid)}
        asked = [
            (numbers[body], place or (0.0, 0.0), angle)
            for body, place, angle in moving
            if body in numbers
        ]
        first = bodies.RigidBodies(rigid, asked, gravity)
        own, marked = slice(0, first.size), slice(0, len(asked))
        parts: list[tuple[bodies.BodySet, slice, slice]] = [(first, own, marked)]
        self.at = {body: 3 * i for body, i in numbers.items()}
        self.elastic: dict[str, tuple[bodies.FlexibleBody, slice]] = {}
        for name, one in flexible.items():
            markers = [(place, angle) for body, place, angle in moving if body == name]
            link = one.body(markers, gravity)
            own = slice(own.stop, own.stop + link.size)
            marked = slice(marked.stop, marked.stop + len(markers))
            parts.append((link, own, marked))
            self.at[name], self.elastic[name] = own.start, (link, own)
        self.parts = tuple(parts)

    def _ask(self, body: str, place: Point | None, angle_rad: float = 0.0) -> int:
        """Return the number of a marker; markers of the ground are below 0, until all are known."""
        if body == GROUND:
            fixed = (place or (0.0, 0.0), angle_rad)
            return -1 - self._fixed.setdefault(fixed, len(self._fixed))
        return self._moving.setdefault((body, place, angle_rad), len(self._moving))

    def _number_markers(self, flexible: Mapping[str, Flexible]) -> None:
        """Number the markers: those of rigid bodies, of each elastic one, last of the ground."""
        still, order = len(self._moving), {name: i for i, name in enumerate(flexible, 1)}
        moving = enumerate(self._moving)
        final = sorted(moving, key=lambda asked: order.get(asked[1][0], 0))  # keeps their order
        new = {marker: number for number, (marker, _) in enumerate(final)}

        def number(marker: int) -> int:
            return new[marker] if marker >= 0 else still - 1 - marker

        self.held = {
            point: {body: number(marker) for body, marker in each.items()}
            for point, each in self.held.items()
        }
        for numbers in (self.frames, self.tips, self.guides):
            numbers.update({name: number(marker) for name, marker in numbers.items()})
        self.carriers = {
            point: (body, number(marker)) for point, (body, marker) in self.carriers.items()
        }
        places = [(*place, angle) for place, angle in self._fixed]
        self._still = np.zeros((still + len(places), 3))
        self._still[still:] = np.array(places).reshape(-1, 3)

    def marker(self, body: str, point: str) -> int:
        """Return the number of the marker at a named point of a body."""
        held = self.held.get(point, {})
        return held[body] if body in held else self.carriers[point][1]

    @property
    def markers(self) -> int:
        """Number of markers."""
        return len(self._still)

    def at_rates(self, q: Array, rates: Array) -> Configuration:
        """Return all markers at coordinates and rates (T, n)."""
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
        """Return all markers at coordinates (T, n) alone."""
        return self.at_rates(q, np.zeros_like(q))

    def weigh(self, q: Array, rates: Array) -> tuple[Array, Array]:
        """Return the mass matrix of all bodies (T, n, n); weights, and inertia with the squares of
        rates, on the right side (T, n)."""
        matrix = np.zeros((len(q), self.size, self.size))
        right = np.empty_like(q)
        for part, own, _ in self.parts:
            matrix[:, own, own], right[:, own] = part.weigh(q[:, own], rates[:, own])
        return matrix, right

    @property
    def units(self) -> Array:
        """Unit of each coordinate: the longest link [m], or a radian."""
        angular = np.concatenate([part.angular for part, _, _ in self.parts])
        return np.where(angular, 1.0, self.scene.longest_m)

    def scaled(self, rows: Array) -> Array:
        """Return rows of derivatives by coordinates (m, n) in the units of these, each of the
        largest entry 1."""
        scaled = rows * self.units
        size = np.abs(scaled).max(axis=1, keepdims=True, initial=0.0)
        return np.asarray(scaled / np.where(size > 0.0, size, 1.0))

    @cached_property
    def coefficients(self) -> NDArray[np.intp]:
        """Numbers of the coordinates that deform elastic links, (k,)."""
        own = [np.arange(at.start + 3, at.stop) for _, at in self.elastic.values()]
        return np.concatenate([np.empty(0, dtype=np.intp), *own])

    def mass(self, q: Array) -> Array:
        """Return the mass matrix alone."""
        return self.weigh(q, np.zeros_like(q))[0]

    def height_energy(self, q: Array) -> Array:
        """Return the potential energy of all bodies [J], (T,)."""
        return np.asarray(sum(part.height_energy(q[:, own]) for part, own, _ in self.parts))

    def lost(self, rates: Array) -> Array:
        """Return the power that damping of elastic links takes [W], (T,)."""
        return np.asarray(sum(part.lost(rates[:, own]) for part, own, _ in self.parts))


class JointEquations:
    """Equations of all joints, ``count`` in number (m): those of pins first, two each.

    ``size`` is n, the number of coordinates.
    """

    def __init__(self, assembly: Assembly) -> None:
        self.size, self._held = assembly.size, assembly.held
        pairs = list(self.pin_pairs())
        self._first = np.array([self._held[p][a] for p, a, _ in pairs], dtype=int)
        self._other = np.array([self._held[p][b] for p, _, b in pairs], dtype=int)
        sliders = list(assembly.scene.sliders.values())
        self._tip = np.array([assembly.tips[s.name] for s in sliders], dtype=int)
        self._turning = np.array([assembly.frames[sliding_body(s)] for s in sliders], dtype=int)
        self._guide = np.array([assembly.guides[s.name] for s in sliders], dtype=int)
        self._lean = np.array([sliding_angle(s) - s.direction_rad for s in sliders])
        gears = list(assembly.scene.gears.values())
        self._turns = np.zeros((len(gears), 1 + max([*assembly.frames.values(), 0])))
        """Factor of the angle of each marker in the relation of each pair of gears, and their
        constants [rad]."""
        for row, gear in zip(self._turns, gears, strict=True):
            for body, factor in gear.relation.items():
                if body != GROUND:
                    row[assembly.frames[body]] += factor / gear.teeth[0]
        self._constants = np.array([gear.constant_rad / gear.teeth[0] for gear in gears])
        self._slid = slice(2 * len(pairs), 2 * len(pairs) + 2 * len(sliders))
        self.count = self._slid.stop + len(gears)

    def pin_pairs(self) -> Iterator[tuple[str, str, str]]:
        """Yield the point and the two bodies of every two equations of pins, in their order."""
        for point, held in self._held.items():
            first, *others = held
            for other in others:
                yield point, first, other

    def gaps(self, now: Configuration) -> Array:
        """Return the violation of each equation [m or rad], (T, m); angles up to whole turns."""
        place = now.place
        pins = place[:, self._first, :2] - place[:, self._other, :2]
        rows = np.empty((len(place), self.count))
        pinned = 2 * len(self._first)
        rows[:, :pinned] = pins.reshape(len(place), -1)
        if len(self._tip):
            _, across, away = self._lines(now)
            lean = place[:, self._turning, 2] - place[:, self._guide, 2] - self._lean
            rows[:, self._slid][:, ::2] = _dot(across, away)
            rows[:, self._slid][:, 1::2] = lean - math.tau * np.round(lean / math.tau)
        if len(self._constants):
            rows[:, self._slid.stop :] = self._summed(place[:, :, 2]) - self._constants
        return rows

    def jacobian(self, now: Configuration) -> Array:
        """Return their derivatives by the coordinates, (T, m, n)."""
        gradient = now.gradient
        rows = np.empty((len(gradient), self.count, self.size))
        pinned = 2 * len(self._first)
        pins = gradient[:, self._first, :2] - gradient[:, self._other, :2]
        rows[:, :pinned] = pins.reshape(len(gradient), pinned, self.size)
        if len(self._tip):
            along, across, away = self._lines(now)
            guide = gradient[:, self._guide]
            drawn = gradient[:, self._tip, :2] - guide[:, :, :2]
            turned = _dot(along, away)[:, :, None] * guide[:, :, 2]
            rows[:, self._slid][:, ::2] = np.einsum("tsk,tskn->tsn", across, drawn) - turned
            rows[:, self._slid][:, 1::2] = gradient[:, self._turning, 2] - guide[:, :, 2]
        if len(self._constants):
            rows[:, self._slid.stop :] = self._summed(gradient[:, :, 2])
        return rows

    def gamma(self, now: Configuration) -> Array:
        """Return the right side of the equations of accelerations, Phi_q q'' = gamma, (T, m)."""
        drift = now.drift
        rows = np.empty((len(drift), self.count))
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
            rows[:, self._slid][:, ::2] = turned + guide[:, :, 2] * _dot(along, away) - bent
            rows[:, self._slid][:, 1::2] = guide[:, :, 2] - drift[:, self._turning, 2]
        if len(self._constants):
            rows[:, self._slid.stop :] = -self._summed(drift[:, :, 2])
        return rows

    def _summed(self, of_markers: Array) -> Array:
        """Return the sum over markers of (T, markers, ...) in the relations of gears."""
        own = of_markers[:, : self._turns.shape[1]]
        return np.asarray(np.einsum("gk,tk...->tg...", self._turns, own))

    def _lines(self, now: Configuration) -> tuple[Array, Array, Array]:
        """Vectors along and across the line of every slider, and from guide to tip (T, S, 2)."""
        angle = now.place[:, self._guide, 2]
        c, s = np.cos(angle), np.sin(angle)
        away = now.place[:, self._tip, :2] - now.place[:, self._guide, :2]
        return np.stack([c, s], axis=2), np.stack([-s, c], axis=2), away


def _dot(a: Array, b: Array) -> Array:
    return np.asarray((a * b).sum(axis=2))
