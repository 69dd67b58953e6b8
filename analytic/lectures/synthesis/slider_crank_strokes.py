r"""Slider-cranks by their stroke, and by their time ratio.

::

            A1                        O2 at the origin, the line below it by e; the slider at B1
         r /  \ l                    (crank folded over the rod) and B2 (crank and rod stretched):
         O2     \
          | e     \                  O2 B1 = l - r,  O2 B2 = l + r,  B1 B2 = stroke
      ----+---B1---B---B2---

With the angle a = B1 O2 B2 the slow stroke takes 180 + a of the crank's turn, the quick 180 - a.
All O2 of one a lie on a circle through B1 and B2, of radius R = stroke / (2 sin a). With the angle
b = O2 B2 B1 it is O2 B1 = 2 R sin(b), O2 B2 = 2 R sin(a + b), e = O2 B2 sin(b), and O2 B1 is below
the line by a + b: nothing here is a difference, and digits are kept where O2 is next to B1.

Source: lecture "Tong hop co cau" (synthesis), slider-crank; R. L. Norton, Design of Machinery,
sections 2.13 and 3.4 (time ratio).
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from analytic.lectures.synthesis import design
from models.errors import CrankcheckError
from models.lectures.draft import Draft, bar
from models.lectures.tasks.positions import StrokeTask

O2, PIN, SLIDER = "O2", "A", "B"
RODS = (2.0, 3.0, 4.0, 5.0)
"""Default rods, over half the stroke."""
SQUARE = math.radians(0.1)
"""Distance of a from 90 deg, below which the rod of every O2 is square to the slider's line to
within this, at the inner end: there the crank is nearly locked."""
PLACES = 12
"""Number of default places of O2 on the circle of a time ratio."""


@dataclass(frozen=True)
class Ends:
    """Crank and rod [m], and the slider's ends seen from O2 [m]."""

    crank: float
    rod: float
    first: complex
    second: complex

    @staticmethod
    def beside(crank: float, rod: float, offset: float, *, over: bool = False) -> Ends:
        """Make the ends for an offset; ``over`` O2 the one end is as far as the other."""
        outer = math.sqrt((rod + crank) ** 2 - offset**2)
        inner = -outer if over else math.sqrt(max((rod - crank) ** 2 - offset**2, 0.0))
        return Ends(crank, rod, complex(inner, -offset), complex(outer, -offset))

    @staticmethod
    def seen_under(stroke: float, lag: float, at_far: float) -> Ends:
        """Make the ends for the angles a = B1 O2 B2 and b = O2 B2 B1 [rad]."""
        twice = stroke / math.sin(lag)
        near, far = twice * math.sin(at_far), twice * math.sin(lag + at_far)
        first = cmath.rect(near, -(lag + at_far))
        return Ends(0.5 * (far - near), 0.5 * (far + near), first, first + stroke)

    @property
    def offset(self) -> float:
        """Distance of O2 from the slider's line [m]."""
        return abs(self.first.imag)

    @property
    def angles(self) -> tuple[float, float]:
        """Crank's angles in both ends [rad]: folded it points away from the slider."""
        folded = cmath.phase(-self.first) if self.rod > self.crank else math.pi
        return folded, cmath.phase(self.second)


def stroke_proposals(task: StrokeTask) -> list[design.Proposal]:
    """Return the slider-cranks of a task. Raises CrankcheckError for an impossible task."""
    return [_proposal(task, ends) for ends in _ends(task)]


def lag_of(time_ratio: float) -> float:
    """Return the angle a [rad] of Q = (180 + a) / (180 - a)."""
    return math.pi * (time_ratio - 1.0) / (time_ratio + 1.0)


def readable_ratio(time_ratio: float | None) -> str:
    """Return a time ratio with the digits by which it differs from a whole number."""
    ratio = time_ratio or math.nan
    return f"{ratio:.{10 if 1e-8 < abs(ratio - round(ratio)) < 1e-4 else 6}g}"


def circle_step(lag: float, seen: design.DrawnCircle, pivot: complex) -> design.DrawingStep:
    """Return the step to the places of O2 from which a stroke is seen under an angle [rad]."""
    words = (
        f"the circle from which B1 B2 is seen under a = {math.degrees(lag):.6g} deg, and O2 on it"
    )
    return design.DrawingStep(words, (seen, design.Dot(pivot, O2, "result", fixed=True)))


def _ends(task: StrokeTask) -> Iterator[Ends]:
    stroke = task.stroke_m
    if task.form == "isosceles":
        yield Ends.beside(0.25 * stroke, 0.25 * stroke, 0.0, over=True)
    elif task.time_ratio is not None:
        lag = lag_of(task.time_ratio)
        for at_far in _by_time_ratio(task, lag):
            yield Ends.seen_under(stroke, lag, at_far)
    else:
        offset = task.offset_m or 0.0
        rods = [task.rod_m] if task.rod_m else [0.5 * k * stroke + offset for k in RODS]
        for rod in rods:
            yield Ends.beside(crank_of(stroke, rod, offset), rod, offset)


def crank_of(stroke: float, rod: float, offset: float) -> float:
    """Return the crank [m] of a stroke: with u, v = sqrt((l +- r)^2 - e^2) and u - v = s, u + v is
    4 l r / s, and r^2 = s^2 (4 l^2 - 4 e^2 - s^2) / (4 (4 l^2 - s^2)). Raises CrankcheckError for a
    rod that is too short for it."""
    least = 0.5 * stroke + offset
    square = stroke**2 * (4.0 * rod**2 - 4.0 * offset**2 - stroke**2)
    below = 4.0 * (4.0 * rod**2 - stroke**2)
    crank = math.sqrt(square / below) if square > 0.0 < below else math.nan
    if not crank + offset < rod:
        raise CrankcheckError(
            f"rod_m is {rod:g}: with a stroke of {stroke:g} m and an offset of {offset:g} m the "
            f"crank would not turn; take a longer rod, such as {2.0 * least:.6g} m"
        )
    return crank


def _by_time_ratio(task: StrokeTask, lag: float) -> Iterator[float]:
    """Yield the angles b of O2 on the circle of the angle a, beside the stroke's inner end."""
    most = 0.5 * math.pi - SQUARE
    if lag > most:
        raise CrankcheckError(
            f"time_ratio is {readable_ratio(task.time_ratio)}: a slider-crank whose crank turns "
            "has one below 3, and transmits by less than 0.1 deg above "
            f"{(math.pi + most) / (math.pi - most):.4f}: give 1 to this; a slotted lever has any "
            "(`crankcheck synth quick-return`)"
        )
    if task.offset_m is not None:
        yield _beside(task, lag, task.offset_m)
    elif task.rod_m is not None:
        yield _with_rod(task, lag, task.rod_m)
    else:
        yield from (0.5 * math.pi - lag) * (np.arange(PLACES) + 0.5) / PLACES


def _beside(task: StrokeTask, lag: float, offset: float) -> float:
    """Return the angle b of an offset, 2 R sin(a + b) sin(b): with t = tan(b) and k = e / R it is
    (2 cos a - k) t^2 + 2 t sin a = k."""
    over = 2.0 * offset * math.sin(lag) / task.stroke_m
    least = 2.0 * math.cos(lag) - over
    if not offset > 0.0 or not least > 0.0:
        most = task.stroke_m / math.tan(lag)
        raise CrankcheckError(
            f"offset_m is {offset:g}: with a stroke of {task.stroke_m:g} m and a time ratio of "
            f"{readable_ratio(task.time_ratio)} it lies between 0 and {most:.6g} m"
        )
    sine = math.sin(lag)
    return math.atan(over / (sine + math.sqrt(sine**2 + over * least)))


def _with_rod(task: StrokeTask, lag: float, rod: float) -> float:
    """Return the angle b of a rod, the mean of O2 B1 and O2 B2: 2 R sin(b + a / 2) cos(a / 2)."""
    most = task.stroke_m * math.cos(0.5 * lag) / math.sin(lag)
    at_far = math.asin(rod / most) - 0.5 * lag if rod < most else math.nan
    if not 0.0 < at_far < 0.5 * math.pi - lag:
        low, high = (most * math.sin(x) for x in (0.5 * lag, 0.5 * (math.pi - lag)))
        raise CrankcheckError(
            f"rod_m is {rod:g}: with a stroke of {task.stroke_m:g} m and a time ratio of "
            f"{readable_ratio(task.time_ratio)} it lies between {low:.6g} and {high:.6g} m"
        )
    return at_far


def _proposal(task: StrokeTask, ends: Ends) -> design.Proposal:
    """Return the slider-crank; its displacement counts from the inner end of the stroke."""
    through = [ends.first.real, ends.first.imag]
    links = {"crank": bar(O2, PIN, ends.crank), "rod": bar(PIN, SLIDER, ends.rod)}
    slider = {"on": "ground", "through_m": through, "direction_deg": 0.0}
    draft = Draft(task.name, task.source, {O2: 0j}, links, {}, sliders={SLIDER: slider})
    asked = [(design.AskedSlide(SLIDER, at),) for at in (0.0, task.stroke_m)]
    lengths = {"crank": ends.crank, "rod": ends.rod, "offset": ends.offset}
    told = {name: f"{length:.6g} m" for name, length in lengths.items()}
    return design.to_and_fro(draft, ends.angles, asked, told, _steps(task, ends), SLIDER)


def _steps(task: StrokeTask, ends: Ends) -> Iterator[design.DrawingStep]:
    first, second = ends.first, ends.second
    line = design.Segment(first, second, "given", beyond=0.2)
    yield design.DrawingStep(
        f"the stroke, {task.stroke_m:g} m on the slider's line",
        (line, *design.numbered("B", (first, second), "given")),
    )
    if task.time_ratio is not None:
        lag = lag_of(task.time_ratio)
        radius = 0.5 * abs(second - first) / math.sin(lag)
        centre = 0.5 * (first + second) + 1j * 0.5 * abs(second - first) / math.tan(lag)
        yield circle_step(lag, design.DrawnCircle(centre, radius), 0j)
    else:
        pivot = design.Dot(0j, O2, "result", fixed=True)
        yield design.DrawingStep(f"O2 beside the line by {-first.imag:.6g} m", (pivot,))
    yield design.DrawingStep(
        "crank and rod are a quarter of the stroke each, and O2 is its middle"
        if task.form == "isosceles"
        else "O2 B1 is rod less crank, O2 B2 rod and crank: half their difference is the crank",
        (*design.rays(0j, (first, second)), design.DrawnCircle(0j, ends.crank)),
    )
    pin = cmath.rect(ends.crank, ends.angles[0])
    yield design.DrawingStep(
        "crank and rod in position 1",
        (*design.chained(0j, pin, first), design.Dot(pin, "A1", "result")),
    )
