"""Task of function generation: x is mapped onto the input, y onto the output, both linearly."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Literal

import numpy as np

from models.array import Array
from models.errors import CrankcheckError
from models.lectures.formula import parse_formula
from models.scene.tabulated import Tabulated


def chebyshev_spacing(count: int, low: float, high: float) -> Array:
    """Return so many precision points between two ends, in order, (count,).

    They are the roots of Chebyshev's polynomial: the structural error of a function that they
    interpolate by a polynomial is then as even over the range as its next derivative is.

    Source: lecture "Tong hop co cau" (synthesis), "Chebyshev spacing"; R. L. Norton, Design of
    Machinery, section 5.13.
    """
    j = np.arange(1, count + 1, dtype=np.float64)
    middle, half = 0.5 * (low + high), 0.5 * (high - low)
    return np.asarray(middle - half * np.cos((2.0 * j - 1.0) * np.pi / (2.0 * count)))


LOOKS = 2001
"""Samples of a function over its range."""
HALVINGS = 45
"""Halvings of the widest step between two samples, in search of a jump: a root, the steepest
continuous function, rises by 2e-7 of that step over its last part."""
JUMP = 1e-3
"""Rest of the widest step at a jump, over the range of y."""
FLAT = 1e-12
"""Change of a constant function, over the largest value."""


@dataclass(frozen=True)
class GivenFunction:
    """Function by its name; ``at`` gives its values (T,) at x (T,), NaN where it has none. ``rows``
    is the range of x of a table."""

    name: str
    at: Callable[[Array], Array]
    rows: tuple[float, float] | None = None

    @staticmethod
    def of_formula(text: str) -> GivenFunction:
        """Make the function of a text such as ``x^1.6``. Raises CrankcheckError for another."""
        formula = parse_formula(text)
        return GivenFunction(f"y = {formula.text}", formula.at)

    @staticmethod
    def of_table(x: Sequence[float], y: Sequence[float], name: str = "a table") -> GivenFunction:
        """Make the function of rows, with cubics between them that rise and fall as the rows do.
        Raises CrankcheckError for fewer than two rows, places that do not increase, and values that
        are no numbers."""
        places, values = tuple(map(float, x)), tuple(map(float, y))
        if not np.isfinite([*places, *values]).all():
            raise CrankcheckError(f"{name}: the rows of a function have to be finite numbers")
        try:
            table = Tabulated(places, values, "pchip")
        except ValueError as fault:
            raise CrankcheckError(f"{name}: {fault}") from None
        return GivenFunction(name, table.at, (places[0], places[-1]))

    def extremes(self, low: float, high: float) -> tuple[float, float]:
        """Return the least and the largest y between two x. Raises CrankcheckError for an invalid
        range; one on which the function is not defined, jumps or is constant."""
        if not (np.isfinite([low, high]).all() and low < high):
            raise CrankcheckError(
                f"{self.name}: a range of x from {low:g} to {high:g} was requested; give two "
                "numbers, the smaller one first"
            )
        if self.rows is not None and not self.rows[0] <= low < high <= self.rows[1]:
            raise CrankcheckError(
                f"{self.name}: x from {low:g} to {high:g} was requested, and its rows go from "
                f"{self.rows[0]:g} to {self.rows[1]:g}; request a part of them"
            )
        x = np.linspace(low, high, LOOKS)
        y = self._defined(x)
        least, most = float(np.min(y)), float(np.max(y))
        if most - least <= FLAT * float(np.max(np.abs(y))):
            raise CrankcheckError(
                f"{self.name} is constant from x = {low:g} to {high:g}: an output that stands "
                "still needs no mechanism; give a function that changes"
            )
        self._refuse_jump(x, y, most - least)
        return min(least, self._tip(x, y, -1.0)), max(most, self._tip(x, y, 1.0))

    def _defined(self, x: Array) -> Array:
        """Return the values; raises CrankcheckError that names the first x without one."""
        y = self.at(x)
        bad = ~np.isfinite(y)
        if bad.any():
            at = x[int(np.argmax(bad))]
            raise CrankcheckError(
                f"{self.name} is not defined at x = {at:.6g}; give a range without this place"
            )
        return y

    def _refuse_jump(self, x: Array, y: Array, span: float) -> None:
        """Halve the widest step: continuous ones get flat. Raises CrankcheckError at a jump."""
        k = int(np.argmax(np.abs(np.diff(y))))
        ends, values = x[k : k + 2], y[k : k + 2]
        for _ in range(HALVINGS):
            three = np.array([ends[0], ends.mean(), ends[1]])
            along = np.array([values[0], self._defined(three[1:2])[0], values[1]])
            later = int(abs(along[2] - along[1]) > abs(along[1] - along[0]))
            ends, values = three[later : later + 2], along[later : later + 2]
        if abs(values[1] - values[0]) > JUMP * span:
            raise CrankcheckError(
                f"{self.name} jumps at x = {ends[0]:.6g}; give a range in which it is continuous"
            )

    def _tip(self, x: Array, y: Array, sign: float) -> float:
        """Return the largest value, with sign -1 the least, refined about the largest sample."""
        k = int(np.argmax(sign * y))
        low, high = x[max(k - 1, 0)], x[min(k + 1, len(x) - 1)]
        best = sign * y[k]
        for _ in range(4):
            looks = np.linspace(low, high, 65)
            values = sign * self._defined(looks)
            k = int(np.argmax(values))
            best = max(best, values[k])
            low, high = looks[max(k - 1, 0)], looks[min(k + 1, 64)]
        return float(sign * best)


MechanismKind = Literal["fourbar", "slider-crank"]
COUNTS = (3, 4, 5)
"""Possible numbers of precision points: a mechanism has as many free numbers: lengths, starts."""
COINCIDING = 1e-6
"""Distance of coincident precision points, over the range."""


@dataclass(frozen=True)
class FunctionTask:
    """Task of function generation.

    Parameters
    ----------
    function : GivenFunction
        y = f(x).
    x_low, x_high : float
        The range of x.
    input_range_rad, output_range : float
        The ranges of the input and the output over those of x and y: angles [rad], for a slider's
        output a displacement [m]. Negative is clockwise, or back along the line.
    mechanism : "fourbar" or "slider-crank"
        The input of both is a link; the output is a link, or a slider.
    points : int or tuple of float
        Number of precision points, 3 to 5, in Chebyshev's spacing; or their x.
    input_start_rad, output_start : float or None
        The input's angle [rad] at ``x_low``, and the output's [rad], or [m] from the foot of the
        input's pivot on the line, where y is at the end of its range that f(x_low) is nearer to;
        None leaves them open. Five points find both. Four find one, and take one, three take both:
        open ones among those taken are tried on a grid.
    ground_m : float
        The distance of the pivots [m]. A slider-crank has its size by ``output_range``.
    equal_ripple : bool
        Move the points until the error has equal ripples.

    Raises
    ------
    CrankcheckError
        Invalid ranges, points and starts; a function that is not defined, jumps or is constant.
    """

    function: GivenFunction
    x_low: float
    x_high: float
    input_range_rad: float
    output_range: float
    mechanism: MechanismKind = "fourbar"
    points: int | tuple[float, ...] = 3
    input_start_rad: float | None = None
    output_start: float | None = None
    ground_m: float = 1.0
    equal_ripple: bool = False

    def __post_init__(self) -> None:
        if self.mechanism not in ("fourbar", "slider-crank"):
            raise CrankcheckError(
                f"a mechanism {self.mechanism!r} was requested; functions are generated by fourbar "
                "or slider-crank"
            )
        _ = self.y_ends
        self._check_ranges()
        self._check_points()
        self._check_starts()

    @cached_property
    def y_ends(self) -> tuple[float, float]:
        """Ends of y's range: first the one nearer to f(x_low)."""
        least, most = self.function.extremes(self.x_low, self.x_high)
        first = float(self.function.at(np.array([self.x_low]))[0])
        return (least, most) if first - least <= most - first else (most, least)

    @property
    def count(self) -> int:
        """Number of precision points."""
        return self.points if isinstance(self.points, int) else len(self.points)

    @property
    def x_points(self) -> Array:
        """The x of the precision points, in order (n,): the given ones, or Chebyshev's."""
        if isinstance(self.points, int):
            return chebyshev_spacing(self.points, self.x_low, self.x_high)
        return np.array(sorted(self.points), dtype=np.float64)

    @property
    def y_scale(self) -> float:
        """Change of y per rad, or m, of the output."""
        first, last = self.y_ends
        return (last - first) / self.output_range

    def input_turn(self, x: Array) -> Array:
        """Return the angle of the input from its start [rad], (T,)."""
        return np.asarray(self.input_range_rad * (x - self.x_low) / (self.x_high - self.x_low))

    def output_way(self, x: Array) -> Array:
        """Return the required output, from its start [rad or m], (T,)."""
        return np.asarray((self.function.at(x) - self.y_ends[0]) / self.y_scale)

    @property
    def scale_m(self) -> float:
        """Unit of a generator's lengths: the ground, for a slider-crank the slider's range [m]."""
        return self.ground_m if self.mechanism == "fourbar" else abs(self.output_range)

    @property
    def output_scale(self) -> float:
        """Unit of a generator's output: 1 rad, for a slider `scale_m`."""
        return 1.0 if self.mechanism == "fourbar" else self.scale_m

    def output_scales(self, x: Array) -> Array:
        """Return `output_way` in the units of generators [rad or scales], (T,)."""
        return self.output_way(x) / self.output_scale

    def _check_ranges(self) -> None:
        slides = self.mechanism == "slider-crank"
        angles = {"input": self.input_range_rad} | ({} if slides else {"output": self.output_range})
        for name, angle in angles.items():
            if not 0.0 < abs(angle) <= math.tau:
                raise CrankcheckError(
                    f"an {name} range of {math.degrees(angle):g} deg was requested; give one of up "
                    "to 360 deg, negative for clockwise"
                )
        lengths = {"slider's range": abs(self.output_range)} if slides else {}
        for name, length in (lengths | {"ground length": self.ground_m}).items():
            if not 0.0 < length < math.inf:
                raise CrankcheckError(f"a {name} of {length:g} m was requested; give a length > 0")

    def _check_points(self) -> None:
        if self.count not in COUNTS:
            raise CrankcheckError(
                f"{self.count} precision points were requested; Freudenstein's equation meets 3, 4 "
                "or 5 of them"
            )
        if self.equal_ripple and not isinstance(self.points, int):
            raise CrankcheckError(
                "equal ripples were requested with given precision points; they find their own: "
                "give the number of points, or leave out the equal ripples"
            )
        x = self.x_points
        outside = x[~((x >= self.x_low) & (x <= self.x_high))]
        if outside.size:
            raise CrankcheckError(
                f"a precision point at x = {outside[0]:g} was requested, outside of the range "
                f"{self.x_low:g} to {self.x_high:g}; give points within it"
            )
        self._refuse_coinciding(x)

    def _refuse_coinciding(self, x: Array) -> None:
        near = np.flatnonzero(np.diff(x) <= COINCIDING * (self.x_high - self.x_low))
        if near.size:
            raise CrankcheckError(
                f"precision points {near[0] + 1} and {near[0] + 2} coincide at x = "
                f"{x[near[0]]:g}; give points that differ"
            )
        if math.tau - np.ptp(self.input_turn(x)) <= COINCIDING:
            raise CrankcheckError(
                "the first and the last precision point coincide, a whole turn of the input apart; "
                "give a smaller input range, or points that differ"
            )

    def _check_starts(self) -> None:
        starts = {"input": self.input_start_rad, "output": self.output_start}
        given = [name for name, start in starts.items() if start is not None]
        for name in given:
            if not math.isfinite(starts[name] or 0.0):
                raise CrankcheckError(f"an {name} start of {starts[name]} was requested, no number")
        most = len(starts) - (self.count - min(COUNTS))
        if len(given) > most:
            leave = "both open" if most == 0 else "one of them open"
            raise CrankcheckError(
                f"{self.count} precision points were requested with the start of the "
                f"{' and of the '.join(given)} given; so many points determine it: leave "
                f"{leave}, or use {len(COUNTS) + 2 - len(given)} points"
            )
