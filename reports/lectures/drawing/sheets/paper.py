"""Paper: its size, and the boxes on it, in millimetres from the lower left corner."""

from __future__ import annotations

import re
from dataclasses import dataclass

import numpy as np

from analytic.lectures.drawings.paper_scale import round_scale
from models.array import Array
from models.errors import CrankcheckError

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
