"""A crank and a coupler that swing a rocker between two positions of its pin, in equal times.

::

    O2 lies on the extension of the chord B1 B2, half of which the crank is:
                                                                 |B1 B2|
       B1 ------ B2 ------ (A1 -- O2 -- A2)      crank = O2 A =  -------,  coupler = A B = M O2
            M                                                       2

In B1 crank and coupler are stretched, in B2 they lie over each other; half a turn is between them.
With a coupler longer than the crank it is a Grashof crank-rocker wherever the rocker's pivot is, as
r^2 + O2 O4^2 = l^2 + R^2 for the rocker R.

Source: lecture "Tong hop co cau" (synthesis), examples 2, 3 and 5.
"""

from __future__ import annotations

import cmath
import math
from dataclasses import dataclass

from analytic.lectures.synthesis.construction import Circle, Dot, Segment, Step
from models.errors import CrankcheckError

FACTORS = (1.5, 2.0, 3.0, 4.0)
"""Where a task is silent: distances of O2 from the middle of B1 B2, over the crank."""


@dataclass(frozen=True)
class ToAndFro:
    """The crank and the coupler: places [m], lengths [m], the crank's angles in both positions
    [rad]."""

    pivot: complex
    crank_m: float
    coupler_m: float
    angles: tuple[float, float]

    @staticmethod
    def of(first: complex, second: complex, distance_m: float, *, beyond: int) -> ToAndFro:
        """Of the rocker's pin in its two places; the crank's pivot lies ``beyond`` the first (1)
        or the second (2). Raises CrankcheckError where it would lie between them."""
        crank = 0.5 * abs(second - first)
        if not distance_m > crank:
            raise CrankcheckError(
                f"distance_m is {distance_m:g}: the crank's pivot would lie between the rocker "
                f"pin's places, {2.0 * crank:.6g} m apart; take more than {crank:.6g} m"
            )
        near, far = (first, second) if beyond == 1 else (second, first)
        along = (near - far) / abs(near - far)
        pivot = 0.5 * (first + second) + distance_m * along
        folded, stretched = cmath.phase(along), cmath.phase(-along)
        angles = (folded, stretched) if beyond == 1 else (stretched, folded)
        return ToAndFro(pivot, crank, distance_m, angles)

    def pin(self, position: int) -> complex:
        """Where the crank's pin is in a position, 0 or 1."""
        return self.pivot + cmath.rect(self.crank_m, self.angles[position])

    def steps(self, ends: tuple[complex, complex], letters: tuple[str, str, str]) -> list[Step]:
        """The construction; ``letters`` are the crank's pivot, its pin, the rocker's pin."""
        pivot, pin, end = letters
        middle = 0.5 * sum(ends)
        far = max(ends, key=lambda place: abs(place - self.pivot))
        return [
            Step(
                f"the chord {end}1{end}2, and {pivot} on its extension",
                (Segment(far, self.pivot), Dot(self.pivot, pivot, "result", fixed=True)),
            ),
            Step(
                f"half of {end}1{end}2 is the crank: its circle meets the line in {pin}1 and "
                f"{pin}2",
                (
                    Segment(middle, ends[0]),
                    Circle(self.pivot, self.crank_m),
                    Dot(self.pin(0), f"{pin}1", "result"),
                    Dot(self.pin(1), f"{pin}2"),
                ),
            ),
            Step(
                f"{pin}1{end}1 is the coupler",
                (
                    Segment(self.pivot, self.pin(0), "result"),
                    Segment(self.pin(0), ends[0], "result"),
                ),
            ),
        ]


def choices(crank_m: float, asked: float | None) -> list[float]:
    """Distances of the crank's pivot: that which is asked for, or several."""
    return [asked] if asked is not None else [factor * crank_m for factor in FACTORS]


def chord(radius: float, swing_rad: float) -> float:
    """The distance of the two places of a rocker's pin [m]."""
    return 2.0 * radius * math.sin(0.5 * swing_rad)
