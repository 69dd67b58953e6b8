"""Tolerances: one per quantity, for every engine alike, as pure numbers, each with its reason.

A default is a budget that follows from the step and from the scene, as the theory of the error
says::

    min(cap, (coefficient * step^order + summed) * curvature^power / conditioning
             + (share * curvature + load_share * loading) * step^s
             + slope * place / conditioning)  +  floor  +  rounding / step^k

``step`` is the driver's turn in one time step [rad], ``curvature`` the largest pure acceleration of
the reference (at least 1), ``conditioning`` its smallest sine of a transmission angle, and
``share`` what a soft constraint may leave open of an acceleration (s = 0), and so of a velocity (s
= 1), at every step; k is how often the quantity was differenced. ``summed`` is what rounding may
make of the driver's angle by the end of the run [rad] (`reports.compare.drive_rounding`), which the
mechanism passes on as it does the driver's motion: the one part that grows with the number of
steps.

For places and gaps ``curvature / conditioning`` is at least twice the largest ``jolt``, half of
a + omega^2 r at a distance r from the centre of a body: that much, times step^2, an engine that
solves for impulses sets bodies off to close its joints (`reports.judge.start_allowance`).

A change point that the motion goes through is left out of ``conditioning``, with half a radian of
the driver on both sides (`reports.compare.change_points`). Rates there are held to limits of their
own (`in_passage`): what it takes to make good an error of place, within its limit, in one step.

What was let go is ever further off the longer it lasts, by ``lasting * travel * step^3 *
curvature^1.5`` more: impulses and springs that close joints take energy at every step, and what
that makes of the phase adds up to that. ``travel`` [rad] is what the driver turns through, each
part of it weighed with the square of its speed over the largest: it is fast for a small part of a
swing alone. And a speed that is off by a share of step^2 makes a phase that is off by ``drifting``
of what the driver turns through, which counts where the sensitivity does not grow as fast: a motor
that keeps the speed. Where the joints push hard at the start, in which engines open them by the arc
of a step, they take a share of the energy: the phase is off by ``opening`` of that, too.

The energy itself is off by ``arc`` times what the arcs of steps may make of its means, and ``late``
times what impulses that come a step late may have lost (`analytic.forces.late_impulses`), weighed
with the masses, as no acceleration of a light link says. On the shipped scenes pymunk has up to 0.6
of it; over the step and the curvature alone its drifts went from 0.02 to 19 times one limit.

Where links bend, rates have as many joints in a row as there are segments, each with a part of its
own: their budget grows with the root of that number. The deflection of the links, a share of its
largest, has the budget of places over that (``bends``), and what the swings of the springs are off
by (`_swung`); all that is held to the beam, what the exact chain of as many segments is off it by
(`reports.compare.elastic`), as that is no engine's fault. A beam of an engine's own has no joints
within: its deflection is off by that share of itself by which what bends it is. Of exudyn it is a
quarter of all that on the shipped scenes.

Forces are shares of the largest of the reference, in which the masses cancel: no ratio of these is
in their budget, but in that of the start (`reports.judge.start_allowance`).

Loads add two parts, and none where there are none (`reports.compare.loading`). A soft constraint
gives way by ``share`` of the acceleration that a load would give its body, times the square of its
time constant, some steps; where that bends, by ``loading`` from step to step, accelerations are
off. And a load that rises over a displacement by ``slope`` is another where its slider is off by
``place``: by what it was seen to be, and by no more than its limit.

A motor between two moving bodies is closed by a step as their pins are: its drive has a tenth of
the budget of places, and not that of rounding alone.

``cap`` is what anyone would call wrong, whatever the theory grants: near a singular position the
budget grows without end, and an engine on the other branch must not pass.

The coefficients are measured, at 90 to 1440 steps a turn on every shipped scene, and leave the
worst engine of profile tuned a factor of two. A number given by the scene or on the command line
is taken as it stands.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from models.errors import CrankcheckError, suggestion
from models.scene import Scene
from reports.compare.elastic.elastic_facts import ElasticFacts
from reports.compare.errors import Errors
from reports.judge.three_steps import AT_ROUNDING
from reports.quantities import QUANTITIES, named
from reports.quantities.places import WITHIN_A_STEP
from reports.quantities.quantity import Tolerance, tolerance_name

DEFAULTS: dict[str, Tolerance] = {
    tolerance_name(name, each.source): each.tolerance
    for name, entry in QUANTITIES.items()
    for each in entry.criteria
    if entry.role not in ("free", "elastic")
}
"""Of a mechanism that is driven."""
BENDING: dict[str, Tolerance] = {
    tolerance_name(name, each.source): each.tolerance
    for name, entry in QUANTITIES.items()
    for each in entry.criteria
    if entry.role == "elastic"
}
"""Of elastic links themselves."""
ELASTIC = DEFAULTS | BENDING
"""Of a mechanism whose links bend."""
FREE: dict[str, Tolerance] = {
    tolerance_name(name, each.source): of_free
    for name, entry in QUANTITIES.items()
    for each in entry.criteria
    if (of_free := each.tolerance if entry.role == "free" else each.free) is not None
}
"""Of one that was let go: its errors at the same time are over the sensitivity of its motion."""
FREE_ELASTIC = FREE | BENDING
"""Of one whose links bend as well."""
EVERY = tuple(dict.fromkeys((*DEFAULTS, *FREE, *ELASTIC)))
"""All that there may be a limit of."""

CLOSED_BY_A_MOTOR = 0.1
"""Of the budget of places: what a motor between two moving bodies may leave open."""
FORCES = frozenset(named("force"))


def default(tolerance: Tolerance, errors: Errors) -> float:
    """The limit for a run with this step and this scene."""
    step, curvature = errors.step_rad, errors.curvature
    bend = curvature**tolerance.power
    if tolerance.conditioned:
        bend /= max(errors.conditioning, 1e-12)
    if tolerance.closes:
        bend = max(bend, 2.0 * errors.worst_jolt)
    budget = (tolerance.coefficient * step**tolerance.order + errors.summed_rad) * bend
    if tolerance.rate and errors.elastic is not None:
        budget *= math.sqrt(errors.elastic.segments)
    budget += tolerance.drifting * errors.drifted_rad * step**tolerance.order
    lasted = errors.travel_rad * step ** (tolerance.order + 1) * curvature**1.5
    budget += tolerance.lasting * lasted
    budget += tolerance.opening * errors.late.start * errors.drifted_rad
    budget += tolerance.arc * errors.late.offset + tolerance.late * errors.late.loss
    shaken = tolerance.share * curvature + tolerance.load_share * errors.loading
    budget += shaken * step**tolerance.share_order
    budget += _felt(tolerance, errors)
    if tolerance.bends and errors.elastic is not None:
        joined = 1.0 if errors.elastic.of_beam else errors.elastic.slender
        budget = budget * joined + _swung(step, errors.elastic)
    budget = min(float(budget), tolerance.cap)
    return float(budget + tolerance.floor + AT_ROUNDING / step**tolerance.differenced)


def _felt(tolerance: Tolerance, errors: Errors) -> float:
    """What loads are off by where their sliders are off, as a share of the largest force."""
    slope = errors.load_slopes.get(tolerance.slope, 0.0)
    if not slope:
        return 0.0
    worst, most = errors.worst("displacement"), default(WITHIN_A_STEP, errors)
    off = worst.pure if worst is not None and worst.pure <= most else most
    return slope * off / max(errors.conditioning, 1e-12)


def _swung(step: float, elastic: ElasticFacts) -> float:
    """What the swings of springs are off by, of which a step makes (r step)^2/24 of the phase.

    What starts straight rings as under an even load: k half-waves, k odd, with 1/k^5 of the
    deflection, k^2 times as fast, and so with k^6 of the phase, up to their whole swing. Of that
    the sum falls as the step to the power 4/3.
    """
    phase = (elastic.ratio * step) ** 2 * (1.0 + math.tau * elastic.cycles) / 12.0
    if not elastic.straight:
        return phase
    return sum(min(2.0, k**6 * phase) / k**5 for k in range(1, elastic.segments, 2))


def beyond_engine(name: str, errors: Errors) -> float:
    """What the exact chain of segments, or what elements, are off the beam by, and the beam itself,
    of a quantity."""
    elastic = errors.elastic
    if elastic is None or name == "segments":
        return 0.0
    own = elastic.apart.get(name.removesuffix("-differenced"), 0.0)
    if elastic.estimated:
        own *= 2.0
    if name in FORCES:  # what bends by another share pushes by as much more
        locked = 2.0 * elastic.chain if elastic.of_beam else 0.0
        return own + 0.5 * (default(ELASTIC["segments"], errors) + locked)
    return own + (elastic.doubt if name == "deflection" else 0.0)


def passing(tolerance: Tolerance, errors: Errors) -> float:
    """The limit of a rate near a change point, where places are made good within a step."""
    made_good = default(WITHIN_A_STEP, errors) / errors.step_rad**tolerance.rate
    return max(default(tolerance, errors), made_good)


@dataclass(frozen=True)
class Limit:
    """The limit in force for one quantity, and where it comes from."""

    number: float
    origin: str


def numbers_for(errors: Errors) -> Mapping[str, Tolerance]:
    """The numbers of the default limits of a run."""
    return known_limits(free=errors.free is not None, bends=errors.elastic is not None)


def known_limits(*, free: bool, bends: bool) -> Mapping[str, Tolerance]:
    """Those that there are of what is let go, or driven, with links that bend or without."""
    if bends:
        return FREE_ELASTIC if free else ELASTIC
    return FREE if free else DEFAULTS


def limits(
    scene: Scene, errors: Errors, overrides: Mapping[str, float], option: str = "--tol"
) -> dict[str, Limit]:
    """The limit per tolerance name: command line before scene before default."""
    chosen = {}
    for name, tolerance in numbers_for(errors).items():
        if name in overrides:
            chosen[name] = Limit(overrides[name], option)
        elif name in scene.tolerance:
            chosen[name] = Limit(scene.tolerance[name], "scene")
        else:
            own = default(tolerance, errors) + beyond_engine(name, errors)
            if name == "drive" and errors.drives_within:
                own += CLOSED_BY_A_MOTOR * default(WITHIN_A_STEP, errors)
            chosen[name] = Limit(own, "default")
    return chosen


def in_passage(name: str, limit: Limit, errors: Errors) -> Limit:
    """The limit for a rate near a change point; one that was given stands there too. Forces have
    none: where a dyad is singular its joints may push against each other as they like, and the
    motion is the same."""
    if limit.origin != "default":
        return limit
    if name in FORCES:
        return Limit(math.inf, "not judged near a change point")
    return Limit(passing(numbers_for(errors)[name], errors), "default near a change point")


def parse(texts: Iterable[str], option: str = "--tol", every: str = "") -> dict[str, float]:
    """`angle=1e-4` and the like, also several in one text with commas between.

    ``every`` is the name that a number by itself is kept under, where it may stand so.

    Raises
    ------
    CrankcheckError
        A text that is not NAME=NUMBER, a name that is no quantity, a number that is not positive.
    """
    numbers: dict[str, float] = {}
    for text in (part.strip() for whole in texts for part in whole.split(",")):
        name, equals, number = text.rpartition("=")
        place = f"{option} {text!r}"
        if not (equals or every):
            raise CrankcheckError(f"{place}: no `=` in it; write it like {option} angle=1e-4")
        key = _quantity(name.strip(), place) if equals else every
        numbers[key] = _positive(number, place)
    return numbers


def check_names(scene: Scene) -> None:
    """Refuse a scene whose [tolerance] names something that is no quantity."""
    for name in scene.tolerance:
        _quantity(name, f"scene {scene.name}, [tolerance] {name}")


def refuse_forces_unasked(option: str, quantities: Iterable[str]) -> None:
    """Refuse an option about forces where these are not judged. Raises CrankcheckError."""
    asked = [name for name in quantities if name in FORCES]
    if asked:
        raise CrankcheckError(
            f"{option} {asked[0]}: forces are not judged unless they are asked for; add --forces, "
            f"or leave {asked[0]} out"
        )


def refuse_of_other_motion(
    option: str, quantities: Iterable[str], free: Iterable[bool], *, bends: bool = False
) -> None:
    """Refuse limits of what none of the cells has, which are ``free`` or driven; ``bends``
    says that one has elastic links. Raises CrankcheckError."""
    known = {name for each in set(free) for name in known_limits(free=each, bends=bends)}
    other = [name for name in quantities if name not in known]
    if other:
        of = "of free motion; let scenes go with --free, or" if other[0] in FREE else "of a drive;"
        of = "of elastic links;" if other[0] in BENDING else of
        raise CrankcheckError(
            f"{option} {other[0]}: it is {of} leave {other[0]} out. There is {', '.join(known)}"
        )


def _quantity(name: str, place: str) -> str:
    """The name, or a CrankcheckError that suggests the near ones."""
    if name in EVERY:
        return name
    hint = suggestion(name, EVERY, "use one of", 2, 0.6)
    raise CrankcheckError(f"{place}: {name!r} is no quantity; {hint}")


def _positive(number: str, place: str) -> float:
    """A finite number above 0."""
    try:
        value = float(number)
    except ValueError:
        value = math.nan
    if not (math.isfinite(value) and value > 0.0):
        raise CrankcheckError(
            f"{place}: {number.strip()!r} is not a number above 0; write it like angle=1e-4"
        )
    return value
