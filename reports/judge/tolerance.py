"""Tolerances: one per quantity, for every engine alike, as pure numbers, each with its reason.
The numbers stand with each quantity, in `reports.quantities`.

A default is a budget by the step and the scene, from the theory of the error::

    min(cap, (coefficient * step^order + summed) * curvature^power / conditioning
             + (share * curvature + load_share * loading) * step^s
             + slope * place / conditioning)  +  floor  +  rounding / step^k

``step`` is the driver's turn in one time step [rad], ``curvature`` the largest pure acceleration of
the reference (at least 1), ``conditioning`` its smallest sine of a transmission angle, and
``share`` the part that a soft constraint may leave open of an acceleration (s = 0), and so of a
velocity (s = 1), at every step; k is the number of differentiations. ``summed`` is the rounding
of the driver's angle by the end of the run [rad] (`reports.compare.whole_errors`), which the
mechanism transmits like the driver's motion: the one part that grows with the number of steps.
The rounding of single precision is added before the cap (`shaken_by_rounding`).

For positions and gaps ``curvature / conditioning`` is at least twice the largest ``jolt``, half of
a + omega^2 r at a distance r from the centre of a body: an engine that solves for impulses
displaces bodies by that times step^2 to close its joints (`reports.judge.rules.limits`).

A change point on the way is left out of ``conditioning``, with half a radian of the driver on both
sides (`reports.compare.hardness`). Rates there have separate limits (`in_passage`): the rate that
corrects a position error, within its limit, in one step.

Errors of free motion grow with its length, by ``lasting * travel * step^3 * curvature^1.5``:
impulses and springs that close joints take energy at every step, and their effects on the phase add
up to that. ``travel`` [rad] is the driver's turning, each part weighed with the square of its speed
over the largest: it is fast for a small part of a swing alone. And a speed error of a share of
step^2 makes a phase error of ``drifting`` of the driver's turning, which counts where the
sensitivity does not grow as fast: with a motor that keeps the speed. Where the joints push hard at
the start, in which engines open them by the arc of a step, they take a share of the energy: this
adds ``opening`` of that to the phase error.

The profile of a cam by contact has facets: their sagitta and the flights over their corners are no
engine's fault, and have no cap; its follower sinks in by the way that closes it in a step, or flies
as far (`reports.compare.errors.FacetFacts`).

Where the law of a cam jumps in acceleration or jerk, a step over the jump has some of either side:
accelerations are off by up to that of the acceleration, and by half of what the jerk's changes in
a step.

The energy itself is off by ``arc`` times the possible effect of the arcs of steps on its means, and
``late`` times the possible loss by impulses that come a step late
(`analytic.forces.late_impulses`), weighed with the masses, as no acceleration of a light link
shows. On the shipped scenes pymunk has up to 0.6 of it; over the step and the curvature alone its
drifts went from 0.02 to 19 times one limit.

Where links bend, rates have as many joints in a row as there are segments, each with a part of its
own: their budget grows with the root of that number. The deflection of the links, a share of its
largest, has the budget of positions over that (``bends``), and the error of the swings of the
springs (`ElasticFacts.deflecting`); all quantities compared with the beam have the exact chain's
own difference from it in addition (`reports.compare.elastic_errors`), as that is no engine's fault.
A beam of an engine's own has no joints within: its deflection error is the relative error of the
bending loads. For exudyn it is a quarter of all that on the shipped scenes.

Forces are shares of the largest of the reference, in which the masses cancel: no ratio of these is
in their budget, but in that of the start (`reports.judge.rules.limits`).

Loads add two parts, and none without loads (`reports.compare.hardness`). A soft constraint gives
way by ``share`` of the acceleration that a load would give its body, times the square of its time
constant, some steps; where that bends, by ``loading`` from step to step, accelerations are off. And
a load that rises over a displacement by ``slope`` changes where its slider is off by ``place``: the
observed error, and at most its limit.

A motor between two moving bodies is closed by a step as their pins are: its drive has a tenth of
the budget of positions, and not that of rounding alone.

``cap`` is a plainly wrong result, whatever the theory grants: near a singular position the budget
grows without end, and an engine on the other branch must not pass.

The coefficients are measured, at 90 to 1440 steps a turn on every shipped scene, and leave the
worst engine of profile tuned a factor of two. A number given by the scene or on the command line is
taken unchanged.
"""

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from models.errors import CrankcheckError, suggestion
from models.scene import Scene
from reports.compare.errors import Errors
from reports.quantities import named
from reports.quantities.limits import BENDING, EVERY, FREE
from reports.quantities.places import WITHIN_A_STEP
from reports.quantities.quantity import Tolerance
from sim.engine import AT_ROUNDING

CLOSED_BY_A_MOTOR = 0.1
"""Share of the budget of positions that a motor between two moving bodies may leave open."""
BORNE = 2.5
"""Share of a largest force by which a jump of all accelerations by their scale is borne."""
FORCES = frozenset(named("force"))


def default(tolerance: Tolerance, errors: Errors) -> float:
    """Return the limit for a run with this step and this scene."""
    scene, motion, links = errors.of_scene, errors.of_motion, errors.of_links
    step, curvature = scene.step_rad, scene.curvature
    bend = curvature**tolerance.power
    if tolerance.conditioned:
        bend /= max(scene.conditioning, 1e-12)
    if tolerance.closes:
        bend = max(bend, 2.0 * scene.worst_jolt)
    budget = (tolerance.coefficient * step**tolerance.order + scene.summed_rad) * bend
    if tolerance.rate:
        budget *= math.sqrt(links.segments)
    budget += tolerance.drifting * motion.drifted_rad * step**tolerance.order
    lasted = motion.travel_rad * step ** (tolerance.order + 1) * curvature**1.5
    budget += tolerance.lasting * lasted
    budget += tolerance.opening * motion.late.start * motion.drifted_rad
    budget += tolerance.arc * motion.late.offset + tolerance.late * motion.late.loss
    shaken = tolerance.share * curvature + tolerance.load_share * errors.of_forces.loading
    budget += shaken * step**tolerance.share_order
    budget += _felt(tolerance, errors)
    if tolerance.bends:
        budget = links.deflecting(budget, step)
    budget += shaken_by_rounding(errors, max(tolerance.rate, tolerance.differenced))
    budget = min(float(budget), tolerance.cap)
    jumping = scene.jumping(max(tolerance.rate, tolerance.differenced))
    budget += jumping * (BORNE if tolerance.makes_up else 1.0)
    return float(budget + tolerance.floor + AT_ROUNDING / step**tolerance.differenced)


def shaken_by_rounding(errors: Errors, rate: int, parts: int = 1) -> float:
    """Return the error of a rate of this order by rounding beyond double precision, with the step
    divided into ``parts``: joints correct a rounded place within a step."""
    scene = errors.of_scene
    shaken = (scene.floor - AT_ROUNDING) * (parts / scene.step_rad) ** rate
    if rate and shaken:
        shaken *= scene.curvature / max(scene.conditioning, 1e-12)
    return float(shaken)


def _felt(tolerance: Tolerance, errors: Errors) -> float:
    """Return the error of loads due to that of their sliders, as a share of the largest force."""
    slope = errors.of_forces.load_slopes.get(tolerance.slope, 0.0)
    if not slope:
        return 0.0
    worst, most = errors.worst("displacement"), default(WITHIN_A_STEP, errors)
    off = worst.pure if worst is not None and worst.pure <= most else most
    return slope * off / max(errors.of_scene.conditioning, 1e-12)


def beyond_engine(name: str, errors: Errors) -> float:
    """Return the model error of an engine's links and cams, as a pure number of a quantity."""
    links, facets, tolerance = errors.of_links, errors.of_scene.facets, errors.limits[name]
    if facets is not None and name != "drive":
        rate = max(tolerance.rate, tolerance.differenced)
        return facets.error(rate, errors.of_scene.step_rad)
    own, segments = links.beyond(name), links.limits.get("segments")
    if name in FORCES and segments:  # a relative error of bending is one of the force
        return own + 0.5 * (default(segments, errors) + links.locked)
    return own


def passing(tolerance: Tolerance, errors: Errors) -> float:
    """Return the limit of a rate near a change point: positions are corrected within a step."""
    made_good = default(WITHIN_A_STEP, errors) / errors.of_scene.step_rad**tolerance.rate
    return max(default(tolerance, errors), made_good)


@dataclass(frozen=True)
class Limit:
    """The limit in force for one quantity, and its origin."""

    number: float
    origin: str


def limits(
    scene: Scene, errors: Errors, overrides: Mapping[str, float], option: str = "--tol"
) -> dict[str, Limit]:
    """Return the limit per tolerance name: command line before scene before default."""
    chosen = {}
    for name, tolerance in errors.limits.items():
        if name in overrides:
            chosen[name] = Limit(overrides[name], option)
        elif name in scene.tolerance:
            chosen[name] = Limit(scene.tolerance[name], "scene")
        else:
            own = default(tolerance, errors) + beyond_engine(name, errors)
            if name == "drive" and errors.of_scene.drives_within:
                own += CLOSED_BY_A_MOTOR * default(WITHIN_A_STEP, errors)
            chosen[name] = Limit(own, "default")
    return chosen


def in_passage(name: str, limit: Limit, errors: Errors) -> Limit:
    """Return the limit for a rate near a change point; a given one also applies there. Forces have
    none: where a dyad is singular its joints may push against each other arbitrarily, without
    effect on the motion."""
    if limit.origin != "default":
        return limit
    if name in FORCES:
        return Limit(math.inf, "not judged near a change point")
    return Limit(passing(errors.limits[name], errors), "default near a change point")


def parse(texts: Iterable[str], option: str = "--tol", every: str = "") -> dict[str, float]:
    """Parse `angle=1e-4` and the like, also several in one text with commas between. ``every`` is
    the key of a number by itself, where that is permitted. Raises CrankcheckError for a text that
    is not NAME=NUMBER, a name that is no quantity, a number that is not positive."""
    numbers: dict[str, float] = {}
    for text in (part.strip() for whole in texts for part in whole.split(",")):
        name, equals, number = text.rpartition("=")
        place = f"{option} {text!r}"
        if not (equals or every):
            raise CrankcheckError(f"{place}: no `=` in it; write it like {option} angle=1e-4")
        key = _known_quantity(name.strip(), place) if equals else every
        numbers[key] = _positive_number(number, place)
    return numbers


def check_names(scene: Scene) -> None:
    """Refuse a scene whose [tolerance] names an unknown quantity."""
    for name in scene.tolerance:
        _known_quantity(name, f"scene {scene.name}, [tolerance] {name}")


def refuse_forces_unasked(option: str, quantities: Iterable[str]) -> None:
    """Refuse an option about forces where these are not judged. Raises CrankcheckError."""
    asked = [name for name in quantities if name in FORCES]
    if asked:
        raise CrankcheckError(
            f"{option} {asked[0]}: forces are judged with --forces only; add it, or leave "
            f"{asked[0]} out"
        )


def refuse_of_other_kinds(
    option: str, quantities: Iterable[str], known: Iterable[Mapping[str, Tolerance]]
) -> None:
    """Refuse limits of quantities that none of the ``known`` has. Raises CrankcheckError."""
    names = [name for limits in known for name in limits]
    other = [name for name in quantities if name not in names]
    if other:
        of = "for free motion; add --free, or" if other[0] in FREE else "for a drive;"
        of = "for elastic links;" if other[0] in BENDING else of
        raise CrankcheckError(
            f"{option} {other[0]}: it is {of} leave {other[0]} out. "
            f"There is {', '.join(dict.fromkeys(names))}"
        )


def _known_quantity(name: str, place: str) -> str:
    if name in EVERY:
        return name
    hint = suggestion(name, EVERY, "use one of", 2, 0.6)
    raise CrankcheckError(f"{place}: {name!r} is not a quantity; {hint}")


def _positive_number(number: str, place: str) -> float:
    try:
        value = float(number)
    except ValueError:
        value = math.nan
    if not (math.isfinite(value) and value > 0.0):
        raise CrankcheckError(
            f"{place}: {number.strip()!r} is not a number above 0; write it like angle=1e-4"
        )
    return value
