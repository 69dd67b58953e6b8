"""One cycle of a mechanism over the driver's phase, zeros of its rates, travel of an output.

The phase grows evenly in time. For a driver that turns it is its angle, and a cycle is a turn (two,
where change points let positions repeat after two only); for one that swings it is the argument of
the sine, and a cycle is a swing to and fro.

Zeros are searched at `SCAN` phases a turn, closer where a rate comes nearer to zero than beside it,
as it may pass zero and return between two samples; each is then bisected, on the closed form, until
its floats have no middle.

Travel covers any mechanism that goes through a whole cycle. Tests compare it with
closed forms (`analytic.mechanism.fourbar`, slider-crank, slotted lever).
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from analytic.kinematics import repeats_after, solve_driven
from models.array import Array
from models.errors import CrankcheckError
from models.motion import Motion, PointMotion
from models.scene import GROUND, Scene
from models.scene.laws import Oscillating

SCAN = 720
"""Samples of a turn."""
ZOOMS = 5
FINER = 65
"""Samples of the neighbourhood of every smallest rate in each zoom."""
HALVINGS = 60
DEPTH = 1e-9
"""Fall of a rate, over the largest, or value below zero, that is more than rounding."""


@dataclass(frozen=True)
class Along:
    """Place of a point along a direction of the ground, counter-clockwise from x [rad]."""

    point: str
    direction_rad: float


Output = str | Along
"""Link or slider by name, or a point along a direction."""
Series = tuple[Array, Array, Array]
"""Place ([rad] or [m]) and its rates by the phase."""


@dataclass(frozen=True)
class Cycle:
    """Cycle of ``period_rad`` of the phase; ``swing`` is the law of a driver that swings."""

    scene: Scene
    period_rad: float
    swing: Oscillating | None

    @staticmethod
    def of(scene: Scene) -> Cycle:
        """Return the cycle of a scene's driver; without a swing it turns at constant speed."""
        law = scene.driver.law
        if isinstance(law, Oscillating):
            return Cycle(scene, math.tau, Oscillating(law.centre_rad, abs(law.amplitude_rad), 1.0))
        if scene.driver.slider is not None:
            raise CrankcheckError(
                f"{scene.name}: {scene.driver.joint} returns only by an oscillating law, and "
                "has no cycle"
            )
        return Cycle(scene, repeats_after(scene), None)

    @property
    def grid(self) -> Array:
        """Sampled phases, half a step away from 0."""
        count = SCAN * round(self.period_rad / math.tau)
        return (np.arange(count, dtype=np.float64) + 0.5) * (math.tau / SCAN)

    def driver(self, phase: Array) -> Array:
        """Return the driver's angles [rad], or displacements [m]."""
        return phase if self.swing is None else self.swing.at(phase)[0]

    def at(self, outputs: Sequence[Output], phase: Array, *, bound: bool = False) -> Motion:
        """Return the motion of the outputs at phases that grow by one a second."""
        theta, one, zero = phase, np.ones_like(phase), np.zeros_like(phase)
        if self.swing is not None:
            theta, one, zero = self.swing.at(phase)
        named = [output for output in outputs if isinstance(output, str)]
        links = [name for name in named if name in self.scene.links]
        sliders = [name for name in named if name not in self.scene.links]
        points = [output.point for output in outputs if isinstance(output, Along)]
        return solve_driven(
            self.scene,
            theta,
            one,
            zero,
            links=links,
            points=tuple(dict.fromkeys(points)),
            sliders=sliders,
            bound=bound,
        )

    def refuse_singular(self, phase: Array, motion: Motion) -> None:
        """Refuse a cycle in which a dyad nearly loses its position, change points apart: an output
        may run to infinity there. Raises CrankcheckError."""
        passed = {crossing.dyad for crossing in motion.crossings}
        for key, sine in motion.conditioning.items():
            if key in passed:
                continue
            worst = int(np.argmin(sine))
            if sine[worst] < math.tau / SCAN:
                place = float(self.driver(phase)[worst])
                slides = self.scene.driver.slider is not None
                where = f"{place:.4g} m" if slides else f"{math.degrees(place):.4g} deg"
                raise CrankcheckError(
                    f"{self.scene.name}: the dyad of {key} passes a singular position near "
                    f"{where}, where its travel has no limits"
                )


def series(motion: Motion, output: Output) -> Series:
    """Return the place of an output, its rate and the rate of that."""
    if isinstance(output, Along):
        along = np.array([math.cos(output.direction_rad), math.sin(output.direction_rad)])
        point = motion.points[output.point]
        return point.position @ along, point.velocity @ along, point.acceleration @ along
    if output in motion.links:
        link = motion.links[output]
        return link.theta, link.omega, link.alpha
    slider = motion.sliders[output]
    return slider.displacement, slider.speed, slider.acceleration


def zeros(cycle: Cycle, outputs: Sequence[Output], order: int) -> dict[Output, Array]:
    """Return by output the phases of a cycle at which its rate (``order`` 1) or the rate of that
    (2) changes its sign, in order, to rounding.

    The work is that of one output: all are refined together. A rate that is always zero has none.

    Raises
    ------
    ReachError
        The driver does not turn fully, or swing as far as its law has it.
    CrankcheckError
        A cycle that passes a singular position, change points apart; an unknown point or slider.
    """
    grid = cycle.grid
    looked = cycle.at(outputs, grid, bound=True)
    cycle.refuse_singular(grid, looked)
    moving = [output for output in dict.fromkeys(outputs) if _moves(looked, output, order)]
    brackets: dict[Output, tuple[Array, Array, Array]] = {}
    for output, (phase, rate) in _closer(cycle, moving, grid, looked, order).items():
        sign = np.sign(rate)
        turns = np.flatnonzero(sign != np.roll(sign, -1))
        after = np.append(phase[1:], phase[0] + cycle.period_rad)
        brackets[output] = phase[turns], after[turns], sign[turns]
    refined = _refined(cycle, brackets, order)
    return {output: refined.get(output, np.zeros(0)) for output in outputs}


def _moves(motion: Motion, output: Output, order: int) -> bool:
    """True if a rate is more than rounding somewhere."""
    assert motion.bound is not None
    if isinstance(output, Along):
        bounds: PointMotion = motion.bound.points[output.point]
        bound = (bounds.position, bounds.velocity, bounds.acceleration)[order]
    else:
        every = {**motion.bound.sliders, **motion.bound.links}
        bound = tuple(vars(every[output]).values())[order]
    return bool(np.any(np.abs(series(motion, output)[order]) > bound))


def _closer(
    cycle: Cycle, outputs: Sequence[Output], grid: Array, looked: Motion, order: int
) -> dict[Output, tuple[Array, Array]]:
    """Return by output the phases of the grid and those where its rate went through zero and back
    between them, in order, and the rates there.

    A rate that is nearest to zero at one sample is sampled ever closer on both sides of it, up to
    its smallest value.
    """
    rates = {output: series(looked, output)[order] for output in outputs}
    valleys = [(output, k) for output, rate in rates.items() for k in _valleys(rate)]
    if not valleys:
        return {output: (grid, rate) for output, rate in rates.items()}
    places = np.array([grid[k] for _, k in valleys])
    signs = np.array([np.sign(rates[output][k]) for output, k in valleys])
    width = math.tau / SCAN
    for _ in range(ZOOMS):
        near = places[:, None] + np.linspace(-width, width, FINER)
        motion = cycle.at(list(rates), near.ravel())
        every = {output: series(motion, output)[order].reshape(near.shape) for output in rates}
        signed = np.array([every[o][i] for i, (o, _) in enumerate(valleys)]) * signs[:, None]
        best = np.arange(len(near)), np.argmin(signed, axis=1)
        places, least = near[best], signed[best]
        width *= 2.0 / (FINER - 1)
    found = {}
    for output, rate in rates.items():
        back = -DEPTH * np.max(np.abs(rate))
        more = [i for i, (name, _) in enumerate(valleys) if name == output and least[i] < back]
        phase = np.append(grid, places[more])
        inside = np.argsort(phase)
        found[output] = phase[inside], np.append(rate, signs[more] * least[more])[inside]
    return found


def _valleys(rate: Array) -> NDArray[np.intp]:
    """Return the samples where a periodic rate of one sign is nearer to zero than beside them."""
    before, after, size = np.roll(rate, 1), np.roll(rate, -1), np.abs(rate)
    same = (np.sign(before) == np.sign(rate)) & (np.sign(after) == np.sign(rate))
    least = (size <= np.abs(before)) & (size <= np.abs(after))
    depth = np.maximum(np.abs(before), np.abs(after)) - size
    return np.flatnonzero(same & least & (depth > DEPTH * np.max(size)))


def _refined(
    cycle: Cycle, between: Mapping[Output, tuple[Array, Array, Array]], order: int
) -> dict[Output, Array]:
    """Return the zeros by bisection: ``between`` has, by output, the samples just before and after
    them, and the signs of the rate before."""
    owner = [output for output, (low, _, _) in between.items() for _ in low]
    if not owner:
        return {}
    low, high, signs = (np.concatenate(parts) for parts in zip(*between.values(), strict=True))
    for _ in range(HALVINGS):
        middle: Array = 0.5 * (low + high)
        motion = cycle.at(list(between), middle)
        rates = {output: series(motion, output)[order] for output in between}
        same = np.array([np.sign(rates[output][k]) for k, output in enumerate(owner)]) == signs
        low, high = np.where(same, middle, low), np.where(same, high, middle)
    mine = {output: np.array([each == output for each in owner]) for output in between}
    return {output: np.sort(low[rows] % cycle.period_rad) for output, rows in mine.items()}


REST = 1e-12
"""Extreme speed, over the largest, that is rounding: the end of a rest."""
SAME = 1e-9
"""Distance of limit positions, over the stroke, below which they are one place."""


@dataclass(frozen=True)
class Travel:
    """Travel of an output over ``period_rad`` of the driver's phase, after which it is back.

    ``low`` and ``high`` are its extremes ([rad] for a link, else [m]), ``low_at_rad`` the phase (of
    the cycle, see `analytic.mechanism.cycle`) where it first has ``low``, and ``high_at_rad`` that
    where it next has ``high``; ``limits`` is the number of times that it turns back in a cycle (two
    or more, a rest between them or not). ``time_ratio`` is the phase of the longer stroke between
    the extremes over that of the shorter, and so of their times.
    """

    low: float
    high: float
    low_at_rad: float
    high_at_rad: float
    period_rad: float = math.tau
    limits: int = 2

    @property
    def stroke(self) -> float:
        """Swing [rad] or stroke [m]."""
        return self.high - self.low

    @property
    def time_ratio(self) -> float:
        forth = (self.high_at_rad - self.low_at_rad) % self.period_rad
        back = self.period_rad - forth
        return max(forth, back) / min(forth, back)


def travel(scene: Scene, output: Output) -> Travel:
    """Find the travel of a link, a slider or a point along a direction until the mechanism repeats.

    Raises
    ------
    ReachError
        The driver does not turn fully, or swing as far as its law has it.
    CrankcheckError
        No such output; an output that turns fully; or a cycle that passes a singular position,
        change points apart.
    """
    if isinstance(output, str) and output not in scene.links and output not in scene.sliders:
        have = ", ".join([*scene.links, *scene.sliders])
        raise CrankcheckError(f"{scene.name}: no link or slider {output!r}; it has {have}")
    found = travels(scene, [output])[output]
    if isinstance(found, CrankcheckError):
        raise found
    return found


def travels(scene: Scene, outputs: Sequence[Output]) -> dict[Output, Travel | CrankcheckError]:
    """Return the travel of several outputs, or the error of an output without one.

    The work is that of one output: all are refined together. Raises the errors of `travel` that
    concern the whole mechanism.
    """
    cycle = Cycle.of(scene)
    limits = {o: at for o, at in zeros(cycle, outputs, 1).items() if at.size > 1}
    found = _extremes(cycle, limits)
    return {output: found.get(output) or _endless(scene, output) for output in outputs}


def _endless(scene: Scene, output: Output) -> CrankcheckError:
    name = output if isinstance(output, str) else output.point
    return CrankcheckError(f"{scene.name}: {name} never turns back: it has no limit positions")


def _extremes(cycle: Cycle, limits: Mapping[Output, Array]) -> dict[Output, Travel]:
    """Return the outermost of the limit positions, whose phases are given by output.

    Angles are continuous along the cycle: a swing may be more than half a turn.
    """
    if not limits:
        return {}
    phase = np.concatenate([cycle.grid, *limits.values()])
    order = np.argsort(phase)
    motion = cycle.at(list(limits), phase[order])
    travelled, first = {}, len(cycle.grid)
    for output, at in limits.items():
        places = series(motion, output)[0][np.argsort(order)[first : first + at.size]]
        first += at.size
        low, high = float(np.min(places)), float(np.max(places))
        same = SAME * (high - low)
        low_at = float(at[places <= low + same][0])
        high_at = _next(at[places >= high - same], low_at, cycle)
        again_at = _next(at[places <= low + same], high_at, cycle)
        back = (again_at - low_at) % cycle.period_rad or cycle.period_rad
        moves = np.diff(places, append=places[0])
        senses = np.sign(moves[np.abs(moves) > same])  # the ends of a rest are one place
        reversals = int(np.count_nonzero(senses != np.roll(senses, 1)))
        travelled[output] = Travel(low, high, low_at, high_at, back, reversals)
    return travelled


def _next(at: Array, after: float, cycle: Cycle) -> float:
    """Return the first of the phases that follows another in the cycle."""
    return float(at[np.argmin((at - after) % cycle.period_rad)])


@dataclass(frozen=True)
class ExtremeSpeed:
    """Largest or smallest speed within a cycle.

    ``driver_rad`` is the driver's angle (0 to ``period_rad`` of its cycle if it turns), ``rate``
    the speed over that of the driver's phase: [1] for a link, else [m].
    """

    driver_rad: float
    rate: float


def extreme_speeds(
    scene: Scene, outputs: Sequence[Output]
) -> dict[Output, tuple[ExtremeSpeed, ...]]:
    """Return by output its extreme speeds in the order of the phase, under a driver of constant
    speed or one that swings: where its acceleration changes sign, found on the closed form to
    rounding. A constant speed and a rest have none. Raises as `analytic.mechanism.cycle.zeros`."""
    cycle = Cycle.of(scene)
    found = {}
    for output, at in zeros(cycle, outputs, 2).items():
        rates = series(cycle.at([output], at), output)[1] if at.size else at
        angles = cycle.driver(at)
        found[output] = tuple(
            ExtremeSpeed(float(angle), float(rate))
            for angle, rate in zip(angles, rates, strict=True)
            if abs(rate) > REST * np.max(np.abs(rates))
        )
    return found


def coriolis(scene: Scene, motion: Motion) -> Mapping[str, Array]:
    """Return 2 omega v [m/s^2], (T,), of sliders on moving guides: omega of the guide, v along it.

    Positive to the left of the slider's line, a quarter turn counter-clockwise from its direction:
    v turned in the sense of omega. The guides must be among the motion's links. Its rounding is
    that of the two factors (``motion.bound``).
    """
    return {
        name: 2.0 * motion.links[slider.on].omega * motion.sliders[name].speed
        for name, slider in scene.sliders.items()
        if slider.on != GROUND
    }
