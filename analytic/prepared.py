"""A scene made ready to be solved: what does not depend on the samples.

Structure, constants of the groups and change points are worked out once for a scene: a pure
function of it, whose results for the last `KEPT` scenes are kept.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache

import numpy as np

from analytic.assur.group_steps import prepare
from analytic.change_points.find import passages, passed
from analytic.change_points.sign import ChangePoints
from analytic.dyads.chunk import Chunk, Passage
from analytic.dyads.driven import driver_scale, told
from analytic.dyads.parts import OpenError
from analytic.dyads.plane import AngleError, Real
from analytic.dyads.steps import FollowedStep, Step, stretched
from analytic.reach import describe_reach
from analytic.result import MotionArrays, Selection
from analytic.structure.mobility import analyse
from analytic.turns.cells import CellSolver
from analytic.turns.count import Counter, Turns
from models.array import Array
from models.errors import ReachError
from models.motion import Crossing, Motion
from models.names import MOST_ASSEMBLIES
from models.scene import KEPT, Same, Scene

CHUNK = 12288
"""Samples solved at a time: their intermediate arrays fit the second-level cache."""
Driven = tuple[Array, Real, Real, AngleError | None]
"""Angles, rates and accelerations of the driver, and what they may be wrong by."""


def spans(count: int) -> Iterator[slice]:
    """So many samples, a chunk at a time."""
    for first in range(0, count, CHUNK):
        yield slice(first, first + CHUNK)


def prepared(scene: Scene) -> Prepared:
    """The scene made ready to be solved. Raises StructureError."""
    return _prepared(Same(scene))


@lru_cache(maxsize=KEPT)
def _prepared(same: Same) -> Prepared:
    steps = prepare(same.scene, analyse(same.scene))
    start = float(same.scene.driver.law.at(np.zeros(1))[0][0]) / driver_scale(same.scene)
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

    @cached_property
    def followed(self) -> tuple[FollowedStep, ...]:
        """The groups of class III, each followed along the driver."""
        return tuple(step for step in self.steps if isinstance(step, FollowedStep))

    @property
    def looked_turns(self) -> int:
        """Turns of the driver over which its range is looked for (`analytic.reach.ranges`): what is
        followed is back after as many as it has assemblies, or ends."""
        return MOST_ASSEMBLIES if self.followed and self.scene.driver.slider is None else 1

    @property
    def period(self) -> float:
        """The driver angle [rad] after which the positions repeat."""
        periods = [passage.period for passage in self.passages.values()]
        periods += [step.period(self.passages) or math.tau for step in self.followed]
        return max(periods, default=math.tau)

    def stretched(self, theta: Array) -> Chunk:
        return stretched(self.scene, self.steps, theta, self.passages)

    def motion(
        self, wanted: Selection, time_s: Array, driver: Callable[[slice], Driven], *, bound: bool
    ) -> Motion:
        """The motion, chunk by chunk, with the change points on the way from time 0 through it."""
        result = MotionArrays(wanted, time_s, self.steps, bound=bound)
        low = high = self.start
        for span in spans(len(time_s)):
            driven = driver(span)
            low = min(low, float(driven[0].min()))
            high = max(high, float(driven[0].max()))
            counted = wanted.links and low < high  # at the start itself there is nothing to count
            counter = Counter(self.turns, driven[0]) if counted else None
            result.write(span, self.chunk(*driven), counter)
        return replace(result.motion(), crossings=self._passed(low, high))

    def _passed(self, low: float, high: float) -> tuple[Crossing, ...]:
        """The change points that a driver passes between two angles [rad]."""
        crossings = passed(self.passages, low, high)
        for step in self.followed:
            crossings += step.passed(self.passages, low, high)
        return crossings

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
        if isinstance(step, FollowedStep):
            index = int(np.argmax(short_m > 0.0))  # the first, beside the end
            ends = step.end_in_words(self.passages, float(theta[index]))
            return (
                f"{scene.name}: {scene.driver.joint} at {told(scene, theta[index])}: {ends}. "
                f"{describe_reach(scene, self.stretched, self.looked_turns)}"
            )
        return (
            f"{scene.name}: {scene.driver.joint} at {told(scene, theta[index])}: the loop "
            f"cannot close at {step.key}, it is open by {float(np.ravel(short_m)[index]):.3g} m. "
            f"{describe_reach(scene, self.stretched, self.looked_turns)}"
        )
