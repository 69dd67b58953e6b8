"""Integrate the equations of motion over time, from kink to kink of what acts.

The state is q, q' and the work of loads and dampers, (2 n + 1,). After each step of the adaptive
method the state is put back onto the constraints, by what its own error has left them open, so that
the order of the method stays. Source: E. Hairer, G. Wanner, Solving Ordinary Differential Equations
II, VII.2 (projection); the same and S. P. Norsett, I, II.5 (the method of order 8).
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
from scipy.integrate import DOP853, OdeSolution  # type: ignore[import-untyped]  # ships no stubs
from scipy.optimize import brentq  # type: ignore[import-untyped]

from analytic.multibody.dynamics import Dynamics
from analytic.multibody.generalised_forces import Strokes
from analytic.multibody.singular_passage import (
    NEAR,
    SingularPassage,
    passage_ahead,
    smallest_singular,
)
from analytic.multibody.state_history import StateHistory
from analytic.multibody.switches import Switch, edges, state_cells, strokes, switches
from models.array import Array
from models.errors import CrankcheckError

MOST_STEPS = 1_000_000
FIRST_STEPS, FAR = 2_000, 2.0
"""After so many it is told how many all take, and refused where they are so many times too many."""
CAREFUL = 0.1
"""The smallest singular value of the constraints, of rows of the largest entry 1, below which the
stages of a step are put back onto the constraints as well: what they are off by, which is more than
the step is, counts there over that value."""


@dataclass
class _Steps:
    """The steps of an integration: the times between them, and what is within; ``clear_s`` is the
    time since which nothing has jumped. ``careful`` if a change point may be near."""

    times: list[float]
    until_s: float
    within: list[Callable[[Array], Array]] = field(default_factory=list)
    passages: list[SingularPassage] = field(default_factory=list)
    clear_s: float = 0.0
    careful: bool = False

    def add(self, end_s: float, within: Callable[[Array], Array]) -> None:
        self.times.append(end_s)
        self.within.append(within)

    @property
    def solution(self) -> OdeSolution:
        return OdeSolution(self.times, self.within)


@dataclass(frozen=True)
class _Crossing:
    """When a switch is gone over, the cells of all after it, and whose switch it is."""

    at_s: float
    cells: Array
    load: str
    slider: str


@dataclass(frozen=True)
class Adaptive:
    """Integrates with steps of a size that keeps to a tolerance, over the largest of what a
    coordinate has been and its unit; ``projected`` back onto the constraints after each."""

    dynamics: Dynamics
    tolerance: float
    projected: bool

    def history(self, q: Array, rates: Array, until_s: float) -> StateHistory:
        """The motion from a state to a time [s]. Raises CrankcheckError where it cannot go on."""
        forces = self.dynamics.forces
        own, state = switches(forces), np.concatenate([q, rates, [0.0]])
        steps = _Steps([0.0], until_s)
        times = edges(forces.scene, until_s)
        cells = self._first_cells(own, state)
        for begin, end in itertools.pairwise(times):
            state, cells = self._between_edges(steps, own, cells, begin, end, state)
        return StateHistory(steps.solution, len(steps.within), tuple(steps.passages))

    def _first_cells(self, own: tuple[Switch, ...], state: Array) -> Array:
        """The cells in which the switches are as the motion starts, or into which it moves."""
        cells = state_cells(own, self.dynamics.forces, state)
        if not any(switch.turning for switch in own):
            return cells
        # Where it starts at rest, no stroke has begun.
        off = dict.fromkeys(strokes(own, cells), False)
        slope = self.dynamics.rates(0.0, state, off)
        ahead = state_cells(own, self.dynamics.forces, state + 1e-9 * slope)
        return np.where([switch.turning for switch in own], ahead, cells)

    def _between_edges(
        self,
        steps: _Steps,
        own: tuple[Switch, ...],
        cells: Array,
        begin: float,
        end: float,
        state: Array,
    ) -> tuple[Array, Array]:
        """Integrate between two edges over time; the state and the cells at the end."""
        solver = self._solver(steps, begin, end, state, strokes(own, cells), None)
        steps.clear_s = begin
        while solver.status == "running":
            before_s, before = float(solver.t), solver.y
            self._step(solver, steps)
            crossing = self._crossing(own, cells, solver)
            if crossing is None:
                self._take(steps, solver)
                solver = self._passed(steps, solver, strokes(own, cells))
                continue
            # Once more, up to the crossing alone; on from there with the step as it was.
            first_s = float(solver.t) - before_s
            if crossing.at_s > before_s:
                solver = self._solver(
                    steps, before_s, crossing.at_s, before, strokes(own, cells), first_s
                )
                while solver.status == "running":
                    self._step(solver, steps)
                    self._take(steps, solver)
                before_s, before = float(solver.t), solver.y
                cells = crossing.cells
            else:
                first_s = self._shortened(crossing, first_s)
            steps.clear_s = before_s
            if before_s < end:
                solver = self._solver(steps, before_s, end, before, strokes(own, cells), first_s)
        return solver.y, cells

    def _passed(self, steps: _Steps, solver: DOP853, own: Strokes) -> DOP853:
        """The integration on the other side of a change point, if one is just ahead."""
        if not self.projected or self.dynamics.rank == 0 or solver.status != "running":
            return solver
        n, now_s = self.dynamics.assembly.size, float(solver.t)
        smallest = smallest_singular(self.dynamics, solver.y[:n])
        steps.careful = smallest < CAREFUL
        if smallest >= NEAR:
            return solver
        passage = passage_ahead(self.dynamics, steps.solution, steps.clear_s, now_s, smallest)
        if passage is None or passage.end_s >= solver.t_bound:
            return solver
        state = self._closed(passage.state(np.array([passage.end_s]))[:, 0])
        steps.add(passage.end_s, passage.state)
        steps.passages.append(passage)
        steps.clear_s = passage.end_s
        return self._solver(steps, passage.end_s, float(solver.t_bound), state, own, None)

    def _shortened(self, crossing: _Crossing, step_s: float) -> float:
        """A shorter step from the turn of a slider on, within which it may not turn back.

        Raises CrankcheckError for one that turns back at once: a load that comes on with its stroke
        drives it back, and it is held where it is.
        """
        if step_s > 1e-9 * max(crossing.at_s, 1e-3):
            return 0.1 * step_s
        raise CrankcheckError(
            f"{self.dynamics.assembly.scene.name}: at {crossing.at_s:g} s "
            f"loads.{crossing.load} holds slider {crossing.slider} in place: it drives it back as "
            "soon as the stroke begins; let it act on both strokes, or over the displacement"
        )

    def _solver(
        self,
        steps: _Steps,
        begin: float,
        end: float,
        state: Array,
        own: Strokes,
        first_s: float | None,
    ) -> DOP853:
        # What jumps at an edge has its old value up to it.
        last = math.nextafter(end, begin)

        def rates(time_s: float, state: Array) -> Array:
            if steps.careful:
                state = self._closed(state)
            return self.dynamics.rates(min(max(time_s, begin), last), state, own)

        first = None if first_s is None else min(first_s, end - begin)
        return DOP853(
            rates, begin, state, end,
            rtol=max(self.tolerance, 3e-14), atol=self.tolerance * self._units(), first_step=first,
        )  # fmt: skip

    def _units(self) -> Array:
        """What a coordinate, a rate and the work count as one of."""
        own = self.dynamics.assembly.units
        return np.concatenate([own, own, [self.dynamics.assembly.scene.longest_m**2]])

    def _step(self, solver: DOP853, steps: _Steps) -> None:
        name = self.dynamics.assembly.scene.name
        with np.errstate(all="ignore"):
            trouble = solver.step()
        if solver.status == "failed" or not np.isfinite(solver.y).all():
            raise CrankcheckError(f"{name}: the integration fails at {solver.t:g} s: {trouble}")
        self._check_count(len(steps.times), float(solver.t), steps.until_s)

    def _check_count(self, made: int, now_s: float, until_s: float) -> None:
        """Raises CrankcheckError where the time takes more steps than can be worked out."""
        ahead = made * until_s / now_s
        if made > MOST_STEPS or (made >= FIRST_STEPS and ahead > FAR * MOST_STEPS):
            raise CrankcheckError(
                f"{self.dynamics.assembly.scene.name}: free for {until_s:g} s, of which "
                f"{now_s:.3g} s took {made} steps of the integration; at most {MOST_STEPS} are "
                "made, and a load that is switched by the motion may hold it in place, or a "
                f"spring or damper is too stiff: give a time of {now_s * MOST_STEPS / made:.2g} s "
                "or less, or a softer one"
            )

    def _take(self, steps: _Steps, solver: DOP853) -> None:
        """Keep a step, and put the state back onto the constraints."""
        steps.add(float(solver.t), solver.dense_output())
        if self.projected:
            solver.y = self._closed(solver.y)

    def _closed(self, state: Array) -> Array:
        """A state on the constraints."""
        n = self.dynamics.assembly.size
        q, rates = self.dynamics.closed(state[:n], state[n : 2 * n])
        return np.concatenate([q, rates, state[2 * n :]])

    def _crossing(self, own: tuple[Switch, ...], cells: Array, solver: DOP853) -> _Crossing | None:
        """The switch that the last step goes over first; ``at_s`` is the start of the step for a
        slider that turned there, and is on its way back at the end."""
        found: list[_Crossing] = []
        forces = self.dynamics.forces
        arrived = state_cells(own, self.dynamics.forces, solver.y)
        if np.array_equal(arrived, cells):
            return None
        within = solver.dense_output()
        for number in np.flatnonzero(arrived != cells):
            switch, up = own[number], arrived[number] > cells[number]
            after = cells.copy()
            after[number] += 1 if up else -1
            kink = switch.begin(int(max(cells[number], after[number])))

            def beyond(time_s: float, switch: Switch = switch, kink: float = kink) -> float:
                return switch.of_state(forces, within(time_s)) - kink

            at_s, begin, end = float(solver.t_old), beyond(solver.t_old), beyond(solver.t)
            if begin * end < 0.0:
                at_s = float(brentq(beyond, solver.t_old, solver.t, xtol=1e-15, rtol=1e-15))
            if not switch.turning and not (begin * end < 0.0 and at_s > solver.t_old):
                # From the kink on, or by rounding from beside it, which is as good.
                cells[number] = after[number]
                return self._crossing(own, cells, solver)
            found.append(_Crossing(at_s, after, switch.load.name, str(switch.load.slider)))
        return min(found, key=lambda one: one.at_s, default=None)
