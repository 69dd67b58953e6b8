"""The cheapest settings of each engine that reach a target error on every scene of a study."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from reports.choice.across import Candidate, candidates
from reports.choice.cost import equal, noise, reached
from reports.choice.lines import Line, lines
from reports.store.reader import Stored
from sim.engine import Drive, SettingValue

TARGETS = (1e-2, 1e-3, 1e-4, 1e-6)
"""Errors of place [rad, or of the longest link]."""


@dataclass(frozen=True)
class Recommendation:
    """What to set for a target, or why there is nothing to set.

    The promise rests on measured cells alone: at ``steps_per_turn`` the error of place is at most
    ``target`` on every scene; ``worst_error`` is the largest, on ``worst_scene``. Where nothing
    reaches the target ``variant`` is None, ``reason`` says so, and the numbers are those of what
    came nearest.

    ``s_per_turn`` and ``us_per_step`` are geometric means over the scenes. ``least_steps`` is where
    along the fits the target is met on every scene, between measured steps; None where that is not
    known. ``equal_to`` costs the same, within the noise. ``caution`` says at which finer steps the
    promise does not hold, and ``steadier`` what to take in its place. ``others`` has a sentence on
    each other variant of the engine.
    """

    target: float
    engine: str
    versions: tuple[str, ...]
    variant: str | None
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
    steadier: str = ""
    others: tuple[str, ...] = ()
    reason: str = ""


def recommendations(
    stored: Stored, targets: Sequence[float] = TARGETS
) -> tuple[Recommendation, ...]:
    """One for each engine and target.

    Of all settings and measured steps whose error is at most the target on every scene of the
    store, those with the least time per turn (geometric mean over the scenes) are chosen; of those
    that are equal within the noise, the ones with the least error.
    """
    every = lines(stored)
    within = noise(stored)
    known = candidates(every)
    engines = dict.fromkeys(line.engine for line in every)
    return tuple(
        _recommend(target, [c for c in known if c.engine == name], every, within)
        for name in engines
        for target in targets
    )


def _recommend(
    target: float, known: Sequence[Candidate], every: Sequence[Line], within: float
) -> Recommendation:
    """The recommendation of one engine."""
    good = [one for one in known if one.reaches(target)]
    timed = [one for one in good if math.isfinite(one.s_per_turn)]
    if not timed:
        nearest = max(known, key=lambda one: (one.reaching(target), -one.worst_error))
        return _of(nearest, target, None, reason=_nothing(target, good, nearest))
    best = _cheapest(timed, within)
    same = [
        one.name
        for one in timed
        if one is not best and equal(one.s_per_turn, best.s_per_turn, within)
    ]
    return _of(
        best, target, best.variant, least_steps=_least_steps(best, every, target), same=tuple(same)
    )


def _cheapest(timed: Sequence[Candidate], within: float) -> Candidate:
    """The most accurate of those that cost least, within the noise."""
    least = min(one.s_per_turn for one in timed)
    level = [one for one in timed if equal(one.s_per_turn, least, within)]
    return min(level, key=lambda one: one.worst_error)


def _nothing(target: float, good: Sequence[Candidate], nearest: Candidate) -> str:
    """Why nothing is recommended."""
    if good:
        names = ", ".join(dict.fromkeys(one.variant for one in good))
        return f"{names} reach it, and were not timed on every scene; sweep without --no-timing"
    text = f"nearest: {nearest.name}, {nearest.reaching(target)} of {nearest.scenes} scenes"
    faults = [f"{scene} {why}" for scene, why in nearest.faults.items()]
    if nearest.worst_scene is not None:
        worst = nearest.errors[nearest.worst_scene]
        faults.append(f"{worst:.1e} on {nearest.worst_scene}")
    return f"{text}; {', '.join(faults)}"


def _least_steps(best: Candidate, every: Sequence[Line], target: float) -> float | None:
    """Steps a turn from which on all scenes meet the target, along the fits."""
    own = [x for x in every if (x.engine, x.variant) == (best.engine, best.variant)]
    found = [reached(line, target) for line in own]
    steps = [one.steps_per_turn for one in found if one is not None]
    return max(steps) if len(steps) == len(found) else None


def _of(
    one: Candidate,
    target: float,
    variant: str | None,
    *,
    least_steps: float | None = None,
    same: tuple[str, ...] = (),
    reason: str = "",
) -> Recommendation:
    """A recommendation with the numbers of a candidate."""
    worst = one.worst_scene
    return Recommendation(
        target=target,
        engine=one.engine,
        versions=one.versions,
        variant=variant,
        profile=one.profile,
        drive=one.drive,
        settings=one.settings,
        steps_per_turn=one.steps_per_turn,
        s_per_turn=one.s_per_turn,
        us_per_step=one.us_per_step,
        us_per_step_median=one.us_per_step_median,
        worst_error=math.nan if worst is None else one.errors[worst],
        worst_scene=worst,
        scenes=one.scenes,
        least_steps=least_steps,
        equal_to=same,
        reason=reason,
    )
