"""A set of settings at one number of steps a turn, over every scene of a study, and its cost."""

from __future__ import annotations

import json
import math
from collections.abc import Hashable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import TypeVar

import numpy as np
import pandas as pd

from reports.protocol.length import clock_of
from reports.protocol.way import WAYS, ResultKind, Way, way
from reports.results.floor_fit import interpolate
from reports.results.lines import Line, Named, called, comparable, named, numbers
from reports.store.reader import Stored
from sim.engine import Drive, SettingValue

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
    "Geometric means over the scenes, interpolated along the fits; m/n: reached on m of n "
    "scenes only. If the coarsest step already reaches an error, its time is shown: nothing is "
    "extrapolated."
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


NOT_RUN = "not run"


@dataclass(frozen=True)
class Candidate:
    """Settings that may be recommended, with their measurements.

    ``errors`` are place errors by scene [pure] of the runs that ended well, or deflection errors
    where links bend, as its ``way`` says; ``faults`` say why a scene has none. ``us_per_step`` and
    ``s_per_turn`` are geometric means over the scenes, in which each counts the same however slow
    it is; NaN where a scene was not timed.
    """

    engine: str
    variant: str
    versions: tuple[str, ...]
    drive: Drive
    settings: Mapping[str, SettingValue] = field(repr=False)
    steps_per_turn: float
    errors: Mapping[str, float] = field(repr=False)
    faults: Mapping[str, str] = field(repr=False)
    us_per_step: float
    s_per_turn: float
    way: Way | None = None

    @property
    def kind(self) -> ResultKind:
        """Kind of the results of such cells."""
        return (self.way or way(WAYS[-1])).results

    @property
    def scenes(self) -> int:
        """Number of scenes."""
        return len(self.errors) + len(self.faults)

    @property
    def name(self) -> str:
        """Name in a sentence."""
        return f"{called(self.variant, self.drive)} at {self.steps_told}"

    @property
    def steps_told(self) -> str:
        """Step in words."""
        return f"{self.steps_per_turn:g} steps a {clock_of(self.drive).name}"

    @property
    def worst_scene(self) -> str | None:
        """Scene with the largest error; None where no run ended well."""
        return max(self.errors, key=lambda scene: self.errors[scene], default=None)

    @property
    def worst_error(self) -> float:
        """Largest error over the scenes; infinite where one has no run that ended well."""
        return math.inf if self.faults else max(self.errors.values(), default=math.inf)

    def holds(self, other: Candidate | Line) -> bool:
        """True if a line, or another candidate, has these settings."""
        names = ("engine", "variant", "drive", "settings")
        return all(getattr(self, name) == getattr(other, name) for name in names)

    def reaching(self, target: float) -> int:
        """Return the number of scenes with an error of at most ``target``."""
        return sum(error <= target for error in self.errors.values())

    def reaches(self, target: float) -> bool:
        """True if the error is at most ``target`` on all scenes."""
        return self.reaching(target) == self.scenes


def candidates(lines: Sequence[Line]) -> tuple[Candidate, ...]:
    """Return all settings and steps of a study, by variant, from coarse to fine.

    Settings count as the same where all of them are, drive included; a scene on which they were not
    run is a fault.
    """
    scenes = list(dict.fromkeys(line.scene for line in lines))
    groups: dict[tuple[str, ...], dict[str, Line]] = {}
    for line in lines:
        settings = json.dumps(dict(line.settings), sort_keys=True)
        groups.setdefault((*named(line), settings), {})[line.scene] = line
    return tuple(one for group in groups.values() for one in _each_step(group, scenes))


def _each_step(group: Mapping[str, Line], scenes: Sequence[str]) -> list[Candidate]:
    by_step: dict[float, dict[str, pd.Series]] = {}
    for scene, line in group.items():
        for _, row in line.cells.iterrows():
            by_step.setdefault(round(float(row["steps_per_turn"]), 6), {})[scene] = row
    first = next(iter(group.values()))
    versions = tuple(sorted({line.version for line in group.values()}, key=numbers))
    every = []
    for steps, rows in sorted(by_step.items()):
        faults = {scene: _fault(rows.get(scene)) for scene in scenes}
        good = {scene: row for scene, row in rows.items() if not faults[scene]}
        complete = tuple(good.values()) if len(good) == len(scenes) else ()
        every.append(
            Candidate(
                engine=first.engine,
                variant=first.variant,
                versions=versions,
                drive=first.drive,
                settings=first.settings,
                steps_per_turn=steps,
                errors={scene: float(row["place_pure"]) for scene, row in good.items()},
                faults={scene: fault for scene, fault in faults.items() if fault},
                us_per_step=mean(float(row["us_per_step"]) for row in complete),
                s_per_turn=mean(float(row["s_per_turn"]) for row in complete),
                way=first.way,
            )
        )
    return every


def _fault(row: pd.Series | None) -> str:
    if row is None:
        return NOT_RUN
    if row["status"] != "ok":
        return str(row["status"])
    return "" if math.isfinite(row["place_pure"]) else "error is no number"


CellKey = TypeVar("CellKey", bound=Hashable)


def front(cells: pd.DataFrame, noise: float = 0.0) -> list[str]:
    """Return keys of the cells that no other beats in both error and time, from the slowest on.

    ``cells`` are rows of a store, of one scene; cells that did not end well, or were not timed,
    take no part. A time counts as shorter only if it is shorter by more than ``noise``.
    """
    good = cells[(cells["status"] == "ok") & cells["s_per_turn"].notna()]
    rows = good[["key", "place_pure", "s_per_turn"]].itertuples(index=False)
    return _unbeaten(((str(k), float(e), float(t)) for k, e, t in rows), noise)


def front_over_all(candidates: Iterable[Candidate], noise: float = 0.0) -> tuple[Candidate, ...]:
    """Return the settings that no other beats in both worst error over all scenes and mean time.

    Settings that fail on a scene take no part.
    """
    every = list(candidates)
    points = ((i, one.worst_error, one.s_per_turn) for i, one in enumerate(every))
    return tuple(every[i] for i in _unbeaten(points, noise))


def _unbeaten(points: Iterable[tuple[CellKey, float, float]], noise: float) -> list[CellKey]:
    """Return names of (name, error, time) that are faster than all of at least their accuracy."""
    unbeaten: list[CellKey] = []
    least = math.inf
    finite = [p for p in points if math.isfinite(p[1]) and math.isfinite(p[2])]
    for name, _, time_s in sorted(finite, key=lambda p: (p[1], p[2])):
        if time_s * (1.0 + _known(noise)) < least:
            unbeaten.append(name)
            least = time_s
    return unbeaten


def _known(noise: float) -> float:
    return noise if math.isfinite(noise) else 0.0


def performance_profile(lines: Sequence[Line], target: float, noise: float = 0.0) -> pd.DataFrame:
    """Return shares of scenes where variants reach ``target`` within a factor of the fastest.

    Columns engine, variant (as `Line.name` has it), factor, share; rows of a variant are the
    corners of a rising stair (``share`` holds from ``factor`` on), which starts at factor 1. Scenes
    on which no variant reaches the target count as well, so that no stair need rise to 1. Times
    come from `time_to`; within ``noise`` of the fastest they are called equal.
    Source: Dolan and More, Benchmarking optimization software with performance profiles, 2002.
    """
    times = pd.DataFrame(
        [(x.engine, x.name, x.scene, time_to(x, target)) for x in lines],
        columns=["engine", "variant", "scene", "s"],
    ).astype({"s": float})
    number = times["scene"].nunique()
    factor = times["s"] / times.groupby("scene")["s"].transform("min")
    times["factor"] = np.where(factor <= 1.0 + _known(noise), 1.0, factor)
    rows = []
    for (engine, variant), own in times.groupby(["engine", "variant"], sort=False):
        corners = own["factor"].dropna().sort_values().to_numpy()
        for at in np.union1d([1.0], corners):
            share = float(np.count_nonzero(corners <= at)) / number
            rows.append((engine, variant, float(at), share))
    return pd.DataFrame(rows, columns=["engine", "variant", "factor", "share"])
