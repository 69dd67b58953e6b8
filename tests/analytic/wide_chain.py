"""A whole mechanism in long doubles, at thousands of samples at once.

As `tests.analytic.chain`: the same constraints over jets, with a mantissa of 64 bits, 2048 times as
fine as a float's. Directions are made of the angles as they were given, degrees
of a file or radians, each by itself, so that no sum of large angles is rounded.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from models.array import Array
from models.motion import Motion
from models.scene import GROUND, Scene, Slider
from models.scene.joints import sliding_body
from models.scene.laws import ConstantSpeed, Law, Oscillating
from tests.analytic.chain import Frame, JetChain, Solved, turned
from tests.analytic.change_points.jets import Jet, _made
from tests.analytic.oracle import Place

Wide = np.longdouble
HAS_DIGITS = np.finfo(Wide).nmant >= 63
"""Not on every platform."""
PI = Wide("3.14159265358979323846264338327950288")
ROUNDS = 6
Rows = Any
"""An array of long doubles, (T,) or (T, coordinates)."""


@dataclass(frozen=True)
class Angle:
    """A constant angle as it was given, exactly: in radians, or in degrees."""

    number: float
    in_degrees: bool = False

    @property
    def wide(self) -> Rows:
        return Wide(self.number) * (PI / 180) if self.in_degrees else Wide(self.number)

    @property
    def direction(self) -> tuple[Rows, Rows]:
        whole = Angle(float(np.fmod(self.number, 360.0)), True) if self.in_degrees else self
        return np.cos(whole.wide), np.sin(whole.wide)


@dataclass(frozen=True)
class Given:
    """The angles of a scene as they were given: of each slider those of its line and of the link
    on it, and those of the driver's law by their names in `models.scene.laws`."""

    lines: Mapping[str, Angle]
    leans: Mapping[str, Angle]
    law: Mapping[str, Angle]

    @staticmethod
    def of(scene: Scene) -> Given:
        """The radians of the scene itself."""
        sliders = scene.sliders.values()
        return Given(
            {s.name: Angle(s.direction_rad) for s in sliders},
            {s.name: Angle(s.angle_rad) for s in sliders},
            {k: Angle(v) for k, v in vars(scene.driver.law).items() if k.endswith("_rad")},
        )


def law_at(law: Law, given: Mapping[str, Angle], time_s: Array) -> Jet:
    t, rest = Wide(time_s), np.zeros(time_s.shape, dtype=Wide)
    if isinstance(law, ConstantSpeed):
        speed = Wide(law.speed_rad_s)
        return _made(given["start_rad"].wide + speed * t, rest + speed, rest)
    assert isinstance(law, Oscillating)
    w, a = Wide(law.frequency_rad_s), given["amplitude_rad"].wide
    phase = w * t + given["phase_rad"].wide
    swing = a * np.sin(phase)
    return _made(given["centre_rad"].wide + swing, a * w * np.cos(phase), -w * w * swing)


def toward(angle: Jet) -> Place:
    c, s = np.cos(angle.value), np.sin(angle.value)
    square = angle.rate * angle.rate
    return Place(
        _made(c, -s * angle.rate, -s * angle.second - c * square),
        _made(s, c * angle.rate, c * angle.second - s * square),
    )


def still(value: float) -> Jet:
    return _made(Wide(value), Wide(0), Wide(0))


class WideChain(JetChain):
    """The constraints of a scene over jets of samples."""

    def __init__(self, scene: Scene, given: Given) -> None:
        super().__init__(scene)
        self.given = given
        blocks = [sliding_body(s) for s in scene.sliders.values() if s.link is None]
        self.bodies = (*scene.links, *blocks)

    def solve(self, motion: Motion) -> Solved:
        drive = law_at(self.scene.driver.law, self.given.law, motion.time_s)
        place = self._coordinates(motion, drive)
        inverse = Wide(np.linalg.inv(np.float64(self._jacobian(place, drive))))
        levels = [place, np.zeros_like(place), np.zeros_like(place)]
        for _ in range(ROUNDS):
            wrong = self._equations(levels, drive)
            for level, name in enumerate(("value", "rate", "second")):
                off = _rows([getattr(jet, name) for jet in wrong], len(place))
                levels[level] = levels[level] - np.einsum("tij,tj->ti", inverse, off)
        return self.solved(self._frames(levels))

    def along(self, guide: Frame, slider: Slider) -> Place:
        return turned(guide.along, self.given.lines[slider.name].direction)

    def _coordinates(self, motion: Motion, drive: Jet) -> Rows:
        angles: dict[str, Rows] = {GROUND: Wide(0)}
        columns: list[Rows] = []
        for link in self.scene.links.values():
            theta = Wide(np.remainder(motion.links[link.name].theta, 2 * np.pi))
            angles[link.name] = drive.value if link.name == self.scene.driver.link else theta
            point, local = next(iter(link.points.items()))
            c, s = np.cos(angles[link.name]), np.sin(angles[link.name])
            x, y = Wide(motion.points[point].position).T
            columns += [x - c * local[0] + s * local[1], y - s * local[0] - c * local[1]]
            columns.append(angles[link.name])
        for slider in self.scene.sliders.values():
            if slider.link is None:
                columns += list(Wide(motion.points[slider.point].position).T)
                columns.append(angles[slider.on] + Wide(slider.direction_rad))
        return _rows(columns, len(motion.time_s))

    def _jacobian(self, place: Rows, drive: Jet) -> Rows:
        """What the equations change by with each coordinate, (T, equations, coordinates)."""
        columns = []
        for k in range(place.shape[1]):
            rates = np.zeros_like(place)
            rates[:, k] = 1
            found = self._equations([place, rates, np.zeros_like(place)], _made(drive.value, 0, 0))
            columns.append(_rows([jet.rate for jet in found], len(place)))
        return np.stack(columns, axis=2)

    def _frames(self, levels: list[Rows]) -> dict[str, Frame]:
        zero, one = still(0.0), still(1.0)
        frames = {GROUND: Frame(Place(zero, zero), zero, Place(one, zero))}
        for i, body in enumerate(self.bodies):
            x, y, angle = (_made(*(rows[:, 3 * i + k] for rows in levels)) for k in range(3))
            frames[body] = Frame(Place(x, y), angle, toward(angle))
        return frames

    def _equations(self, levels: list[Rows], drive: Jet) -> list[Jet]:
        frames = self._frames(levels)
        rows = self.gaps(frames)
        for slider in self.scene.sliders.values():
            away, along = self.ride(frames, slider)
            kept = turned(along, self.given.leans[slider.name].direction)
            rows += [along.cross(away), kept.cross(frames[sliding_body(slider)].along)]
        return [*rows, frames[self.scene.driver.link].angle - drive]


def _rows(columns: list[Rows], samples: int) -> Rows:
    """Columns side by side, (T, columns); those that are constant for every sample."""
    return np.stack([np.broadcast_to(column, (samples,)) for column in columns], axis=1)
