"""A diff as Markdown, short enough for a comment on a pull request."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence

from reports.diff.changes import Diff
from reports.diff.words import HEADS, Line, footer, headline, left_out, lines, remarks, verdict

BUDGETS = {"worse": 30_000, "better": 8_000, "new": 4_000, "missing": 4_000}
"""Bytes of each part: all of them with the heads stay below the 65,536 of a comment on GitHub."""
HEAD = 6_000
"""Bytes that the remarks may take, and the footer."""
SPECIAL = re.compile(r"([\\`*_\[\]<|~#])")
"""What a name must not do: start a table's cell, a tag, a link, a reference or emphasis."""


def markdown(diff: Diff, strict: bool = False) -> str:
    """The whole diff; what exceeds its room is counted."""
    parts = [f"## crankcheck diff: {verdict(diff, strict).lower()}", f"**{headline(diff)}**"]
    parts += ["\n".join(_fitted((f"- {_plain(text)}" for text in remarks(diff)), HEAD))]
    worse, better = lines(diff, "worse"), lines(diff, "better")
    if worse:
        parts.append(f"### worse\n\n{_table(worse, BUDGETS['worse'])}")
    if better:
        parts.append(_folded(f"{len(better)} better", _table(better, BUDGETS["better"])))
    for word, cells in (("new", diff.added), ("missing", diff.missing)):
        texts = (f"- {_plain(text)}" for text in left_out(cells))
        listed = "\n".join(_fitted(texts, BUDGETS[word]))
        if listed:
            parts.append(_folded(f"{len(cells)} {word}", listed))
    parts.append("\n".join(_fitted((f"{_plain(text)}  " for text in footer(diff)), HEAD)))
    return "\n\n".join(part for part in parts if part) + "\n"


def _table(found: Sequence[Line], room: int) -> str:
    """Rows as a table."""
    heads = [head.replace("\n", " ") for head in HEADS]
    top = [_row(heads), _row(["---"] * 4 + ["--:"] * 3)]
    return "\n".join([*top, *_fitted(map(_line, found), room, "rows")])


def _line(line: Line) -> str:
    quantity = f"{line.quantity}: {line.reason}" if line.reason else line.quantity
    cells = (line.scene, line.engine, line.steps, quantity, line.old, line.new, line.ratio)
    return _row([_plain(cell) for cell in cells])


def _row(cells: Sequence[str]) -> str:
    return f"| {' | '.join(cells)} |"


def _folded(title: str, body: str) -> str:
    """What is shown on a click; the empty lines are what makes it Markdown inside of HTML."""
    return f"<details><summary>{title}</summary>\n\n{body}\n\n</details>"


def _fitted(texts: Iterable[str], room: int, what: str = "lines") -> Iterator[str]:
    """As many of the texts as fit, then how many did not."""
    left = 0
    for text in texts:
        room -= len(text.encode()) + 1
        if room >= 0 and not left:
            yield text
        else:
            left += 1
    if left:
        yield f"\nand {left} more {what}"


def _plain(text: str) -> str:
    """A text that means itself, on one line."""
    return SPECIAL.sub(r"\\\1", " ".join(text.split()))
