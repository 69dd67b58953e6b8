"""Laws of motion of a cam: lift of its follower over the cam's angle, with three derivatives.

A law is a list of segments over one turn: rises, dwells, returns. All kinds are pieces of one form,
a polynomial and a sine about the middle of the piece, so that values are exact to rounding at both
ends, and limits from either side of a knot are at hand.

Source: R. L. Norton, Design of Machinery, 5th ed. 2012, ch. 8 (kinds, and peak factors: table 8-3).
"""

from __future__ import annotations

import math
from bisect import bisect_right
from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from models.array import Array

SLACK = 1e-9
"""Rounding in the sum of spans over a turn, of lifts over the stroke, in a jump over its peak."""
PI, MOST_TERMS = math.pi, 8


class CamLift(NamedTuple):
    """Lift [m or rad] and its first three derivatives by the cam's angle [1/rad each], (T,)."""

    value: Array
    first: Array
    second: Array
    third: Array


class Jump(NamedTuple):
    """Knot [rad] of a law, and by how much lift and its three derivatives by the cam's angle change
    there: 0 where continuous."""

    angle_rad: float
    lift: float
    velocity: float
    acceleration: float
    jerk: float


class _Piece(NamedTuple):
    """y = sum of c_k t^k + size sin(rate t + phase), t from -1 at ``start`` to 1 at the end."""

    start: float
    coefficients: tuple[float, ...]
    size: float = 0.0
    rate: float = 0.0
    phase: float = 0.0


@dataclass(frozen=True)
class CamSegment:
    """A rise, dwell or return: its kind, span [rad], and change of lift [m or rad].

    A table lists ``points`` (angle, lift) from the segment's start, (0, 0), to its end. The spline
    of degree ``order`` through them is periodic over a whole turn; otherwise its first (order - 1)
    / 2 derivatives are 0 at both ends, as dwells beside it need. Raises ValueError.
    """

    kind: str
    span_rad: float
    lift: float = 0.0
    points: tuple[tuple[float, float], ...] = ()
    order: int = 5

    def __post_init__(self) -> None:
        if self.kind not in KINDS:
            raise ValueError(f"no kind of motion {self.kind!r:.60}; there are {', '.join(KINDS)}")
        if not (math.isfinite(self.lift) and 0.0 < self.span_rad < math.inf):
            raise ValueError(
                f"found a {self.kind} of span {self.span_rad!r:.60} rad and lift "
                f"{self.lift!r:.60}; give a span above 0 and finite numbers"
            )
        if self.kind != "table" and (self.kind == "dwell") != (self.lift == 0.0):
            raise ValueError(f"lift of a {self.kind}: {self.lift:g}; 0 is a dwell, others are not")
        if (self.kind == "table") != bool(self.points):
            raise ValueError(f"found {len(self.points)} points of a {self.kind}; a table has them")
        if self.points:
            self._check_table()

    def _check_table(self) -> None:
        if self.order not in (1, 3, 5, 7):  # degrees of splines whose knots are the rows
            raise ValueError(f"order of a table: {self.order}; there are 1, 3, 5, 7")
        rows = np.array(self.points, dtype=np.float64)
        # A periodic spline of degree k needs k + 1 points besides the repeated one.
        need = self.order + 2 if self.is_whole_turn and self.order > 1 else 2
        if len(rows) < need or not (np.isfinite(rows).all() and np.diff(rows[:, 0]).min() > 0.0):
            raise ValueError(
                f"found {len(rows)} points; a table of order {self.order} over "
                f"{math.degrees(self.span_rad):.6g} deg has {need} or more, finite, and their "
                "angles increase"
            )
        ends = np.array([(0.0, 0.0), (self.span_rad, self.lift)])
        if (np.abs(rows[[0, -1]] - ends) > SLACK * np.abs(rows).max(axis=0)).any():
            raise ValueError(
                f"found a table from {self.points[0]} to {self.points[-1]}; it begins in (0, 0) "
                f"and ends at its span and lift, ({self.span_rad:g}, {self.lift:g})"
            )

    @property
    def is_whole_turn(self) -> bool:
        return self.span_rad > math.tau * (1.0 - SLACK)


def _spline(table: CamSegment) -> list[_Piece]:
    """The spline of a table as Taylor polynomials about the middles between its points."""
    from scipy.interpolate import make_interp_spline  # type: ignore[import-untyped]  # no stubs

    share, lift = np.array(table.points).T
    share, k = share / share[-1], table.order
    conditions: object = [(order, 0.0) for order in range(1, (k + 1) // 2)]
    conditions = (conditions, conditions) if k > 1 else None
    if table.is_whole_turn and k > 1:
        lift, conditions = np.append(lift[:-1], lift[0]), "periodic"
    spline = make_interp_spline(share, lift, k, bc_type=conditions)
    middle, half = 0.5 * (share[1:] + share[:-1]), 0.5 * np.diff(share)
    terms = np.array([spline(middle, n) * half**n / math.factorial(n) for n in range(k + 1)]).T
    return [_Piece(a, tuple(c)) for a, c in zip(share[:-1].tolist(), terms.tolist(), strict=True)]


def _integrated(*parts: tuple[float, float, float, float]) -> list[_Piece]:
    """Return the pieces of a law by its acceleration, from rest at 0: each part has its end, the
    acceleration's size, rate and phase, size sin(rate (u - start) + phase); rate 0: constant."""
    found, start, lift, speed = [], 0.0, 0.0, 0.0
    for end, size, rate, phase in parts:
        w = 0.5 * (end - start)
        a, b, f = (size, 0.0, 0.0) if rate == 0.0 else (0.0, -size / rate**2, rate * w)
        # Speed and lift of the polynomial at the middle, such that the whole continues the last.
        middle_speed = speed + a * w - (b / w * f * math.cos(phase) if f else 0.0)
        middle_lift = lift + middle_speed * w - 0.5 * a * w**2 - b * math.sin(phase)
        terms = (middle_lift, middle_speed * w, 0.5 * a * w**2)
        found.append(_Piece(start, terms, b, f, phase + f))
        lift = sum(terms) + b * math.sin(phase + 2.0 * f)
        speed = middle_speed + a * w + (b / w * f * math.cos(phase + 2.0 * f) if f else 0.0)
        start = end
    return found


TRAPEZOID, SINE = 8.0 * PI / (PI + 2.0), 4.0 * PI**2 / (PI + 4.0)
"""Peaks of acceleration of the two modified laws."""
UNIT: Mapping[str, list[_Piece]] = {
    "dwell": [_Piece(0.0, (0.0,))],
    "uniform": [_Piece(0.0, (0.5, 0.5))],
    "parabolic": _integrated((0.5, 4.0, 0.0, 0.0), (1.0, -4.0, 0.0, 0.0)),
    "harmonic": [_Piece(0.0, (0.5,), 0.5, PI / 2)],
    "cycloidal": [_Piece(0.0, (0.5, 0.5), 0.5 / PI, PI)],
    # dy/dt = 15/16 (1 - t^2)^2 and 35/32 (1 - t^2)^3: odd about the middle.
    "3-4-5": [_Piece(0.0, (0.5, 15 / 16, 0.0, -10 / 16, 0.0, 3 / 16))],
    "4-5-6-7": [_Piece(0.0, (0.5, 35 / 32, 0.0, -35 / 32, 0.0, 21 / 32, 0.0, -5 / 32))],
    # Sines of a quarter wave over 1/8 of the span each, constant parts of 1/4 between them.
    "modified-trapezoid": _integrated(
        (1 / 8, TRAPEZOID, 4.0 * PI, 0.0),
        (3 / 8, TRAPEZOID, 0.0, 0.0),
        (5 / 8, TRAPEZOID, 4.0 * PI, PI / 2),
        (7 / 8, -TRAPEZOID, 0.0, 0.0),
        (1.0, -TRAPEZOID, 4.0 * PI, PI / 2),
    ),
    # Quarter waves over 1/8 of the span at both ends, half a slow wave between them.
    "modified-sine": _integrated(
        (1 / 8, SINE, 4.0 * PI, 0.0),
        (7 / 8, SINE, 4.0 * PI / 3, PI / 2),
        (1.0, -SINE, 4.0 * PI, PI / 2),
    ),
}
"""Rises of unit lift over unit span."""
KINDS = (*UNIT, "table")


def _rates(t: Any, of: Any, terms: Any, size: Any, rate: Any, phase: Any, half: Any) -> Any:
    """Return lift and three derivatives in a piece or, as arrays (T,), in several."""
    angle = rate * t + phase
    sine, cosine = size * of.sin(angle), size * of.cos(angle)
    value = first = second = third = 0.0 * t
    for c in terms[::-1]:  # Horner's scheme for all Taylor terms at once
        third, second = third * t + second, second * t + first
        first, value = first * t + value, value * t + c
    return (
        value + sine,
        (first + rate * cosine) / half,
        (2.0 * second - rate**2 * sine) / half**2,
        (6.0 * third - rate**3 * cosine) / half**3,
    )


@dataclass(frozen=True)
class CamLaw:
    """Segments in their order over a turn of the cam, counted from angle 0.

    The lift is 0 in the lowest knot between two segments. Raises ValueError for spans that are not
    a turn together, and for lifts that do not sum to 0.
    """

    segments: tuple[CamSegment, ...]

    def __post_init__(self) -> None:
        turn = math.fsum(one.span_rad for one in self.segments)
        if not abs(turn - math.tau) <= SLACK * math.tau:
            off = math.degrees(turn - math.tau)
            raise ValueError(
                f"the spans of {len(self.segments)} segments are {math.degrees(turn):.9g} deg, "
                f"{abs(off):.6g} {'over' if off > 0.0 else 'short of'} 360; make them one turn"
            )
        left = math.fsum(one.lift for one in self.segments)
        if not abs(left) <= SLACK * max(abs(one.lift) for one in self.segments):
            raise ValueError(
                f"the law does not close: after a turn its lift is {left:.6g} from where it began; "
                "give rises and returns that sum to 0"
            )

    def __reduce__(self) -> tuple[type[CamLaw], tuple[tuple[CamSegment, ...]]]:
        return CamLaw, (self.segments,)  # without what is computed from it

    def scaled(self, factor: float) -> CamLaw:
        """Return the law with every lift times a factor."""
        grown = []
        for one in self.segments:
            points = tuple((angle, factor * lift) for angle, lift in one.points)
            grown.append(replace(one, lift=factor * one.lift, points=points))
        return CamLaw(tuple(grown))

    @cached_property  # once for all evaluations
    def _pieces(self) -> tuple[Array, Array]:
        """Ends (n + 1,) [rad] of the pieces; coefficients, sines, half widths (12, n) of each."""
        spans = np.array([one.span_rad for one in self.segments])
        angles = np.append(0.0, np.cumsum(spans)) * (math.tau / math.fsum(spans))
        lifts = np.append(0.0, np.cumsum([one.lift for one in self.segments[:-1]]))
        lifts -= lifts.min()
        ends, rows = [], []
        for k, each in enumerate(self.segments):
            table, span = each.kind == "table", angles[k + 1] - angles[k]
            lift = 1.0 if table else each.lift
            for one in _spline(each) if table else UNIT[each.kind]:
                ends.append(angles[k] + span * one.start)
                terms = one.coefficients + (0.0,) * (MOST_TERMS - len(one.coefficients))
                first, *others = (lift * c for c in (*terms, one.size))
                rows.append((lifts[k] + first, *others, one.rate, one.phase))
        ends.append(math.tau)
        half = 0.5 * np.diff(ends)
        return np.array(ends), np.array([*np.array(rows).T, half])

    @cached_property
    def _rows(self) -> tuple[list[float], list[tuple[Any, ...]]]:
        """The same as plain numbers, a row each piece: an array's are read ten times as slowly."""
        ends, pieces = self._pieces
        return ends.tolist(), [(row[:-4], *row[-4:]) for row in pieces.T.tolist()]

    def at(self, phi: Array) -> CamLift:
        """Return lift and derivatives at angles (T,) [rad] of any turn; in a knot those after it.
        Accurate to rounding of the stroke, over the span to the power of the derivative."""
        ends, (*_, half) = self._pieces
        folded = np.mod(np.asarray(phi, dtype=np.float64), math.tau)
        k = np.clip(np.searchsorted(ends, folded, side="right") - 1, 0, len(half) - 1)
        return self._in(k, np.clip((folded - ends[k]) / half[k] - 1.0, -1.0, 1.0))

    def at_one(self, phi: float) -> tuple[float, ...]:
        """Return `at` for one angle [rad], within rounding: engines call it at every step."""
        ends, rows = self._rows
        folded = phi % math.tau
        k = min(bisect_right(ends, folded), len(rows)) - 1
        t = min((folded - ends[k]) / rows[k][-1] - 1.0, 1.0)
        return tuple(_rates(t, math, *rows[k]))

    def _in(self, k: NDArray[np.intp], t: Array) -> CamLift:
        """Lift and derivatives in pieces ``k`` at their own ``t``, between -1 and 1."""
        pieces = self._pieces[1][:, k]
        return CamLift(*_rates(t, np, pieces[:-4], *pieces[-4:]))

    @property
    def knots_rad(self) -> tuple[float, ...]:
        """Angles at which the formula changes, from 0 to a turn."""
        return tuple(self._pieces[0].tolist())

    @cached_property
    def jumps(self) -> tuple[Jump, ...]:
        """Knots at which lift, velocity, acceleration or jerk jump, and by how much."""
        ends, (*terms, _, _, _, half) = self._pieces
        count, size = np.arange(len(half)), np.abs(terms).max()
        ending, beginning = (self._in(count, np.full(len(half), t)) for t in (1.0, -1.0))
        steps = []
        for order, (end, begin) in enumerate(zip(ending, beginning, strict=True)):
            step = begin - np.roll(end, 1)
            rounding = 64 * np.finfo(float).eps * size / np.minimum(half, np.roll(half, 1)) ** order
            largest = max(map(abs, self.extremes[order]))
            steps.append(np.where(np.abs(step) > np.maximum(SLACK * largest, rounding), step, 0.0))
        rows = np.array([ends[:-1], *steps]).T.tolist()
        return tuple(Jump(*row) for row in rows if any(row[1:]))

    @property
    def continuous(self) -> int:
        """Number of the derivatives without a jump, in their order: 3 to the jerk, -1 for none."""
        return min((k for one in self.jumps for k in range(4) if one[1 + k]), default=4) - 1

    @cached_property  # bounds need them at every solution
    def extremes(self) -> tuple[tuple[float, float], ...]:
        """Least and largest value of the lift and of each derivative, exactly."""
        return tuple(map(self._extremes_of, range(4)))

    def _extremes_of(self, order: int) -> tuple[float, float]:
        found = []
        for k, (terms, size, rate, phase, _) in enumerate(self._rows[1]):
            turning = [-1.0, 1.0]
            if size == 0.0:
                slope = np.polynomial.Polynomial(terms).deriv(order + 1)
                roots = slope.trim().roots() if np.any(slope.coef) else np.zeros(0)
                turning += [r.real for r in np.atleast_1d(roots) if abs(r.imag) < 1e-7]
            else:  # the sine's own; the polynomial beside it is straight, but in lift and velocity
                quarter = 0.5 * PI * (order + 1)
                waves = range(math.floor(-rate / PI) - 4, math.ceil(rate / PI) + 5)
                turning += [(n * PI - phase - quarter) / rate for n in waves]
            inside = np.array([t for t in turning if abs(t) <= 1.0])
            found.append(self._in(np.full(len(inside), k), inside)[order])
        return float(min(map(np.min, found))), float(max(map(np.max, found)))

    @property
    def fourth_at_most(self) -> float:
        """Bound of the fourth derivative by the cam's angle."""
        *terms, size, rate, _, half = np.abs(self._pieces[1])
        steep = sum(math.perm(k, 4) * c for k, c in enumerate(terms)) + size * rate**4
        return float(np.max(steep / half**4))

    @property
    def stroke(self) -> float:
        """Difference of the largest and the least lift [m or rad]."""
        low, high = self.extremes[0]
        return high - low

    @property
    def peaks(self) -> tuple[float, ...]:
        """Largest magnitudes of the derivatives; infinite where the one before jumps."""
        largest = [max(map(abs, each)) for each in self.extremes[1:]]
        return tuple(x if self.continuous >= n else math.inf for n, x in enumerate(largest))


def peak_factors(kind: str) -> tuple[float, ...]:
    """Return C_v, C_a, C_j: the peaks of a rise of unit lift over unit span, between dwells."""
    rest = CamSegment("dwell", PI - 1.0)
    return CamLaw((CamSegment(kind, 1.0, 1.0), rest, CamSegment(kind, 1.0, -1.0), rest)).peaks
