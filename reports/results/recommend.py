"""The cheapest settings of each engine that reach a target error on every scene of a study."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

from reports.output.numbers import short
from reports.results.candidates import Candidate, candidates
from reports.results.cost import equal, noise, reached
from reports.results.lines import Line, lines
from reports.results.why_not import about, broken, nearest, nothing
from reports.store.reader import Stored
from sim.engine import Drive, SettingValue
from sim.registry import offering
from sim.snippets import PERIOD_S, snippet

TARGETS = (1e-2, 1e-3, 1e-4, 1e-6)
"""Errors of place [rad, or of the longest link]."""


@dataclass(frozen=True)
class Recommendation:
    """What to set for a target, or why there is nothing to set.

    The promise rests on measured cells alone: at ``steps_per_turn`` the error of place is at most
    ``target`` on every one of the ``scenes``; ``worst_error`` is the largest, on ``worst_scene``.
    Where nothing reaches the target ``variant`` is None, ``reason`` says so, and the numbers are
    those of what came ``nearest`` (a variant's name).

    ``s_per_turn`` [s], ``us_per_step`` and ``us_per_step_median`` (least and median repeat) are
    geometric means over the scenes. ``least_steps`` is where along the fits every scene meets the
    target, between measured steps; None where a fit does not tell. ``equal_to`` cost the same,
    within the noise, and have the larger error. ``caution`` says at which finer steps the promise
    does not hold, and ``steadier`` is the cheapest of which that can not be said. ``others`` has a
    sentence on each other variant of the engine.
    """

    target: float
    engine: str
    versions: tuple[str, ...]
    variant: str | None
    nearest: str
    profile: str
    drive: Drive
    settings: Mapping[str, SettingValue] = field(repr=False)
    steps_per_turn: float
    s_per_turn: float
    us_per_step: float
    us_per_step_median: float
    worst_error: float
    worst_scene: str | None
    scenes: int
    least_steps: float | None = None
    equal_to: tuple[str, ...] = ()
    caution: str = ""
    steadier: Recommendation | None = None
    others: tuple[str, ...] = ()
    reason: str = ""

    def snippet(self, period_s: float = PERIOD_S) -> str:
        """Text to copy and paste, headed by what it promises; empty where there is none."""
        if self.variant is None or self.engine not in offering("snippet"):
            return ""
        scenes = "the scene" if self.scenes == 1 else f"each of {self.scenes} scenes"
        head = (
            f"{self.engine} {', '.join(self.versions)}, {self.variant}: place within "
            f"{self.target:g} (rad, or of the longest link) on {scenes}; at worst "
            f"{short(self.worst_error)}, on {self.worst_scene}.",
            *([f"Caution: {self.caution}."] if self.caution else []),
        )
        return snippet(
            self.engine, self.settings, self.steps_per_turn, period_s, drive=self.drive, head=head
        )


def recommendations(
    stored: Stored, targets: Sequence[float] = TARGETS
) -> tuple[Recommendation, ...]:
    """One for each engine and target.

    Of all settings and measured steps whose error is at most the target on every scene of the
    store, those with the least time per turn (geometric mean over the scenes) are chosen; of
    settings that are equal within the noise, the ones with the least error. Of two steps of the
    same settings the longer costs less: that takes no clock.
    """
    every = lines(stored)
    within = noise(stored)
    known = candidates(every)
    engines = dict.fromkeys(line.engine for line in every)
    return tuple(
        _recommended(target, [c for c in known if c.engine == name], every, within)
        for name in engines
        for target in targets
    )


def _recommended(
    target: float, known: Sequence[Candidate], every: Sequence[Line], within: float
) -> Recommendation:
    """The recommendation of one engine."""
    good = [one for one in known if one.reaches(target)]
    timed = _longest_steps([one for one in good if math.isfinite(one.s_per_turn)])
    if not timed:
        best = nearest(known, target)
        found = replace(_of(best, target, every), variant=None, reason=nothing(best, good, target))
    else:
        best = _cheapest(timed, within)
        found = _of(best, target, every)
        found = replace(
            found, equal_to=_equal_to(best, timed, within), caution=broken(best, known, target)
        )
        steady = _longest_steps(
            [
                one
                for one in good
                if math.isfinite(one.s_per_turn) and not broken(one, known, target)
            ]
        )
        if found.caution and steady:
            found = replace(found, steadier=_of(_cheapest(steady, within), target, every))
    return replace(found, others=about(known, best, target))


def _longest_steps(timed: Sequence[Candidate]) -> list[Candidate]:
    """The candidate with the fewest steps of each set of settings."""
    found: dict[tuple[str, str], Candidate] = {}
    for one in sorted(timed, key=lambda one: one.steps_per_turn):
        found.setdefault((one.variant, one.drive), one)
    return list(found.values())


def _cheapest(timed: Sequence[Candidate], within: float) -> Candidate:
    """The most accurate of those that cost least, within the noise."""
    least = min(one.s_per_turn for one in timed)
    level = [one for one in timed if equal(one.s_per_turn, least, within)]
    return min(level, key=lambda one: one.worst_error)


def _equal_to(best: Candidate, timed: Sequence[Candidate], within: float) -> tuple[str, ...]:
    """What costs the same."""
    rest = (one for one in timed if one is not best)
    return tuple(one.name for one in rest if equal(one.s_per_turn, best.s_per_turn, within))


def _least_steps(one: Candidate, every: Sequence[Line], target: float) -> float | None:
    """Steps a turn from which on all scenes meet the target, along the fits."""
    found = [reached(line, target) for line in every if one.holds(line)]
    steps = [each.steps_per_turn for each in found if each is not None]
    return max(steps) if len(steps) == len(found) else None


def _of(one: Candidate, target: float, every: Sequence[Line]) -> Recommendation:
    """A candidate as a recommendation."""
    return Recommendation(
        target=target,
        engine=one.engine,
        versions=one.versions,
        variant=one.variant,
        nearest=one.variant,
        profile=one.profile,
        drive=one.drive,
        settings=one.settings,
        steps_per_turn=one.steps_per_turn,
        s_per_turn=one.s_per_turn,
        us_per_step=one.us_per_step,
        us_per_step_median=one.us_per_step_median,
        worst_error=max(one.errors.values(), default=math.nan),
        worst_scene=one.worst_scene,
        scenes=one.scenes,
        least_steps=_least_steps(one, every, target),
    )
