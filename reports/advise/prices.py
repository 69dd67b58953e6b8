"""What the sub-steps of a promise take: timed in turns on this machine, after all errors."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import closing
from dataclasses import dataclass

from reports.advise.demand import Demand
from reports.advise.search import LIMITS, SearchResult
from reports.results.cost import apart, noise_of
from reports.sweep.measured import Repeats, timed_in_turns
from reports.workers.isolated import Isolated

ROUNDS = 10
"""How often each is timed, one after the other: a slow minute then slows all."""
GUESS_US = 30.0
"""Of a step; high, so that a repeat is short: of many short ones the least is hardly disturbed."""


@dataclass(frozen=True)
class Price:
    """What the dearest of the scenes takes with a promise: a step [microseconds], and a second of
    the mechanism's own time [s], which is the share of real time; least of all repeats."""

    scene: str
    us_per_step: float
    s_per_s: float


@dataclass(frozen=True)
class Prices:
    """A price for each of those reached, None where there is no promise or its process was lost;
    ``noise`` is the relative difference up to which two are called equal, NaN of none."""

    each: tuple[Price | None, ...]
    noise: float


def prices(
    demand: Demand, found: Sequence[SearchResult], done: Callable[[], None] = lambda: None
) -> Prices:
    """Time every promise at its step, alone on this machine; ``done`` is called `timings` times."""
    promised = [(one, one.promise.substeps) for one in found if one.promise]
    cells = [demand.cell(scene, o.choice, n) for o, n in promised for scene in demand.scenes]
    with closing(Isolated[Repeats](LIMITS)) as isolated:
        timings = timed_in_turns(isolated, [(cell, GUESS_US) for cell in cells], ROUNDS, done)
    noise = noise_of(apart(min(a), min(b)) for a, b in filter(None, timings))
    rows = iter(timings)
    each = [
        _price(demand, one, [next(rows) for _ in demand.scenes] if one.promise else [])
        for one in found
    ]
    return Prices(tuple(each), noise)


def timings(demand: Demand, found: Sequence[SearchResult]) -> int:
    """How many timings there are."""
    return ROUNDS * len(demand.scenes) * sum(one.promise is not None for one in found)


def _price(
    demand: Demand, one: SearchResult, timings: Sequence[tuple[Repeats, Repeats] | None]
) -> Price | None:
    """That of the dearest scene."""
    least = [min(*timing[0], *timing[1]) for timing in timings if timing is not None]
    if one.promise is None or len(least) < len(demand.scenes):
        return None
    us = max(least)
    steps_per_s = one.promise.substeps / demand.frame_s
    return Price(demand.scenes[least.index(us)].name, us, 1e-6 * us * steps_per_s)
