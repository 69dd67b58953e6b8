"""Where what acts is not smooth: edges over time, and places over the state of the mechanism."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import islice

import numpy as np

from analytic.multibody.configuration import Configuration
from analytic.multibody.generalised_forces import GeneralisedForces, Strokes
from models.array import Array
from models.loads import Load
from models.scene import Scene

MOST_EDGES = 100_000
"""Of a load over time that are integrated from one to the next."""


@dataclass(frozen=True)
class Switch:
    """A load with kinks over a coordinate of the state, or, ``turning``, with a stroke.

    Between two kinks the coordinate is in one ``cell``: cell k begins with kink k - 1; with a
    ``period`` they go on for ever, to both sides.
    """

    load: Load
    kinks: tuple[float, ...]
    period: float | None
    turning: bool

    def coordinate(self, forces: GeneralisedForces, now: Configuration) -> float:
        """Where the state is, in the unit of the kinks."""
        if self.turning:
            assert self.load.slider is not None
            return float(forces.slide(self.load.slider, now).speed[0])
        return float(forces.over(self.load, np.zeros(1), now)[0])

    def of_state(self, forces: GeneralisedForces, state: Array) -> float:
        """That of a state, of q, q' and what else, (2 n + 1,)."""
        n = forces.assembly.size
        now = forces.assembly.at_rates(state[None, :n], state[None, n : 2 * n])
        return self.coordinate(forces, now)

    def cell(self, x: float) -> int:
        """The number of the cell that a coordinate is in."""
        if self.period is None:
            return int(np.searchsorted(self.kinks, x, side="right"))
        turns = int((x - self.kinks[0]) // self.period)
        within = x - turns * self.period
        return turns * len(self.kinks) + int(np.searchsorted(self.kinks, within, side="right"))

    def begin(self, cell: int) -> float:
        """The kink with which a cell begins."""
        turns, k = divmod(cell - 1, len(self.kinks))
        return self.kinks[k] + (turns * self.period if self.period is not None else 0.0)


def switches(forces: GeneralisedForces) -> tuple[Switch, ...]:
    """Those of all loads of a scene that go by the state."""
    return tuple(_switches(forces))


def _switches(forces: GeneralisedForces) -> Iterator[Switch]:
    for load in forces.scene.loads.values():
        kinks = load.characteristic.kinks
        if load.over != "time" and kinks:
            period = load.characteristic.repeats_after
            if period is not None and kinks[-1] - kinks[0] > period * (1.0 - 1e-9):
                kinks = kinks[:-1]  # the first of the next period
            yield Switch(load, kinks, period, turning=False)
        if load.stroke != "both":
            yield Switch(load, (0.0,), None, turning=True)


def state_cells(own: tuple[Switch, ...], forces: GeneralisedForces, state: Array) -> Array:
    """The cells that the switches are in at a state (2 n + 1,)."""
    return np.array([switch.cell(switch.of_state(forces, state)) for switch in own], dtype=int)


def strokes(own: tuple[Switch, ...], cells: Array) -> Strokes:
    """Whether the loads on one stroke act, with the switches in their cells."""
    return {
        switch.load.name: bool((cell > 0) == (switch.load.stroke == "forward"))
        for switch, cell in zip(own, cells, strict=True)
        if switch.turning
    }


def edges(scene: Scene, until_s: float) -> list[float]:
    """The times at which loads over time are not smooth, from 0 to the end with both."""
    inside: set[float] = set()
    for load in scene.loads.values():
        if load.over == "time":
            inside.update(islice(load.characteristic.kinks_between(0.0, until_s), MOST_EDGES))
    return [0.0, *sorted(inside - {0.0, until_s}), until_s]
