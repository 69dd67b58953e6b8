"""Crank-rockers by their swing and their time ratio.

::

              B1          The rocker's ends are seen from O2 under a, so O2 lies on a circle through
            / | \\         them, on either side of the chord B1 B2:
         O2   |  O4       O2 B1 and O2 B2 are coupler less crank, and coupler and crank.
            \\ | /
              B2          Q = (180 + a) / (180 - a)

Source: R. L. Norton, Design of Machinery, section 3.4.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from analytic.lectures.synthesis.design import (
    AskedAngle,
    Circle,
    Dot,
    PrecisionPosition,
    Proposal,
    Segment,
    Step,
)
from analytic.lectures.synthesis.driving_dyad import chord
from models.lectures.draft import Draft, bar
from models.lectures.tasks.positions import QuickReturnTask

PLACES = 24
"""Places of O2 that are tried on the circles of a time ratio, half on either side."""


@dataclass(frozen=True)
class SwungRocker:
    """The rocker about O4 in the origin: its angles in both ends [rad], the places of B there [m],
    and the circle that O2 lies on."""

    rocker_m: float
    angles: tuple[float, float]
    ends: tuple[complex, complex]
    seen: Circle


def crank_rockers(task: QuickReturnTask, lag: float) -> Iterator[Proposal]:
    """Those of a task whose slow stroke takes half a turn and ``lag`` [rad]."""
    assert task.rocker_m is not None
    assert task.swing_deg is not None
    half = math.radians(0.5 * task.swing_deg)
    angles = 0.5 * math.pi + half, 0.5 * math.pi - half
    ends = cmath.rect(task.rocker_m, angles[0]), cmath.rect(task.rocker_m, angles[1])
    radius = 0.5 * chord(task.rocker_m, 2.0 * half) / math.sin(lag)
    reach = math.pi - lag
    for side in (1.0, -1.0):
        centre = 0.5 * sum(ends) + side * 1j * radius * math.cos(lag)
        swung = SwungRocker(task.rocker_m, angles, ends, Circle(centre, radius))
        for share in (np.arange(PLACES // 2) + 0.5) / (PLACES // 2):
            pivot = centre + side * 1j * radius * cmath.exp(1j * reach * (2.0 * share - 1.0))
            if (proposal := _crank_rocker(task, swung, pivot, lag)) is not None:
                yield proposal


def _crank_rocker(
    task: QuickReturnTask, swung: SwungRocker, pivot: complex, lag: float
) -> Proposal | None:
    """That with O2 at a place of the circle; None as near to B1 as to B2."""
    far, near = sorted(swung.ends, key=lambda end: -abs(end - pivot))
    crank = 0.5 * (abs(far - pivot) - abs(near - pivot))
    coupler = 0.5 * (abs(far - pivot) + abs(near - pivot))
    if not 0.0 < crank < coupler:
        return None
    turned = [cmath.phase(end - pivot) + (math.pi if end == near else 0.0) for end in swung.ends]
    links = {
        "crank": bar(O2, PIN, crank),
        "coupler": bar(PIN, END, coupler),
        "rocker": bar(O4, END, swung.rocker_m),
    }
    draft = Draft(task.name, task.source, {O2: pivot, O4: 0j}, links, {})
    positions = tuple(
        PrecisionPosition(angle, (AskedAngle("rocker", lever),))
        for angle, lever in zip(turned, swung.angles, strict=True)
    )
    told = {"crank": f"{crank:.6g} m", "coupler": f"{coupler:.6g} m"}
    pin = pivot + cmath.rect(crank, turned[0])
    steps = tuple(_steps(swung, Circle(pivot, crank), pin, lag))
    return Proposal(draft, "crank", positions, told, steps, turns_back="rocker")


def _steps(swung: SwungRocker, turn: Circle, pin: complex, lag: float) -> Iterator[Step]:
    """Both ends, the circle they are seen from, and that of the crank, its pin in position 1."""
    pivot, ends = turn.centre, swung.ends
    yield Step(
        "the rocker O4 B in its end positions",
        (
            Dot(0j, O4, "given", fixed=True),
            *(Segment(0j, end, "given") for end in ends),
            *(Dot(end, f"B{n}", "given") for n, end in enumerate(ends, 1)),
        ),
    )
    yield Step(
        f"the circle from which B1 B2 is seen under a = {math.degrees(lag):.6g} deg, and O2 on it",
        (swung.seen, Dot(pivot, O2, "result", fixed=True)),
    )
    yield Step(
        "half the difference of O2 B1 and O2 B2 is the crank, half their sum the coupler",
        (
            *(Segment(pivot, end) for end in ends),
            turn,
            Segment(pivot, pin, "result"),
            Segment(pin, ends[0], "result"),
            Segment(0j, ends[0], "result"),
            Dot(pin, "A1", "result"),
        ),
    )
