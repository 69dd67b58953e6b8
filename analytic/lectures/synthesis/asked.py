"""What a mechanism is asked to do: precision positions, and how far a motion is from them."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from models.array import Array
from models.motion import Motion


@dataclass(frozen=True)
class AskedAngle:
    """A link has an angle [rad], whole turns apart."""

    link: str
    angle: float

    def value(self, motion: Motion) -> NDArray[np.complex128]:
        """Where a motion has it, as a turn exp(i angle), (T,)."""
        return np.asarray(np.exp(1j * motion.links[self.link].theta))

    def off(self, motion: Motion) -> Array:
        """How far a motion is from it [rad], (T,), with its sign."""
        off = motion.links[self.link].theta - self.angle
        return np.asarray(off - math.tau * np.round(off / math.tau))


@dataclass(frozen=True)
class AskedPlace:
    """A point is at a place [m]."""

    point: str
    place: complex

    def value(self, motion: Motion) -> NDArray[np.complex128]:
        """Where a motion has it [m], (T,)."""
        place = motion.points[self.point].position
        return np.asarray(place[:, 0] + 1j * place[:, 1])

    def off(self, motion: Motion) -> Array:
        """How far a motion is from it [m], (T,)."""
        way = motion.points[self.point].position - (self.place.real, self.place.imag)
        return np.asarray(np.hypot(way[:, 0], way[:, 1]))


@dataclass(frozen=True)
class AskedSlide:
    """A slider has a displacement [m]."""

    slider: str
    displacement: float

    def value(self, motion: Motion) -> NDArray[np.complex128]:
        """Where a motion has it [m], (T,)."""
        return motion.sliders[self.slider].displacement.astype(complex)

    def off(self, motion: Motion) -> Array:
        """How far a motion is from it [m], (T,), with its sign."""
        return np.asarray(motion.sliders[self.slider].displacement - self.displacement)


Asked = AskedAngle | AskedPlace | AskedSlide


@dataclass(frozen=True)
class PrecisionPosition:
    """What is asked at an angle of the driver [rad], measured as the scene measures it."""

    driver_rad: float
    asked: tuple[Asked, ...]

    def off(self, motion: Motion, size_m: float) -> Array:
        """The largest distance of a motion from it, (T,): angles in rad, lengths over the size."""
        off = [np.abs(each.off(motion)) / scale_of(each, size_m) for each in self.asked]
        return np.asarray(np.max(off, axis=0))


def scale_of(asked: Asked, size_m: float) -> float:
    """What an error of it is divided by: 1 of an angle."""
    return 1.0 if isinstance(asked, AskedAngle) else size_m


def names_of(positions: Sequence[PrecisionPosition]) -> tuple[list[str], list[str], list[str]]:
    """The links, points and sliders of which anything is asked."""
    every = [each for position in positions for each in position.asked]
    links = dict.fromkeys(each.link for each in every if isinstance(each, AskedAngle))
    points = dict.fromkeys(each.point for each in every if isinstance(each, AskedPlace))
    sliders = dict.fromkeys(each.slider for each in every if isinstance(each, AskedSlide))
    return list(links), list(points), list(sliders)
