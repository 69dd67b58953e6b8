"""The steps of an integration, and the state of an assembly over time that it gives."""

from __future__ import annotations

import itertools
import math
from bisect import bisect_right
from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
from scipy.integrate import OdeSolution  # type: ignore[import-untyped]  # ships no stubs
from scipy.interpolate import CubicHermiteSpline  # type: ignore[import-untyped]  # ships no stubs

from analytic.multibody.dynamics import Dynamics
from analytic.multibody.generalised_forces import Strokes, edges, state_cells, strokes, switches
from analytic.multibody.singular_passage import SingularPassage
from models.array import Array
from models.errors import CrankcheckError, few
from models.scene import Scene


@dataclass(frozen=True)
class StateHistory:
    """The ``state`` at times [s], (2 n + 1, T); ``passages`` are the change points on the way."""

    state: Callable[[Array], Array]
    steps: int
    passages: tuple[SingularPassage, ...] = ()


LARGEST = 1e12
"""Of a coordinate or rate, over what it counts as one of: beyond it a motion has come apart."""


@dataclass(frozen=True)
class FixedSteps:
    """The method of Runge and Kutta of order 4 with steps of one size, as the thesis on elastic
    mechanisms has it; in between cubics, of the same order. Edges over time are at steps."""

    dynamics: Dynamics
    step_s: float

    def history(self, q: Array, rates: Array, until_s: float) -> StateHistory:
        """The motion from a state to a time [s]. Raises CrankcheckError where it comes apart."""
        own = switches(self.dynamics.forces)
        state = np.concatenate([q, rates, [0.0]])
        times, states, slopes = [], [], []
        edge = edges(self.dynamics.assembly.scene, until_s)
        for begin, end in itertools.pairwise(edge):
            count = max(1, math.ceil((end - begin) / self.step_s * (1.0 - 1e-9)))
            h, last = (end - begin) / count, math.nextafter(end, begin)
            for i in range(count):
                at_s = begin + i * h
                held = strokes(own, state_cells(own, self.dynamics.forces, state))
                slope, state_after = self._step(at_s, h, last, state, held)
                times.append(at_s)
                states.append(state)
                slopes.append(slope)
                state = state_after
                self._check(state, at_s + h)
        held = strokes(own, state_cells(own, self.dynamics.forces, state))
        times.append(until_s)
        states.append(state)
        slopes.append(self.dynamics.rates(until_s, state, held))
        spline = CubicHermiteSpline(np.array(times), np.array(states), np.array(slopes))
        return StateHistory(lambda time_s: np.asarray(spline(time_s).T), len(times) - 1)

    def _step(
        self, at_s: float, h: float, last: float, state: Array, held: Strokes
    ) -> tuple[Array, Array]:
        """The slope at the begin of a step, and the state at its end."""
        rates = self.dynamics.rates
        with np.errstate(all="ignore"):
            k1 = rates(at_s, state, held)
            k2 = rates(min(at_s + 0.5 * h, last), state + 0.5 * h * k1, held)
            k3 = rates(min(at_s + 0.5 * h, last), state + 0.5 * h * k2, held)
            k4 = rates(min(at_s + h, last), state + h * k3, held)
        return k1, state + h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4)

    def _check(self, state: Array, time_s: float) -> None:
        if not np.abs(state).max() < LARGEST:
            raise CrankcheckError(
                f"{self.dynamics.assembly.scene.name}: with steps of {self.step_s:g} s the motion "
                f"comes apart at {time_s:g} s; take smaller ones, or a smaller alpha and beta"
            )


SHARE = 0.9
"""Of the time of a motion that is lost: what is faster after it is held against what was before."""
MANY = 100.0
"""That over which its speed has grown since then, where it grows without bound."""
FEW = 0.05
"""Edges over time in so many steps are not why they are short."""


@dataclass
class Pace:
    """How fast a motion was at the ends of its steps: the largest up to each of them, and the
    last; ``edges`` are the numbers of steps that edges over time end."""

    times_s: list[float] = field(default_factory=list)
    largest: list[float] = field(default_factory=list)
    last: float = 0.0
    edges: list[int] = field(default_factory=list)

    def note(self, time_s: float, speed: float) -> None:
        """The start of the motion, or the end of a step."""
        self.times_s.append(time_s)
        self.largest.append(max(speed, self.largest[-1]) if self.largest else speed)
        self.last = speed

    def end_at_edge(self) -> None:
        """Say that the last step ended at an edge over time."""
        self.edges.append(self.made)

    @property
    def made(self) -> int:
        """How many steps there are."""
        return len(self.times_s) - 1

    def lasted_s(self, count: int) -> float:
        """How long the last ``count`` steps took [s]; infinite where there are not so many, or
        where it is edges over time that made them short."""
        first = self.made - count
        if first < 0 or len(self.edges) - bisect_right(self.edges, first) > FEW * count:
            return math.inf
        return self.times_s[-1] - self.times_s[first]

    def check_runaway(self, scene: Scene, lost_s: float) -> None:
        """Raises CrankcheckError for a motion that is lost at ``lost_s`` [s], if that is because
        its speed goes to infinity.

        It is held against the largest speed before: a motion that turns back is slow for a while.

        A load that grows with the square of the speed that it drives, v' = c v^2, has v = 1 / (c
        (t* - t)): no step leads to t*, whatever its size.
        """
        before = self.largest[bisect_right(self.times_s, SHARE * lost_s) - 1]
        if not self.last > MANY * before:
            return
        over = [load for load in scene.loads.values() if load.over != "time"]
        named = few([f"loads.{load.name} over {load.over}" for load in over], 6) or "what acts"
        raise CrankcheckError(
            f"{scene.name}: it runs away: at about {lost_s:.4g} s its speed goes to infinity, and "
            f"is over {MANY:g} times what it was up to {SHARE * lost_s:.3g} s; {named} drives it "
            f"ever faster: give a time of {SHARE * lost_s:.2g} s or less, or a load that does not "
            "grow faster than the speed or the way that it goes by"
        )


MOST_STEPS = 1_000_000
FIRST_STEPS, FAR = 2_000, 2.0
"""After so many it is told how many all take, and refused where they are so many times too many."""

CROWD = 200
"""The last steps, which tell how many all would take if they stay as short."""


@dataclass
class Steps:
    """The steps of an integration: their ``pace`` with the times between them, and what is within
    each; ``clear_s`` is the time since which nothing has jumped. ``careful`` if a change point may
    be near, ``tried`` the smallest singular value from which on a passage through it was looked for
    in vain."""

    pace: Pace
    until_s: float
    within: list[Callable[[Array], Array]] = field(default_factory=list)
    passages: list[SingularPassage] = field(default_factory=list)
    clear_s: float = 0.0
    careful: bool = False
    tried: float = math.inf

    def add(self, end_s: float, within: Callable[[Array], Array], speed: float) -> None:
        self.pace.note(end_s, speed)
        self.within.append(within)

    @property
    def times(self) -> list[float]:
        return self.pace.times_s

    @property
    def solution(self) -> OdeSolution:
        return OdeSolution(self.times, self.within)

    @property
    def crowded(self) -> bool:
        """Whether the time that is left would take too many steps, as short as the last ones; it is
        looked at now and then."""
        made, now_s = self.pace.made, self.times[-1]
        if made < CROWD or made % CROWD:
            return False
        return (self.until_s - now_s) * CROWD > FAR * MOST_STEPS * self.pace.lasted_s(CROWD)

    def check_count(self, name: str, now_s: float) -> None:
        """Raises CrankcheckError where the time of a scene takes more steps than can be made."""
        made = len(self.times)
        ahead = made * self.until_s / now_s
        if made > MOST_STEPS or (made >= FIRST_STEPS and ahead > FAR * MOST_STEPS):
            raise CrankcheckError(
                f"{name}: free for {self.until_s:g} s, of which "
                f"{now_s:.3g} s took {made} steps of the integration; at most {MOST_STEPS} are "
                "made, and a load that is switched by the motion may hold it in place, or a "
                f"spring or damper is too stiff: give a time of {now_s * MOST_STEPS / made:.2g} s "
                "or less, or a softer one"
            )
