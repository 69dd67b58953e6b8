"""Body carried by the coupler of a four-bar through two, three, four or five positions."""

import itertools
from collections.abc import Iterator, Sequence

from analytic.lectures.synthesis.burmester import five_positions, four_positions
from analytic.lectures.synthesis.design import (
    COINCIDING,
    PIVOTS,
    CarriedBody,
    Dot,
    DrawingStep,
    DrawnCircle,
    DrawnCurve,
    Element,
    Proposal,
    Segment,
    chained,
)
from analytic.lectures.synthesis.driving_dyad import swings_little, with_driving_dyad
from analytic.lectures.synthesis.pose import (
    PlanePose,
    PoseDyad,
    PoseSlide,
    about_bisector,
    about_circumcentre,
    about_given_pivot,
    bisector,
    crank_or_slide,
    refuse_coinciding,
    sound_pairs,
)
from analytic.lectures.synthesis.special_positions import (
    SURELY,
    cardan_crank,
    special_proposals,
    with_slide,
)
from models.errors import CrankcheckError
from models.lectures.tasks.positions import CouplerTask

Pair = tuple[PoseDyad, PoseDyad]
BEYOND = 0.15
"""Extension of a drawn bisector, over its length."""


def guiding_steps(body: CarriedBody, pair: Pair, *, inverted: bool) -> Iterator[DrawingStep]:
    """Yield the construction: the body's places, bisectors or circles, and the links."""
    yield given_positions(body)
    for which, (dyad, pivot) in enumerate(zip(pair, PIVOTS, strict=True)):
        letter = body.letter(dyad.moving, which)
        if inverted:
            yield _inverted(body, dyad, pivot, letter)
        elif len(body.poses) < 4:
            yield _bisected(body, dyad, pivot, letter)
        else:
            words = f"{letter} is a circle point of all {len(body.poses)} positions, {pivot} the "
            circle = DrawnCircle(dyad.fixed, dyad.radius(body.poses))
            dot = Dot(dyad.fixed, pivot, "result", fixed=True)
            yield DrawingStep(words + "middle of its circle", (circle, dot))
    yield links(body, pair)


def given_positions(body: CarriedBody) -> DrawingStep:
    """Draw the body in its positions: the line between two points of it, or a short one along its
    own x-axis."""
    elements: list[Element] = []
    (name, start), *others = body.points.items()
    span = max(abs(b.point - a.point) for a, b in itertools.combinations(body.poses, 2))
    second, end = others[0] if others else ("", start + 0.25 * span)
    for number, pose in enumerate(body.poses, 1):
        elements.append(Segment(pose.at(start), pose.at(end), "given"))
        elements.append(Dot(pose.at(start), f"{name}{number}", "given"))
        if second:
            elements.append(Dot(pose.at(end), f"{second}{number}", "given"))
    return DrawingStep(f"{name}{second} in its {len(body.poses)} positions", tuple(elements))


def _bisected(body: CarriedBody, dyad: PoseDyad, pivot: str, letter: str) -> DrawingStep:
    """Draw the fixed pivot on the bisectors between the places of a moving one."""
    places = [pose.at(dyad.moving) for pose in body.poses]
    elements: list[Element] = []
    for first, second in itertools.pairwise(places):
        middle = bisector(first, second).middle
        elements.append(Segment(first, second))
        elements.append(Segment(middle, dyad.fixed, beyond=BEYOND))
    elements.append(Dot(dyad.fixed, pivot, "result", fixed=True))
    a, b, c = (f"{letter}{number}" for number in (1, 2, 3))
    words = f"{pivot} anywhere on the bisector of {a}{b}"
    if len(places) > 2:
        elements.append(DrawnCircle(dyad.fixed, dyad.radius(body.poses)))
        words = (
            f"the bisectors of {a}{b} and {b}{c} meet in {pivot}, the middle of the circle through "
            f"{a}, {b}, {c}"
        )
    return DrawingStep(words, tuple(elements))


def _inverted(body: CarriedBody, dyad: PoseDyad, pivot: str, letter: str) -> DrawingStep:
    """Draw the moving pivot from the places of a fixed one, seen from the body in position 1."""
    first = body.poses[0]
    places = [first.at(pose.back(dyad.fixed)) for pose in body.poses]
    centre = first.at(dyad.moving)
    elements: list[Element] = [Dot(dyad.fixed, pivot, "given", fixed=True)]
    elements += [Dot(place, f"{pivot}'{number}") for number, place in enumerate(places[1:], 2)]
    for one, other in itertools.pairwise(places):
        elements.append(Segment(bisector(one, other).middle, centre, beyond=BEYOND))
    elements += [DrawnCircle(centre, abs(centre - dyad.fixed)), Dot(centre, f"{letter}1", "result")]
    return DrawingStep(
        f"{pivot} as the body sees it: its places turned back into position 1 lie on a circle "
        f"about {letter}1",
        tuple(elements),
    )


def links(body: CarriedBody, pair: Pair) -> DrawingStep:
    """Draw the four-bar in its first position."""
    first, second = (body.poses[0].at(dyad.moving) for dyad in pair)
    a, b = (f"{body.letter(dyad.moving, which)}1" for which, dyad in enumerate(pair))
    elements: tuple[Element, ...] = (
        *chained(pair[0].fixed, first, second, pair[1].fixed),
        Dot(first, a, "result"),
        Dot(second, b, "result"),
        Dot(pair[0].fixed, PIVOTS[0], "result", fixed=True),
        Dot(pair[1].fixed, PIVOTS[1], "result", fixed=True),
    )
    return DrawingStep(f"the links {PIVOTS[0]}{a}, {a}{b} and {PIVOTS[1]}{b}", elements)


def curve_steps(body: CarriedBody, curves: Sequence[Sequence[PoseDyad]]) -> Iterator[DrawingStep]:
    """Draw Burmester's curves of four positions."""
    yield given_positions(body)
    at = body.poses[0].at
    centres = DrawnCurve(tuple(tuple(dyad.fixed for dyad in piece) for piece in curves))
    circles = DrawnCurve(tuple(tuple(at(dyad.moving) for dyad in piece) for piece in curves))
    yield DrawingStep("the centre-point curve: where fixed pivots can stand", (centres,))
    yield DrawingStep("the circle-point curve: their moving pivots in position 1", (circles,))


DISTANCES = (0.5, 1.0, 2.0)
"""Default distances of fixed pivots for two positions, from the middles of the ways, over the
longest way, on either side."""
CURVE_DYADS = 240
"""Number of dyads of Burmester's curves that are paired with each other."""
CHOSEN = 40
"""Pairs of four positions that are examined, the best transmitting in the positions first."""
FALLEN_BACK = 3
"""Number of examined pairs if all have a defect."""


def coupler_proposals(
    task: CouplerTask, *, few: bool = False, unled: bool = False
) -> tuple[list[Proposal], int]:
    """Return the four-bars of a task, or ``few`` of very many, and the number of pairs of cranks
    considered; ``unled`` the crank or slider that does what no four-bar can be led through. Raises
    CrankcheckError for positions that coincide; a point that stays; no crank that holds the body in
    all positions."""
    poses = tuple(PlanePose(point, angle) for point, angle in task.poses)
    body = CarriedBody(task.name, task.source, poses, task.own_points)
    refuse_coinciding(body.poses, body.size)
    unled = unled or _is_special(task, body)
    special = special_proposals(body, given_positions(body)) if unled else []
    if special and special[0].allowed <= SURELY:
        return special, len(special)
    try:
        proposals, looked = _general(task, body, few=few)
    except CrankcheckError:
        if not special:
            raise
        return special, len(special)
    return special + proposals, len(special) + looked


def _is_special(task: CouplerTask, body: CarriedBody) -> bool:
    """True for three positions and more, and for two if a moving pivot stays where it is."""
    if len(body.poses) > 2:
        return True
    first, last = body.poses
    near = COINCIDING * body.size
    return any(abs(last.at(z) - first.at(z)) <= near for z in _moving(task, body))


def _general(task: CouplerTask, body: CarriedBody, *, few: bool) -> tuple[list[Proposal], int]:
    """Return the mechanisms of positions about different poles."""
    if len(body.poses) == 2:
        pairs = list(_two(task, body, DISTANCES[1:2] if few else DISTANCES))
    elif len(body.poses) == 3:
        one, other = _three(task, body)
        if isinstance(one, PoseSlide) or isinstance(other, PoseSlide):
            found = list(_sliding(task, body, (one, other)))
            return found, len(found)
        pairs = [((one, other), {})]
    else:
        return _many(task, body, few=few)
    proposals = [
        proposal for pair, chosen in pairs for proposal in _driven(task, body, pair, chosen)
    ]
    if task.driving_dyad:
        proposals = [
            six for four in proposals if swings_little(four) for six in with_driving_dyad(four)
        ]
        if not proposals:
            raise CrankcheckError(
                f"{task.name}: no driving dyad: the input link of every four-bar turns by half a "
                "turn between the positions; take other distances_m"
            )
    return proposals, len(proposals)


def _moving(task: CouplerTask, body: CarriedBody) -> tuple[complex, complex]:
    """Return the two moving pivots in the body's frame."""
    if task.moving_m is not None:
        one, other = (body.poses[0].back(complex(*place)) for place in task.moving_m)
    else:
        one, other = body.points.values()
    if one == other:
        raise CrankcheckError(f"{task.name}: the two moving pivots coincide; take two points apart")
    return one, other


def _two(
    task: CouplerTask, body: CarriedBody, shares: Sequence[float]
) -> Iterator[tuple[Pair, dict[str, str]]]:
    """Yield pairs for two positions: the fixed pivots anywhere on the bisectors."""
    moving = _moving(task, body)
    ways = [abs(body.poses[1].at(z) - body.poses[0].at(z)) for z in moving]
    steps = [sign * share * max(ways) for share in shares for sign in (1.0, -1.0)]
    for far in [task.distances_m] if task.distances_m else itertools.product(steps, steps):
        one, other = (about_bisector(body.poses, *each) for each in zip(moving, far, strict=True))
        told = zip(PIVOTS, far, strict=True)
        yield (one, other), {f"{name} from the middle": f"{way:.6g} m" for name, way in told}


def _three(task: CouplerTask, body: CarriedBody) -> list[PoseDyad | PoseSlide]:
    """Return two dyads for three positions: moving pivots by circles, fixed ones by inversion."""
    if task.fixed_m is not None:
        return [about_given_pivot(body.poses, complex(*place)) for place in task.fixed_m]
    return [about_circumcentre(body.poses, moving) for moving in _moving(task, body)]


def _sliding(
    task: CouplerTask, body: CarriedBody, dyads: Sequence[PoseDyad | PoseSlide]
) -> Iterator[Proposal]:
    """Yield the slider-cranks of dyads of which one, or both, have a pivot at infinity. Raises
    CrankcheckError for two sliders that no crank drives."""
    given = given_positions(body)
    slides = {which: one for which, one in enumerate(dyads) if isinstance(one, PoseSlide)}
    cranks = [one for one in dyads if isinstance(one, PoseDyad)]
    if not cranks and task.fixed_m is None:
        cranks = [each for each in [cardan_crank(body, [*slides.values()])] if each is not None]
    if not cranks:
        raise CrankcheckError(
            f"{task.name}: both pivots lie on a line in the three positions, and the lines are "
            "parallel or of the body: no crank drives two such sliders; take another pivot"
        )
    for which, slide in slides.items():
        yield with_slide(body, cranks[0], slide, 1 - which, given)


def _many(task: CouplerTask, body: CarriedBody, *, few: bool) -> tuple[list[Proposal], int]:
    """Return four-bars of four positions, along Burmester's curves, or of five, by all cranks."""
    lines = [PoseSlide.of([p.at(z) for p in body.poses], z) for z in body.points.values()]
    if len(lines) > 1 and all(each.off <= COINCIDING * body.size for each in lines):
        found = list(_sliding(task, body, lines))
        return found, len(found)
    is_four = len(body.poses) == 4
    curves = four_positions(body.poses) if is_four else []
    dyads = _wished(task, curves) if is_four else five_positions(body.poses)
    if len(dyads) < 2:
        raise CrankcheckError(
            f"{task.name}: {len(dyads)} cranks hold the body in all {len(body.poses)} positions "
            "(real Burmester pairs), and a four-bar needs two; change a position, or leave one out "
            "and take one of the curves of the other four"
        )
    if curves:
        sound = sound_pairs(body.poses, dyads)
        count = min(FALLEN_BACK if few else CHOSEN, sound.sound) or FALLEN_BACK
        chosen = [(dyads[i], dyads[k]) for i, k in sound.pairs[:count].tolist()]
        steps = tuple(curve_steps(body, curves))
        return [body.four_bar(pair, steps=steps) for pair in chosen], len(sound.pairs)
    proposals: list[Proposal] = []
    short = [
        crank_or_slide([pose.at(each.moving) for pose in body.poses], each.fixed, each.moving)
        for each in dyads
    ]
    for pair in itertools.combinations(short, 2):
        one, other = pair
        if isinstance(one, PoseSlide) or isinstance(other, PoseSlide):
            proposals += _sliding(task, body, pair)
        else:
            proposals += _driven(task, body, (one, other), {})
    return proposals, len(proposals)


def _wished(task: CouplerTask, pieces: Sequence[Sequence[PoseDyad]]) -> list[PoseDyad]:
    """Return about `CURVE_DYADS` cranks along the curves: those with fixed pivots in the wished
    region, if two have."""
    every = [dyad for piece in pieces for dyad in piece]
    region = task.pivots_in
    inside = [dyad for dyad in every if region is not None and region.holds(dyad.fixed)]
    kept = inside if len(inside) > 1 else every
    return kept[:: max(1, len(kept) // CURVE_DYADS)]


def _driven(
    task: CouplerTask, body: CarriedBody, pair: Pair, chosen: dict[str, str]
) -> Iterator[Proposal]:
    """Yield the four-bar of a pair, driven at the requested sides."""
    steps = tuple(guiding_steps(body, pair, inverted=task.fixed_m is not None))
    if task.driver != "second":
        yield body.four_bar(pair, chosen=chosen, steps=steps)
    if task.driver != "first":
        yield body.four_bar(pair, driven=1, chosen=chosen, steps=steps)
