"""Special positions of a body: those about one pivot, along a circle or a line, and those in which
a pivot of a four-bar is at infinity, and a slider takes the place of its crank.

::

    about one pivot    translation on a circle     translation on a line    a point A on a line
       C1  C2             A ----- B                 O2 -- crank, rod --       crank O4 B, and A
        \\ /              /  body /                          [ body ]         on its line
        O2             O2      O4                     -----------------      ---[A]------

Source: A. S. Hall, Kinematics and Linkage Design, chapter 5 (poles, points at infinity); R. L.
Norton, Design of Machinery, sections 2.12 (parallelogram) and 4.5 (elliptic trammel).
"""

import cmath
import itertools
import math
from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from analytic.lectures.synthesis import design
from analytic.lectures.synthesis.design import COUPLER, INPUT, PIVOTS, CarriedBody
from analytic.lectures.synthesis.pose import (
    PARALLEL,
    PlanePose,
    PoseDyad,
    PoseSlide,
    circle_through,
    pole,
)
from models.files.assemble import Table
from models.lectures.draft import SPEED_RAD_S, Draft, bar, plate
from models.lectures.tasks.positions import RIGID

EXACT = 1e-9
"""Deviation of special positions by rounding, over their size. Up to `RIGID` they are given to few
digits, and are met to these."""
SURELY = 1e-5
"""Deviation, over the longest link, up to which other mechanisms are near to these and worse."""
CRANK, ROD = 0.6, 3.0
"""Crank over the way of a body on a line, and rod over the crank."""
DIRECTIONS = 24
"""Number of directions from one pin of a parallelogram to the other that are tried."""
TURNING: Table = {"link": INPUT, "speed_rad_s": SPEED_RAD_S}
CLEAR = 0.1
"""Least sine of the angle between a crank and the line of the pins of a parallelogram."""
BEST = 3
"""Number of parallelograms, the best transmitting first."""


def special_proposals(body: CarriedBody, given: design.DrawingStep) -> list[design.Proposal]:
    """Return the mechanisms of positions about one pivot, or of a body that does not
    turn, along a circle (four and five: with three any two cranks do) or a line; none of others.
    ``given`` draws the positions."""
    size = body.size or 1.0
    turned = max(abs(math.remainder(p.angle - body.poses[0].angle, math.tau)) for p in body.poses)
    if turned > PARALLEL:
        found, off = _about_one_pivot(body)
    else:
        found, off = _without_turn(body)
    if off > RIGID * size:
        return []
    rounded = off > EXACT * size
    told = {"positions met to": f"{off:.3g} m"} if rounded else {}
    return [
        replace(
            one,
            chosen={**one.chosen, **told},
            allowed=(off + EXACT * size) / one.draft.driven(TURNING).scene.longest_m * rounded,
            steps=(given, *one.steps),
        )
        for one in found
    ]


def _about_one_pivot(body: CarriedBody) -> tuple[list[design.Proposal], float]:
    """Return the crank that the body is, and the distance of its poles from one another [m]."""
    pairs = list(itertools.combinations(body.poses, 2))
    poles = [place for place in (pole(*pair) for pair in pairs) if place is not None]
    if len(poles) < len(pairs):
        return [], math.inf
    # Poles of wide turns are the most certain ones.
    weights = [abs(cmath.exp(1j * (b.angle - a.angle)) - 1.0) ** 2 for a, b in pairs]
    pivot = complex(np.average(poles, weights=weights))
    own = body.poses[0].back(pivot)
    off = max(abs(pose.at(own) - pivot) for pose in body.poses)
    far = body.size or 1.0
    points = {key: at for key, at in body.points.items() if abs(at - own) > EXACT * far}
    shown = points or {design.letters_beside(body.points, 1)[0]: own + far}
    name = PIVOTS[0]
    links = {INPUT: plate({name: own, **shown})}
    draft = Draft(body.name, body.source, {name: pivot}, links, {})
    turned = replace(body, points=points)
    positions = tuple(turned.asked(pose.angle, pose, INPUT) for pose in body.poses)
    dot = design.Dot(pivot, name, "result", fixed=True)
    rays = design.rays(pivot, (pose.at(at) for pose in body.poses for at in shown.values()))
    step = design.DrawingStep(f"all poles are one point: the body turns about {name}", (*rays, dot))
    told = {"kind": "the body is a crank"}
    return [design.Proposal(draft, INPUT, positions, told, (step,))], off


def _without_turn(body: CarriedBody) -> tuple[list[design.Proposal], float]:
    """Return the slider or the parallelograms of a body that does not turn, and the distance of its
    places from their line or circle [m]."""
    places = [pose.point for pose in body.poses]
    slide = PoseSlide.of(places, 0j)
    span = max(abs(b - a) for a, b in itertools.combinations(places, 2))
    if slide.off > EXACT * span and len(places) == 3:
        return [], math.inf
    if slide.off > EXACT * span:
        triples = itertools.combinations(places, 3)
        three = max(triples, key=lambda p: abs(((p[1] - p[0]).conjugate() * (p[2] - p[0])).imag))
        if (centre := circle_through(*three)) is not None:
            radius = abs(three[0] - centre)
            off = max(abs(abs(place - centre) - radius) for place in places)
            if off <= slide.off:
                # The radius is that of the first place, and may be off by as much the other way.
                return list(_parallelograms(body, centre - places[0], radius)), 2.0 * off
    return [_on_a_line(body, slide)], slide.off


def _parallelograms(
    body: CarriedBody, to_centre: complex, radius: float
) -> Iterator[design.Proposal]:
    """Yield those of two cranks that stay on one side of the line of their pins in all positions,
    as far from it as possible: in it they are at a change point."""
    first = body.poses[0]
    cranks = [pose.point - first.point - to_centre for pose in body.poses]
    own = list(body.points.values())
    start, base = own[0], abs(own[1] - own[0]) if len(own) > 1 else radius
    ends = [start + cmath.rect(base, math.tau * k / DIRECTIONS) for k in range(DIRECTIONS)]

    def least(end: complex) -> float:
        turned = cmath.exp(1j * first.angle) * (end - start)
        sines = [(crank / turned).imag * abs(turned) / radius for crank in cranks]
        one_side = min(sines) > 0.0 or max(sines) < 0.0
        return min(map(abs, sines)) - 2.0 * (not one_side)

    found = sorted(own[1:] + ends, key=least, reverse=True)[:BEST]
    for end in [end for end in found if least(end) > CLEAR] or found[:1]:
        dyads = [PoseDyad(first.at(moving) + to_centre, moving) for moving in (start, end)]
        circles = (design.DrawnCircle(dyad.fixed, radius) for dyad in dyads)
        ground = (
            design.Dot(dyad.fixed, name, "result", fixed=True)
            for dyad, name in zip(dyads, PIVOTS, strict=True)
        )
        words = (
            "the body does not turn: all its points run on equal circles, and two cranks are one"
        )
        step = design.DrawingStep(words, (*circles, *ground))
        told = {"kind": "parallelogram", "cranks": f"{radius:.6g} m"}
        yield body.four_bar((dyads[0], dyads[1]), chosen=told, steps=(step,))


def _on_a_line(body: CarriedBody, slide: PoseSlide) -> design.Proposal:
    """Return the slider-crank whose slider the body is: it runs on a line and does not turn. A body
    that comes back does so in the other half of the crank's turn."""
    turn = cmath.exp(1j * slide.direction)
    ways = [((pose.point - slide.through) / turn).real for pose in body.poses]
    crank = CRANK * (max(ways) - min(ways))
    rod = ROD * crank
    pivot = slide.through + turn * (0.5 * (max(ways) + min(ways)) - rod)
    angles = []
    for k, pose in enumerate(body.poses):
        far = abs(pose.point - pivot)
        away = ways[max(k, 1)] > ways[max(k, 1) - 1]
        angle = math.acos((far**2 + crank**2 - rod**2) / (2.0 * far * crank))
        angles.append(slide.direction + (-angle if away else angle))
    slider = body.letter(0j, 1)
    pin, other = design.letters_beside([*body.points, slider], 2)
    beside = {} if len(body.points) > 1 else {other: complex(0.5 * crank)}
    direction = math.degrees(slide.direction)
    draft = Draft(
        body.name,
        body.source,
        {PIVOTS[0]: pivot},
        {
            INPUT: bar(PIVOTS[0], pin, crank),
            "rod": bar(pin, slider, rod),
            COUPLER: plate({slider: 0j} | dict(body.points) | beside),
        },
        {},
        sliders={
            slider: {
                "on": "ground",
                "link": COUPLER,
                "through_m": [slide.through.real, slide.through.imag],
                "direction_deg": direction,
                "angle_deg": math.degrees(body.poses[0].angle) - direction,
            }
        },
    )
    positions = tuple(map(body.asked, angles, body.poses))
    line = design.Segment(slide.through, slide.through + turn * max(ways, key=abs), beyond=0.2)
    dot = design.Dot(pivot, PIVOTS[0], "result", fixed=True)
    words = "the body runs on a line and does not turn: it is a slider, led by a crank and a rod"
    told = {"kind": "the body is a slider", "crank": f"{crank:.6g} m", "rod": f"{rod:.6g} m"}
    step = design.DrawingStep(words, (line, dot))
    return design.Proposal(draft, INPUT, positions, told, (step,))


def with_slide(
    body: CarriedBody, dyad: PoseDyad, slide: PoseSlide, which: int, given: design.DrawingStep
) -> design.Proposal:
    """Return the slider-crank whose rod the body is, driven at the crank; ``which`` is the number
    of the crank (0 or 1). An inverted slide is a block about a fixed pivot, on a line of the body.
    """
    pivot, pin = PIVOTS[which], body.letter(dyad.moving, which)
    other = PIVOTS[1 - which] if slide.inverted else body.letter(slide.point, 1 - which)
    own = {pin: dyad.moving} | ({} if slide.inverted else {other: slide.point})
    if len(own | dict(body.points)) == 1:
        own[design.letters_beside(own, 1)[0]] = slide.through
    ground = {pivot: dyad.fixed} | ({other: slide.point} if slide.inverted else {})
    line: Table = {
        "on": COUPLER if slide.inverted else "ground",
        "through_m": [slide.through.real, slide.through.imag],
        "direction_deg": math.degrees(slide.direction),
    }
    links = {
        INPUT: bar(pivot, pin, dyad.radius(body.poses)),
        COUPLER: plate(own | dict(body.points)),
    }
    draft = Draft(body.name, body.source, ground, links, {}, sliders={other: line})
    positions = tuple(map(body.asked, dyad.turns(body.poses), body.poses))
    seen = body.poses[0] if slide.inverted else PlanePose(0j, 0.0)
    start = seen.at(slide.through)
    along = cmath.rect(abs(start - dyad.fixed), seen.angle + slide.direction)
    words = f"{other} lies on a line of the {'body' if slide.inverted else 'ground'} in all "
    elements: tuple[design.Element, ...] = (
        design.Segment(start - along, start + along),
        design.DrawnCircle(dyad.fixed, dyad.radius(body.poses)),
        *design.chained(dyad.fixed, body.poses[0].at(dyad.moving)),
        design.Dot(dyad.fixed, pivot, "result", fixed=True),
    )
    step = design.DrawingStep(f"{words}positions: a slider takes the place of its crank", elements)
    told = {
        "driven at": pivot,
        "slider": f"{other}, along {round(math.degrees(slide.direction), 6):g} deg",
    }
    allowed = (1.0 + EXACT) * slide.off / draft.driven(TURNING).scene.longest_m
    return design.Proposal(draft, INPUT, positions, told, (given, step), allowed=allowed)


def cardan_crank(body: CarriedBody, slides: Sequence[PoseSlide]) -> PoseDyad | None:
    """Return the crank of an elliptic trammel: the circle through both sliders and the meeting
    point of their lines has its centre fixed in the body, and this runs on a circle about that
    point. None for parallel lines."""
    one, other = slides
    turned = math.sin(other.direction - one.direction)
    if abs(turned) < PARALLEL:
        return None
    between = other.through - one.through
    far = (between * cmath.exp(-1j * other.direction)).imag / -turned
    meet = one.through + cmath.rect(far, one.direction)
    for pose in body.poses:  # the first in which no slider is at that point
        centre = circle_through(pose.at(one.point), pose.at(other.point), meet)
        if centre is not None:
            return PoseDyad(meet, pose.back(centre))
    return None
