"""Slider-cranks that meet 3, 4 or 5 points of a function: the displacement of the slider.

::

              A                a = O2 A at phi (input), b = A B, e the distance of the slider's line
        a  ./   \\  b           from O2, s the slider's place from the foot of O2. That b keeps its
       ./ phi     \\            length is
     O2 - - - - -   \\
      | e             \\           k1 s cos phi + k2 sin phi + k3 = s^2,
    --+--------------[ B ]--
        ---- s ---->              k1 = 2 a,  k2 = 2 a e,  k3 = b^2 - a^2 - e^2;  e > 0 is above O2.

Source: R. S. Hartenberg and J. Denavit, Kinematic Synthesis of Linkages, chapter 10.
"""

from __future__ import annotations

import cmath
import math
from dataclasses import dataclass

import numpy as np

from analytic.lectures.synthesis.function import generator
from analytic.lectures.synthesis.function.fourbar import Found, over
from models.array import Array


@dataclass(frozen=True)
class SliderCrankGenerator(generator.Generator):
    """Slider-crank in units of the slider's range."""

    @property
    def positive(self) -> SliderCrankGenerator:
        """The slider-crank with a positive crank: both k1 and k2 change their signs."""
        k1, k2, k3 = self.k
        if k1 > 0.0:
            return self
        turned = generator.toggled(self.turned, ("input",))
        return SliderCrankGenerator(
            (-k1, -k2, k3), generator.opposite(self.input_start), self.output_start, turned
        )

    @property
    def lengths(self) -> tuple[float, ...]:
        """Lengths a and b."""
        k1, _, k3 = self.k
        if k1 == 0.0:
            return math.inf, math.inf
        a = 0.5 * k1
        return abs(a), math.sqrt(max(k3 + a**2 + self.offset**2, 0.0))

    @property
    def offset(self) -> float:
        """Distance e of the line above the input's pivot."""
        return self.k[1] / self.k[0]

    def discriminant(self, phi: Array) -> Array:
        k1, k2, k3 = self.k
        return np.asarray((0.5 * k1 * np.cos(phi)) ** 2 + k2 * np.sin(phi) + k3)

    def output(self, phi: Array, sign: float | Array) -> Array:
        root = self.discriminant(phi)
        half = np.sqrt(np.where(root >= 0.0, root, np.nan))
        return np.asarray(0.5 * self.k[0] * np.cos(phi) + sign * half)

    def slopes(self, phi: Array, output: Array) -> Array:
        k1, k2, _ = self.k
        below = 2.0 * output - k1 * np.cos(phi)
        by_phi = k2 * np.cos(phi) - k1 * output * np.sin(phi)
        columns = [output * np.cos(phi), np.sin(phi), np.ones_like(phi), by_phi]
        return np.stack(columns) / below

    def apart(self, asked: Array, output: Array) -> Array:
        return np.asarray(asked - output)


def slider_cranks(
    turns: Array, ways: Array, input_start: float | None = None, output_start: float | None = None
) -> list[generator.Generator]:
    """Return all slider-cranks whose input and slider go through precision points, as `fourbars`;
    ``ways`` and ``output_start`` are displacements of the slider [scales]."""
    if input_start is not None and output_start is not None:
        found = [_of_both(input_start + turns, output_start + ways, input_start, output_start)]
    elif input_start is not None:
        found = _of_input(input_start + turns, ways, input_start)
    elif output_start is not None:
        found = _of_output(turns, output_start + ways, output_start)
    else:
        found = _of_none(turns, ways)
    return [SliderCrankGenerator(*each).positive for each in found if all(np.isfinite(each[0]))]


def _of_both(phi: Array, s: Array, phi0: float, s0: float) -> Found:
    """Solve the equations, linear in k1, k2, k3."""
    x = generator.one_vector(
        np.stack([s * np.cos(phi), np.sin(phi), np.ones_like(phi), -(s**2)], axis=1)
    )
    return over((x[0], x[1], x[2]), x[3]), phi0, s0


def _of_input(phi: Array, ways: Array, phi0: float) -> list[Found]:
    """Solve the equations, linear in k1, k1 s0, k2, k3 - s0^2 and s0."""
    left = [ways * np.cos(phi), np.cos(phi), np.sin(phi), np.ones_like(phi)]
    rows = np.stack([*left, -2.0 * ways, -(ways**2)], axis=1)
    found = []
    for x in generator.vectors_of(rows, lambda x: float(x[1] * x[5] - x[0] * x[4]), 2):
        k1, k2, rest = over((x[0], x[2], x[3]), x[5])
        s0 = over((x[4], 0.0, 0.0), x[5])[0]
        found.append(((k1, k2, rest + s0**2), phi0, s0))
    return found


def _of_output(turns: Array, s: Array, s0: float) -> list[Found]:
    """Solve the equations, linear in k1 (cos, sin) phi0, k2 (sin, cos) phi0 and k3."""
    of_phi = [np.cos(turns), np.sin(turns)]
    left = [s * of_phi[0], -s * of_phi[1], *of_phi, np.ones_like(s)]
    found = []
    for x in generator.vectors_of(
        np.stack([*left, -(s**2)], axis=1), lambda x: float(x[0] * x[2] - x[1] * x[3]), 2
    ):
        first, second = complex(x[0], x[1]), complex(x[3], x[2])
        phi0 = cmath.phase(first)
        along = (second * cmath.exp(-1j * phi0)).real
        found.append((over((abs(first), along, x[4]), x[5]), phi0, s0))
    return found


def _of_none(turns: Array, ways: Array) -> list[Found]:
    """Solve the equations, linear in k1 (cos, sin) phi0, in (k1 s0 + i k2) exp(-i phi0), k3 - s0^2
    and s0: the same s0 in two of them gives a cubic."""
    of_phi = [np.cos(turns), np.sin(turns)]
    left = [ways * of_phi[0], -ways * of_phi[1], *of_phi, np.ones_like(turns)]
    rows = np.stack([*left, -2.0 * ways, -(ways**2)], axis=1)
    found = []
    for x in generator.vectors_of(rows, _belonging, 3):
        first, second = complex(x[0], x[1]), complex(x[2], x[3])
        sign = math.copysign(1.0, x[6])
        k1, s0, rest = over((abs(first), sign * x[5], sign * x[4]), abs(x[6]))
        if 0.0 < k1 < math.inf:
            k2 = (first * second).imag / (x[6] ** 2 * k1)
            found.append(((k1, k2, rest + s0**2), cmath.phase(sign * first), s0))
    return found


def _belonging(x: Array) -> float:
    """Return k1 times k1 s0, from two of the products, less k1^2 times s0."""
    first, second = complex(x[0], x[1]), complex(x[2], x[3])
    return float((first * second).real * x[6] - abs(first) ** 2 * x[5])
