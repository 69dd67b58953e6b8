"""Constructions to draw: three positions by circles, the lecture's rocker, Burmester's curves, and
a pole that is far off."""

import cmath
import math
from dataclasses import replace
from functools import lru_cache

from analytic.lectures.synthesis.burmester import four_positions
from analytic.lectures.synthesis.coupler import curve_steps, guiding_steps, links
from analytic.lectures.synthesis.design import (
    AskedAngle,
    CarriedBody,
    Dot,
    DrawingStep,
    DrawnCircle,
    PrecisionPosition,
    Proposal,
    Segment,
)
from analytic.lectures.synthesis.pose import PlanePose, PoseDyad, about_circumcentre, pole
from models.lectures.draft import Draft, bar

LECTURE = 'Lecture "Tong hop co cau" (synthesis)'
THREE = (PlanePose(0.0 + 0.0j, 0.9), PlanePose(0.09 + 0.05j, 0.55), PlanePose(0.2 + 0.045j, 0.1))
C, D = 0.0 + 0.0j, 0.12 + 0.0j
"""Points of the body that is carried [m], in its own frame."""


@lru_cache
def three_positions() -> Proposal:
    """A coupler C D in three positions, by circumcentres (the lecture, example 6)."""
    body = CarriedBody("three-positions", LECTURE + ", example 6", THREE, {"C": C, "D": D})
    pair = about_circumcentre(THREE, C), about_circumcentre(THREE, D)
    assert isinstance(pair[0], PoseDyad)
    assert isinstance(pair[1], PoseDyad)
    return body.four_bar(pair, steps=tuple(guiding_steps(body, pair, inverted=False)))


@lru_cache
def rocker_by_angle() -> Proposal:
    """The rocker by its angle (the lecture, example 2): crank O2 A, coupler A B, rocker O4 B."""
    o4, length, swing, lean = 0.0 + 0.0j, 0.2, math.radians(70.0), math.radians(115.0)
    b1, b2 = (o4 + cmath.rect(length, lean + side * swing / 2) for side in (1.0, -1.0))
    along = (b2 - b1) / abs(b2 - b1)
    radius, middle = abs(b2 - b1) / 2, (b1 + b2) / 2
    coupler = 0.3
    o2 = middle + coupler * along
    a1, a2 = o2 - radius * along, o2 + radius * along
    ends = (
        Dot(o4, "O4", "given", fixed=True), Dot(b1, "B1", "given"), Dot(b2, "B2", "given"),
        Segment(o4, b1, "given"), Segment(o4, b2, "given"),
    )  # fmt: skip
    drawn = (Segment(o2, a1, "result"), Segment(a1, b1, "result"), Segment(o4, b1, "result"))
    # drawn with B in B1 where the crank lies over the coupler, away from O4's end
    steps = (
        DrawingStep("The rocker O4 B in its end positions, 70° apart.", ends),
        DrawingStep("The line B1 B2, and its extension.", (Segment(b1, a2, beyond=0.1),)),
        DrawingStep("O2 is chosen on the extension.", (Dot(o2, "O2", "result", fixed=True),)),
        DrawingStep(
            "Half of B1 B2 is the radius of a circle about O2, which meets the line in A1 and A2.",
            (DrawnCircle(o2, radius), Dot(a1, "A1"), Dot(a2, "A2")),
        ),
        DrawingStep("The crank is O2 A1, the coupler A1 B1.", drawn),
    )
    bars = {
        "crank": bar("O2", "A", radius),
        "coupler": bar("A", "B", coupler),
        "rocker": bar("O4", "B", length),
    }
    draft = Draft("rocker-by-angle", LECTURE + ", example 2", {"O2": o2, "O4": o4}, bars, {})
    start = cmath.phase(a1 - o2)
    positions = tuple(
        PrecisionPosition(start + half, (AskedAngle("rocker", cmath.phase(b - o4)),))
        for half, b in ((0.0, b1), (math.pi, b2))
    )
    chosen = {"O2 from the middle of B1 B2": f"{coupler:g} m"}
    return Proposal(draft, "crank", positions, chosen, steps)


FOUR = (
    PlanePose(0j, 0.0),
    PlanePose(0.1 + 0.05j, 0.35),
    PlanePose(0.18 + 0.14j, 0.9),
    PlanePose(0.2 + 0.26j, 1.6),
)


@lru_cache
def burmester_curves() -> Proposal:
    """Burmester's curves of four positions, and the four-bar of two of their dyads."""
    pieces = four_positions(FOUR)
    every = [dyad for piece in pieces for dyad in piece]
    near = [d for d in every if abs(d.fixed) < 0.45 and 0.05 < d.radius(FOUR) < 0.4]
    first = near[0]
    second = max(near, key=lambda d: min(abs(d.fixed - first.fixed), abs(d.moving - first.moving)))
    body = CarriedBody("burmester", LECTURE, FOUR, {"P": 0j})
    steps = (*curve_steps(body, pieces), links(body, (first, second)))
    return body.four_bar((first, second), steps=steps)


@lru_cache
def far_pole() -> Proposal:
    """Three positions, the first two of which are nearly a translation: their pole is far off."""
    proposal = three_positions()
    first, second = PlanePose(0j, 0.9), PlanePose(0.1 + 0.02j, 0.9 + 0.004)
    place = pole(first, second)
    assert place is not None
    circles = (DrawnCircle(place, abs(place - first.point)), DrawnCircle(place, 0.3))
    words = "The pole of a turn that is nearly none, and the circle of a point about it."
    extra = DrawingStep(words, (Dot(place, "P12"), Segment(first.point, place), *circles))
    return replace(proposal, chosen={}, steps=(*proposal.steps, extra))
