"""Noise and recommendations for the terminal."""

from __future__ import annotations

import math
from collections.abc import Sequence

from rich.console import Group, RenderableType
from rich.markup import escape
from rich.text import Text

from reports.output.console import plain_table
from reports.output.numbers import short
from reports.results.cost import SHARE, noise, pairs
from reports.results.lines import called, left_out, machine
from reports.results.recommend import Recommendation
from reports.store.reader import Stored
from reports.way.clock import clock_of
from reports.way.result_kind import ResultKind
from reports.way.way import WAYS, way

WIDE = 90
"""Columns of a terminal that have room for the scene of the worst error in a column of its own."""


def recommendation_table(
    recommendations: Sequence[Recommendation], width: int = WIDE
) -> RenderableType:
    """The cheapest settings for each target and engine, with what is to be said of them below: a
    table each of what was driven, of what was let go, and of elastic links."""
    kinds = dict.fromkeys(_kind(one) for one in recommendations)
    tables: list[RenderableType] = []
    for kind in kinds:
        own = [one for one in recommendations if _kind(one) == kind]
        tables += ["", _table(own, width)]
    return Group(*tables[1:]) if tables else _table(recommendations, width)


def _kind(one: Recommendation) -> tuple[ResultKind, str]:
    return one.best.kind, clock_of(one.best.drive).name


def _table(recommendations: Sequence[Recommendation], width: int) -> RenderableType:
    """What was driven, or what was let go, with rigid links or elastic ones."""
    wide = width >= WIDE
    best = recommendations[0].best if recommendations else None
    kind = best.kind if best else way(WAYS[-1]).results
    table = plain_table(f"cheapest settings that keep every {kind.kept}")
    turn = clock_of(best.drive if best else "").name
    table.add_column(kind.head, no_wrap=True, justify="right")
    table.add_column("engine", no_wrap=True)
    table.add_column("settings", overflow="fold", min_width=10)
    for head in (f"steps\na {turn}", "us per\nstep", f"ms per\n{turn}", "worst\nerror"):
        table.add_column(head, justify="right", no_wrap=True)
    if wide:
        table.add_column("on scene", overflow="fold")
        table.add_column("steps on\nthe fit", justify="right", no_wrap=True)
    notes: list[str] = []
    for one in recommendations:
        mark = _mark(_note(one), notes)
        table.add_row(*_row(one, mark, wide))
        if one.steadier is not None:
            table.add_row(*_row(one.steadier, "", wide, steadier=True), style="dim")
    return Group(table, *(Text(f"[{i}] {note}") for i, note in enumerate(notes, 1)))


def _row(
    one: Recommendation, mark: str, wide: bool, *, steadier: bool = False
) -> Sequence[str | Text]:
    """One row, with dashes where nothing reaches the target."""
    best = one.best
    name = Text(("or " if steadier else "") + called(best.variant, best.drive))
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
    first = ["", ""] if steadier else [short_target(one.target), best.engine]
    return [*first, name, *numbers]


def short_target(target: float) -> str:
    """1e-3 for 0.001."""
    return short(target, 1) if target < 1.0 else f"{target:g}"


def _note(one: Recommendation) -> str:
    """What is to be said of a row; empty where there is nothing."""
    if one.reason:
        return one.reason
    if one.caution:
        return f"holds at this step, {one.caution}"
    return f"equal within the noise: {', '.join(one.equal_to)}" if one.equal_to else ""


def _mark(note: str, notes: list[str]) -> str:
    """The number of a note, which is added to the others where it is new."""
    if note and note not in notes:
        notes.append(note)
    return str(notes.index(note) + 1) if note else ""


def noise_line(stored: Stored) -> str:
    """How well costs are known, in a line; and whose times are left out."""
    apart = pairs(stored)
    if apart.empty:
        return "No cell was timed: no costs, and no recommendation rests on one."
    text = (
        f"Noise of costs on {machine(stored.cells)}: {SHARE:.0%} of {len(apart)} A/A pairs differ "
        f"by less than {noise(stored):.1%}, half of them by less than {apart.median():.1%}; "
        "costs that differ by less than the former are called equal."
    )
    others = left_out(stored.cells)
    return text + (f" Times of {', '.join(others)} are not compared with these." if others else "")
