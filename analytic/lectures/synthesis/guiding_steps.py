"""How a body that two cranks hold in its positions is constructed, step by step."""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Sequence

from analytic.lectures.synthesis.construction import Circle, Curve, Dot, Element, Segment, Step
from analytic.lectures.synthesis.fourbar_draft import PIVOTS, CarriedBody
from analytic.lectures.synthesis.guided_body import Dyad
from analytic.lectures.synthesis.pose import bisector

Pair = tuple[Dyad, Dyad]
BEYOND = 0.15
"""Of its length a bisector is drawn on."""


def guiding_steps(body: CarriedBody, pair: Pair, *, inverted: bool) -> Iterator[Step]:
    """The construction: the body's places, bisectors or circles, and the links."""
    yield given_positions(body)
    for which, (dyad, pivot) in enumerate(zip(pair, PIVOTS, strict=True)):
        letter = body.letter(dyad.moving, which)
        if inverted:
            yield _inverted(body, dyad, pivot, letter)
        elif len(body.poses) < 4:
            yield _bisected(body, dyad, pivot, letter)
        else:
            words = f"{letter} is a circle point of all {len(body.poses)} positions, {pivot} the "
            circle = Circle(dyad.fixed, dyad.radius(body.poses))
            dot = Dot(dyad.fixed, pivot, "result", fixed=True)
            yield Step(words + "middle of its circle", (circle, dot))
    yield links(body, pair)


def given_positions(body: CarriedBody) -> Step:
    """The body in its positions: the line between two points of it, or a short one along its own
    x-axis."""
    elements: list[Element] = []
    (name, start), *others = body.points.items()
    span = max(abs(b.point - a.point) for a, b in itertools.combinations(body.poses, 2))
    second, end = others[0] if others else ("", start + 0.25 * span)
    for number, pose in enumerate(body.poses, 1):
        elements.append(Segment(pose.at(start), pose.at(end), "given"))
        elements.append(Dot(pose.at(start), f"{name}{number}", "given"))
        if second:
            elements.append(Dot(pose.at(end), f"{second}{number}", "given"))
    return Step(f"{name}{second} in its {len(body.poses)} positions", tuple(elements))


def _bisected(body: CarriedBody, dyad: Dyad, pivot: str, letter: str) -> Step:
    """The fixed pivot on the bisectors between the places of a moving one."""
    places = [pose.at(dyad.moving) for pose in body.poses]
    elements: list[Element] = []
    for first, second in itertools.pairwise(places):
        middle = bisector(first, second).middle
        elements.append(Segment(first, second))
        elements.append(Segment(middle, dyad.fixed, beyond=BEYOND))
    elements.append(Dot(dyad.fixed, pivot, "result", fixed=True))
    names = [f"{letter}{number}" for number in range(1, len(places) + 1)]
    if len(places) == 2:
        words = f"{pivot} anywhere on the bisector of {names[0]}{names[1]}"
    else:
        elements.append(Circle(dyad.fixed, dyad.radius(body.poses)))
        words = (
            f"the bisectors of {names[0]}{names[1]} and {names[1]}{names[2]} meet in {pivot}, the "
            f"middle of the circle through {', '.join(names)}"
        )
    return Step(words, tuple(elements))


def _inverted(body: CarriedBody, dyad: Dyad, pivot: str, letter: str) -> Step:
    """The moving pivot from the places of a fixed one, as the body in position 1 sees it."""
    first = body.poses[0]
    places = [first.at(pose.back(dyad.fixed)) for pose in body.poses]
    centre = first.at(dyad.moving)
    elements: list[Element] = [Dot(dyad.fixed, pivot, "given", fixed=True)]
    elements += [Dot(place, f"{pivot}'{number}") for number, place in enumerate(places[1:], 2)]
    for one, other in itertools.pairwise(places):
        elements.append(Segment(bisector(one, other).middle, centre, beyond=BEYOND))
    elements += [Circle(centre, abs(centre - dyad.fixed)), Dot(centre, f"{letter}1", "result")]
    return Step(
        f"{pivot} as the body sees it: its places turned back into position 1 lie on a circle "
        f"about {letter}1",
        tuple(elements),
    )


def links(body: CarriedBody, pair: Pair) -> Step:
    """The four-bar in its first position."""
    pins = [body.poses[0].at(dyad.moving) for dyad in pair]
    letters = [f"{body.letter(dyad.moving, which)}1" for which, dyad in enumerate(pair)]
    elements: tuple[Element, ...] = (
        Segment(pair[0].fixed, pins[0], "result"),
        Segment(pins[0], pins[1], "result"),
        Segment(pins[1], pair[1].fixed, "result"),
        *(Dot(place, letter, "result") for place, letter in zip(pins, letters, strict=True)),
        *(
            Dot(dyad.fixed, pivot, "result", fixed=True)
            for dyad, pivot in zip(pair, PIVOTS, strict=True)
        ),
    )
    return Step(f"the links {PIVOTS[0]}{letters[0]}, {''.join(letters)} and "
                f"{PIVOTS[1]}{letters[1]}", elements)  # fmt: skip


def curve_steps(body: CarriedBody, curves: Sequence[Sequence[Dyad]]) -> Iterator[Step]:
    """Burmester's curves of four positions."""
    yield given_positions(body)
    centres = tuple(tuple(dyad.fixed for dyad in piece) for piece in curves)
    circles = tuple(tuple(body.poses[0].at(dyad.moving) for dyad in piece) for piece in curves)
    yield Step("the centre-point curve: where fixed pivots can stand", (Curve(centres),))
    yield Step("the circle-point curve: their moving pivots in position 1", (Curve(circles),))
