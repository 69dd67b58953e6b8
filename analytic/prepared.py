"""Scene prepared for solving: everything that does not depend on the samples.

Structure, constants of the groups and change points are a pure function of a scene, computed once;
the results for the last `KEPT` scenes are kept.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache, partial

import numpy as np

from analytic.change_points.find import passages, passed
from analytic.change_points.sign import ChangePoints
from analytic.change_points.turns import CellSolver, Counter, Turns
from analytic.dyads.chunk import Chunk, Passage, driver_scale, told
from analytic.dyads.parts import OpenError
from analytic.dyads.plane import AngleError, Real
from analytic.dyads.redundant import BridgeStep
from analytic.dyads.riding import PlacedBodies
from analytic.dyads.steps import (
    DYAD_STEPS,
    FollowedStep,
    PeriodicStep,
    Step,
    common_period,
    stretched,
)
from analytic.result import MotionArrays, Selection
from analytic.structure.gear_groups import GearGroup
from analytic.structure.groups import Bridge, Following, Triad
from analytic.structure.mobility import Structure, analyse
from models.array import Array, Mask
from models.errors import ReachError
from models.files.body_table import MOST_ASSEMBLIES
from models.motion import Motion
from models.scene import GROUND, KEPT, Same, Scene

CHUNK = 12288
"""Samples solved at a time: their intermediate arrays fit the second-level cache."""
Driven = tuple[Array, Real, Real, AngleError | None]
"""Angles, rates and accelerations of the driver, and their errors."""


def spans(count: int) -> Iterator[slice]:
    """Yield so many samples, a chunk at a time."""
    for first in range(0, count, CHUNK):
        yield slice(first, first + CHUNK)


def prepared(scene: Scene) -> Prepared:
    """Return the scene prepared for solving. Raises StructureError."""
    return _prepared(Same(scene))


@lru_cache(maxsize=KEPT)
def _prepared(same: Same) -> Prepared:
    steps = prepare(same.scene, analyse(same.scene))
    start = float(same.scene.driver.law.at(np.zeros(1))[0][0]) / driver_scale(same.scene)
    return Prepared(same.scene, steps, passages(same.scene, steps), start)


@dataclass(frozen=True)
class Prepared:
    """Scene prepared for solving; ``start`` is the driver's angle at time 0."""

    scene: Scene
    steps: Sequence[Step]
    passages: Mapping[str, ChangePoints]
    start: float

    @cached_property
    def turns(self) -> Turns:
        """The whole turns of the links, computed on first use."""
        look = CellSolver(self.scene, self.steps, self.passages)
        return Turns.of(look, self.start, self.period)

    @cached_property
    def followed(self) -> tuple[FollowedStep, ...]:
        """The groups of class III, each followed along the driver."""
        return tuple(step for step in self.steps if isinstance(step, FollowedStep))

    @property
    def looked_turns(self) -> int:
        """Turns of the driver over which its range is looked for (`ranges`): a followed group is
        back after as many as it has assemblies, or ends; one on gears with theirs."""
        if self.scene.driver.slider is not None:
            return 1
        if self.followed or not any(isinstance(step, PeriodicStep) for step in self.steps):
            return MOST_ASSEMBLIES if self.followed else 1
        return round(self.period / math.tau)

    @cached_property
    def reach(self) -> list[Range]:
        """Reachable driver angles [rad], as `ranges`."""
        return ranges(self.stretched, self.looked_turns)

    @property
    def period(self) -> float:
        """Driver angle [rad] after which the positions repeat."""
        return common_period(self.steps, self.passages)

    def stretched(self, theta: Array) -> Chunk:
        return stretched(self.scene, self.steps, theta, self.passages)

    def motion(
        self, wanted: Selection, time_s: Array, driver: Callable[[slice], Driven], *, bound: bool
    ) -> Motion:
        """Return the motion, chunk by chunk, with the change points from time 0 through it."""
        result = MotionArrays(wanted, time_s, self.steps, bound=bound)
        low = high = self.start
        for span in spans(len(time_s)):
            driven = driver(span)
            low = min(low, float(driven[0].min()))
            high = max(high, float(driven[0].max()))
            counted = wanted.links and low < high  # at the start itself there is nothing to count
            counter = Counter(self.turns, driven[0]) if counted else None
            result.write(span, self.chunk(*driven), counter)
        crossings = passed(self.passages, low, high)
        for step in self.followed:
            crossings += step.passed(self.passages, low, high)
        return replace(result.motion(), crossings=crossings)

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
        """Solve one chunk through all steps; ``passing`` has the dyads that go through a limit of
        the driver, ``roots`` those known better than by the driver. Raises ReachError."""
        passages = self.passages if passing is None else {**self.passages, **passing}
        chunk = Chunk.begin(self.scene, theta, omega, alpha, error, passages=passages, roots=roots)
        for step in self.steps:
            try:
                step.advance(chunk)
            except OpenError as opened:
                raise ReachError(self._open(step, theta, opened.short_m)) from None
        return chunk

    def _open(self, step: Step, theta: Array, short_m: Array) -> str:
        scene, index = self.scene, int(np.argmax(short_m))
        if isinstance(step, FollowedStep):
            index = int(np.argmax(short_m > 0.0))  # the first, beside the end
            fault = step.end_in_words(self.passages, float(theta[index]))
        else:
            open_m = float(np.ravel(short_m)[index])
            fault = f"the loop cannot close at {step.key}, it is open by {open_m:.3g} m"
        return (
            f"{scene.name}: {scene.driver.joint} at {told(scene, theta[index])}: {fault}. "
            f"{self._reach_in_words}"
        )

    @property
    def _reach_in_words(self) -> str:
        driver = self.scene.driver
        if not self.reach:
            grid = np.linspace(-math.pi, math.pi, SCAN + 1)
            short = shortage(self.stretched, grid)
            best = int(np.argmin(short))
            where = "angle" if driver.slider is None else "place"
            return (
                f"It cannot be assembled at any {where} of {driver.joint}: it comes nearest at "
                f"{told(self.scene, grid[best])}, open by {short[best]:.3g} m; change a length."
            )
        slides, scale = driver.slider is not None, driver_scale(self.scene)
        unit, by = ("m", scale) if slides else ("deg", math.degrees(1.0))
        spans = " and ".join(f"{a * by:.6g} to {b * by:.6g} {unit}" for a, b in self.reach)
        more_than_one = any(high - low > math.tau for low, high in self.reach)
        from_there = "" if slides or more_than_one else " (and whole turns from there)"
        return f"{driver.joint} can stand at {spans}{from_there}."


SCAN = 1440
"""Angles of the first scan of a turn; between two of them, it is refined where the mechanism is
nearest to closing, or to opening."""
NARROW = 20 * math.tau / SCAN
"""Width of a range [rad] below which it is scanned anew."""
ZOOMS, FINER = 5, 33
"""Number of refinements of the smallest shortage between samples, and of places in each."""

Range = tuple[float, float]
Stretched = Callable[[Array], Chunk]


def shortage(stretched: Stretched, theta: Array) -> Array:
    """Return the shortage of closure at driver angles ``theta`` (T,) [m]; <= 0 closes."""
    chunk = stretched(theta)
    short = np.full(theta.shape, -np.inf)
    for value in chunk.shortage.values():
        short = np.maximum(short, np.nan_to_num(value, nan=np.inf))
    return short


def ranges(stretched: Stretched, turns: int = 1) -> list[Range]:
    """Return the reachable driver angles within a turn, as (from, to) [rad] in increasing order.

    [(-pi, pi)] where the driver turns fully; [] where the mechanism cannot be assembled at all. A
    range may run beyond pi where it holds that angle. A group followed along the driver may go on
    for more than a turn and end all the same: it is scanned over so many ``turns`` both ways, and
    returned as it is where they differ.

    The sign changes of the shortage of closure over a turn of the driver are refined by bisection.
    Source: rotatability of a driver, e.g. Norton, Design of Machinery, section 4.10 (limit
    positions); for the four-bar `analytic.mechanism.fourbar` has the closed form, and a test
    compares both.
    """
    if turns > 1 and (found := _over_turns(stretched, turns)) is not None:
        return found
    looks = np.linspace(-math.pi, math.pi, SCAN + 1)
    grid = with_valleys(lambda theta: shortage(stretched, theta), looks)
    closes = shortage(stretched, grid) <= 0.0
    if closes.all():
        return [(-math.pi, math.pi)]
    edges = np.flatnonzero(closes[1:] != closes[:-1])
    if not len(edges):
        return []
    short_at = partial(shortage, stretched)
    borders = bisect(short_at, grid[edges], grid[edges + 1], closes[edges])
    opens = [float(a) for a, was in zip(borders, closes[edges], strict=True) if not was]
    ends = [float(a) for a, was in zip(borders, closes[edges], strict=True) if was]
    if closes[0]:  # the range that holds the angle pi: its end is a turn after the first
        ends = [*ends[1:], ends[0] + math.tau]
    wholes = zip(opens, ends, strict=True)
    return [part for whole in wholes for part in _closer(stretched, whole)]


def _closer(stretched: Stretched, whole: Range) -> list[Range]:
    """Scan a range anew that is so narrow that few samples fell into it: it may have gaps."""
    low, high = whole
    if high - low > NARROW:
        return [whole]
    grid = np.linspace(low, high, SCAN + 1)
    closes = shortage(stretched, grid) <= 0.0
    closes[[0, -1]] = True
    return _parts(stretched, grid, closes)


def with_valleys(shortage_at: Callable[[Array], Array], theta: Array) -> Array:
    """Return the samples, and closer ones where a mechanism is nearest to closing, or to opening,
    between two of them, so that no narrow part is missed, nor one of two beside a sample."""
    short = shortage_at(theta)
    size = np.abs(short[1:-1])
    near = (size <= np.abs(short[:-2])) & (size <= np.abs(short[2:]))
    places = np.flatnonzero(near) + 1
    if not places.size:
        return theta
    low, high, sign = theta[places - 1], theta[places + 1], np.sign(short[places])
    share, first = np.linspace(0.0, 1.0, FINER), np.zeros(0)
    for _ in range(ZOOMS):
        looks = low[:, None] + (high - low)[:, None] * share
        first = first if first.size else looks.ravel()
        value = shortage_at(looks.ravel()).reshape(looks.shape) * sign[:, None]
        best = np.clip(np.argmin(value, axis=1), 1, FINER - 2)
        rows = np.arange(len(best))
        low, high, tip = looks[rows, best - 1], looks[rows, best + 1], looks[rows, best]
    return np.unique(np.concatenate([theta, first, tip]))


def _over_turns(stretched: Stretched, turns: int) -> list[Range] | None:
    """Return the ranges over several turns both ways; None where all turns are alike."""
    grid = np.linspace(-turns * math.tau, turns * math.tau, 2 * turns * SCAN + 1)
    closes = shortage(stretched, grid) <= 0.0
    unlike = np.count_nonzero(closes[SCAN:] != closes[:-SCAN])
    if unlike <= 2 * turns:  # looks beside an end, by rounding
        return None
    return _parts(stretched, grid, closes)


def _parts(stretched: Stretched, grid: Array, closes: Mask) -> list[Range]:
    """Return the ranges between the first and the last angle of a grid."""
    edges = np.flatnonzero(closes[1:] != closes[:-1])
    short_at = partial(shortage, stretched)
    borders = bisect(short_at, grid[edges], grid[edges + 1], closes[edges]).tolist()
    ends = [float(grid[0])] * bool(closes[0]) + borders + [float(grid[-1])] * bool(closes[-1])
    return list(zip(ends[::2], ends[1::2], strict=True))


def bisect(
    shortage_at: Callable[[Array], Array], low: Array, high: Array, closes_low: Mask
) -> Array:
    """Return the angles at which closing begins or ends, each on the side that closes."""
    for _ in range(60):
        middle = 0.5 * (low + high)
        if np.all((middle == low) | (middle == high)):
            break
        same = (shortage_at(middle) <= 0.0) == closes_low
        low, high = np.where(same, middle, low), np.where(same, high, middle)
    return np.where(closes_low, low, high)


def prepare(scene: Scene, structure: Structure) -> list[Step]:
    """Return the steps of all groups, in solving order."""
    driver, compound = scene.driver, structure.compound
    known = {GROUND} if compound is not None else {GROUND, driver.link}
    steps: list[Step] = []
    for part in structure.order:
        placed = PlacedBodies(scene, structure, frozenset(known))
        if isinstance(part, Bridge):
            steps.append(BridgeStep(placed, part))
        elif isinstance(part, GearGroup):
            from analytic.higher_pairs.gear_step import GearStep  # few scenes need it

            leads = not isinstance(structure.order[-1], GearGroup)
            steps.append(GearStep(placed, part, steps, leads=leads))
        elif isinstance(part, Following):
            from analytic.higher_pairs.follower_step import FollowerStep  # few scenes need it

            steps.append(FollowerStep(placed, part))
        elif isinstance(part, Triad) or (compound is not None and compound.name in part.bodies):
            from analytic.assur.mounting import Mounting  # few scenes need it
            from analytic.assur.step import AssurStep

            steps.append(AssurStep(Mounting(placed, part), steps))
        else:
            steps.append(DYAD_STEPS[part.kind](placed, part))
        known.update(part.bodies)
        if compound is not None and compound.name in part.bodies:
            known.update((compound.base, compound.link))
    return steps
