"""The reference: position, velocity and acceleration of a whole mechanism, in closed form.

`solve` runs the driver's law through the mechanism's Assur groups in solving order, in chunks that
stay in cache, and writes the requested series. With ``bound`` every number carries a bound of its
own error, propagated from group to group (`analytic.dyads.parts`).
"""

import itertools
import math
from collections.abc import Callable, Iterable, Iterator
from dataclasses import replace

import numpy as np

from analytic.change_points.turns import Counter
from analytic.dyads.chunk import Chunk, driver_scale
from analytic.dyads.plane import EPS, EXACT_ANGLE, STEADY, AngleError, Real
from analytic.prepared import Driven, Range, prepared, spans
from analytic.result import Selection
from analytic.structure.groups import Group, Triad
from analytic.structure.mobility import Structure, analyse
from models.array import Array, beside, samples
from models.errors import CrankcheckError, ReachError, StructureError
from models.files.body_table import MOST_ASSEMBLIES
from models.motion import Motion
from models.scene import Scene
from models.scene.laws import ConstantSpeed, Law


def solve(
    scene: Scene,
    time_s: Array,
    *,
    links: str | Iterable[str] | None = None,
    points: str | Iterable[str] | None = None,
    sliders: str | Iterable[str] | None = None,
    bound: bool = True,
) -> Motion:
    """Return the motion of a scene at the given times.

    Parameters
    ----------
    scene : Scene
        The mechanism with its driver's law.
    time_s : Array
        Times [s], shape (T,).
    links, points, sliders : str, Iterable[str] or None
        Names to return, one or several; None is all, () is none.
    bound : bool
        Carry error bounds (about three times the work).

    Returns
    -------
    Motion
        Angles of links are continuous with the driver's angle, whichever samples are requested: in
        (-pi, pi] at time 0, and counted on from there; a link that keeps an angle to the ground or
        to the driver is that much ahead of it. Sliders count from ``through_m``. In chains of more
        than some six dyads whole turns are counted to the nearest angle, which bounds of angles
        take as right (`analytic.change_points.turns.MOST`).

    Raises
    ------
    StructureError
        The scene has no closed form, or a mobility other than 1.
    ReachError
        The law leads to a driver angle in which the mechanism cannot be assembled; the message
        names the reachable range.
    CrankcheckError
        Times that are no numbers, a name that is not in the scene.
    """
    time_s = samples(time_s, "time_s")
    driver = _driver_of(scene, time_s, bound=bound)
    ready = prepared(scene)
    return ready.motion(Selection.of(scene, links, points, sliders), time_s, driver, bound=bound)


def solve_driven(
    scene: Scene,
    theta: Array,
    omega: Array,
    alpha: Array,
    time_s: Array | None = None,
    *,
    links: str | Iterable[str] | None = None,
    points: str | Iterable[str] | None = None,
    sliders: str | Iterable[str] | None = None,
    bound: bool = True,
) -> Motion:
    """Return the motion of a scene whose driver has the given angles, rates and accelerations.

    As `solve`, but for driver angles [rad], rates [rad/s] and accelerations [rad/s^2], shape (T,),
    (for a driven slider its displacements, speeds and accelerations in m), taken as exact: the
    geometry at the angle that an engine logged, say. One rate, or one acceleration, counts for all
    samples. Whole turns are counted from the angle that the scene's law has at time 0. ``time_s``
    only labels the samples.
    """
    theta = samples(theta, "theta")
    omega, alpha = beside(omega, theta, "omega", "theta"), beside(alpha, theta, "alpha", "theta")
    labels = beside(0.0 if time_s is None else time_s, theta, "time_s", "theta")

    def driver(span: slice) -> Driven:
        error = EXACT_ANGLE if bound else None
        return theta[span], omega[span], alpha[span], error

    ready = prepared(scene)
    chosen = Selection.of(scene, links, points, sliders)
    return ready.motion(chosen, labels, _scaled(scene, driver), bound=bound)


def chunks(scene: Scene, time_s: Array, *, bound: bool) -> Iterator[tuple[slice, Chunk]]:
    """Yield the solved mechanism at the given times (T,), a chunk of samples at a time, for
    computations beyond its motion. Raises as `solve`."""
    driver, ready = _driver_of(scene, time_s, bound=bound), prepared(scene)
    for span in spans(len(time_s)):
        yield span, ready.chunk(*driver(span))


def unit_chunk(scene: Scene, theta: Array, *, bound: bool) -> Chunk:
    """Return the mechanism at driver angles [rad] taken as exact, the driver at 1 rad/s and steady:
    rates are derivatives by its angle then, accelerations second ones. Raises as `solve`."""
    return prepared(scene).chunk(theta, 1.0, STEADY, EXACT_ANGLE if bound else None)


def driven_chunk(scene: Scene, theta: Array, omega: Array) -> Chunk:
    """Return the mechanism at driver angles [rad] with rates [rad/s] (T,), steady, without bounds.
    Raises as `solve`."""
    return prepared(scene).chunk(theta, omega, STEADY, None)


def counted_angle(chunk: Chunk, link: str) -> Array:
    """Return the angle of a solved chunk's link [rad], (T,), whole turns counted as in a motion."""
    body = chunk.bodies[link]
    if body.theta is not None:
        return np.broadcast_to(body.theta, chunk.theta.shape)
    angle = np.broadcast_to(np.arctan2(body.turn.y, body.turn.x), chunk.theta.shape).copy()
    Counter(prepared(chunk.scene).turns, chunk.theta).count(link, angle)
    return angle


def reach(scene: Scene) -> list[Range]:
    """Return the driver angles [rad], within a turn, in which the scene can be assembled
    (`analytic.prepared`); for a driven slider, its displacements [m]."""
    scale = driver_scale(scene)
    return [(low * scale, high * scale) for low, high in prepared(scene).reach]


def _driver_of(scene: Scene, time_s: Array, *, bound: bool) -> Callable[[slice], Driven]:
    law = scene.driver.law
    if scene.is_free and np.any(time_s != 0.0):
        raise CrankcheckError(
            f"{scene.name}: free motion, whose driver follows no law after time 0; solve it with "
            "`analytic.free`"
        )

    def driver(span: slice) -> Driven:
        t = time_s[span]
        theta, omega, alpha = _law_at(law, t)
        return theta, omega, alpha, _rounding_of(law, t, theta) if bound else None

    return _scaled(scene, driver)


def _scaled(scene: Scene, driver: Callable[[slice], Driven]) -> Callable[[slice], Driven]:
    """Return the driver's coordinate as the reference's driver angle (`analytic.dyads.chunk`)."""
    scale = driver_scale(scene)
    if scale == 1.0:
        return driver

    def scaled(span: slice) -> Driven:
        theta, omega, alpha, error = driver(span)
        if error is not None:
            error = AngleError(*(bound / scale for bound in error))
        return theta / scale, omega / scale, alpha / scale, error

    return scaled


def _law_at(law: Law, t: Array) -> tuple[Array, Real, Real]:
    """Return the law at times ``t``; constants as one number, which costs no arithmetic."""
    if isinstance(law, ConstantSpeed):
        return law.angle(t), law.speed_rad_s, STEADY
    return law.at(t)


def _rounding_of(law: Law, t: Array, theta: Array) -> AngleError:
    peak = law.peak_speed_rad_s
    if isinstance(law, ConstantSpeed):
        # A product, a sum, and the degrees of the start; its speed is exact.
        angle = 0.5 * (np.abs(theta) + peak * np.abs(t)) + law.offset_rad
        return AngleError(EPS * angle, 0.0, 0.0)
    age = np.abs(t) * law.fastest_rad_s + abs(law.phase_rad)
    return AngleError(
        4 * EPS * (np.abs(theta) + law.offset_rad + peak * np.abs(t)),
        4 * EPS * peak * (1.0 + age),
        4 * EPS * peak * law.fastest_rad_s * (1.0 + age),
    )


def repeats_after(scene: Scene) -> float:
    """Return the driver angle [rad] after which the positions repeat: a turn, or more of them where
    the mechanism goes through an odd number of change points in one; infinite for a slider."""
    return math.inf if scene.driver.slider is not None else prepared(scene).period


SAME = 1e-9
"""Distance of coincident places, over the longest length."""
MOST_SIDES = 8
"""Most dyads whose assemblies are tried in every combination."""


def in_assembly(scene: Scene, motion: Motion) -> Scene | None:
    """Return the scene with the branch that puts its points at time 0 where a motion has them at
    its first sample; None if there is none, or no solution of the scene."""
    try:
        structure = analyse(replace(scene, branch={}))
    except StructureError:
        return None
    for branch in branches(structure):
        held = replace(scene, branch=branch)
        try:
            places = solve(held, np.zeros(1), links=(), sliders=(), bound=False).points
        except (ReachError, StructureError):
            continue
        apart = (
            math.dist(motion.points[p].position[0], at.position[0]) for p, at in places.items()
        )
        if max(apart) <= SAME * scene.longest_m:
            return held
    return None


def chosen_groups(structure: Structure) -> list[Group | Triad]:
    """Return the groups that have more than one assembly, in solving order."""
    return [
        part
        for part in structure.order
        if isinstance(part, Triad) or (isinstance(part, Group) and part.assemblies > 1)
    ]


def choices(scene: Scene, group: Group | Triad) -> tuple[int, ...]:
    """Return the possible branches of a group, first that of the scene; of class III also numbers
    that may not exist."""
    own = scene.branch.get(group.branch_key, 1)
    if isinstance(group, Group):
        return own, -own
    return own, *(number for number in range(1, MOST_ASSEMBLIES + 1) if number != own)


def branches(structure: Structure) -> Iterator[dict[str, int]]:
    """Yield every choice of assemblies; of class III groups also numbers that may not exist."""
    sides = [group.branch_key for group in structure.groups if group.assemblies == 2][:MOST_SIDES]
    numbers = [triad.branch_key for triad in structure.triads]
    choices = [*([1, -1] for _ in sides), *(range(1, MOST_ASSEMBLIES + 1) for _ in numbers)]
    for chosen in itertools.product(*choices):
        yield dict(zip([*sides, *numbers], chosen, strict=True))


def nearness(scene: Scene, motion: Motion) -> dict[str, Array]:
    """Return the distance of dyads from their nearest singular position at samples, (T,) by name.

    It is ``motion.conditioning`` (1 best, 0 singular); for an RPR dyad times the distance of its
    two pins over the largest in the motion. The motion is one by `analytic.kinematics`, of
    ``scene``, with all its points.

    The conditioning of a dyad is the sine of its transmission angle or its like, a pure number for
    the direction in which its parts lie. That of an RPR dyad whose line goes through the pin of its
    link is always 1, though the link has no direction when the block is on that pin: their distance
    counts there.
    """
    distances = dict(motion.conditioning)
    for group in analyse(scene).groups:
        if group.kind == "RPR":
            ends = (motion.points[pin].position for pin in (group.outer1, group.outer2))
            apart = np.hypot(*np.subtract(*ends).T)
            distances[group.branch_key] = distances[group.branch_key] * apart / np.max(apart)
    return distances
