"""Error against time: what is beaten by nothing, on a scene and over all of them."""

from __future__ import annotations

import math
from collections.abc import Hashable, Iterable, Sequence
from typing import TypeVar

import numpy as np
import pandas as pd

from reports.results.candidates import Candidate
from reports.results.cost import time_to
from reports.results.lines import Line

CellKey = TypeVar("CellKey", bound=Hashable)


def front(cells: pd.DataFrame, noise: float = 0.0) -> list[str]:
    """Keys of the cells that no other beats in both error and time, from the slowest on.

    ``cells`` are rows of a store, of one scene; those that did not end well, or were not timed,
    take no part. With ``noise`` a time counts as shorter only where it is so by more than that.
    """
    good = cells[(cells["status"] == "ok") & cells["s_per_turn"].notna()]
    rows = good[["key", "place_pure", "s_per_turn"]].itertuples(index=False)
    return _unbeaten(((str(k), float(e), float(t)) for k, e, t in rows), noise)


def front_over_all(candidates: Iterable[Candidate], noise: float = 0.0) -> tuple[Candidate, ...]:
    """The settings that no other beats in both the worst error over all scenes and the mean time.

    Settings that fail on a scene take no part.
    """
    every = list(candidates)
    points = ((i, one.worst_error, one.s_per_turn) for i, one in enumerate(every))
    return tuple(every[i] for i in _unbeaten(points, noise))


def _unbeaten(points: Iterable[tuple[CellKey, float, float]], noise: float) -> list[CellKey]:
    """Names of (name, error, time) that are faster than all that are as accurate."""
    unbeaten: list[CellKey] = []
    least = math.inf
    finite = [p for p in points if math.isfinite(p[1]) and math.isfinite(p[2])]
    for name, _, time_s in sorted(finite, key=lambda p: (p[1], p[2])):
        if time_s * (1.0 + _known(noise)) < least:
            unbeaten.append(name)
            least = time_s
    return unbeaten


def _known(noise: float) -> float:
    """The noise, none where it was not measured."""
    return noise if math.isfinite(noise) else 0.0


def performance_profile(lines: Sequence[Line], target: float, noise: float = 0.0) -> pd.DataFrame:
    """On which share of the scenes each variant reaches ``target`` within a factor of the fastest.

    Columns engine, variant (as `Line.name` has it), factor, share; rows of a variant are the
    corners of a rising stair (``share`` holds from ``factor`` on), which starts at factor 1. Scenes
    on which no variant reaches the target count as well, so that no stair need rise to 1. Times are
    those of `reports.results.cost.time_to`; within ``noise`` of the fastest they are called equal.
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
