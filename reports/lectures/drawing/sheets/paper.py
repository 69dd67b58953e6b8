"""Paper: its size, and the boxes on it, in millimetres from the lower left corner.

Source: lecture "Phan tich dong hoc": K is the real value over the length drawn in mm, and is taken
from 1, 2, 5 times a power of ten. The problem book takes the one that gives the vector of the
crank's pin a length of k times the drawn crank, p b = k AB.
"""

from __future__ import annotations

import math
import re
from dataclasses import dataclass

import numpy as np

from models.array import Array
from models.errors import CrankcheckError
from models.scene import Scene
from reports.output.provenance import crankcheck_version

STEPS = (1.0, 2.0, 5.0)
ROUNDING = 1e-9
"""By what a size may pass the room and fit still."""


def round_scale(size: float, room_mm: float) -> float:
    """The finest round scale [unit/mm] at which a size [unit] fits into a room [mm].

    Raises ValueError for a size or a room that is not above 0.
    """
    if not (0.0 < size < math.inf and 0.0 < room_mm < math.inf):
        raise ValueError(f"size {size!r} in {room_mm!r} mm: a scale needs both above 0")
    least = size / room_mm
    power = 10.0 ** math.floor(math.log10(least))
    tried = [step * power for step in (*STEPS, 10.0)]
    return next(scale for scale in tried if scale * (1.0 + ROUNDING) >= least)


def book_scales(length_scale: float, omega: float, k: float) -> tuple[float, float]:
    """The scales of velocities [m/s/mm] and accelerations [m/s^2/mm] of the problem book.

    With a scale of lengths [m/mm], a crank of constant ``omega`` [rad/s] and a wanted ``k``, the
    vectors of the crank's pin are k times as long as the crank is drawn.
    """
    rate = abs(omega)
    return rate * length_scale / k, rate * rate * length_scale / k


SIZES = {
    "A5": (210.0, 148.0),
    "A4": (297.0, 210.0),
    "A3": (420.0, 297.0),
    "A2": (594.0, 420.0),
}
LEAST_MM, MOST_MM = (180.0, 120.0), 2000.0
"""What a sheet needs at least, wide and high; and the longest that is taken for paper."""
ECHO = 20
"""So many letters of a size that is none are told."""
MM_PER_IN = 25.4


@dataclass(frozen=True)
class Paper:
    """A sheet, wide and high [mm]."""

    width: float
    height: float

    @staticmethod
    def of(text: str) -> Paper:
        """A4 and the like, across, or WIDTHxHEIGHT in mm. Raises CrankcheckError."""
        told = text if len(text) <= ECHO else f"{text[:ECHO]}..."
        match = re.fullmatch(r"(\d+(?:\.\d+)?)x(\d+(?:\.\d+)?)", text)
        if text.upper() not in SIZES and match is None:
            raise CrankcheckError(
                f"--paper {told}: no size; use {', '.join(SIZES)}, or WIDTHxHEIGHT in mm, such as "
                "297x210"
            )
        width, height = SIZES.get(text.upper()) or (float(match[1]), float(match[2]))  # type: ignore[index]  # told apart above
        if width < LEAST_MM[0] or height < LEAST_MM[1] or max(width, height) > MOST_MM:
            raise CrankcheckError(
                f"--paper {told}: {width:g} x {height:g} mm; a sheet that can be read needs "
                f"{LEAST_MM[0]:g} x {LEAST_MM[1]:g} mm or more, and at most {MOST_MM:g} mm"
            )
        return Paper(width, height)


@dataclass(frozen=True)
class Box:
    """A part of the sheet: its lower left corner, width and height [mm]."""

    left: float
    bottom: float
    width: float
    height: float

    @property
    def middle(self) -> tuple[float, float]:
        return self.left + self.width / 2, self.bottom + self.height / 2

    @property
    def corners(self) -> tuple[Array, Array]:
        """The lower left and the upper right one [mm]."""
        low = np.array([self.left, self.bottom])
        return low, low + np.array([self.width, self.height])

    def fitted(self, places: Array, padding: float) -> tuple[float, Array]:
        """The finest round scale [unit/mm] at which places (n, 2) have so much room around them
        [mm] in the box, 1 of places that are one; and the middle of them (2,)."""
        low, high = places.min(axis=0), places.max(axis=0)
        room = np.array([self.width, self.height]) - 2 * padding
        scales = [round_scale(s, r) for s, r in zip(high - low, room, strict=True) if s > 0.0]
        return max(scales, default=1.0), (low + high) / 2


def sheet_note(scene: Scene) -> str:
    """Who drew it, and where the mechanism comes from."""
    return f"crankcheck {crankcheck_version()}, closed form; {scene.source}"


def of_elastic(scene: Scene, words: str) -> str:
    """What is said of a scene that has elastic links, of which sheets know none."""
    return words if scene.elastic else ""
