"""Advice: the searched choices, cheapest first, with the best of each engine and its snippet."""

import math
from collections.abc import Callable, Mapping, Sequence
from contextlib import closing
from dataclasses import dataclass, field

from reports.advise.demand import Demand, MeasuredStudy
from reports.advise.search import LIMITS, SearchResult
from reports.output.numbers import count, short
from reports.results.candidates import apart, equal, noise_of
from reports.results.runs import grouped
from reports.sweep.measured import Repeats, timed_in_turns
from reports.workers.isolated import Isolated
from sim.registry import engine, offering
from sim.registry.offers import Stepping, frame_snippet

ROUNDS = 10
"""Rounds of timing, one after the other: a slow minute then slows all."""
GUESS_US = 30.0
"""Guess of a step; high, so that a repeat is short: the least of many is hardly disturbed."""


@dataclass(frozen=True)
class Price:
    """Cost of the dearest of the scenes with a promise: a step [microseconds], and a second of the
    mechanism's own time [s], which is the share of real time; least of all repeats."""

    scene: str
    us_per_step: float
    s_per_s: float


@dataclass(frozen=True)
class Prices:
    """A price for each result, None where there is no promise or its process was lost; ``noise`` is
    the relative difference up to which two are called equal, NaN of none."""

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
    """Return the number of timings."""
    return ROUNDS * len(demand.scenes) * sum(one.promise is not None for one in found)


def _price(
    demand: Demand, one: SearchResult, timings: Sequence[tuple[Repeats, Repeats] | None]
) -> Price | None:
    least = [min(*timing[0], *timing[1]) for timing in timings if timing is not None]
    if one.promise is None or len(least) < len(demand.scenes):
        return None
    us = max(least)
    steps_per_s = one.promise.substeps / demand.frame_s
    return Price(demand.scenes[least.index(us)].name, us, 1e-6 * us * steps_per_s)


@dataclass(frozen=True)
class Offer:
    """A choice with its search result, and the cost of that."""

    reached: SearchResult
    price: Price | None

    @property
    def s_per_s(self) -> float:
        """Share of real time; infinite where it is not known."""
        return math.inf if self.price is None else self.price.s_per_s

    @property
    def place(self) -> tuple[bool, float, float]:
        """Place in a table: promises by their price, then the rest by their error."""
        best = self.reached.promise or self.reached.nearest
        return not self.reached.promise, self.s_per_s, best.error if best else math.inf


@dataclass(frozen=True)
class Advice:
    """All offers, cheapest first; ``noise`` is the difference up to which two prices are called
    equal, and ``facts`` the provenance. The scenes were ``named``, or are the usual ones."""

    demand: Demand
    offers: tuple[Offer, ...]
    noise: float
    known: MeasuredStudy
    facts: Mapping[str, str] = field(default_factory=dict)
    named: bool = True

    @property
    def promises(self) -> tuple[Offer, ...]:
        return tuple(offer for offer in self.offers if offer.reached.promise)

    @property
    def best(self) -> tuple[Offer, ...]:
        """Cheapest promise of each engine, of the steady ones where there are any; among promises
        that cost the same, within the noise, the one with the least error."""
        by_engine = grouped((offer.reached.choice.engine, offer) for offer in self.promises)
        best = (self._best([o for o in own if self.steady(o)] or own) for own in by_engine.values())
        return tuple(sorted(best, key=lambda offer: offer.place))

    @property
    def nearest(self) -> Offer | None:
        """Nearest offer where nothing reaches the target."""
        over = [offer for offer in self.offers if offer.reached.nearest]
        return min(over, key=lambda offer: offer.place, default=None)

    def equal(self, a: Offer, b: Offer) -> bool:
        """True if two cost the same, within the noise."""
        return equal(a.s_per_s, b.s_per_s, self.noise)

    def steady(self, offer: Offer) -> bool:
        """True if the error of a promise does not grow, and it holds at finer steps."""
        promise = offer.reached.promise
        return promise is not None and not promise.seen.grows and not self.caution(offer)

    def caution(self, offer: Offer) -> str:
        """Return where a study has it over the target at finer steps than the promise; "" where it
        does not, or does not say."""
        demand, promise, choice = self.demand, offer.reached.promise, offer.reached.choice
        if promise is None:
            return ""
        steps = demand.steps_per_turn(promise.substeps)
        missed = {
            scene.name: self.known.missed(scene, choice, steps, demand.target)
            for scene in demand.scenes
        }
        over = [(finer, name) for name, finer in missed.items() if finer is not None]
        if not over:
            return ""
        finer, name = min(over)
        return (
            f"holds with {count(promise.substeps, 'sub-step')}, but not at every finer step: in "
            f"the study {name} is over the target at {finer:g} steps a turn "
            f"({finer / demand.frames_per_turn:.3g} sub-steps)"
        )

    def snippet(self, offer: Offer) -> str:
        """Return text to copy and paste, headed by its promise; empty where there is none."""
        promise, choice, demand = offer.reached.promise, offer.reached.choice, self.demand
        if promise is None or choice.engine not in offering("snippet"):
            return ""
        scenes = demand.scenes
        which = scenes[0].name if len(scenes) == 1 else f"each of {len(scenes)} scenes"
        worst = "" if len(scenes) == 1 else f", on {promise.scene}"
        head = (
            f"{choice.engine} {engine(choice.engine).version()}, {choice.name}, "
            f"{count(promise.substeps, 'step')} a frame: place within {demand.target:g} (rad, or "
            f"of the longest link) on {which} at {demand.speed_rad_s:g} rad/s, over "
            f"{demand.turns:g} turns; at worst {short(promise.error)}{worst}."
        )
        caution = f"Caution: {said}." if (said := self.caution(offer)) else ""
        stepping = Stepping(demand.period_s, demand.frame_s / promise.substeps, promise.substeps)
        return frame_snippet(choice.engine, choice.settings, stepping, [head, caution])

    def _best(self, own: Sequence[Offer]) -> Offer:
        level = [offer for offer in own if self.equal(offer, own[0])]
        return min(level, key=lambda offer: offer.place[2])


def offers(found: Sequence[SearchResult], priced: Prices) -> tuple[Offer, ...]:
    """Return the results with their prices, cheapest first."""
    every = [Offer(one, price) for one, price in zip(found, priced.each, strict=True)]
    return tuple(sorted(every, key=lambda offer: offer.place))
