"""The reference: position, velocity and acceleration of a whole mechanism, in closed form.

`solve` runs the driver's law through the mechanism's Assur groups in solving order, in chunks that
stay in cache, and writes what was asked for. With ``bound`` every number carries a bound of its own
error, propagated from group to group (`analytic.dyads.closure`).

What does not depend on the samples, structure, constants of the groups and change points, is worked
out once for a scene: a pure function of it, whose results for the last `KEPT` scenes are kept.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache

import numpy as np

from analytic.change_points.find import passages, passed
from analytic.change_points.sign import ChangePoints
from analytic.dyads.chunk import Chunk, Passage
from analytic.dyads.parts import OpenError
from analytic.dyads.plane import EPS, EXACT_ANGLE, STEADY, AngleError, Real
from analytic.dyads.steps import Step, prepare, stretched
from analytic.reach import Range, describe_reach, ranges
from analytic.result import MotionArrays, Selection
from analytic.structure.mobility import analyse
from analytic.turns.cells import CellSolver
from analytic.turns.count import Counter, Turns
from models.array import Array
from models.errors import CrankcheckError, ReachError
from models.laws import ConstantSpeed, Law
from models.motion import Motion
from models.samples import beside, samples
from models.scene import KEPT, Same, Scene

CHUNK = 12288
"""Samples solved at a time: their intermediate arrays fit the second-level cache."""
Driven = tuple[Array, Real, Real, AngleError | None]
"""Angles, rates and accelerations of the driver, and what they may be wrong by."""


def solve(
    scene: Scene,
    time_s: Array,
    *,
    links: str | Iterable[str] | None = None,
    points: str | Iterable[str] | None = None,
    sliders: str | Iterable[str] | None = None,
    bound: bool = True,
) -> Motion:
    """The motion of a scene at the given times.

    Parameters
    ----------
    scene : Scene
        The mechanism with its driver's law.
    time_s : Array
        Times [s], shape (T,).
    links, points, sliders : str, Iterable[str] or None
        What to return, by one name or several; None is all, () is none.
    bound : bool
        Carry error bounds (about three times the work).

    Returns
    -------
    Motion
        Angles of links go on continuously with the driver's angle, the same whatever samples
        are asked for: in (-pi, pi] at time 0, and counted on from there; a link that keeps an angle
        to the ground or to the driver is that much ahead of it. Sliders count from ``through_m``.
        In chains of more than some six dyads whole turns are counted to the nearest angle, which
        bounds of angles take as right (`analytic.turns.cells.MOST`).

    Raises
    ------
    StructureError
        The scene has no closed form, or a mobility other than 1.
    ReachError
        The law leads to a driver angle in which the mechanism cannot be assembled; the message
        names the reachable range.
    CrankcheckError
        Times that are no numbers, a name that the scene has not.
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
    """The motion of a scene whose driver has the given angles, rates and accelerations.

    As `solve`, but for driver angles [rad], rates [rad/s] and accelerations [rad/s^2], shape (T,),
    that are taken as exact: the geometry at the angle that an engine logged, say. One rate, or one
    acceleration, counts for all samples. Whole turns are counted from the angle that the scene's
    law has at time 0. ``time_s`` only labels the samples.
    """
    theta = samples(theta, "theta")
    omega, alpha = beside(omega, theta, "omega", "theta"), beside(alpha, theta, "alpha", "theta")
    labels = beside(0.0 if time_s is None else time_s, theta, "time_s", "theta")

    def driver(span: slice) -> Driven:
        error = EXACT_ANGLE if bound else None
        return theta[span], omega[span], alpha[span], error

    ready = prepared(scene)
    return ready.motion(Selection.of(scene, links, points, sliders), labels, driver, bound=bound)


def chunks(scene: Scene, time_s: Array, *, bound: bool) -> Iterator[tuple[slice, Chunk]]:
    """The solved mechanism at the given times (T,), a chunk of samples at a time, for what builds
    on more than its motion. Raises as `solve`."""
    driver, ready = _driver_of(scene, time_s, bound=bound), prepared(scene)
    for first in range(0, len(time_s), CHUNK):
        span = slice(first, first + CHUNK)
        yield span, ready.chunk(*driver(span))


def unit_chunk(scene: Scene, theta: Array, *, bound: bool) -> Chunk:
    """The mechanism at driver angles [rad] taken as exact, the driver at 1 rad/s and steady: rates
    are derivatives by its angle then, accelerations second ones. Raises as `solve`."""
    return prepared(scene).chunk(theta, 1.0, STEADY, EXACT_ANGLE if bound else None)


def driven_chunk(scene: Scene, theta: Array, omega: Array) -> Chunk:
    """The mechanism at driver angles [rad] with rates [rad/s] (T,), steady, without bounds. Raises
    as `solve`."""
    return prepared(scene).chunk(theta, omega, STEADY, None)


def counted_angle(chunk: Chunk, link: str) -> Array:
    """The angle of a link of a solved chunk [rad], (T,), its whole turns counted as in a motion."""
    body = chunk.bodies[link]
    if body.theta is not None:
        return np.broadcast_to(body.theta, chunk.theta.shape)
    angle = np.broadcast_to(np.arctan2(body.turn.y, body.turn.x), chunk.theta.shape).copy()
    Counter(_prepared(Same(chunk.scene)).turns, chunk.theta).count(link, angle)
    return angle


def reach(scene: Scene) -> list[Range]:
    """The driver angles, within a turn, in which the scene can be assembled (`analytic.reach`)."""
    return ranges(prepared(scene).stretched)


def _driver_of(scene: Scene, time_s: Array, *, bound: bool) -> Callable[[slice], Driven]:
    """The driver under its law, by spans of the times."""
    law = scene.driver.law
    if scene.is_free and np.any(time_s != 0.0):
        raise CrankcheckError(
            f"{scene.name}: its driver is let go, and follows no law but at time 0; its motion is "
            "that of `analytic.free`"
        )

    def driver(span: slice) -> Driven:
        t = time_s[span]
        theta, omega, alpha = _law_at(law, t)
        return theta, omega, alpha, _rounding_of(law, t, theta) if bound else None

    return driver


def _law_at(law: Law, t: Array) -> tuple[Array, Real, Real]:
    """The law at times ``t``; what is constant as one number, which costs no arithmetic."""
    if isinstance(law, ConstantSpeed):
        return law.angle(t), law.speed_rad_s, STEADY
    return law.at(t)


def _rounding_of(law: Law, t: Array, theta: Array) -> AngleError:
    """What rounding does to a law at times ``t``, where it has the angles ``theta``."""
    peak = law.peak_speed_rad_s
    if isinstance(law, ConstantSpeed):
        # A product, a sum, and the degrees of the start; its speed is what it was told to be.
        angle = 0.5 * (np.abs(theta) + peak * np.abs(t)) + law.offset_rad
        return AngleError(EPS * angle, 0.0, 0.0)
    age = np.abs(t) * law.fastest_rad_s + abs(law.phase_rad)
    return AngleError(
        4 * EPS * (np.abs(theta) + law.offset_rad + peak * np.abs(t)),
        4 * EPS * peak * (1.0 + age),
        4 * EPS * peak * law.fastest_rad_s * (1.0 + age),
    )


def repeats_after(scene: Scene) -> float:
    """The driver angle [rad] after which the positions repeat: a turn, or more of them where the
    mechanism goes through an odd number of change points in one."""
    return prepared(scene).period


def prepared(scene: Scene) -> Prepared:
    """The scene made ready to be solved. Raises StructureError."""
    return _prepared(Same(scene))


@lru_cache(maxsize=KEPT)
def _prepared(same: Same) -> Prepared:
    steps = prepare(same.scene, analyse(same.scene))
    start = float(same.scene.driver.law.at(np.zeros(1))[0][0])
    return Prepared(same.scene, steps, passages(same.scene, steps), start)


@dataclass(frozen=True)
class Prepared:
    """A scene made ready to be solved; ``start`` is the driver's angle at time 0."""

    scene: Scene
    steps: Sequence[Step]
    passages: Mapping[str, ChangePoints]
    start: float

    @cached_property
    def turns(self) -> Turns:
        """The whole turns of the links, worked out when they are first asked for."""
        look = CellSolver(self.scene, self.steps, self.passages)
        return Turns.of(look, self.start, self.period)

    @property
    def period(self) -> float:
        """The driver angle [rad] after which the positions repeat."""
        return max((passage.period for passage in self.passages.values()), default=math.tau)

    def stretched(self, theta: Array) -> Chunk:
        return stretched(self.scene, self.steps, theta, self.passages)

    def motion(
        self, wanted: Selection, time_s: Array, driver: Callable[[slice], Driven], *, bound: bool
    ) -> Motion:
        """The motion, chunk by chunk, with the change points on the way from time 0 through it."""
        result = MotionArrays(wanted, time_s, self.steps, bound=bound)
        low = high = self.start
        for first in range(0, len(time_s), CHUNK):
            span = slice(first, first + CHUNK)
            driven = driver(span)
            low = min(low, float(driven[0].min()))
            high = max(high, float(driven[0].max()))
            counted = wanted.links and low < high  # at the start itself there is nothing to count
            counter = Counter(self.turns, driven[0]) if counted else None
            result.write(span, self.chunk(*driven), counter)
        return replace(result.motion(), crossings=passed(self.passages, low, high))

    @np.errstate(divide="ignore", invalid="ignore", over="ignore")  # rates where there are none
    def chunk(
        self,
        theta: Array,
        omega: Real,
        alpha: Real,
        error: AngleError | None,
        passing: Mapping[str, Passage] | None = None,
        roots: Mapping[str, Real] | None = None,
    ) -> Chunk:
        """One chunk through all steps; dyads that go through a limit of the driver as ``passing``
        has it, with ``roots`` that are known better than by the driver. Raises ReachError."""
        passages = self.passages if passing is None else {**self.passages, **passing}
        chunk = Chunk.begin(self.scene, theta, omega, alpha, error, passages=passages, roots=roots)
        for step in self.steps:
            try:
                step.advance(chunk)
            except OpenError as opened:
                raise ReachError(self._open(step, theta, opened.short_m)) from None
        return chunk

    def _open(self, step: Step, theta: Array, short_m: Array) -> str:
        """Where the loop cannot close, by how much, and where it can."""
        scene, index = self.scene, int(np.argmax(short_m))
        return (
            f"{scene.name}: {scene.driver.link} at {math.degrees(theta[index]):.6g} deg: the loop "
            f"cannot close at {step.key}, it is open by {float(np.ravel(short_m)[index]):.3g} m. "
            f"{describe_reach(scene, self.stretched)}"
        )
