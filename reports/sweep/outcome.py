"""What is measured of one cell: its rows, and how it moved, ready to travel between processes."""

from __future__ import annotations

import statistics
from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from analytic.kinematics import solve
from models.motion import Motion
from reports.cell import Cell, examined
from reports.rows import cell_row, error_rows
from reports.series import Array
from reports.store.trace import trace
from sim.run import time_run

REPEATS = 6
"""Timed repeats of a cell: every second one belongs to A, the others to B."""
REPEAT_S = 0.02
"""About how long a repeat lasts: long over the clock's resolution, short enough for hundreds."""
UNMEASURED: Mapping[str, object] = {"logged_us_per_step": None, "wall_s": None}
"""The columns of a cell that was lost."""
LEAST_TIMED, MOST_TIMED = 200, 50_000


@dataclass(frozen=True)
class Outcome:
    """A cell that was run: its row, the rows of its errors, its last turn, and the whole motion
    where that was asked for."""

    row: Mapping[str, object]
    errors: tuple[Mapping[str, object], ...] = ()
    trace: Mapping[str, Array] = field(default_factory=dict)
    motion: Motion | None = None
    gaps: Mapping[str, Array] = field(default_factory=dict)


def measured(cell: Cell, keep_motion: bool) -> Outcome:
    """Run a cell, compare it and judge it."""
    checked, run = examined(cell)
    motion = None if run is None else run.motion
    cost = None if run is None else run.cost
    row = cell_row(checked) | {
        # Logged, and with other cells at work beside it: kept, and never compared.
        "logged_us_per_step": cost.us_per_step if cost and cost.steps else None,
        "wall_s": checked.wall_s,
    }
    return Outcome(
        row=row,
        errors=tuple(error_rows(checked)),
        trace=trace(cell.scene, run) if run and checked.errors else {},
        motion=motion if keep_motion else None,
        gaps=run.gaps if run and keep_motion else {},
    )


def timed(cell: Cell, us_per_step: float) -> dict[str, object]:
    """Time the stepping of a cell without logging.

    ``us_per_step`` is a first guess [microseconds], which sets how many steps a repeat has. Half
    of the repeats, alternately, are A and B of the same thing: how far their minima lie apart is
    the noise of the measurement.
    """
    steps = int(np.clip(1e6 * REPEAT_S / max(us_per_step, 0.1), LEAST_TIMED, MOST_TIMED))
    state = solve(cell.scene, np.zeros(1)).state()
    found = time_run(
        cell.scene,
        state,
        cell.engine,
        cell.profile,
        dt_s=cell.dt_s,
        steps=steps,
        repeats=REPEATS,
        drive=cell.drive,
        settings=cell.settings,
    )
    each = [1e6 * wall / steps for wall in found.walls_s]
    return {
        "us_per_step": min(each),
        "us_per_step_median": statistics.median(each),
        "us_per_step_a": min(each[0::2]),
        "us_per_step_b": min(each[1::2]),
        "s_per_turn": 1e-6 * min(each) * cell.steps_per_turn,
        "timed_steps": float(steps),
        "repeats": float(REPEATS),
    }
