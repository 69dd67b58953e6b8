"""Slider-cranks by their stroke, and by their time ratio.

::

            A1                        O2 at the origin, the line below it by e; the slider at B1
         r /  \\ l                    (crank folded over the rod) and B2 (crank and rod stretched):
         O2     \\
          | e     \\                  O2 B1 = l - r,  O2 B2 = l + r,  B1 B2 = stroke
      ----+---B1---B---B2---

With the angle a = B1 O2 B2 the slow stroke takes 180 + a of the crank's turn, the quick 180 - a.

Source: lecture "Tong hop co cau" (synthesis), slider-crank; R. L. Norton, Design of Machinery,
sections 2.13 and 3.4 (time ratio).
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Iterator

import numpy as np

from analytic.synthesis.asked import AskedSlide, PrecisionPosition
from analytic.synthesis.construction import Circle, Dot, Segment, Step
from analytic.synthesis.design import Proposal
from models.draft import Draft, bar
from models.errors import CrankcheckError
from models.tasks.stroke import StrokeTask

O2, PIN, SLIDER = "O2", "A", "B"
RODS = (2.0, 3.0, 4.0, 5.0)
"""Where a task is silent: rods, over half the stroke."""
PLACES = 12
"""Where a task leaves O2 free on the circle of a time ratio: so many places of it."""


def stroke_proposals(task: StrokeTask) -> tuple[list[Proposal], int]:
    """The slider-cranks of a task. Raises CrankcheckError for what no such mechanism has."""
    found = [_proposal(task, *sizes) for sizes in _sizes(task)]
    return found, len(found)


def lag_of(time_ratio: float) -> float:
    """The angle a [rad] of Q = (180 + a) / (180 - a)."""
    return math.pi * (time_ratio - 1.0) / (time_ratio + 1.0)


def _sizes(task: StrokeTask) -> Iterator[tuple[float, float, float]]:
    """Crank, rod and offset [m]."""
    stroke = task.stroke_m
    if task.form == "isosceles":
        yield 0.25 * stroke, 0.25 * stroke, 0.0
    elif task.time_ratio is not None:
        yield from _by_time_ratio(task, lag_of(task.time_ratio))
    else:
        offset = task.offset_m or 0.0
        rods = [task.rod_m] if task.rod_m else [0.5 * k * stroke + offset for k in RODS]
        for rod in rods:
            yield crank_of(stroke, rod, offset), rod, offset


def crank_of(stroke: float, rod: float, offset: float) -> float:
    """The crank [m] of a stroke: with u, v = sqrt((l +- r)^2 - e^2) and u - v = s, u + v is
    4 l r / s, and r^2 = s^2 (4 l^2 - 4 e^2 - s^2) / (4 (4 l^2 - s^2)).

    Raises
    ------
    CrankcheckError
        A rod that is too short for it.
    """
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


def _by_time_ratio(task: StrokeTask, lag: float) -> Iterator[tuple[float, float, float]]:
    """O2 on the circle from which the stroke is seen under the angle a, beside its inner end."""
    stroke, ratio = task.stroke_m, task.time_ratio
    if lag >= 0.5 * math.pi:
        raise CrankcheckError(
            f"time_ratio is {ratio:g}: a slider-crank whose crank turns has one below 3 (a below "
            "90 deg); a slotted lever has any (`crankcheck synth quick-return`)"
        )
    radius = 0.5 * stroke / math.sin(lag)
    centre = complex(0.5 * stroke, -0.5 * stroke / math.tan(lag))
    if task.offset_m is not None:
        yield _sized(task, _at_height(task, centre, radius, -task.offset_m))
        return
    if task.rod_m is not None:
        yield _sized(task, _with_rod(task, centre, radius))
        return
    reach = 0.5 * math.pi - lag
    for share in (np.arange(PLACES) + 0.5) / PLACES:
        angle = math.pi - reach + 2.0 * reach * share
        yield _sized(task, centre + cmath.rect(radius, angle))


def _at_height(task: StrokeTask, centre: complex, radius: float, height: float) -> complex:
    """The place of O2 on the circle, left of B1, at a height [m]."""
    off = height - centre.imag
    x = centre.real - math.sqrt(max(radius**2 - off**2, 0.0))
    if abs(off) > radius or x >= 0.0 or height >= 0.0:
        most = 2.0 * abs(centre.imag)
        raise CrankcheckError(
            f"offset_m is {-height:g}: with a stroke of {task.stroke_m:g} m and a time ratio of "
            f"{task.time_ratio:g} it lies between 0 and {most:.6g} m"
        )
    return complex(x, height)


def _with_rod(task: StrokeTask, centre: complex, radius: float) -> complex:
    """The place of O2 on the circle that gives the rod, (O2 B1 + O2 B2) / 2: O2 B1 = 2 R sin(b) and
    O2 B2 = 2 R sin(b + a) of the angle b that O2 B1 is seen under from the circle."""
    assert task.rod_m is not None
    lag = lag_of(task.time_ratio or 1.0)
    # Their mean is 2 R sin(b + a / 2) cos(a / 2).
    sine = task.rod_m / (2.0 * radius * math.cos(0.5 * lag))
    b = math.asin(sine) - 0.5 * lag if sine < 1.0 else math.nan
    if not 0.0 < b < 0.5 * math.pi - lag:
        low, high = (2.0 * radius * math.cos(0.5 * lag) * math.sin(x)
                     for x in (0.5 * lag, 0.5 * (math.pi - lag)))  # fmt: skip
        raise CrankcheckError(
            f"rod_m is {task.rod_m:g}: with a stroke of {task.stroke_m:g} m and a time ratio of "
            f"{task.time_ratio:g} it lies between {low:.6g} and {high:.6g} m"
        )
    # B1 is at 0; the chord O2 B1 is seen under b, so O2 is 2 b further round the circle.
    return centre + (0j - centre) * cmath.exp(2j * b)


def _sized(task: StrokeTask, pivot: complex) -> tuple[float, float, float]:
    """Crank, rod and offset of O2 at a place, B1 at 0."""
    near, far = abs(pivot), abs(task.stroke_m - pivot)
    return 0.5 * (far - near), 0.5 * (far + near), -pivot.imag


def _proposal(task: StrokeTask, crank: float, rod: float, offset: float) -> Proposal:
    """The slider-crank; its displacement counts from the inner end of the stroke."""
    inner = math.sqrt(max((rod - crank) ** 2 - offset**2, 0.0))
    outer = math.sqrt((rod + crank) ** 2 - offset**2)
    if task.form == "isosceles":
        inner = -outer
    ends = complex(inner, -offset), complex(outer, -offset)
    # Folded the crank points away from the slider, stretched towards it.
    folded = cmath.phase(-ends[0]) if rod > crank else math.pi
    angles = (folded, cmath.phase(ends[1]))
    draft = Draft(
        task.name,
        task.source,
        {O2: 0j},
        {"crank": bar(O2, PIN, crank), "rod": bar(PIN, SLIDER, rod)},
        {},
        sliders={SLIDER: {"on": "ground", "through_m": [inner, -offset], "direction_deg": 0.0}},
    )
    positions = tuple(
        PrecisionPosition(angle, (AskedSlide(SLIDER, place - inner),))
        for angle, place in zip(angles, (inner, outer), strict=True)
    )
    lag = math.degrees(abs(math.remainder(angles[1] - angles[0] - math.pi, math.tau)))
    told = {
        "crank": f"{crank:.6g} m",
        "rod": f"{rod:.6g} m",
        "offset": f"{offset:.6g} m",
        "time ratio": f"{(180.0 + lag) / (180.0 - lag):.6g}",
    }
    return Proposal(draft, "crank", positions, told, tuple(_steps(task, crank, rod, ends, angles)))


def _steps(
    task: StrokeTask,
    crank: float,
    rod: float,
    ends: tuple[complex, complex],
    angles: tuple[float, float],
) -> Iterator[Step]:
    """The construction in the plane of the scene."""
    first, second = ends
    yield Step(
        f"the stroke, {task.stroke_m:g} m on the slider's line",
        (
            Segment(first, second, "given", beyond=0.2),
            Dot(first, "B1", "given"),
            Dot(second, "B2", "given"),
        ),
    )
    if task.time_ratio is not None:
        lag = lag_of(task.time_ratio)
        radius = 0.5 * abs(second - first) / math.sin(lag)
        centre = 0.5 * (first + second) + 1j * 0.5 * abs(second - first) / math.tan(lag)
        yield Step(
            f"the circle from which B1 B2 is seen under a = {math.degrees(lag):.6g} deg, and O2 "
            "on it",
            (Circle(centre, radius), Dot(0j, O2, "result", fixed=True)),
        )
    else:
        yield Step(
            f"O2 beside the line by {-first.imag:.6g} m", (Dot(0j, O2, "result", fixed=True),)
        )
    equal = task.form == "isosceles"
    yield Step(
        "crank and rod are a quarter of the stroke each, and O2 is its middle"
        if equal
        else "O2 B1 is rod less crank, O2 B2 rod and crank: half their difference is the crank",
        (Segment(0j, first), Segment(0j, second), Circle(0j, crank)),
    )
    pin = cmath.rect(crank, angles[0])
    yield Step(
        "crank and rod in position 1",
        (Segment(0j, pin, "result"), Segment(pin, first, "result"), Dot(pin, "A1", "result")),
    )
