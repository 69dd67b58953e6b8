r"""Four-bars (Freudenstein's equation) and slider-cranks that meet 3, 4 or 5 points of a function.

Four-bars::

               B            a = O2 A at phi (input), b = A B, c = O4 B at psi (output), d = O2 O4.
         b  ./  \           That b keeps its length is
       A ./      \ c
      a /         \  psi        k1 cos psi - k2 cos phi + k3 = cos(phi - psi),
       /phi        \
     O2 ----- d ----O4      k1 = d/a,  k2 = d/c,  k3 = (a^2 - b^2 + c^2 + d^2)/(2 a c).

Source: F. Freudenstein, Approximate synthesis of four-bar linkages, Transactions of the ASME 77
(1955), pages 853 to 861; R. S. Hartenberg and J. Denavit, Kinematic Synthesis of Linkages, chapter
10.

Slider-cranks::

              A                a = O2 A at phi (input), b = A B, e the distance of the slider's line
        a  ./   \  b           from O2, s the slider's place from the foot of O2. That b keeps its
       ./ phi     \            length is
     O2 - - - - -   \
      | e             \           k1 s cos phi + k2 sin phi + k3 = s^2,
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
from models.array import Array

NOTHING = 1e-14
"""Length of a vanishing end of a vector, over the vector: lengths over it are infinite."""
Numbers = tuple[float, float, float]
Found = tuple[Numbers, float, float]
"""k1, k2, k3 with their signs, and the starts of input and output [rad]."""


@dataclass(frozen=True)
class FourBarGenerator(generator.Generator):
    """Four-bar in units of its ground d."""

    @property
    def positive(self) -> FourBarGenerator:
        """The four-bar with positive lengths: k3 changes its sign with that of either length."""
        k1, k2, k3 = self.k
        return FourBarGenerator(
            (abs(k1), abs(k2), k3 if k1 * k2 > 0.0 else -k3),
            generator.opposite(self.input_start) if k1 < 0.0 else self.input_start,
            generator.opposite(self.output_start) if k2 < 0.0 else self.output_start,
            generator.toggled(self.turned, ("input",) * (k1 < 0.0) + ("output",) * (k2 < 0.0)),
        )

    @property
    def lengths(self) -> tuple[float, ...]:
        """Lengths a, b and c."""
        k1, k2, k3 = self.k
        if k1 == 0.0 or k2 == 0.0:
            return math.inf, math.inf, math.inf
        a, c = 1.0 / k1, 1.0 / k2
        return abs(a), math.sqrt(max(a**2 + c**2 + 1.0 - 2.0 * a * c * k3, 0.0)), abs(c)

    def _sides(self, phi: Array) -> tuple[Array, Array, Array]:
        """Return p, q, r of p cos psi + q sin psi = r."""
        k1, k2, k3 = self.k
        return k1 - np.cos(phi), -np.sin(phi), k2 * np.cos(phi) - k3

    def discriminant(self, phi: Array) -> Array:
        p, q, r = self._sides(phi)
        return np.asarray(p**2 + q**2 - r**2)

    def output(self, phi: Array, sign: float | Array) -> Array:
        p, q, r = self._sides(phi)
        root = self.discriminant(phi)
        half = np.arctan2(np.sqrt(np.where(root >= 0.0, root, np.nan)), r)
        return np.asarray(np.arctan2(q, p) + sign * half)

    def slopes(self, phi: Array, output: Array) -> Array:
        p, q, _ = self._sides(phi)
        over = p * np.sin(output) - q * np.cos(output)  # less the derivative by psi
        by_phi = np.sin(phi - output) + self.k[1] * np.sin(phi)
        with np.errstate(divide="ignore", invalid="ignore"):  # in a dead point there are none
            return np.stack([np.cos(output), -np.cos(phi), np.ones_like(phi), by_phi]) / over

    def apart(self, asked: Array, output: Array) -> Array:
        off = asked - output
        return np.asarray(off - math.tau * np.round(off / math.tau))


def fourbars(
    turns: Array, ways: Array, input_start: float | None = None, output_start: float | None = None
) -> list[generator.Generator]:
    """Return all four-bars whose input and output go through precision points.

    Parameters
    ----------
    turns, ways : Array
        The angles of input and output from their starts [rad], (n,).
    input_start, output_start : float or None
        The starts [rad]: both for three points, one for four, none for five; the others are found.

    Returns
    -------
    list of Generator
        At most one for three points, two for four, three for five; none with an infinite length, or
        without one. Only turns of given starts are noted.

    Raises
    ------
    CrankcheckError
        Points that a whole family of four-bars meets.
    """
    if input_start is not None and output_start is not None:
        found = [_of_both(turns, ways, input_start, output_start)]
    elif input_start is not None:
        found = _of_input(turns, ways, input_start)
    elif output_start is not None:
        found = _of_output(turns, ways, output_start)
    else:
        found = _of_none(turns, ways)
    return [FourBarGenerator(*each).positive for each in found if all(np.isfinite(each[0]))]


def _of_both(turns: Array, ways: Array, phi0: float, psi0: float) -> Found:
    """Solve the equations, linear in k1, k2, k3."""
    phi, psi = phi0 + turns, psi0 + ways
    rows = np.stack([np.cos(psi), -np.cos(phi), np.ones_like(phi), -np.cos(phi - psi)], axis=1)
    x = generator.one_vector(rows)
    return over((x[0], x[1], x[2]), x[3]), phi0, psi0


def _of_input(turns: Array, ways: Array, phi0: float) -> list[Found]:
    """Solve the equations, linear in k1 (cos, sin) psi0, k2, k3 and (cos, sin) psi0."""
    phi = phi0 + turns
    left = [np.cos(ways), -np.sin(ways), -np.cos(phi), np.ones_like(phi)]
    rows = np.stack([*left, -np.cos(phi - ways), -np.sin(phi - ways)], axis=1)
    every = generator.vectors_of(rows, lambda x: float(x[0] * x[5] - x[1] * x[4]), 2)
    found = []
    for x in every:
        psi0, size = math.atan2(x[5], x[4]), math.hypot(x[5], x[4])
        k1 = x[0] * math.cos(psi0) + x[1] * math.sin(psi0)
        found.append((over((k1, x[2], x[3]), size), phi0, psi0))
    return found


def _of_output(turns: Array, ways: Array, psi0: float) -> list[Found]:
    """Solve from the other side: the output half a turn on is the input of the same equation, and
    k1 and k2 change their places."""
    changed = _of_input(ways, turns, generator.opposite(psi0))
    return [((k2, k1, k3), generator.opposite(phi0), psi0) for (k1, k2, k3), _, phi0 in changed]


def _of_none(turns: Array, ways: Array) -> list[Found]:
    """Solve the equations, linear in k1 (cos, sin) psi0, k2 (cos, sin) phi0, k3 and (cos, sin)(phi0
    - psi0): the relation of these angles is a cubic."""
    left = [np.cos(ways), -np.sin(ways), -np.cos(turns), np.sin(turns), np.ones_like(turns)]
    rows = np.stack([*left, -np.cos(turns - ways), np.sin(turns - ways)], axis=1)
    found = []
    for x in generator.vectors_of(rows, _belonging, 3):
        of_psi, of_phi, between = _ends(x)
        # The sign of the vector with which both lengths are positive.
        sign = math.copysign(1.0, (of_phi * (of_psi * between).conjugate()).real)
        k = over((abs(of_psi), abs(of_phi), sign * x[4]), abs(between))
        found.append((k, cmath.phase(sign * of_phi), cmath.phase(sign * of_psi)))
    return found


def _belonging(x: Array) -> float:
    """Return the sine of the angle between two directions that are one, times three sizes."""
    of_psi, of_phi, between = _ends(x)
    return (of_phi * (of_psi * between).conjugate()).imag


def _ends(x: Array) -> tuple[complex, complex, complex]:
    """Return k1 exp(i psi0), k2 exp(i phi0) and exp(i (phi0 - psi0)), times one number."""
    return complex(x[0], x[1]), complex(x[2], x[3]), complex(x[5], x[6])


def over(k: Numbers, size: float) -> Numbers:
    """Return numbers over one that may be zero: then they are infinite."""
    if abs(size) <= NOTHING * max(map(abs, k)):
        return math.inf, math.inf, math.inf
    k1, k2, k3 = (float(each / size) for each in k)
    return k1, k2, k3


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
        found = [
            _slider_of_both(input_start + turns, output_start + ways, input_start, output_start)
        ]
    elif input_start is not None:
        found = _slider_of_input(input_start + turns, ways, input_start)
    elif output_start is not None:
        found = _slider_of_output(turns, output_start + ways, output_start)
    else:
        found = _slider_of_none(turns, ways)
    return [SliderCrankGenerator(*each).positive for each in found if all(np.isfinite(each[0]))]


def _slider_of_both(phi: Array, s: Array, phi0: float, s0: float) -> Found:
    """Solve the equations, linear in k1, k2, k3."""
    x = generator.one_vector(
        np.stack([s * np.cos(phi), np.sin(phi), np.ones_like(phi), -(s**2)], axis=1)
    )
    return over((x[0], x[1], x[2]), x[3]), phi0, s0


def _slider_of_input(phi: Array, ways: Array, phi0: float) -> list[Found]:
    """Solve the equations, linear in k1, k1 s0, k2, k3 - s0^2 and s0."""
    left = [ways * np.cos(phi), np.cos(phi), np.sin(phi), np.ones_like(phi)]
    rows = np.stack([*left, -2.0 * ways, -(ways**2)], axis=1)
    found = []
    for x in generator.vectors_of(rows, lambda x: float(x[1] * x[5] - x[0] * x[4]), 2):
        k1, k2, rest = over((x[0], x[2], x[3]), x[5])
        s0 = over((x[4], 0.0, 0.0), x[5])[0]
        found.append(((k1, k2, rest + s0**2), phi0, s0))
    return found


def _slider_of_output(turns: Array, s: Array, s0: float) -> list[Found]:
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


def _slider_of_none(turns: Array, ways: Array) -> list[Found]:
    """Solve the equations, linear in k1 (cos, sin) phi0, in (k1 s0 + i k2) exp(-i phi0), k3 - s0^2
    and s0: the same s0 in two of them gives a cubic."""
    of_phi = [np.cos(turns), np.sin(turns)]
    left = [ways * of_phi[0], -ways * of_phi[1], *of_phi, np.ones_like(turns)]
    rows = np.stack([*left, -2.0 * ways, -(ways**2)], axis=1)
    found = []
    for x in generator.vectors_of(rows, _slider_offset, 3):
        first, second = complex(x[0], x[1]), complex(x[2], x[3])
        sign = math.copysign(1.0, x[6])
        k1, s0, rest = over((abs(first), sign * x[5], sign * x[4]), abs(x[6]))
        if 0.0 < k1 < math.inf:
            k2 = (first * second).imag / (x[6] ** 2 * k1)
            found.append(((k1, k2, rest + s0**2), cmath.phase(sign * first), s0))
    return found


def _slider_offset(x: Array) -> float:
    """Return k1 times k1 s0, from two of the products, less k1^2 times s0."""
    first, second = complex(x[0], x[1]), complex(x[2], x[3])
    return float((first * second).real * x[6] - abs(first) ** 2 * x[5])
