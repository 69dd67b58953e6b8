"""Versions side by side on the terminal: how each did, what stands out, the scenes that changed."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import isinf

from rich.console import Console
from rich.table import Table
from rich.text import Text

from reports.history.changes import (
    SAME,
    STANDS_OUT,
    Change,
    Headline,
    changes,
    headlines,
    largest,
    steps,
    times,
)
from reports.history.measured import Found, Outcome, Quantity
from reports.history.overview import overview

COLUMNS: Mapping[str, tuple[str, ...]] = {
    "angle\nrad": ("angle",),
    "place\n/ L": ("place",),
    "gap\n/ L": ("pin gap", "slider gap"),
    "veloc.\n/ w": ("velocity",),
    "accel.\n/ w^2": ("acceleration",),
}
"""Head, and the quantities that the column shows the largest of."""
NARROW = ("angle\nrad", "gap\n/ L")
WIDE = 100
LINES = 9
"""Lines of the table of one profile: with the rest it fits a screen."""
HEADLINES = 10


def show(console: Console, outcomes: Sequence[Outcome], footer: str) -> None:
    """Print the whole history, what stands out first."""
    _versions(console, outcomes)
    _headlines(console, outcomes)
    measured = [outcome for outcome in outcomes if outcome.cells]
    for profile in dict.fromkeys(cell.profile for outcome in measured for cell in outcome.cells):
        _profile(console, profile, measured)
    console.print(Text(footer, "dim"), highlight=False)


def _versions(console: Console, outcomes: Sequence[Outcome]) -> None:
    """One row per version; one that could not be measured shows why."""
    heads, rows = overview(outcomes)
    table = _plain()
    for head in heads:
        table.add_column(head, overflow="fold", no_wrap=head == "version")
    for outcome, row in zip(outcomes, rows, strict=True):
        table.add_row(*row, style="" if outcome.cells else "red")
    console.print(table, "")


def _headlines(console: Console, outcomes: Sequence[Outcome]) -> None:
    """What stands out between the versions."""
    styles = {True: "green", False: "bold red", None: ""}
    lines: list[Headline] = []
    for before, after in steps(outcomes):
        lines += headlines(before, after)
    lines.sort(key=lambda line: line.good is not False)  # what became worse goes first
    for line in lines[:HEADLINES]:
        grid = Table.grid(padding=0)
        grid.add_column(no_wrap=True)
        grid.add_column(overflow="fold")
        grid.add_row("* ", Text(line.text, styles[line.good]))
        console.print(grid)
    if len(lines) > HEADLINES:
        console.print(
            f"  and {len(lines) - HEADLINES} more: -o DIR writes all of them", style="dim"
        )
    if lines:
        console.print()


def _profile(console: Console, profile: str, measured: Sequence[Outcome]) -> None:
    """The scenes of one profile that changed most, a row for each version."""
    cells = {
        (outcome.version, cell.scene): cell
        for outcome in measured
        for cell in outcome.cells
        if cell.profile == profile
    }
    changed = [
        change
        for before, after in steps(measured)
        for change in changes(before, after)
        if change.profile == profile
    ]
    ranked = ranking(list(dict.fromkeys(scene for _, scene in cells)), changed)
    shown = ranked[: max(1, LINES // max(1, len(measured)))]
    heads = tuple(COLUMNS) if console.width >= WIDE else NARROW
    table = _plain()
    console.print(Text(f"profile {profile}: {_part(shown, ranked, changed)}", "bold"))
    table.add_column("scene", overflow="fold", min_width=16)
    table.add_column("version", no_wrap=True)
    for head in heads:
        table.add_column(head, justify="right", no_wrap=True)
    table.add_column("against the\nversion before", overflow="fold", min_width=14)
    for scene in shown:
        for number, outcome in enumerate(measured):
            here = [c for c in changed if (c.scene, c.after) == (scene, outcome.version)]
            cell = cells.get((outcome.version, scene))
            name = Text("" if number else scene)
            table.add_row(name, outcome.version, *_row(cell, here, heads, bool(number)))
    console.print(table, "")


def ranking(scenes: Sequence[str], changed: Sequence[Change]) -> list[str]:
    """The scenes: those that became worse first, then by the largest factor of any error; the
    largest errors first where nothing changed."""

    def rank(scene: str) -> tuple[float, float, float]:
        here = [c for c in changed if c.scene == scene and not c.quantity.rate]
        worse = max((c.factor for c in changed if c.scene == scene and c.ratio < 1.0), default=1.0)
        most = max((c.factor for c in here), default=1.0)
        error = max((c.now for c in here), default=0.0)
        return -worse if worse >= STANDS_OUT else 0.0, -most if most > SAME else 0.0, -error

    return sorted(scenes, key=rank)


def _part(shown: Sequence[str], ranked: Sequence[str], changed: Sequence[Change]) -> str:
    """Which of the scenes a table shows."""
    if len(shown) == len(ranked):
        return "largest errors"
    by = "changed most" if any(c.factor > SAME for c in changed) else "have the largest errors"
    return f"the {len(shown)} of {len(ranked)} scenes that {by} (-o DIR writes all)"


def _row(
    cell: Found | None, changed: Sequence[Change], heads: Sequence[str], later: bool
) -> list[Text]:
    """The numbers of a version, those that changed coloured, and the largest change in words."""
    if cell is None:
        return [Text("-")] * len(heads) + [Text("")]
    numbers = []
    for head in heads:
        known = [cell.errors[name] for name in COLUMNS[head] if name in cell.errors]
        top = largest(change for change in changed if change.quantity.name in COLUMNS[head])
        numbers.append(Text(f"{max(known):.1e}" if known else "-", _style(top)))
    if cell.status != "ok":
        return [*numbers, Text(cell.status, "red")]
    return [*numbers, compared(changed) if later else Text("")]


def compared(changed: Sequence[Change]) -> Text:
    """The largest change of a cell in two or three words."""
    top = largest(change for change in changed if not change.quantity.rate)
    top = top if top and top.factor > SAME else largest(changed)
    if top is None:
        return Text("")
    if top.factor <= SAME:
        return Text("same", "dim")
    factor = "" if isinf(top.factor) else f"{times(top.factor)} x "
    return Text(f"{factor}{top.word} ({_short(top.quantity)})", _style(top))


def _short(quantity: Quantity) -> str:
    return quantity.name.removeprefix("pin ").removeprefix("slider ")


def _style(change: Change | None) -> str:
    """Green and red for what stands out."""
    if change is None or change.factor < STANDS_OUT:
        return ""
    return "green" if change.ratio > 1.0 else "bold red"


def _plain() -> Table:
    """A table without lines."""
    return Table(box=None, padding=(0, 1, 0, 0), collapse_padding=True)
