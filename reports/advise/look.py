"""One run of settings at a step: its error of place, whether that grows, and how it ended."""

from __future__ import annotations

import math
from dataclasses import dataclass

from models.errors import CrankcheckError, EngineError
from reports.compare.beside import Truth
from reports.judge.cell import Cell
from reports.stability.error_series import ErrorSeries, error_series
from sim.run import run

GROWS = 1.05
"""How many times the error of the first half of a run may be in the second, and not grow: samples
that fall elsewhere in a turn make some of it."""
LONGER = 8.0
"""How many times as long a run is in which an error that grows has to stay under the target."""
WORDS = {
    "diverged": "comes apart",
    "locked": "locks",
    "branch-changed": "other branch",
    "timeout": "takes too long",
    "crashed": "crashes",
    "unsupported": "not possible",
}
"""What is said of a run that did not end well."""


@dataclass(frozen=True)
class TriedRun:
    """What came of a run. ``error`` is that of place, over all its samples, infinite where it did
    not end well; ``growth`` is that of the second half of the turns over that of the first, NaN
    where nothing tells."""

    error: float
    status: str = "ok"
    reason: str = ""
    growth: float = math.nan
    studied: bool = False

    @property
    def grows(self) -> bool:
        return self.growth > GROWS


def look(cell: Cell) -> TriedRun:
    """Run a cell, and hold its places to the reference."""
    try:
        start = Truth(cell.scene, bound=False).start
        done = run(
            cell.scene,
            start,
            cell.engine,
            cell.profile,
            dt_s=cell.dt_s,
            steps=cell.steps,
            settings=cell.settings,
        )
    except EngineError as error:
        return TriedRun(math.inf, "unsupported", str(error))
    if done.status == "unsupported" or done.motion is None:
        return TriedRun(math.inf, done.status, done.reason)
    try:
        return _seen(error_series(cell.scene, done))
    except CrankcheckError as error:
        return TriedRun(math.inf, "crashed", f"no reference to compare with: {error}")


def _seen(series: ErrorSeries) -> TriedRun:
    """What the errors of a run say of it."""
    if series.status != "ok":
        return TriedRun(math.inf, series.status, series.reason)
    if series.departure is not None:
        return TriedRun(math.inf, "branch-changed", f"{series.departure.link} left its branch")
    if series.incomplete:
        return TriedRun(math.inf, "crashed", series.incomplete)
    error, _ = series.worst(series.place)
    turn = series.turn
    late = turn > 0.5 * turn[-1]
    early = float(series.place[~late].max(initial=0.0))
    growth = float(series.place[late].max(initial=0.0)) / early if early > 0.0 else math.nan
    return TriedRun(error, growth=growth if turn[-1] >= 2.0 else math.nan)
