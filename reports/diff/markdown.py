"""A diff as Markdown, short enough for a comment on a pull request."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

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
from reports.output.markdown import counted, folded, plain, table
from reports.results.changes.changes import Diff

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
        parts.append(f"### worse\n\n{_table(worse, BUDGETS['worse'])}")
    if better:
        parts.append(folded(f"{len(better)} better", _table(better, BUDGETS["better"])))
    for word, cells in (("new", diff.added), ("missing", diff.missing)):
        texts = (f"- {plain(text)}" for text in left_out(cells))
        if listed := _fitted(texts, BUDGETS[word]):
            parts.append(folded(f"{len(cells)} {word}", listed))
    parts.append(_fitted((f"{plain(text)}  " for text in footer(diff)), HEAD))
    return "\n\n".join(part for part in parts if part) + "\n"


def _table(rows: Sequence[PrintedRow], room: int) -> str:
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
