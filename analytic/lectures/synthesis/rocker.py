"""Crank-rocker for a rocker's swing: by its angle, or between two positions of a body on it."""

import cmath
import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from analytic.lectures.synthesis import design
from analytic.lectures.synthesis.driving_dyad import ToAndFro, choices
from analytic.lectures.synthesis.pose import (
    PlanePose,
    bisector,
    pole,
    refuse_coinciding,
    turn_between,
)
from models.errors import CrankcheckError
from models.lectures.draft import Draft, bar, plate
from models.lectures.tasks.positions import RockerTask

O2, O4 = "O2", "O4"


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
