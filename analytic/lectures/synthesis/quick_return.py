r"""Quick returns: slotted lever, Whitworth's turning guide, crank-rocker.

::

    slotted lever (d > r)            Whitworth (d < r)           both: sin(a / 2) of
                                            A
         O2---A   crank r                 / |   crank r          r / d   slotted lever, swing a
          |  /                          O2  |                    d / r   Whitworth
        d | /    guide about O4       d |   |  guide about O4
          O4                            O4--+                    Q = (180 + a) / (180 - a)

Source: lecture "Tong hop co cau" (synthesis), quick return; R. L. Norton, Design of Machinery,
section 3.4.

::

              B1          The rocker's ends are seen from O2 under a, so O2 lies on a circle through
            / | \         them, on either side of the chord B1 B2:
         O2   |  O4       O2 B1 and O2 B2 are coupler less crank, and coupler and crank.
            \ | /
              B2          Q = (180 + a) / (180 - a)

Source: R. L. Norton, Design of Machinery, section 3.4.
"""

import cmath
import math
from collections.abc import Iterator

import numpy as np

from analytic.lectures.synthesis import design
from analytic.lectures.synthesis.rocker import Swung, by_angle
from analytic.lectures.synthesis.slider_crank_strokes import circle_step, lag_of
from models.errors import CrankcheckError
from models.files.assemble import Table
from models.lectures.draft import Draft, bar
from models.lectures.tasks.positions import QuickReturnTask

PLACES = 24
"""Number of tried places of O2 on the circles of a time ratio, half on either side."""


def crank_rockers(task: QuickReturnTask, lag: float) -> Iterator[design.Proposal]:
    """Yield the crank-rockers of a task whose slow stroke takes half a turn and ``lag`` [rad]."""
    assert task.rocker_m is not None
    assert task.swing_deg is not None
    swung = by_angle(task.rocker_m, task.swing_deg, "the rocker O4 B in its end positions")
    radius = task.rocker_m * math.sin(math.radians(0.5 * task.swing_deg)) / math.sin(lag)
    reach = math.pi - lag
    for side in (1.0, -1.0):
        centre = 0.5 * sum(swung.ends) + side * 1j * radius * math.cos(lag)
        seen = design.DrawnCircle(centre, radius)
        for share in (np.arange(PLACES // 2) + 0.5) / (PLACES // 2):
            pivot = centre + side * 1j * radius * cmath.exp(1j * reach * (2.0 * share - 1.0))
            if (proposal := _crank_rocker(task, swung, seen, pivot)) is not None:
                yield proposal


def _crank_rocker(
    task: QuickReturnTask, swung: Swung, seen: design.DrawnCircle, pivot: complex
) -> design.Proposal | None:
    """Return the one with O2 at a place of the circle; None as near to B1 as to B2."""
    assert task.rocker_m is not None
    far, near = sorted(swung.ends, key=lambda end: -abs(end - pivot))
    crank = 0.5 * (abs(far - pivot) - abs(near - pivot))
    coupler = 0.5 * (abs(far - pivot) + abs(near - pivot))
    if not 0.0 < crank < coupler:
        return None
    turned = [cmath.phase(end - pivot) + (math.pi if end == near else 0.0) for end in swung.ends]
    links = {
        "crank": bar(O2, PIN, crank),
        "coupler": bar(PIN, END, coupler),
        "rocker": bar(O4, END, task.rocker_m),
    }
    draft = Draft(task.name, task.source, {O2: pivot, O4: 0j}, links, {})
    asked = [(design.AskedAngle("rocker", pose.angle),) for pose in swung.poses]
    told = {"crank": f"{crank:.6g} m", "coupler": f"{coupler:.6g} m"}
    pin = pivot + cmath.rect(crank, turned[0])
    lengths = design.DrawingStep(
        "half the difference of O2 B1 and O2 B2 is the crank, half their sum the coupler",
        (
            *design.rays(pivot, swung.ends),
            design.DrawnCircle(pivot, crank),
            *design.chained(pivot, pin, swung.ends[0]),
            *design.chained(0j, swung.ends[0]),
            design.Dot(pin, "A1", "result"),
        ),
    )
    steps = (*swung.steps, circle_step(lag_of(task.time_ratio), seen, pivot), lengths)
    return design.to_and_fro(draft, turned, asked, told, steps, "rocker")


O2, O4, PIN, END, RAM = "O2", "O4", "A", "B", "C"
LONGER = 1.25
"""Lever over the sum of crank and pivot distance: its block stays on it."""
ROD = 2.0
"""Default rod, over the ram's stroke."""


def quick_return_proposals(task: QuickReturnTask) -> list[design.Proposal]:
    """Return the mechanisms of a task."""
    lag = lag_of(task.time_ratio)
    if task.mechanism == "crank-rocker":
        return list(crank_rockers(task, lag))
    return [
        _slotted_lever(task, lag) if task.mechanism == "slotted-lever" else _whitworth(task, lag)
    ]


def _slotted_lever(task: QuickReturnTask, lag: float) -> design.Proposal:
    """Return the lever with O4 at the origin, O2 above it; it swings by a about the y-axis."""
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
    asked: list[tuple[design.Asked, ...]]
    asked = [(design.AskedAngle("lever", angle),) for angle in levers]
    if task.stroke_m is not None:
        slides = _add_ram(task, links, sliders, ends, 0.5 * (lever + ends[0].imag))
        asked = [(*one, slide) for one, slide in zip(asked, slides, strict=True)]
    told = {"crank": f"{crank:.6g} m", "O2 O4": f"{pivots:.6g} m", "swing": _degrees(lag)}
    steps = _steps(1j * pivots, crank, angles, ends, lag)
    goes = "lever" if task.stroke_m is None else RAM
    draft = Draft(task.name, task.source, {O2: 1j * pivots, O4: 0j}, links, {}, sliders=sliders)
    return design.to_and_fro(draft, angles, asked, told, steps, goes)


def _whitworth(task: QuickReturnTask, lag: float) -> design.Proposal:
    """Return the guide with O4 at the origin, O2 above; its end B moves a ram on the x-axis."""
    share = math.sin(0.5 * lag)
    crank = (
        task.crank_m or (task.pivots_m / share if task.pivots_m else 0.0) or (task.stroke_m or 0.0)
    )
    pivots = crank * share
    arm = 0.5 * (task.stroke_m or crank)
    # With the guide level the crank's pin is level with O4, below O2.
    angles = (-0.5 * lag, math.pi + 0.5 * lag)
    links: dict[str, Table] = {"crank": bar(O2, PIN, crank), "guide": bar(O4, END, arm)}
    sliders: dict[str, Table] = {PIN: {"on": "guide"}}
    ends = [complex(arm), complex(-arm)]
    if task.rod_m is not None and not task.rod_m > arm:
        raise CrankcheckError(
            f"rod_m is {task.rod_m:g}: the guide's end is {arm:.6g} m from O4, which the rod has "
            "to pass; take a longer one"
        )
    slides = _add_ram(task, links, sliders, ends, 0.0)
    levels = [design.AskedAngle("guide", level) for level in (0.0, math.pi)]
    asked = zip(levels, slides, strict=True)
    told = {"crank": f"{crank:.6g} m", "O2 O4": f"{pivots:.6g} m", "stroke": f"{2.0 * arm:.6g} m"}
    steps = _steps(1j * pivots, crank, angles, ends, lag)
    draft = Draft(task.name, task.source, {O2: 1j * pivots, O4: 0j}, links, {}, sliders=sliders)
    return design.to_and_fro(draft, angles, asked, told, steps, RAM)


def _add_ram(
    task: QuickReturnTask,
    links: dict[str, Table],
    sliders: dict[str, Table],
    ends: list[complex],
    height: float,
) -> list[design.AskedSlide]:
    """Put a rod and a ram at the end of a lever, the ram on a level line to the right; return its
    places with the lever's ``ends``, counted from the nearest."""
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
    return [design.AskedSlide(RAM, place - min(places)) for place in places]


def _steps(
    pivot: complex, crank: float, angles: tuple[float, float], ends: list[complex], lag: float
) -> Iterator[design.DrawingStep]:
    """Yield the limits of a lever or guide about O4, and the crank's angles there [rad]."""
    yield design.DrawingStep(
        f"the limits of the guide about O4, and O2 above it by {pivot.imag:.6g} m",
        (
            design.Dot(0j, O4, "given", fixed=True),
            design.Dot(pivot, O2, "given", fixed=True),
            *design.rays(0j, ends, "given"),
        ),
    )
    pins = [pivot + cmath.rect(crank, angle) for angle in angles]
    yield design.DrawingStep(
        f"the crank's circle: its pin is at A1 and A2 there, and 180 deg + {_degrees(lag)} of the "
        "turn lie above them",
        (
            design.DrawnCircle(pivot, crank),
            *design.chained(pivot, pins[0]),
            design.Segment(pivot, pins[1]),
            design.Dot(pins[0], "A1", "result"),
            design.Dot(pins[1], "A2"),
        ),
    )


def _degrees(angle: float) -> str:
    return f"{math.degrees(angle):.6g} deg"
