"""Markdown that fits into a comment: names that mean themselves, parts that keep to their room."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Sequence
from html import escape

SPECIAL = re.compile(r"([\\`*_\[\]<>|~#&$])")
"""What would start a cell, tag, link, reference, entity, formula or emphasis."""
JOINER = "\N{WORD JOINER}"
LONGEST = 600
"""Characters of a cell: a reason may hold the whole output of an engine."""


def plain(text: object) -> str:
    """A text that means itself, on one line; it notifies nobody either."""
    words = " ".join(str(text).split())
    words = words if len(words) <= LONGEST else words[: LONGEST - 1] + "…"
    return SPECIAL.sub(r"\\\1", words).replace("@", f"@{JOINER}")


def table(
    heads: Sequence[str],
    rows: Iterable[Sequence[object]],
    room: float = math.inf,
    what: str = "",
) -> str:
    """A table whose cells mean themselves, in ``room`` bytes; what has none is counted below it.

    A head that ends in a colon is over numbers, and stands on the right. ``what`` the rows are
    called where they are counted.
    """
    rules = ["--:" if head.endswith(":") else "---" for head in heads]
    lines = [_row(head.removesuffix(":") for head in heads), _row(rules)]
    body = (_row(plain(cell) for cell in row) for row in rows)
    return "\n".join([*lines, *counted(body, room - 200, what)])


def counted(texts: Iterable[str], room: float, what: str = "") -> list[str]:
    """The first of the texts that have ``room`` bytes together, then how many others there are."""
    kept, left = fitted(texts, room)
    return [*kept, f"\nand {left} more {what}".rstrip()] if left else kept


def fitted(texts: Iterable[str], room: float) -> tuple[list[str], int]:
    """The first of the texts that have ``room`` bytes together, and the number of the others."""
    kept: list[str] = []
    left = 0
    for text in texts:
        room -= len(text.encode()) + 1
        if room >= 0 and not left:
            kept.append(text)
        else:
            left += 1
    return kept, left


def folded(title: str, body: str) -> str:
    """What is shown on a click; the empty lines make it Markdown inside of HTML."""
    return f"<details><summary>{_inside_html(title)}</summary>\n\n{body}\n\n</details>"


def code(text: str, language: str) -> str:
    """A block of code; its fence is longer than any in it."""
    runs = [len(run) for run in re.findall("`+", text)]
    fence = "`" * max(3, 1 + max(runs, default=0))
    return f"{fence}{language}\n{text.rstrip()}\n{fence}"


def _row(cells: Iterable[str]) -> str:
    return f"| {' | '.join(cells)} |"


def _inside_html(text: str) -> str:
    """A text on one line of HTML."""
    return escape(" ".join(text.split()), quote=False).replace("@", f"@{JOINER}")
