"""A diff on the terminal, and as Markdown short enough for a comment on a pull request."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Literal

from rich.console import Console
from rich.text import Text

from reports.diff.words import (
    HEADS,
    PrintedRow,
    footer,
    headline,
    left_out,
    lines,
    remarks,
    verdict,
)
from reports.output.console import hanging, plain_table, say
from reports.output.markdown import counted, folded, plain, table
from reports.results.changes.changes import Diff
from reports.results.changes.runs import StoredCell

MOST = {"worse": 200, "better": 10}
"""Rows of a table; all that is worse is named, unless that is more than anyone reads."""
LEFT_OUT = 8
NARROW = 76
"""Columns below which old and new give way to their ratio."""
STYLES = {"worse": "bold red", "better": "green"}


def show(console: Console, diff: Diff, strict: bool = False) -> None:
    """Print the whole diff."""
    style = STYLES["worse"] if diff.code(strict) else "bold green"
    console.print(Text(f"{verdict(diff, strict)}: {headline(diff)}", style))
    for remark in remarks(diff):
        hanging(console, "  ", remark)
    console.print()
    _grid(console, "worse", lines(diff, "worse"))
    _grid(console, "better", lines(diff, "better"))
    _left_out(console, "new", diff.added)
    _left_out(console, "missing", diff.missing)
    console.print(Text("\n".join(footer(diff)), "dim"), highlight=False)


def _grid(console: Console, word: str, rows: Sequence[PrintedRow]) -> None:
    """The rows of what is worse, or better, and the reasons of engines that gave up."""
    if not rows:
        return
    wide = console.width >= NARROW
    shown = rows[: MOST[word]]
    table = plain_table(word, STYLES[word])
    for head in HEADS:
        number = head in ("old", "new", "ratio")
        if wide or not number or head == "ratio":
            side: Literal["left", "right"] = "right" if number else "left"
            table.add_column(head, overflow="fold", justify=side, no_wrap=number)
    for line in shown:
        middle = (line.old, line.new) if wide else ()
        table.add_row(
            *map(Text, (line.scene, line.engine, line.steps, line.quantity, *middle, line.ratio))
        )
    console.print(table)
    if len(rows) > len(shown):
        more = f"and {len(rows) - len(shown)} more rows; --junit FILE names every cell"
        say(console, more, "dim")
    for text in dict.fromkeys(f"{line.engine}: {line.reason}" for line in shown if line.reason):
        hanging(console, "  ", text)
    console.print()


def _left_out(console: Console, word: str, cells: Sequence[StoredCell]) -> None:
    """The cells of one run only."""
    texts = left_out(cells)
    if not texts:
        return
    console.print(Text(word, "bold"))
    for text in texts[:LEFT_OUT]:
        hanging(console, "  ", text)
    if len(texts) > LEFT_OUT:
        console.print(f"  and {len(texts) - LEFT_OUT} more lines like these", style="dim")
    console.print()


BUDGETS = {"worse": 30_000, "better": 8_000, "new": 4_000, "missing": 4_000}
"""Bytes of each part: all of them with the heads stay below the 65,536 of a comment on GitHub."""
NUMBERS = 3
"""Columns of numbers, which are the last."""
HEAD = 6_000
"""Bytes that the remarks may take, and the footer."""


def markdown(diff: Diff, strict: bool = False) -> str:
    """The whole diff; what exceeds its room is counted."""
    parts = [f"## crankcheck diff: {verdict(diff, strict).lower()}", f"**{headline(diff)}**"]
    parts.append(_fitted((f"- {plain(text)}" for text in remarks(diff)), HEAD))
    worse, better = lines(diff, "worse"), lines(diff, "better")
    if worse:
        parts.append(f"### worse\n\n{_rows(worse, BUDGETS['worse'])}")
    if better:
        parts.append(folded(f"{len(better)} better", _rows(better, BUDGETS["better"])))
    for word, cells in (("new", diff.added), ("missing", diff.missing)):
        texts = (f"- {plain(text)}" for text in left_out(cells))
        if listed := _fitted(texts, BUDGETS[word]):
            parts.append(folded(f"{len(cells)} {word}", listed))
    parts.append(_fitted((f"{plain(text)}  " for text in footer(diff)), HEAD))
    return "\n\n".join(part for part in parts if part) + "\n"


def _rows(rows: Sequence[PrintedRow], room: int) -> str:
    """Rows as a table; what is compared are numbers."""
    heads = [head.replace("\n", " ") for head in HEADS]
    heads[-NUMBERS:] = [f"{head}:" for head in heads[-NUMBERS:]]
    return table(heads, map(_cells, rows), room, "rows")


def _cells(line: PrintedRow) -> tuple[str, ...]:
    quantity = f"{line.quantity}: {line.reason}" if line.reason else line.quantity
    return line.scene, line.engine, line.steps, quantity, line.old, line.new, line.ratio


def _fitted(texts: Iterable[str], room: int) -> str:
    """As many lines as there is room for, then how many there was none for."""
    return "\n".join(counted(texts, room, "lines"))
