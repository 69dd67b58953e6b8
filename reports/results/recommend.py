"""The cheapest settings of each engine that reach a target error on every scene of a study."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from models.errors import few
from reports.output.numbers import short
from reports.results.candidates import NOT_RUN, Candidate, candidates
from reports.results.cost import equal, noise, reached
from reports.results.lines import Line, called, lines
from reports.store.reader import Stored
from reports.way.clock import clock_of
from reports.way.way import WAYS
from sim.registry import offering
from sim.registry.offers import PERIOD_S, snippet


@dataclass(frozen=True)
class Recommendation:
    """What to set for a target, or why there is nothing to set.

    The promise rests on measured cells alone: the error of place of ``best`` is at most ``target``
    on every scene. Where nothing reaches the target ``reason`` says so, and ``best`` comes nearest.

    ``least_steps`` is where along the fits every scene meets the target, between measured steps;
    None where a fit does not tell. ``equal_to`` cost the same, within the noise, and have the
    larger error. ``caution`` says at which finer steps the promise does not hold, and ``steadier``
    is the cheapest of which that can not be said.
    """

    target: float
    best: Candidate
    least_steps: float | None = None
    equal_to: tuple[str, ...] = ()
    caution: str = ""
    steadier: Recommendation | None = None
    reason: str = ""

    def snippet(self, period_s: float = PERIOD_S) -> str:
        """Text to copy and paste, headed by what it promises; empty where there is none. Of what
        is let go, whose steps are counted over a second, it has no period."""
        best = self.best
        if self.reason or best.engine not in offering("snippet"):
            return ""
        scenes = "the scene" if best.scenes == 1 else f"each of {best.scenes} scenes"
        head = (
            f"{best.engine} {', '.join(best.versions)}, {best.variant}: {best.kind.promise} within "
            f"{self.target:g} on {scenes}; at worst {short(best.worst_error)}, on "
            f"{best.worst_scene}.",
            *best.kind.notes,
            *([f"Caution: {self.caution}."] if self.caution else []),
        )
        period_s = clock_of(best.drive).period_s(period_s)
        return snippet(
            best.engine, best.settings, best.steps_per_turn, period_s, drive=best.drive, head=head
        )


def recommendations(
    stored: Stored, targets: Sequence[float] | None = None
) -> tuple[Recommendation, ...]:
    """One for each engine and target, of what was driven, of what was let go, and of both with
    elastic links, which have targets of their own.

    Of all settings and measured steps whose error is at most the target on every scene of the
    store, those with the least time per turn (geometric mean over the scenes) are chosen; of
    settings that are equal within the noise, the ones with the least error. Of two steps of the
    same settings the longer costs less: that takes no clock.
    """
    within = noise(stored)
    every = lines(stored)
    chosen: list[Recommendation] = []
    for name in reversed(WAYS):
        own = [line for line in every if line.way.name == name]
        if own:
            chosen += _of_lines(own, targets or own[0].kind.targets, within)
    return tuple(chosen)


def _of_lines(
    every: Sequence[Line], targets: Sequence[float], within: float
) -> tuple[Recommendation, ...]:
    """One for each engine and target, of some lines."""
    choice = candidates(every)
    engines = dict.fromkeys(line.engine for line in every)
    return tuple(
        _recommended(target, [c for c in choice if c.engine == name], every, within)
        for name in engines
        for target in targets
    )


def _recommended(
    target: float, choice: Sequence[Candidate], every: Sequence[Line], within: float
) -> Recommendation:
    """The recommendation of one engine."""
    good = [one for one in choice if one.reaches(target)]
    timed = [one for one in good if math.isfinite(one.s_per_turn)]
    if not timed:
        best = nearest(choice, target)
        return Recommendation(target, best, reason=nothing(best, good, target))
    best, equal_to = _cheapest(timed, within)
    caution = broken(best, choice, target)
    steady = [one for one in timed if caution and not broken(one, choice, target)]
    steadier = None
    if steady:
        steadiest, _ = _cheapest(steady, within)
        steadier = Recommendation(target, steadiest, _least_steps(steadiest, every, target))
    least_steps = _least_steps(best, every, target)
    return Recommendation(target, best, least_steps, equal_to, caution, steadier)


def _cheapest(timed: Sequence[Candidate], within: float) -> tuple[Candidate, tuple[str, ...]]:
    """The most accurate of those that cost least, within the noise; and what costs the same.

    Of each set of settings only the one with the fewest steps takes part.
    """
    longest: dict[tuple[str, str], Candidate] = {}
    for one in sorted(timed, key=lambda one: one.steps_per_turn):
        longest.setdefault((one.variant, one.drive), one)
    least = min(one.s_per_turn for one in longest.values())
    level = [one for one in longest.values() if equal(one.s_per_turn, least, within)]
    best = min(level, key=lambda one: one.worst_error)
    rest = (one for one in longest.values() if one is not best)
    return best, tuple(o.name for o in rest if equal(o.s_per_turn, best.s_per_turn, within))


def _least_steps(one: Candidate, every: Sequence[Line], target: float) -> float | None:
    """Steps a turn from which on all scenes meet the target, along the fits."""
    meets = [reached(line, target) for line in every if one.holds(line)]
    steps = [each.steps_per_turn for each in meets if each is not None]
    return max(steps) if len(steps) == len(meets) else None


SHOWN = 3
"""Scenes that a sentence names; of more it gives the number."""


def nearest(choice: Sequence[Candidate], target: float) -> Candidate:
    """What reaches the target on most scenes, of those with the least error."""
    return max(choice, key=lambda c: (c.reaching(target), -c.worst_error, -_worst(c), -_time(c)))


def nothing(best: Candidate, good: Sequence[Candidate], target: float) -> str:
    """Why nothing is recommended, where ``best`` comes nearest; ``good`` lack their times."""
    if good:
        names = ", ".join(dict.fromkeys(called(one.variant, one.drive) for one in good))
        return (
            f"{names} would do, but no cost is known of every scene: sweep again without "
            "--no-timing"
        )
    return f"nearest is {best.name}: {_shortfall(best, target)}"


def broken(one: Candidate, choice: Sequence[Candidate], target: float) -> str:
    """Where the same settings miss the target at a finer step; empty where they keep it.

    What was not run at a finer step says nothing.
    """
    finer = [
        c
        for c in choice
        if c.same_settings(one) and c.steps_per_turn > one.steps_per_turn and _missed(c, target)
    ]
    if not finer:
        return ""
    first = min(finer, key=lambda c: c.steps_per_turn)
    return f"not at {first.steps_told}: {few(_missed(first, target), SHOWN)}"


def _shortfall(one: Candidate, target: float) -> str:
    """On how many scenes, and what hinders the others; the nearest where it is on none."""
    if not one.reaching(target) and one.errors:
        scene = min(one.errors, key=lambda name: one.errors[name])
        return f"on no scene, {short(one.errors[scene])} on {scene} at best"
    missing = [f"{scene} {why}" for scene, why in one.faults.items() if why == NOT_RUN]
    rest = few([*_missed(one, target), *missing], SHOWN)
    return f"on {one.reaching(target)} of {one.scenes} scenes; {rest}"


def _missed(one: Candidate, target: float) -> list[str]:
    """The scenes that were run and miss the target, worst first, each with its error or fault."""
    failed = [f"{scene} {why}" for scene, why in one.faults.items() if why != NOT_RUN]
    over = sorted(((e, s) for s, e in one.errors.items() if e > target), reverse=True)
    return failed + [f"{scene} {short(error)}" for error, scene in over]


def _worst(one: Candidate) -> float:
    return max(one.errors.values(), default=math.inf)


def _time(one: Candidate) -> float:
    """Time, infinite where it is not known."""
    return one.s_per_turn if math.isfinite(one.s_per_turn) else math.inf
