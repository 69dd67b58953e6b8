"""Difficulty of a scene for an engine, as pure numbers: its curvature, change points and loads, and
the bodies whose motion no integrator follows exactly.

Driven exactly, a mechanism moves alike under any load; but a soft constraint gives way under loads,
and the effect of a load over a displacement depends on its slider's position.
"""

import itertools
import math
from collections.abc import Callable, Iterable, Mapping
from functools import wraps
from typing import TypeVar, TypeVarTuple, cast

import numpy as np
from numpy.typing import NDArray

from analytic.forces.virtual_power import reduced_machine
from models.array import Array, Mask
from models.errors import CrankcheckError
from models.motion import Crossing, Motion
from models.scene import Scene, driver, joints, loads
from models.scene.cams import OscillatingFollower
from models.scene.pairs import CamPair
from reports.compare.errors import FacetFacts
from reports.compare.tracks import length
from reports.quantities.quantity import BodyKind

Given = TypeVarTuple("Given")
Result = TypeVar("Result")


def shared(measure: Callable[[*Given], Result]) -> Callable[[*Given], Result]:
    """Return a measure that keeps its last result for the same objects and equal arrays: the runs
    of a scene, which follow one another, share a reference."""
    last: list[tuple[tuple[*Given], Result]] = []

    @wraps(measure)
    def kept(*given: *Given) -> Result:
        for before, found in last:
            if all(map(_same, before, given)):
                return found
        found = measure(*given)
        last[:] = [(given, found)]
        return found

    return kept


def _same(one: object, other: object) -> bool:
    arrays = isinstance(one, np.ndarray) and isinstance(other, np.ndarray)
    return one is other or (arrays and np.array_equal(cast(Array, one), cast(Array, other)))


@shared
def loading(scene: Scene, motion: Motion) -> float:
    """Return the largest second difference, from sample to sample, of the acceleration that its
    loads alone would give a body, over that of the driver's speed on the longest link.

    The springs of soft constraints give way by a share of that acceleration, and evenly where it
    grows evenly: their effect on the bodies' accelerations is its second difference. 0 without
    loads, or where a table of one ends before the motion, which then has no forces either.
    """
    try:
        pushes = _pushes(scene, motion)
    except CrankcheckError:
        return 0.0
    return max((_largest(np.abs(np.diff(push, 2))) / size for push, size in pushes), default=0.0)


def parting(scene: Scene, motion: Motion) -> float:
    """Return the largest acceleration, pure, that its loads would give a body at the start if the
    gears and cams of the scene were open; 0 without any, or without loads."""
    pushes = _pushes(scene, motion) if scene.gears or scene.cams else []
    return max((float(np.abs(push[0])) / size for push, size in pushes), default=0.0)


def inertia_share(scene: Scene, force_n: float) -> float:
    """Return the inertia of all masses at the longest link, as a share of a force."""
    masses = [link.mass_kg for link in scene.links.values()]
    masses += [slider.mass_kg for slider in scene.sliders.values()]
    push = sum(masses) * scene.longest_m * scene.pace_rad_s**2
    return push / force_n


def _pushes(scene: Scene, motion: Motion) -> list[tuple[NDArray[np.inexact], float]]:
    """Return the forces and moments of loads on bodies as `_push` does, each with that of a pure
    acceleration of 1; no moments of bodies on a guide, which are not turned."""
    square, found = scene.pace_rad_s**2, list[tuple[NDArray[np.inexact], float]]()
    guided = {slider.link for slider in scene.sliders.values()}
    for name in dict.fromkeys(load.body for load in scene.loads.values()):
        force, moment = _push(scene, motion, name)
        found.append((force, _mass(scene, name) * scene.longest_m * square))
        if name in scene.links and name not in guided and scene.links[name].inertia_kg_m2:
            found.append((moment, scene.links[name].inertia_kg_m2 * square))
    return found


def _push(scene: Scene, motion: Motion, body: str) -> tuple[NDArray[np.complex128], Array]:
    """Return the force of all loads on a body [N], as x + iy, and their moment about its centre of
    mass [N m], (T,). Raises CrankcheckError as `Load.magnitude`."""
    force = np.zeros(motion.time_s.shape, dtype=np.complex128)
    moment = np.zeros(motion.time_s.shape)
    turned = np.exp(1j * _angle(scene, motion, body))
    for load in scene.loads.values():
        if load.body != body:
            continue
        size = _magnitude(scene, load, motion)
        if load.point is None:
            moment += size
            continue
        turn = turned if load.frame == "body" else 1.0
        push = size * turn * np.exp(1j * load.direction_rad)
        force += push
        if body in scene.links:
            place, centre = joints.local_point(scene, body, load.point), scene.links[body].centre_m
            arm = turned * complex(place[0] - centre[0], place[1] - centre[1])
            moment += (arm.conj() * push).imag
    return force, moment


def _angle(scene: Scene, motion: Motion, body: str) -> Array | float:
    """Return the angle of a link, or of a block, which is turned with its guide [rad]."""
    for slider in scene.sliders.values():
        if joints.block_name(slider) == body:
            guide = motion.links.get(slider.on)
            return slider.direction_rad + (0.0 if guide is None else guide.theta)
    return motion.links[body].theta


def _magnitude(scene: Scene, load: loads.Load, motion: Motion) -> Array:
    """Return the size of a load over a motion [N or N m]."""
    slid = None if load.slider is None else motion.sliders[load.slider]
    x = motion.time_s
    if load.over == "angle":
        x = driver.driver_course(scene, motion)[0]
    elif load.over == "displacement" and slid is not None:
        x = slid.displacement
    return load.magnitude(x, None if slid is None else slid.speed)


def _largest(series: Array) -> float:
    return float(np.max(series, where=np.isfinite(series), initial=0.0))


def _mass(scene: Scene, body: str) -> float:
    """Return the mass of a body [kg]; for a massless body, the least mass of any other."""
    own = {name: link.mass_kg for name, link in scene.links.items()}
    own |= {name: slider.mass_kg for name, slider in joints.blocks(scene).items()}
    heavy = [mass for mass in own.values() if mass > 0.0]
    return own.get(body) or min(heavy, default=1.0)


def load_slopes(
    scene: Scene, motion: Motion, force_n: float, torque_n_m: float
) -> dict[str, float]:
    """Return the changes of the loads over displacements per longest link: ``reaction``, as a share
    of the largest, and ``torque``, by their power.

    The slope at a sample is the steepest as far as the samples before and after it.
    """
    bears, turns = np.zeros_like(motion.time_s), np.zeros_like(motion.time_s)
    for load in scene.loads.values():
        if load.over != "displacement" or load.slider is None:
            continue
        slope = _slope(load, motion)
        at_point = load.point is not None
        bears += slope * (scene.longest_m if at_point else 1.0) / force_n
        moved = scene.longest_m / scene.pace_rad_s / torque_n_m
        turns += slope * _speed(scene, load, motion) * moved
    return {"reaction": _largest(bears), "torque": _largest(turns)}


def _slope(load: loads.Load, motion: Motion) -> Array:
    """Return the slope of a load at every sample [N/m or N], 0 where it does not act."""
    assert load.slider is not None
    slid = motion.sliders[load.slider]
    apart = np.abs(np.diff(slid.displacement))
    near = np.maximum(np.append(apart, 0.0), np.insert(apart, 0, 0.0))
    slope = load.characteristic.steepest(slid.displacement, near) * np.ones_like(near)
    acts = {"forward": slid.speed > 0.0, "backward": slid.speed < 0.0}
    return np.where(acts[load.stroke], slope, 0.0) if load.stroke in acts else slope


def _speed(scene: Scene, load: loads.Load, motion: Motion) -> Array:
    """Return the speed of the loaded point or body [m/s or rad/s]."""
    if load.point is not None:
        return np.asarray(np.hypot(*motion.points[load.point].velocity.T))
    guides = {joints.block_name(slider): slider.on for slider in scene.sliders.values()}
    turns = motion.links.get(guides.get(load.body, load.body))  # a block turns with its guide
    return np.zeros_like(motion.time_s) if turns is None else np.abs(turns.omega)


@shared
def curvature(scene: Scene, reference: Motion) -> float:
    """Return the largest finite pure acceleration of the reference, at least 1."""
    square = scene.pace_rad_s**2
    turning = (link.alpha / square for link in reference.links.values())
    moving = (
        point.acceleration / (scene.longest_m * square) for point in reference.points.values()
    )
    sizes = (length(series) for series in itertools.chain(turning, moving))
    return max(float(np.max(each, where=np.isfinite(each), initial=1.0)) for each in sizes)


@shared
def law_jumps(scene: Scene, reference: Motion) -> tuple[float, float]:
    """Return the largest jumps of acceleration and jerk in the laws of cams, pure."""
    found = [(0.0, 0.0)]
    for pair in scene.cams.values():
        turning = reference.links.get(pair.cam)
        speed = 1.0 if turning is None else _largest(np.abs(turning.omega)) / scene.pace_rad_s
        arm = scene.longest_m if pair.slider else 1.0
        found += [
            (abs(jump.acceleration) * speed**2 / arm, abs(jump.jerk) * speed**3 / arm)
            for jump in pair.profile.law.jumps
        ]
    accelerations, jerks = zip(*found, strict=True)
    return max(accelerations), max(jerks)


@shared
def facets(scene: Scene, reference: Motion) -> FacetFacts | None:
    """Return the facts of the cams by contact, of the worst; None where there is none."""
    found, pace = list[FacetFacts](), scene.pace_rad_s
    for pair in (one for one in scene.cams.values() if one.facets):
        follower = pair.profile.follower
        centre = joints.local_point(scene, pair.cam, pair.pivots(scene.points_of)[0])
        length, arm = scene.longest_m, scene.longest_m
        if isinstance(follower, OscillatingFollower):
            length, arm = 1.0, follower.arm_m or follower.pivot_m
        radius = max(math.dist(centre, point) for point in pair.outline) / arm
        side = math.tau / pair.facets
        turning = _largest(np.abs(reference.links[pair.cam].omega)) / pace
        press = _closing(scene, pair, reference) / (length * pace**2)
        found.append(FacetFacts(side**2 / 8.0 * radius, side * radius * turning, press))
    return max(found, key=lambda one: one.sagitta, default=None)


def _closing(scene: Scene, pair: CamPair, reference: Motion) -> float:
    """Return the largest acceleration towards the cam [m/s^2 or rad/s^2] that springs, weights and
    loads give a follower and all that it moves, while it is fast: by the machine reduced to the
    driver, with the rate s' of the lift, M s' over the inertia beyond the least."""
    if scene.is_free:
        return 0.0
    lift = pair.law_at({name: link.theta for name, link in reference.links.items()})
    machine = reduced_machine(scene, reference.time_s)
    rate = np.gradient(lift.value, machine.theta)
    moved = machine.inertia - np.nanmin(machine.inertia)
    fast = (np.abs(rate) > 0.5 * np.nanmax(np.abs(rate))) & (moved > 0.0)
    return _largest(-machine.torque[fast] * rate[fast] / moved[fast])


WINDOW_RAD = 0.5
"""Window of driver angles on both sides of a change point."""


def near(crossings: Iterable[Crossing], driver_rad: Array, within_rad: float) -> Mask:
    """Return a mask of driver angles (T,) nearer than this to one of some change points.

    Rates need it. Within a step of the change point the joints do not hold the dyad in one
    direction: a soft constraint leaves all of an acceleration open there. The position error that
    piled up, of second order, is corrected in one or a few steps when they hold again: that is a
    velocity of first order, and an acceleration that does not shrink with the step. Rates in the
    window are separate rows, of kind "passage", with separate limits
    (`reports.judge.tolerance.in_passage`).

    Measured for profile tuned at 180 to 1440 steps a turn on a parallelogram, a kite and an
    isosceles slider-crank: rates are those of the regular motion again 0.3 rad after the change
    point at 180 steps, 0.2 rad at 360 and 0.1 rad at 720.
    """
    nearby = np.zeros(driver_rad.shape, dtype=bool)
    for crossing in crossings:
        away = np.remainder(driver_rad - crossing.driver_rad + math.pi, math.tau) - math.pi
        nearby |= np.abs(away) < within_rad
    return nearby


@shared
def conditioning(motion: Motion, driver_rad: Array) -> float:
    """Return the smallest sine of a transmission angle, 1 where there is no dyad.

    A dyad in the window of its own change point does not count, unless the motion has no other
    sample: then its largest sine counts, as the farthest from the change point.

    The sine of a dyad falls to 0 in a change point, and yet the smooth branch is regular there:
    inertia carries an engine through, with the position error of the regular motion on both sides.
    The difficulty is therefore measured outside `WINDOW_RAD` of the driver.
    """
    smallest = 1.0
    for key, sine in motion.conditioning.items():
        own = [crossing for crossing in motion.crossings if crossing.dyad == key]
        outside = sine[~near(own, driver_rad, WINDOW_RAD)]
        smallest = min(smallest, float(np.min(outside) if outside.size else np.max(sine)))
    return smallest


Series = dict[tuple[BodyKind, str], Array]
LEAST_SAMPLES = 8
LEAST_TURN_RAD = 0.2
"""Turn of the driver below which no error comes to its full size."""
EVEN = 1e-3
"""Negligible departure: rounding is far below it, and its errors are below those of rounding."""


@shared
def uneven(scene: Scene, reference: Motion, driver_rad: Array) -> dict[tuple[BodyKind, str], float]:
    """Return the departure of each body from even motion with the driver, without even bodies:
    links in radians, sliders and points in longest links, at most 1.

    ``driver_rad`` is the commanded angle of the driver at the samples of the reference, (T,).

    A body that moves evenly with the driver is right to rounding in any integrator: a link that
    turns with it, a link of a parallelogram, a point on either. All others have the truncation
    error of a step, which grows with the departure from even motion: from the driver's angle times
    a number for links and sliders, from the ellipse that its pin could draw for points. So is the
    follower of a cam where an engine has the chord of its law over a step.
    """
    if driver_rad.size < LEAST_SAMPLES or np.ptp(driver_rad) < LEAST_TURN_RAD:
        return {}
    ones, turn = np.ones_like(driver_rad), np.exp(1j * driver_rad)
    straight: Series = {("link", name): link.theta for name, link in reference.links.items()} | {
        ("slider", name): slider.displacement / scene.longest_m
        for name, slider in reference.sliders.items()
    }
    round_: Series = {
        ("point", name): (point.position[:, 0] + 1j * point.position[:, 1]) / scene.longest_m
        for name, point in reference.points.items()
    }
    far = {
        **_departures(straight, np.stack([ones, driver_rad - np.mean(driver_rad)], axis=-1)),
        **_departures(round_, np.stack([ones, turn, turn.conj()], axis=-1)),
    }
    for pair in scene.cams.values():
        link = scene.links.get(pair.follower)
        points = link.points if link else (scene.sliders[pair.slider].point,)
        led = [("link", pair.follower), ("slider", pair.slider), *(("point", p) for p in points)]
        far = {body: size for body, size in far.items() if body not in led}
    return {body: min(size, 1.0) for body, size in far.items() if size > EVEN}


def unevenly_turned(
    scene: Scene, uneven: Mapping[tuple[BodyKind, str], float]
) -> frozenset[tuple[BodyKind, str]]:
    """Return the uneven bodies whose rates are uneven too: links, and bodies carried by such a link
    or sliding on it. Bodies carried by evenly turning links have the right speed in an engine."""
    links = {name for kind, name in uneven if kind == "link"}
    carried = {point for name in links for point in scene.links[name].points}
    slides = {
        name
        for name, slider in scene.sliders.items()
        if slider.on in links or slider.link in links or slider.point in carried
    }
    turned: dict[BodyKind, set[str]] = {"link": links, "point": carried, "slider": slides}
    return frozenset(body for body in uneven if body[1] in turned[body[0]])


def _departures(series: Series, even: NDArray[np.inexact]) -> dict[tuple[BodyKind, str], float]:
    """Return the largest distance of each series (T,) from the span of columns ``even`` (T, n)."""
    moved = np.stack(list(series.values()), axis=-1)
    # The normal equations of two or three columns: a hundredth of the time of a decomposition.
    across = even.conj().T
    weights = np.linalg.solve(across @ even, across @ moved)
    return dict(zip(series, np.max(np.abs(moved - even @ weights), axis=0).tolist(), strict=True))
