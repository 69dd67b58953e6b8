"""Linear forms in the derivatives of a mechanism's coordinates by its dimensions.

A body b stands at z + exp(i theta) s for a place s in its frame, all complex, z its first point.
The derivative of any place, by all dimensions at once, is a linear form in those of z and theta,
and its coefficients vary in time. A body that slides on one placed before it keeps an angle to it:
its own is no unknown.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import TypeVar

import numpy as np

from analytic.dyads.chunk import Chunk
from analytic.dyads.plane import EPS, rounding_of_angles
from analytic.gradients.dimensions import Dimension
from analytic.gradients.varying import MINUS, NOTHING, ONE, QUARTER, Varying, turning
from models.scene import GROUND, Point, Scene, Slider
from models.scene.joints import local_point, sliding_body

Unknown = tuple[str, str]
"""Derivative of the first point ("z", BODY), or of the angle ("turn", BODY), of a body."""
K = TypeVar("K")


@dataclass(frozen=True)
class DerivativeForm:
    """Sum of ``terms`` times unknowns, and of ``by`` for each dimension, by its number."""

    terms: Mapping[Unknown, Varying] = field(default_factory=dict)
    by: Mapping[int, Varying] = field(default_factory=dict)

    def __add__(self, other: DerivativeForm) -> DerivativeForm:
        return DerivativeForm(_sum(self.terms, other.terms), _sum(self.by, other.by))

    def __sub__(self, other: DerivativeForm) -> DerivativeForm:
        return self + other.times(MINUS)

    def times(self, factor: Varying) -> DerivativeForm:
        return DerivativeForm(
            {key: factor * one for key, one in self.terms.items()},
            {key: factor * one for key, one in self.by.items()},
        )

    def value(self, known: Mapping[Unknown, Varying], count: int) -> Varying:
        """Return the form at some of the unknowns (3, P, T), the others left out, with the
        derivatives by ``count`` dimensions, P."""
        total = NOTHING.each
        for key in self.terms.keys() & known.keys():
            total = total + self.terms[key].each * known[key]
        samples = max([total.value.shape[-1], *(one.value.shape[-1] for one in self.by.values())])
        value = np.zeros((3, count, samples), complex)
        error = np.zeros(value.shape)
        for number, one in self.by.items():
            value[:, number], error[:, number] = one.value, one.error
        return total + Varying(value, error)


def _sum(a: Mapping[K, Varying], b: Mapping[K, Varying]) -> dict[K, Varying]:
    both = {**a, **b}
    return {key: a[key] + b[key] if key in a and key in b else one for key, one in both.items()}


class Places:
    """Derivatives of places, lines and displacements of a solved chunk as forms."""

    def __init__(
        self, scene: Scene, chunk: Chunk, wanted: Mapping[str, Dimension], order: Sequence[str]
    ) -> None:
        """``order`` are all bodies in solving order."""
        self.scene, self.chunk, self.wanted, self.order = scene, chunk, wanted, (GROUND, *order)
        self.turns = {b: turning(chunk.bodies[b], chunk.theta) for b in self.order}
        self._firsts = {
            name: next(iter(link.points.values())) for name, link in scene.links.items()
        }
        self._angles = {GROUND: DerivativeForm()}
        self.tied: set[str] = set()
        """Sliders that give a body its angle."""
        for body in order:
            self._angles[body] = self._tied(body) or DerivativeForm({("turn", body): ONE})

    def _tied(self, body: str) -> DerivativeForm | None:
        """Return the derivative of a body's angle by that of one before it, None if there is no
        slider between them."""
        for name, slider in self.scene.sliders.items():
            ends = sliding_body(slider), slider.on
            if body in ends and (other := ends[ends[0] == body]) in self._angles:
                self.tied.add(name)
                own, kept = self._angles[other], self.lean(slider)
                return own + kept if body == ends[0] else own - kept
        return None

    def shifts(self, *key: str) -> dict[int, complex]:
        """Return the shift of a point, a line or another number by each dimension, by its number,
        where there is one."""
        each = (one.shifts.get(key, 0.0) for one in self.wanted.values())
        return {number: complex(shift) for number, shift in enumerate(each) if shift}

    def shifted(self, *key: str) -> DerivativeForm:
        """Return the derivatives of such a number, which is real or in a frame."""
        shifts = self.shifts(*key)
        return DerivativeForm(
            by={n: Varying.constant(s, 2 * EPS * abs(s)) for n, s in shifts.items()}
        )

    def angle(self, body: str) -> DerivativeForm:
        """Return the derivative of a body's angle."""
        return self._angles[body]

    def place(self, body: str, local: Point, *key: str) -> DerivativeForm:
        """Return the derivative of a place ``local`` on a body, which ``key`` shifts."""
        own = self.shifted(*key).times(self.turns[body])
        if body == GROUND:
            return own
        first = self._firsts.get(body, (0.0, 0.0))
        arm = complex(local[0] - first[0], local[1] - first[1])
        rounding = EPS * (abs(complex(*local)) + abs(complex(*first))) if arm else 0.0
        swing = self.turns[body] * QUARTER * Varying.constant(arm, rounding)
        base = own + DerivativeForm({("z", body): ONE})
        return base + self.angle(body).times(swing) if arm else base

    def point(self, body: str, name: str) -> DerivativeForm:
        """Return the derivative of a named point by way of a body that carries it."""
        return self.place(body, local_point(self.scene, body, name), "point", body, name)

    def ride(self, slider: Slider) -> DerivativeForm:
        """Return the derivative of a slider's displacement w and, times i, of its way across::

        w = exp(-i angle) (tip - through)       dw = exp(-i angle) d(tip - through) - i w d(angle)
        """
        guide, name, angle, s = slider.on, slider.name, slider.direction_rad, self.slid(slider)
        off = rounding_of_angles(angle) + 2 * EPS if angle else 0.0
        unit = Varying.constant(complex(np.cos(angle), np.sin(angle)), off)
        tip = self.point(sliding_body(slider), slider.point)
        away = tip - self.place(guide, slider.through_m, "through", name)
        turned = self.angle(guide) + self.shifted("direction", name)
        return away.times((self.turns[guide] * unit).conj()) - turned.times(s * QUARTER)

    def slid(self, slider: Slider) -> Varying:
        """Return the displacement of a slider."""
        s = self.chunk.sliders[slider.name]
        errors = s.error or (0.0, 0.0, 0.0)
        return Varying.of((s.s, s.speed, s.acceleration), tuple(errors), self.chunk.theta)

    def lean(self, slider: Slider) -> DerivativeForm:
        """Return the derivative of the angle of a sliding body against its guide."""
        return self.shifted("direction", slider.name) + self.shifted("lean", slider.name)
