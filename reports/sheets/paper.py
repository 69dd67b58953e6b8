"""Paper: its size, and the boxes on it, in millimetres from the lower left corner."""

from __future__ import annotations

import re
from dataclasses import dataclass

from models.errors import CrankcheckError

SIZES = {
    "A5": (210.0, 148.0),
    "A4": (297.0, 210.0),
    "A3": (420.0, 297.0),
    "A2": (594.0, 420.0),
}
LEAST_MM, MOST_MM = (180.0, 120.0), 2000.0
"""What a sheet needs at least, wide and high; and the longest that is taken for paper."""
MM_PER_IN = 25.4


@dataclass(frozen=True)
class Paper:
    """A sheet, wide and high [mm]."""

    width: float
    height: float

    @staticmethod
    def of(text: str) -> Paper:
        """A4 and the like, across, or WIDTHxHEIGHT in mm. Raises CrankcheckError."""
        match = re.fullmatch(r"(\d+(?:\.\d+)?)x(\d+(?:\.\d+)?)", text)
        if text.upper() not in SIZES and match is None:
            raise CrankcheckError(
                f"--paper {text}: no size; use {', '.join(SIZES)}, or WIDTHxHEIGHT in mm, such as "
                "297x210"
            )
        width, height = SIZES.get(text.upper()) or (float(match[1]), float(match[2]))  # type: ignore[index]  # told apart above
        if width < LEAST_MM[0] or height < LEAST_MM[1] or max(width, height) > MOST_MM:
            raise CrankcheckError(
                f"--paper {text}: {width:g} x {height:g} mm; a sheet that can be read needs "
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
