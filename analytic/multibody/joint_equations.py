"""The constraint equations of the joints of a scene, with their derivatives.

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
from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np

from analytic.multibody.configuration import Configuration
from models.array import Array
from models.joints import sliding_angle, sliding_body
from models.scene import Scene, Slider


@dataclass(frozen=True)
class JointMarkers:
    """The numbers of markers at joints: by pin and body, of each body itself, of what slides and
    of the line that it slides on, by slider."""

    held: Mapping[str, Mapping[str, int]]
    frames: Mapping[str, int]
    tips: Mapping[str, int]
    guides: Mapping[str, int]


class JointEquations:
    """The equations of all joints, ``count`` in number (m): those of pins first, two each.

    ``size`` is n, the number of coordinates.
    """

    def __init__(self, scene: Scene, size: int, markers: JointMarkers) -> None:
        self.size, self._held = size, markers.held
        pairs = list(self.pin_pairs())
        self._first = np.array([self._held[p][a] for p, a, _ in pairs], dtype=int)
        self._other = np.array([self._held[p][b] for p, _, b in pairs], dtype=int)
        sliders: list[Slider] = list(scene.sliders.values())
        self._tip = np.array([markers.tips[s.name] for s in sliders], dtype=int)
        self._turning = np.array([markers.frames[sliding_body(s)] for s in sliders], dtype=int)
        self._guide = np.array([markers.guides[s.name] for s in sliders], dtype=int)
        self._lean = np.array([sliding_angle(s) - s.direction_rad for s in sliders])
        self.count = 2 * len(pairs) + 2 * len(sliders)

    def pin_pairs(self) -> Iterator[tuple[str, str, str]]:
        """The point and the two bodies of every two equations of pins, in their order."""
        for point, held in self._held.items():
            first, *others = held
            for other in others:
                yield point, first, other

    def gaps(self, now: Configuration) -> Array:
        """The violation of each equation [m or rad], (T, m); angles but for whole turns."""
        place = now.place
        pins = place[:, self._first, :2] - place[:, self._other, :2]
        rows = np.empty((len(place), self.count))
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
        rows = np.empty((len(gradient), self.count, self.size))
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
            rows[:, pinned::2] = turned + guide[:, :, 2] * _dot(along, away) - bent
            rows[:, pinned + 1 :: 2] = guide[:, :, 2] - drift[:, self._turning, 2]
        return rows

    def _lines(self, now: Configuration) -> tuple[Array, Array, Array]:
        """Along and across the line of every slider, and from guide to what slides (T, S, 2)."""
        angle = now.place[:, self._guide, 2]
        c, s = np.cos(angle), np.sin(angle)
        away = now.place[:, self._tip, :2] - now.place[:, self._guide, :2]
        return np.stack([c, s], axis=2), np.stack([-s, c], axis=2), away


def _dot(a: Array, b: Array) -> Array:
    return np.asarray((a * b).sum(axis=2))
