"""Integrate the equations of motion over time, from kink to kink of the forces.

The state is q, q' and the work of loads and dampers, (2 n + 1,). After each step of the adaptive
method the state is projected onto the constraints, by no more than the step's error, so that the
order of the method stays. Source: E. Hairer, G. Wanner, Solving Ordinary Differential Equations II,
VII.2 (projection); the same and S. P. Norsett, I, II.5 (the method of order 8).
"""

import itertools
import math
from dataclasses import dataclass

import numpy as np
from scipy.integrate import DOP853  # type: ignore[import-untyped]  # ships no stubs
from scipy.optimize import brentq  # type: ignore[import-untyped]

from analytic.multibody import generalised_forces
from analytic.multibody.dynamics import Dynamics
from analytic.multibody.generalised_forces import Strokes, Switch, state_cells, strokes
from analytic.multibody.steps import (
    Pace,
    StateHistory,
    Steps,
    passage_ahead,
    singular_at,
    smallest_singular,
)
from models.array import Array
from models.errors import CrankcheckError

NEAR = 1e-2
"""Smallest singular value, of rows of the largest entry 1, from which on rounding matters: steps
become short, unless their tolerance grows with its inverse square as the loss does."""
LEAST = 2e-3
"""Value at which a passage begins at the latest; from `NEAR` on it does where steps are short."""
CLOSE = 1.1
"""Ratio to that value, up to which a singular value counts as it."""
SHORT = 0.1
"""Length of a short step, over the time up to the change point."""
CAREFUL = 0.1
"""Smallest singular value of the constraints, of rows of the largest entry 1, below which the
stages of a step are projected onto the constraints as well: their errors, larger than the step's,
count there over that value."""
EPS = float(np.finfo(float).eps)
AGAIN = 0.5
"""Ratio of smallest singular values after which a passage is searched again."""


@dataclass(frozen=True)
class _Crossing:
    """Crossing of a switch: its time, the cells of all after it, its load and slider."""

    at_s: float
    cells: Array
    load: str
    slider: str


@dataclass(frozen=True)
class Adaptive:
    """Integration with adaptive steps to a tolerance, over the largest value so far of a coordinate
    and its unit; ``projected`` onto the constraints after each step."""

    dynamics: Dynamics
    tolerance: float
    projected: bool

    def history(self, q: Array, rates: Array, until_s: float) -> StateHistory:
        """Integrate from a state to a time [s]. Raises CrankcheckError where it cannot go on."""
        forces = self.dynamics.forces
        own, state = generalised_forces.switches(forces), np.concatenate([q, rates, [0.0]])
        steps = Steps(Pace(), until_s)
        steps.pace.note(0.0, self._speed(state))
        times = generalised_forces.edges(forces.scene, until_s)
        cells = self._first_cells(own, state)
        for begin, end in itertools.pairwise(times):
            state, cells = self._between_edges(steps, own, cells, begin, end, state)
            steps.pace.end_at_edge()
        return StateHistory(steps.solution, len(steps.within), tuple(steps.passages))

    def _first_cells(self, own: tuple[Switch, ...], state: Array) -> Array:
        """Return the cells of the switches at the start of the motion, or into which it moves."""
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
        steps: Steps,
        own: tuple[Switch, ...],
        cells: Array,
        begin: float,
        end: float,
        state: Array,
    ) -> tuple[Array, Array]:
        """Integrate between two edges over time; return the state and the cells at the end."""
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

    def _passed(self, steps: Steps, solver: DOP853, own: Strokes) -> DOP853:
        """Return the integration on the other side of a change point, if one is just ahead."""
        if not self.projected or self.dynamics.rank == 0 or solver.status != "running":
            return solver
        now_s = float(solver.t)
        smallest = smallest_singular(self.dynamics, solver.y[: self.dynamics.assembly.size])
        steps.careful = smallest < CAREFUL
        solver.rtol, solver.atol = self._tolerances(max(NEAR / max(smallest, EPS), 1.0) ** 2)
        if not steps.careful:
            return solver
        back_s = 0.1 * (now_s - steps.times[-2])
        at_s = singular_at(self.dynamics, steps.within[-1], now_s, back_s)
        if not now_s < at_s < math.inf:
            steps.tried = math.inf
            return solver
        if smallest > CLOSE * LEAST and (
            smallest > NEAR or solver.h_abs > SHORT * (at_s - now_s)
        ):  # not beyond where a passage begins
            solver.h_abs = min(solver.h_abs, (1.0 - LEAST / smallest) * (at_s - now_s))
            return solver
        if smallest > AGAIN * steps.tried:
            return solver
        steps.tried = smallest
        passage = passage_ahead(self.dynamics, steps.solution, steps.clear_s, now_s, at_s, own)
        if passage is None or passage.end_s >= solver.t_bound:
            return solver
        state = self.dynamics.closed_state(passage.state(np.array([passage.end_s]))[:, 0])
        steps.add(passage.end_s, passage.state, self._speed(state))
        steps.passages.append(passage)
        steps.clear_s = passage.end_s
        return self._solver(steps, passage.end_s, float(solver.t_bound), state, own, None)

    def _shortened(self, crossing: _Crossing, step_s: float) -> float:
        """Return a shorter step from the turn of a slider on, within which it may not turn back.

        Raises CrankcheckError for a slider that turns back at once: a load that begins with its
        stroke drives it back and holds it in place.
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
        steps: Steps,
        begin: float,
        end: float,
        state: Array,
        own: Strokes,
        first_s: float | None,
    ) -> DOP853:
        # A jump at an edge has its old value up to it.
        last = math.nextafter(end, begin)

        def rates(time_s: float, state: Array) -> Array:
            if steps.careful:
                state = self.dynamics.closed_state(state)
            return self.dynamics.rates(min(max(time_s, begin), last), state, own)

        first = None if first_s is None else min(first_s, end - begin)
        rtol, atol = self._tolerances()
        return DOP853(rates, begin, state, end, rtol=rtol, atol=atol, first_step=first)

    def _tolerances(self, loose: float = 1.0) -> tuple[float, Array]:
        """Return so many times the tolerance of steps, relative and absolute."""
        return loose * max(self.tolerance, 3e-14), loose * self.tolerance * self._units()

    def _units(self) -> Array:
        """Return the units of coordinates, rates and work."""
        own = self.dynamics.assembly.units
        return np.concatenate([own, own, [self.dynamics.assembly.scene.longest_m**2]])

    def _step(self, solver: DOP853, steps: Steps) -> None:
        name = self.dynamics.assembly.scene.name
        with np.errstate(all="ignore"):
            trouble = solver.step()
        if solver.status == "failed" or not np.isfinite(solver.y).all():
            steps.pace.check_runaway(self.dynamics.assembly.scene, float(solver.t))
            raise CrankcheckError(f"{name}: the integration fails at {solver.t:g} s: {trouble}")
        if steps.crowded:
            steps.pace.check_runaway(self.dynamics.assembly.scene, float(solver.t))
        steps.check_count(name, float(solver.t))

    def _speed(self, state: Array) -> float:
        """Return the largest rate of a state, in the units of its coordinates."""
        rates = slice(self.dynamics.assembly.size, -1)
        return float(np.abs(state / self._units())[rates].max())

    def _take(self, steps: Steps, solver: DOP853) -> None:
        """Keep a step, and project the state onto the constraints."""
        within = solver.dense_output()
        if self.projected:
            solver.y = self.dynamics.closed_state(solver.y)
        steps.add(float(solver.t), within, self._speed(solver.y))

    def _crossing(self, own: tuple[Switch, ...], cells: Array, solver: DOP853) -> _Crossing | None:
        """Return the first switch that the last step crosses; ``at_s`` is the start of the step for
        a slider that turned there and is on its way back at the end."""
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
