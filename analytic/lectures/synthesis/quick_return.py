"""Quick returns: slotted lever, Whitworth's turning guide, crank-rocker.

::

    slotted lever (d > r)            Whitworth (d < r)           both: sin(a / 2) of
                                            A
         O2---A   crank r                 / |   crank r          r / d   slotted lever, swing a
          |  /                          O2  |                    d / r   Whitworth
        d | /    guide about O4       d |   |  guide about O4
          O4                            O4--+                    Q = (180 + a) / (180 - a)

Source: lecture "Tong hop co cau" (synthesis), quick return; R. L. Norton, Design of Machinery,
section 3.4.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Iterator

from analytic.lectures.synthesis.design import (
    AskedAngle,
    AskedSlide,
    Circle,
    Dot,
    PrecisionPosition,
    Proposal,
    Segment,
    Step,
)
from analytic.lectures.synthesis.quick_crank_rocker import crank_rockers
from analytic.lectures.synthesis.strokes import lag_of
from models.errors import CrankcheckError
from models.files.assemble import Table
from models.lectures.draft import Draft, bar
from models.lectures.tasks.positions import QuickReturnTask

O2, O4, PIN, END, RAM = "O2", "O4", "A", "B", "C"
LONGER = 1.25
"""Of the crank and the distance of the pivots together: a lever that its block stays on."""
ROD = 2.0
"""Where a task is silent: of the ram's stroke."""


def quick_return_proposals(task: QuickReturnTask) -> tuple[list[Proposal], int]:
    """The mechanisms of a task, and how many there are."""
    lag = lag_of(task.time_ratio)
    if task.mechanism == "crank-rocker":
        found = list(crank_rockers(task, lag))
    else:
        found = [_slotted_lever(task, lag) if task.mechanism == "slotted-lever"
                 else _whitworth(task, lag)]  # fmt: skip
    return found, len(found)


def _slotted_lever(task: QuickReturnTask, lag: float) -> Proposal:
    """O4 at the origin, O2 above it; the lever swings by a about the y-axis."""
    share = math.sin(0.5 * lag)
    if task.stroke_m is not None:  # of the lever's end
        lever = 0.5 * task.stroke_m / share
        pivots = lever / (LONGER * (1.0 + share))
    else:
        pivots = task.pivots_m or (task.crank_m or 0.0) / share
        lever = LONGER * pivots * (1.0 + share)
    crank = pivots * share
    # At its limits the lever touches the crank's circle: the crank is square to it.
    angles = (-0.5 * lag, math.pi + 0.5 * lag)
    levers = (0.5 * math.pi - 0.5 * lag, 0.5 * math.pi + 0.5 * lag)
    links: dict[str, Table] = {"crank": bar(O2, PIN, crank), "lever": bar(O4, END, lever)}
    sliders: dict[str, Table] = {PIN: {"on": "lever"}}
    ends = [cmath.rect(lever, angle) for angle in levers]
    asked = [[AskedAngle("lever", angle)] for angle in levers]
    slides: list[float] = []
    if task.stroke_m is not None:
        slides = _add_ram(task, links, sliders, ends, 0.5 * (lever + ends[0].imag))
    draft = Draft(task.name, task.source, {O2: 1j * pivots, O4: 0j}, links, {}, sliders=sliders)
    positions = tuple(
        PrecisionPosition(angle, (*one, *(AskedSlide(RAM, s) for s in slides[k : k + 1])))
        for k, (angle, one) in enumerate(zip(angles, asked, strict=True))
    )
    told = {"crank": f"{crank:.6g} m", "O2 O4": f"{pivots:.6g} m", "swing": _degrees(lag)}
    steps = tuple(_steps(1j * pivots, crank, angles, ends, lag))
    goes = RAM if slides else "lever"
    return Proposal(draft, "crank", positions, told, steps, turns_back=goes)


def _whitworth(task: QuickReturnTask, lag: float) -> Proposal:
    """O4 at the origin, O2 above it; the guide turns, its end B moves a ram along the x-axis."""
    share = math.sin(0.5 * lag)
    crank = (
        task.crank_m or (task.pivots_m / share if task.pivots_m else 0.0) or (task.stroke_m or 0.0)
    )
    pivots = crank * share
    arm = 0.5 * (task.stroke_m or crank)
    # With the guide level the crank's pin is level with O4, below O2.
    angles = (-0.5 * lag, math.pi + 0.5 * lag)
    levers = (0.0, math.pi)
    links: dict[str, Table] = {"crank": bar(O2, PIN, crank), "guide": bar(O4, END, arm)}
    sliders: dict[str, Table] = {PIN: {"on": "guide"}}
    ends = [complex(arm), complex(-arm)]
    if task.rod_m is not None and not task.rod_m > arm:
        raise CrankcheckError(
            f"rod_m is {task.rod_m:g}: the guide's end is {arm:.6g} m from O4, which the rod has "
            "to pass; take a longer one"
        )
    slides = _add_ram(task, links, sliders, ends, 0.0)
    draft = Draft(task.name, task.source, {O2: 1j * pivots, O4: 0j}, links, {}, sliders=sliders)
    positions = tuple(
        PrecisionPosition(angle, (AskedAngle("guide", level), AskedSlide(RAM, slide)))
        for angle, level, slide in zip(angles, levers, slides, strict=True)
    )
    told = {"crank": f"{crank:.6g} m", "O2 O4": f"{pivots:.6g} m", "stroke": f"{2.0 * arm:.6g} m"}
    steps = tuple(_steps(1j * pivots, crank, angles, ends, lag))
    return Proposal(draft, "crank", positions, told, steps, turns_back=RAM)


def _add_ram(
    task: QuickReturnTask,
    links: dict[str, Table],
    sliders: dict[str, Table],
    ends: list[complex],
    height: float,
) -> list[float]:
    """Put a rod and a ram at the end of a lever, the ram on a level line to the right; its places
    with the lever's ``ends``, counted from the nearest."""
    stroke = abs(ends[0].real - ends[1].real)
    rod = task.rod_m or ROD * stroke
    least = abs(ends[0].imag - height)
    if not rod > least:
        raise CrankcheckError(
            f"rod_m is {rod:g}: the lever's end is up to {least:.6g} m beside the ram's line; take "
            "a longer rod"
        )
    below = math.asin((ends[0].imag - height) / rod)
    places = [end.real + rod * math.cos(below) for end in ends]
    links["rod"] = bar(END, RAM, rod)
    sliders[RAM] = {"on": "ground", "through_m": [min(places), height], "direction_deg": 0.0}
    return [place - min(places) for place in places]


def _steps(
    pivot: complex, crank: float, angles: tuple[float, float], ends: list[complex], lag: float
) -> Iterator[Step]:
    """The limits of a lever or guide about O4, and the crank's angles there [rad]."""
    yield Step(
        f"the limits of the guide about O4, and O2 above it by {pivot.imag:.6g} m",
        (
            Dot(0j, O4, "given", fixed=True),
            Dot(pivot, O2, "given", fixed=True),
            *(Segment(0j, end, "given") for end in ends),
        ),
    )
    pins = [pivot + cmath.rect(crank, angle) for angle in angles]
    yield Step(
        f"the crank's circle: its pin is at A1 and A2 there, and 180 deg + {_degrees(lag)} of the "
        "turn lie above them",
        (
            Circle(pivot, crank),
            Segment(pivot, pins[0], "result"),
            Segment(pivot, pins[1]),
            Dot(pins[0], "A1", "result"),
            Dot(pins[1], "A2"),
        ),
    )


def _degrees(angle: float) -> str:
    return f"{math.degrees(angle):.6g} deg"
