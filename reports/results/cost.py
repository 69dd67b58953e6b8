"""The cost of a step, its uncertainty, and the time that a target error takes."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import pandas as pd

from reports.results.floor_fit import interpolate
from reports.results.lines import Line, Named, comparable, named
from reports.store.reader import Stored
from sim.engine import Drive

SHARE = 0.95
"""Share of A/A pairs whose halves differ by no more than the noise."""


def pairs(stored: Stored) -> pd.Series[float]:
    """Return the difference in each timed cell's A/A pair: two timings of a run in one sweep."""
    cells = comparable(stored.cells)
    a, b = cells["us_per_step_a"], cells["us_per_step_b"]
    both = a.notna() & b.notna()
    return pd.Series([apart(*pair) for pair in zip(a[both], b[both], strict=True)], dtype=float)


def noise(stored: Stored) -> float:
    """Return the relative difference up to which two costs are called equal; NaN without timings.

    95 of 100 pairs of timings of the same cell differ by less.
    """
    return noise_of(pairs(stored))


def apart(a: float, b: float) -> float:
    """Return the relative difference of two costs: |a - b| / min(a, b)."""
    return abs(a - b) / min(a, b)


def noise_of(differences: Iterable[float]) -> float:
    """Return the difference that 95 of 100 stay below; NaN of none."""
    found = list(differences)
    return float(np.quantile(found, SHARE)) if found else math.nan


def equal(a: float, b: float, within: float) -> bool:
    """True if two costs differ by no more than the noise ``within``."""
    return a == b or abs(a - b) <= within * min(a, b)


@dataclass(frozen=True)
class Reached:
    """A target error reached on a line: steps a turn, and time per simulated turn [s].

    ``s_per_turn`` is NaN where the cells were not timed. The coarsest step that ended well is taken
    if it already reaches the target: a coarser one may do, but was not run.
    """

    steps_per_turn: float
    s_per_turn: float


def reached(line: Line, target: float) -> Reached | None:
    """Return where a line reaches an error of at most ``target`` and stays below; None: nowhere."""
    dt_s = line.fit.dt_for(target)
    if dt_s is not None:
        return Reached(line.period_s / dt_s, _cost(line, dt_s))
    runs = line.fit.runs
    if runs and all(error <= target for _, error in runs):
        coarsest = runs[-1][0]
        return Reached(line.period_s / coarsest, _cost(line, coarsest))
    return None


def time_to(line: Line, target: float) -> float | None:
    """Return the time per simulated turn [s] that an error of ``target`` takes (see `reached`).

    Interpolated along the fit, never extrapolated; None where the line does not reach the target,
    or was not timed.
    """
    found = reached(line, target)
    return None if found is None or math.isnan(found.s_per_turn) else found.s_per_turn


def _cost(line: Line, dt_s: float) -> float:
    """Return the time per turn [s] at a step, between measured ones; NaN where not timed."""
    timed = line.cells.dropna(subset=["s_per_turn"])
    costs = [float(cost) for cost in timed["s_per_turn"]]
    found = interpolate([float(dt) for dt in timed["dt_s"]], costs, dt_s)
    return math.nan if found is None else found


MEANS = (
    "Geometric means over the scenes, interpolated along the fits; m/n: so on m of n scenes only. "
    "Where the coarsest step reaches an error already, its time stands: nothing is extrapolated."
)


@dataclass(frozen=True)
class Costs:
    """Costs of a variant, as geometric means over the scenes.

    ``us_per_step`` is of the least and ``us_per_step_median`` of the median repeat, over the
    ``timed`` scenes, which have timed cells. ``s_to`` is the time per turn [s] to reach each
    target, NaN where it is not reached on every scene; ``reached`` on how many scenes it is.
    """

    engine: str
    variant: str
    drive: Drive
    us_per_step: float
    us_per_step_median: float
    timed: int
    s_to: Mapping[float, float]
    reached: Mapping[float, int]
    scenes: int

    def part(self, number: int) -> str:
        """Return a number of scenes as m/n; empty where it is all of them."""
        return "" if number == self.scenes else f"{number}/{self.scenes}"


def costs_of(lines: Sequence[Line], targets: Sequence[float]) -> tuple[Costs, ...]:
    """Return the costs of each variant."""
    scenes = len({line.scene for line in lines})
    groups: dict[Named, list[Line]] = {}
    for line in lines:
        groups.setdefault(named(line), []).append(line)
    costs = []
    for name, group in groups.items():
        timed = [x for line in group if len(x := line.cells.dropna(subset=["us_per_step"]))]
        cells = pd.concat(timed or [group[0].cells.iloc[:0]])
        times = {target: [t for x in group if (t := time_to(x, target))] for target in targets}
        costs.append(
            Costs(
                *name,
                us_per_step=mean(cells["us_per_step"]),
                us_per_step_median=mean(cells["us_per_step_median"].dropna()),
                timed=len(timed),
                s_to={a: mean(t) if len(t) == scenes else math.nan for a, t in times.items()},
                reached={a: sum(reached(line, a) is not None for line in group) for a in targets},
                scenes=scenes,
            )
        )
    return tuple(costs)


def mean(values: Iterable[float]) -> float:
    """Return the geometric mean, NaN of nothing."""
    logs = np.log(np.fromiter(values, dtype=np.float64))
    return float(np.exp(logs.mean())) if len(logs) else math.nan
