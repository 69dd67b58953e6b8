"""The cheapest settings of each engine that reach a target error on every scene of a study."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from reports.output.numbers import short
from reports.results.candidates import Candidate, candidates
from reports.results.cost import equal, noise, reached
from reports.results.lines import Line, lines
from reports.results.why_not import broken, nearest, nothing
from reports.store.reader import Stored
from reports.way.clock import clock_of
from reports.way.way import WAYS
from sim.offers import PERIOD_S, snippet
from sim.registry import offering


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
