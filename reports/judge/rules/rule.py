"""The rules' interface: a rule, its evidence, and its finding."""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal, Protocol

from models.scene.driver import place_in_words
from reports.compare.errors import Error, Errors
from reports.compare.worlds import Batch
from reports.judge.three_steps import Convergence
from reports.judge.tolerance import Limit
from reports.quantities import QUANTITIES
from sim.engine import Placing

Level = Literal["pass", "advice", "fail"]


@dataclass(frozen=True)
class Evidence:
    """All facts of one cell: how the run ended, its errors, the limits in force.

    ``errors`` is None where nothing was logged, ``convergence`` (of positions) where it was not
    requested, like ``force_convergence``; a cell that is not ``gated`` is shown only. ``profile``
    is that of the engine, "" where there is none to change. ``placing`` and ``order`` are the
    engine's (`sim.engine.Engine`); ``unasked`` are the differences of the run, and of the finer
    ones, from the request, None where there is no run. ``remedy`` is the result of other settings,
    where they were tried (`reports.verify.advised`). ``absent`` are required parts that a log
    lacks, None where none are required. ``batch`` has all worlds of a cell that is run as a batch;
    all else is then of its worst world.
    """

    status: str
    reason: str
    stopped_at_s: float
    errors: Errors | None
    limits: Mapping[str, Limit]
    convergence: Convergence | None = None
    force_convergence: Convergence | None = None
    gated: bool = True
    profile: str = ""
    placing: Placing = "integrated"
    order: int = 2
    unasked: tuple[str, ...] | None = None
    remedy: str = ""
    absent: tuple[str, ...] | None = None
    batch: Batch | None = None


@dataclass(frozen=True)
class Finding:
    """Finding of one rule on one cell: in words, and as a number against its limit. ``cure`` is the
    remedy for this cell, "" where none is needed."""

    rule: str
    level: Level
    text: str
    number: float | None = None
    limit: float | None = None
    cure: str = ""

    @property
    def taken(self) -> float:
        """Its number over its limit; infinite where that is not finite, NaN without a limit."""
        if self.number is None or not self.limit:
            return math.nan
        return self.number / self.limit if math.isfinite(self.number) else math.inf


class Rule(Protocol):
    """One check with an ID, a title, its reason, and a cure for its failure."""

    @property
    def id(self) -> str: ...

    @property
    def title(self) -> str: ...

    @property
    def explanation(self) -> str: ...

    @property
    def cure(self) -> str: ...

    def check(self, evidence: Evidence) -> Finding | None:
        """Return the finding, or None where the rule does not apply."""
        ...


def measure(error: Error) -> str:
    """Return the size of an error in its unit, and over its scale where that is another number."""
    if error.quantity == "drive" and error.driver_unit == "m":
        return f"{error.pure:.3g} L"
    size = f"{error.maximum:.3g} {error.unit}"
    return size if error.unit == "rad" else f"{size} = {error.pure:.3g} {share(error)}"


def share(error: Error) -> str:
    """Return the unit of the pure number of an error."""
    return QUANTITIES[error.quantity].of(error.body_kind).share


def place(error: Error) -> str:
    """Return an error in words: body, size, and where it is largest."""
    driver = place_in_words(error.driver_at_maximum_rad, error.driver_unit, ".1f")
    time_s = error.time_of_maximum_s  # none of a log over the driver's angle
    at = "at" if math.isnan(time_s) else f"at t = {time_s:.4g} s,"
    return f"{error.body_kind} {error.body}: {measure(error)} {at} driver {driver}"
