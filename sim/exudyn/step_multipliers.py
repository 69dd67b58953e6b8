"""The multipliers of all constraints, which are the forces in exudyn's joints, at every step."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import numpy as np

from models.array import Array
from sim.exudyn.plane_system import Index


class Multipliers:
    """Multipliers that exudyn is asked for at the end of each of its steps.

    ``first`` are those of the start, where the system does not hold them itself.
    """

    def __init__(self, system: Any, first: Array | None) -> None:
        self._system, self._first = system, first
        self._times_s: list[float] = []
        self._rows: list[Array] = []

    def rows(self, index: Index) -> list[int]:
        """Which of them are those of a joint."""
        return [int(row) for row in self._system.systemData.GetObjectLTGAE(index)]

    @contextmanager
    def kept(self, steps_done: int) -> Iterator[None]:
        """Keep those of now, ``steps_done`` steps after the start, and of each step meanwhile."""
        state = self._system.systemData
        now = np.array(state.GetAECoordinates())
        self._times_s = [float(state.GetTime())]
        self._rows = [now if steps_done or self._first is None else self._first]
        self._system.SetPostStepUserFunction(self._keep)
        try:
            yield
        finally:
            self._system.SetPostStepUserFunction(0)

    def _keep(self, system: Any, time_s: float) -> bool:
        """What exudyn calls; a stretch calls it at its own start as well."""
        if time_s > self._times_s[-1]:
            self._times_s.append(time_s)
            self._rows.append(np.array(system.systemData.GetAECoordinates()))
        return True

    def at(self, time_s: Array) -> Array:
        """Those of some of the steps, by times on exudyn's clock; a row each."""
        clock = np.array(self._times_s)
        # Of a step that was cut the last part ends at the step.
        near = 0.5 * (clock[1:] + clock[:-1])
        return np.array(self._rows)[np.searchsorted(near, time_s)]
