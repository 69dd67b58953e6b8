"""Measurements of cells: rows, and their motion, ready to travel between processes; times."""

from __future__ import annotations

import statistics
import threading
from collections.abc import Callable, Generator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import partial
from itertools import chain
from typing import TYPE_CHECKING

import numpy as np

from models.array import Array
from models.errors import CrankcheckError
from models.motion import State
from reports.compare.free_truth import released_state
from reports.compare.last_turn import trace
from reports.judge.cell import Cell, examined
from reports.judge.rows import cell_row, error_rows
from reports.output.write import crankcheck_version
from reports.workers.isolated import Isolated, Limits, Lost
from sim.engine import Run
from sim.own_engine.known import spellings, told
from sim.run import time_run

if TYPE_CHECKING:
    from distributed import Client


REPEATS = 2
"""Timed repeats of a cell in one round."""
REPEAT_S = 0.015
"""Length of a repeat [s], roughly: long over the clock's resolution, short enough for hundreds."""
UNMEASURED: Mapping[str, object] = {"logged_us_per_step": None, "wall_s": None}
"""Columns of a cell that was lost."""
LEAST_TIMED, MOST_TIMED = 200, 50_000
Repeats = tuple[float, ...]
"""Cost of a step in each repeat [microseconds]."""


@dataclass(frozen=True)
class MeasuredCell:
    """A cell that was run: its row, the rows of its errors, its last turn, and the run itself if
    requested. ``crankcheck`` is the version that ran it."""

    row: Mapping[str, object]
    errors: tuple[Mapping[str, object], ...] = ()
    trace: Mapping[str, Array] = field(default_factory=dict)
    crankcheck: str = ""
    run: Run | None = None


def measured(cell: Cell, keep_run: bool) -> MeasuredCell:
    """Run a cell, compare it and judge it."""
    checked, run = examined(cell)
    cost = None if run is None else run.cost
    row = cell_row(checked) | {
        # Logged, and with other cells at work beside it: kept, and never compared.
        "logged_us_per_step": cost.us_per_step if cost and cost.steps else None,
        "wall_s": checked.wall_s,
    }
    return MeasuredCell(
        row=row,
        errors=tuple(error_rows(checked)),
        trace=trace(cell.shown_truth, run) if run and checked.errors else {},
        crankcheck=crankcheck_version(),
        run=run if run and run.motion and keep_run else None,
    )


def timed_in_turns(
    isolated: Isolated[Repeats],
    cells: Sequence[tuple[Cell, float]],
    rounds: int,
    done: Callable[[], None] = lambda: None,
) -> list[tuple[Repeats, Repeats] | None]:
    """Return the cost of a step of each cell, in repeats of the rounds A and B, which take turns.

    Every cell, which comes with a first guess [microseconds], is timed once a round: a slow minute
    slows all of them. The difference of the minima of A and B is the noise. None for a cell that
    was lost in any round. ``done`` is called after every cell of every round.
    """
    taken: list[list[Repeats]] = [[] for _ in cells]
    for number in range(rounds):
        for (cell, us_per_step), before in zip(cells, taken, strict=True):
            if len(before) == number:  # it was not lost
                repeats = isolated.call(timed, cell, us_per_step)
                if not isinstance(repeats, Lost):
                    before.append(repeats)
            done()
    return [
        (tuple(chain(*each[::2])), tuple(chain(*each[1::2]))) if len(each) == rounds else None
        for each in taken
    ]


def timed(cell: Cell, us_per_step: float) -> Repeats:
    """Return the cost of a step of a cell without logging, in several repeats [microseconds].

    ``us_per_step`` is a first guess, which sets how many steps a repeat has.
    """
    steps = int(np.clip(1e6 * REPEAT_S / max(us_per_step, 0.1), LEAST_TIMED, MOST_TIMED))
    found = time_run(
        cell.given,
        _start(cell),
        cell.engine,
        cell.profile,
        dt_s=cell.dt_s,
        steps=steps,
        repeats=REPEATS,
        drive=cell.drive,
        settings=cell.settings,
    )
    return tuple(1e6 * wall / steps for wall in found.walls_s)


def _start(cell: Cell) -> State:
    """Return the start of a cell, without its whole reference. Raises CrankcheckError."""
    truth = cell.way.launch(cell.planned)
    return truth.start if truth else released_state(cell.scene)


def timing_row(cell: Cell, a: Sequence[float], b: Sequence[float]) -> dict[str, object]:
    """Return the columns of a timing, from rounds A and B over the same cells, some time apart.

    The difference of their minima is the noise of comparing cells with each other.
    """
    return {
        "us_per_step": min(*a, *b),
        "us_per_step_median": statistics.median([*a, *b]),
        "us_per_step_a": min(a),
        "us_per_step_b": min(b),
        "s_per_turn": 1e-6 * min(*a, *b) * cell.steps_per_turn,
        "repeats": float(len(a) + len(b)),
    }


ANSWER_S = 5.0
"""Longest time for the answer of a scheduler [s]."""
_own = threading.local()


def connected(address: str) -> Client:
    """Return a cluster, at the address of its scheduler. Raises CrankcheckError for no cluster at
    the address, one without workers, or no Dask here."""
    try:
        from distributed import Client
    except ImportError:
        raise CrankcheckError(
            "--dask: distributed is not installed; pip install 'crankcheck[dask]'"
        ) from None
    try:
        client = Client(address, timeout=ANSWER_S)  # type: ignore[no-untyped-call]  # not annotated
    except (OSError, ValueError) as error:
        raise CrankcheckError(
            f"--dask {address}: no scheduler answers there ({error}); start one with "
            "`dask scheduler` and workers with `dask worker ADDRESS`"
        ) from None
    if not client.scheduler_info()["workers"]:
        raise CrankcheckError(
            f"--dask {address}: no workers; start some with `dask worker {address}`"
        )
    return client


def on_cluster(
    client: Client, cells: Sequence[Cell], limits: Limits, keep_run: bool
) -> Generator[tuple[int, MeasuredCell | Lost]]:
    """Run `measured` on every cell, each in a child process of the Dask worker that has it; yield
    index and outcome of each as it ends. The client is closed when this is."""
    from distributed import as_completed

    try:
        there = partial(_there, limits=limits, keep_run=keep_run, own_engines=spellings())
        futures = client.map(there, cells, pure=False)
        indices = {future.key: index for index, future in enumerate(futures)}
        ended = as_completed(futures, with_results=True)  # type: ignore[no-untyped-call]
        del futures  # a cluster keeps a result as long as somebody has its future
        for future, outcome in ended:
            yield indices[future.key], outcome
    finally:
        client.close()  # type: ignore[no-untyped-call]  # not annotated


def _there(
    cell: Cell, limits: Limits, keep_run: bool, own_engines: Mapping[str, str]
) -> MeasuredCell | Lost:
    """Run one cell in the child process of this thread of a Dask worker."""
    told(own_engines)
    child: Isolated[MeasuredCell] | None = getattr(_own, "child", None)
    if child is not None and child.limits != limits:
        child.close()
        child = None
    if child is None:
        child = _own.child = Isolated(limits)
    return child.call(measured, cell, keep_run)
