r"""Quick returns and crank-rockers: slotted lever, Whitworth's guide, swings and positions.

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
from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np

from analytic.lectures.synthesis import design
from analytic.lectures.synthesis.driving_dyad import ToAndFro, choices
from analytic.lectures.synthesis.pose import (
    PlanePose,
    bisector,
    pole,
    refuse_coinciding,
    turn_between,
)
from analytic.lectures.synthesis.slider_crank_strokes import circle_step, lag_of
from models.errors import CrankcheckError
from models.files.assemble import Table
from models.lectures.draft import Draft, bar, plate
from models.lectures.tasks.positions import QuickReturnTask, RockerTask

O2, O4, PIN, END, RAM = "O2", "O4", "A", "B", "C"


@dataclass(frozen=True)
class Swung:
    """Rocker in two positions: its pivot, its pin in both, its own angles, its points in its own
    frame (O4 at its origin), its drawing; ``pin`` is the named point at the pin, if any."""

    pivot: complex
    ends: tuple[complex, complex]
    poses: tuple[PlanePose, PlanePose]
    points: Mapping[str, complex]
    steps: tuple[design.DrawingStep, ...]
    pin: str = ""


def rocker_proposals(task: RockerTask) -> list[design.Proposal]:
    """Return the crank-rockers of a task. Raises CrankcheckError for positions that coincide, or
    whose pole is at infinity; a crank's pivot between the ends."""
    if task.positions:
        swung = _by_positions(task)
    else:
        assert task.rocker_m is not None
        assert task.swing_deg is not None
        words = f"the rocker O4 B in its end positions, {task.swing_deg:g} deg apart"
        swung = by_angle(task.rocker_m, task.swing_deg, words)
    crank = 0.5 * abs(swung.ends[1] - swung.ends[0])
    return [
        _proposal(task, swung, distance, beyond)
        for distance in choices(crank, task.distance_m)
        for beyond in (2, 1)
    ]


def by_angle(rocker_m: float, swing_deg: float, words: str) -> Swung:
    """Return the rocker with O4 at the origin, its ends on either side of the y-axis."""
    half = math.radians(0.5 * swing_deg)
    poses = PlanePose(0j, 0.5 * math.pi + half), PlanePose(0j, 0.5 * math.pi - half)
    ends = cmath.rect(rocker_m, poses[0].angle), cmath.rect(rocker_m, poses[1].angle)
    step = design.DrawingStep(
        words,
        (
            design.Dot(0j, O4, "given", fixed=True),
            *design.rays(0j, ends, "given"),
            *design.numbered("B", ends, "given"),
        ),
    )
    return Swung(0j, ends, poses, {}, (step,))


def _by_positions(task: RockerTask) -> Swung:
    """Return the rocker with O4 in the rotopole; B lies on the line from it to the first point."""
    first, second = (PlanePose(point, angle) for point, angle in task.body.poses)
    own = task.body.own_points
    size = abs(second.point - first.point) + max(map(abs, own.values()))
    refuse_coinciding((first, second), size)
    pivot = pole(first, second)
    if pivot is None:
        across = math.degrees(cmath.phase(1j * (second.point - first.point))) % 180.0
        raise CrankcheckError(
            f"{task.name}: the body is moved without being turned, so its pole is at infinity, "
            f"along {across:.4g} deg: no rocker does that; a coupler can (`crankcheck synth "
            "coupler`)"
        )
    near = 1e-9 * (size + abs(pivot))
    off_pole = [name for name in own if abs(first.at(own[name]) - pivot) > near]
    if not off_pole and task.rocker_m is None:
        raise CrankcheckError(
            f"{task.name}: {', '.join(own)} is the pole, and so the rocker's pivot O4: give "
            "rocker_m, how far its pin is from there"
        )
    # If the only point of a body is the pole, the pin lies along its own x-axis.
    letter = off_pole[0] if off_pole else ""
    towards = first.at(own[letter]) - pivot if letter else cmath.exp(1j * first.angle)
    arm_m, arm = abs(towards), towards / abs(towards)
    radius = task.rocker_m or arm_m
    is_pin = bool(letter) and abs(radius - arm_m) <= 1e-9 * arm_m
    pin = letter if is_pin else design.letters_beside(own, 2)[1]
    turn = cmath.exp(1j * turn_between(first, second))
    ends = (pivot + radius * arm, pivot + radius * arm * turn)
    # The rocker's own frame: O4 at its origin, B on its x-axis.
    poses = (PlanePose(pivot, cmath.phase(arm)), PlanePose(pivot, cmath.phase(arm * turn)))
    # A point in the pole stays there whatever the rocker does.
    points = {name: poses[0].back(first.at(own[name])) for name in off_pole}
    if is_pin:
        points[letter] = complex(radius)
    steps = (*_pole_steps((first, second), own, pivot), _pin_step(pivot, ends, pin, letter))
    return Swung(pivot, ends, poses, points, steps, pin if is_pin else "")


def _pole_steps(
    places: tuple[PlanePose, PlanePose], own: Mapping[str, complex], pivot: complex
) -> Iterator[design.DrawingStep]:
    elements: list[design.Element] = [
        design.Dot(pose.at(each), f"{name}{number}", "given")
        for number, pose in enumerate(places, 1)
        for name, each in own.items()
    ]
    if len(own) > 1:
        one, other = own.values()
        elements = [
            *(design.Segment(pose.at(one), pose.at(other), "given") for pose in places),
            *elements,
        ]
    yield design.DrawingStep("the body in its two positions", tuple(elements))
    ways = [(places[0].at(each), places[1].at(each)) for each in own.values()]
    yield design.DrawingStep(
        f"the bisectors of {' and '.join(f'{n}1{n}2' for n in own)} meet in the rotopole O4"
        if len(own) > 1
        else "the body turns from one into the other about the rotopole O4",
        (
            *(design.Segment(bisector(a, b).middle, pivot, beyond=0.15) for a, b in ways if a != b),
            design.Dot(pivot, O4, "result", fixed=True),
        ),
    )


def _pin_step(
    pivot: complex, ends: tuple[complex, complex], pin: str, letter: str
) -> design.DrawingStep:
    words = f"{pin} on the line from O4 to {letter}1, and on the same arc in position 2"
    return design.DrawingStep(
        words if letter else f"{pin} at its distance from O4, in both positions",
        (
            design.DrawnCircle(pivot, abs(ends[0] - pivot)),
            *design.rays(pivot, ends),
            *design.numbered(pin, ends),
        ),
    )


def _proposal(task: RockerTask, swung: Swung, distance_m: float, beyond: int) -> design.Proposal:
    """Return the crank-rocker with O2 at a distance from the chord's middle, beyond B1 or B2."""
    found = ToAndFro.of(*swung.ends, distance_m, beyond=beyond)
    crank_pin, free = design.letters_beside(swung.points, 2)
    rocker_pin = swung.pin or free
    radius = abs(swung.ends[0] - swung.pivot)
    own = {O4: 0j, rocker_pin: complex(radius), **swung.points}
    links = {
        "crank": bar(O2, crank_pin, found.crank_m),
        "coupler": bar(crank_pin, rocker_pin, found.coupler_m),
        "rocker": plate(own) if swung.points else bar(O4, rocker_pin, radius),
    }
    draft = Draft(task.name, task.source, {O2: found.pivot, O4: swung.pivot}, links, {})
    asked = [_asked(swung, pose) for pose in swung.poses]
    rocker = design.DrawingStep("the rocker", (*design.chained(swung.pivot, swung.ends[0]),))
    construction = found.steps(swung.ends, (O2, crank_pin, rocker_pin))
    steps = (*swung.steps, *construction, rocker)
    told = {"O2 from the chord's middle": f"{distance_m:.6g} m", "beyond": f"{rocker_pin}{beyond}"}
    return design.to_and_fro(draft, found.angles, asked, told, steps, "rocker")


def _asked(swung: Swung, pose: PlanePose) -> tuple[design.Asked, ...]:
    places = (design.AskedPlace(name, pose.at(place)) for name, place in swung.points.items())
    return (design.AskedAngle("rocker", pose.angle), *places)


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
