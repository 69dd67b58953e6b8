"""What hard runs are compared with, by name; each way has its own."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import cast

import numpy as np

from analytic.kinematics import solve
from models.array import Array
from models.motion import Motion, State
from reports.stability.case import Judge, Trial
from reports.stability.error_series import ErrorSeries
from reports.way.way import WAYS, way
from sim.engine import Run


def _solved_start(trial: Trial) -> State:
    return trial.start or solve(trial.scene, np.zeros(1)).state()


@dataclass(frozen=True)
class Yardstick:
    """How a run is seen beside its truth, how that moves, to be drawn, and the state that they
    start in. ``error_of`` says what the errors are of, as pure numbers; ``with_forces`` whether
    those of forces may be asked for as well."""

    error_of: str
    look: Callable[[Trial, Run], ErrorSeries]
    motion: Callable[[Trial, Array], Motion]
    start: Callable[[Trial], State] = _solved_start
    with_forces: bool = False


def yardsticks() -> dict[Judge, tuple[str, Yardstick]]:
    """All, by name, each with the name of its way."""
    series = {
        name: cast(Mapping[Judge, Yardstick], way(name).own_part("series", {})) for name in WAYS
    }
    return {judge: (name, each) for name, own in series.items() for judge, each in own.items()}
