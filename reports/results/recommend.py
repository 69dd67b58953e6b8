"""The cheapest settings of each engine that reach a target error on every scene of a study; on the
terminal too, with the noise.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from rich.console import Group, RenderableType
from rich.markup import escape
from rich.text import Text

from models.errors import few
from reports.output.console import grid
from reports.output.numbers import short
from reports.output.palette import engine_styles
from reports.protocol.length import clock_of
from reports.protocol.way import WAYS, ResultKind, way
from reports.results.candidates import (
    NOT_RUN,
    SHARE,
    Candidate,
    candidates,
    equal,
    noise,
    pairs,
    reached,
)
from reports.results.lines import Line, called, left_out, lines, machine
from reports.store.reader import Stored
from sim.registry import offering
from sim.registry.offers import PERIOD_S, snippet


@dataclass(frozen=True)
class Recommendation:
    """Settings for a target, or the reason why there are none.

    The promise uses measured cells alone: the error of place of ``best`` is at most ``target`` on
    every scene. ``reason`` says that nothing reaches the target, and ``best`` comes nearest then.

    ``least_steps`` is where along the fits every scene meets the target, between measured steps;
    None where a fit does not show it. ``equal_to`` cost the same, within the noise, and have the
    larger error. ``caution`` says at which finer steps the promise does not hold, and ``steadier``
    is the cheapest without such a caution.
    """

    target: float
    best: Candidate
    least_steps: float | None = None
    equal_to: tuple[str, ...] = ()
    caution: str = ""
    steadier: Recommendation | None = None
    reason: str = ""

    def snippet(self, period_s: float = PERIOD_S) -> str:
        """Return text to copy and paste, headed by its promise; empty where there is none.
        ``period_s`` is not used for a free motion, with its steps per second."""
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
    """Return one for each engine and target, of driven scenes, of free motion, and of both with
    elastic links, which have targets of their own.

    The settings and measured step with the least time per turn (geometric mean over the scenes) are
    chosen, of all with an error of at most the target on every scene of the store; the least error
    decides among settings that are equal within the noise. The longer of two steps of the same
    settings costs less: that takes no clock.
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
    """Return the most accurate of the cheapest, within the noise; and the names of equal cost.

    Only the fewest steps of each set of settings take part.
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
    """Return the steps a turn from which on all scenes meet the target, along the fits."""
    meets = [reached(line, target) for line in every if one.holds(line)]
    steps = [each.steps_per_turn for each in meets if each is not None]
    return max(steps) if len(steps) == len(meets) else None


SHOWN = 3
"""Scenes that a sentence names; beyond, it gives their number."""


def nearest(choice: Sequence[Candidate], target: float) -> Candidate:
    """Return the candidate with the target reached on most scenes, and of these the least error."""
    return max(choice, key=lambda c: (c.reaching(target), -c.worst_error, -_worst(c), -_time(c)))


def nothing(best: Candidate, good: Sequence[Candidate], target: float) -> str:
    """Say why nothing is recommended, where ``best`` comes nearest; ``good`` lack their times."""
    if good:
        names = ", ".join(dict.fromkeys(called(one.variant, one.drive) for one in good))
        return (
            f"{names} would do, but costs of some scenes are unknown: sweep again without "
            "--no-timing"
        )
    return f"nearest is {best.name}: {_shortfall(best, target)}"


def broken(one: Candidate, choice: Sequence[Candidate], target: float) -> str:
    """Say where the same settings miss the target at a finer step; empty where they keep it.

    Settings that were not run at a finer step say nothing.
    """
    finer = [
        c
        for c in choice
        if c.holds(one) and c.steps_per_turn > one.steps_per_turn and _missed(c, target)
    ]
    if not finer:
        return ""
    first = min(finer, key=lambda c: c.steps_per_turn)
    return f"not at {first.steps_told}: {few(_missed(first, target), SHOWN)}"


def _shortfall(one: Candidate, target: float) -> str:
    """Say on how many scenes, and the faults of the others; the nearest where on none."""
    if not one.reaching(target) and one.errors:
        scene = min(one.errors, key=lambda name: one.errors[name])
        return f"on no scene, {short(one.errors[scene])} on {scene} at best"
    missing = [f"{scene} {why}" for scene, why in one.faults.items() if why == NOT_RUN]
    rest = few([*_missed(one, target), *missing], SHOWN)
    return f"on {one.reaching(target)} of {one.scenes} scenes; {rest}"


def _missed(one: Candidate, target: float) -> list[str]:
    """Return the scenes that miss the target, worst first, each with error or fault."""
    failed = [f"{scene} {why}" for scene, why in one.faults.items() if why != NOT_RUN]
    over = sorted(((e, s) for s, e in one.errors.items() if e > target), reverse=True)
    return failed + [f"{scene} {short(error)}" for error, scene in over]


def _worst(one: Candidate) -> float:
    return max(one.errors.values(), default=math.inf)


def _time(one: Candidate) -> float:
    """Return the time, infinite where it is not known."""
    return one.s_per_turn if math.isfinite(one.s_per_turn) else math.inf


WIDE = 90
"""Columns of a terminal with room for a column of the scene of the worst error."""
WIDE_HEADS = ("on scene", "steps on\nthe fit:")


def recommendation_table(
    recommendations: Sequence[Recommendation], width: int = WIDE
) -> RenderableType:
    """Return the cheapest settings for each target and engine, with their notes below: a table each
    of driven scenes, of free motion, and of elastic links."""
    kinds = dict.fromkeys(_kind(one) for one in recommendations)
    styles = engine_styles(one.best.engine for one in recommendations)
    tables: list[RenderableType] = []
    for kind in kinds:
        own = [one for one in recommendations if _kind(one) == kind]
        tables += ["", _table(own, width, styles)]
    return Group(*tables[1:]) if tables else _table(recommendations, width, styles)


def _kind(one: Recommendation) -> tuple[ResultKind, str]:
    return one.best.kind, clock_of(one.best.drive).name


def _table(
    recommendations: Sequence[Recommendation], width: int, styles: Mapping[str, str]
) -> RenderableType:
    """Return the table of one kind: driven or free, with rigid links or elastic ones."""
    wide = width >= WIDE
    best = recommendations[0].best if recommendations else None
    kind = best.kind if best else way(WAYS[-1]).results
    turn = clock_of(best.drive if best else "").name
    numbers = (f"steps\na {turn}:", "us per\nstep:", f"ms per\n{turn}:", "worst\nerror:")
    table = grid(
        (f"{kind.head}:", "engine", "settings", *numbers, *WIDE_HEADS[: 2 * wide]),
        title=f"cheapest settings that keep every {kind.kept}",
        gap=1,
        whole=("engine",),
        least={"settings": 10},
    )
    notes: list[str] = []
    for one in recommendations:
        mark = _mark(_note(one), notes)
        table.add_row(*_row(one, mark, wide, styles))
        if one.steadier is not None:
            table.add_row(*_row(one.steadier, "", wide), style="dim")
    return Group(table, *(Text(f"[{i}] {note}") for i, note in enumerate(notes, 1)))


def _row(
    one: Recommendation, mark: str, wide: bool, styles: Mapping[str, str] | None = None
) -> Sequence[str | Text]:
    """Return a row; of steadier settings, below another row of the engine, without ``styles``."""
    best = one.best
    name = Text(("" if styles else "or ") + called(best.variant, best.drive))
    numbers = [
        f"{best.steps_per_turn:g}",
        f"{best.us_per_step:.2f}",
        f"{1e3 * best.s_per_turn:.3f}",
        short(best.worst_error),
    ]
    if wide:
        least = "-" if one.least_steps is None else f"{math.ceil(one.least_steps - 1e-6)}"
        numbers += [escape(str(best.worst_scene)), least]
    if one.reason:
        name, numbers = Text("none", "red"), ["-"] * len(numbers)
    if mark:
        name.append(f" [{mark}]", "yellow")
    engine = Text(best.engine, styles[best.engine]) if styles else ""
    first = [short_target(one.target) if styles else "", engine]
    return [*first, name, *numbers]


def short_target(target: float) -> str:
    """Return 1e-3 for 0.001."""
    return short(target, 1) if target < 1.0 else f"{target:g}"


def _note(one: Recommendation) -> str:
    if one.reason:
        return one.reason
    if one.caution:
        return f"holds at this step, {one.caution}"
    return f"equal within the noise: {', '.join(one.equal_to)}" if one.equal_to else ""


def _mark(note: str, notes: list[str]) -> str:
    """Return the number of a note, which is added to the others where it is new."""
    if note and note not in notes:
        notes.append(note)
    return str(notes.index(note) + 1) if note else ""


def noise_line(stored: Stored) -> str:
    """Return the noise of costs in a line; and whose times are left out."""
    apart = pairs(stored)
    if apart.empty:
        return "No cell was timed: costs are unknown, and no recommendation uses them."
    text = (
        f"Noise of costs on {machine(stored.cells)}: {SHARE:.0%} of {len(apart)} A/A pairs differ "
        f"by less than {noise(stored):.1%}, half of them by less than {apart.median():.1%}; "
        "costs that differ by less than the former are called equal."
    )
    others = left_out(stored.cells)
    return text + (f" Times of {', '.join(others)} are not compared with these." if others else "")
