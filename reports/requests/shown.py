"""Base of all results: the text that the command prints, and a picture of it for notebooks.

The HTML needs no scripts or style sheets, and has the colours of the notebook, light or dark.
"""

from __future__ import annotations

import io
import itertools
from collections.abc import Callable, Iterable
from html import escape
from typing import Any

from rich.console import Console, Group
from rich.markup import render
from rich.style import Style
from rich.table import Table
from rich.text import Text

from reports.output.console import TABLE_WIDTH


class Shown:
    """A result that is printed as its table, and that a notebook shows with its mechanism.

    A result equals itself alone: its series are not compared.
    """

    def show(self, console: Console) -> None:
        """Print the result as the command does."""
        raise NotImplementedError

    def _drawn(self) -> str:
        """The mechanism as SVG; "" where there is none to draw."""
        return ""

    def __str__(self) -> str:
        return as_text(self.show)

    def __repr__(self) -> str:
        return str(self)

    def _repr_html_(self) -> str:
        return as_html(self._drawn(), self.show)

    __eq__ = object.__eq__
    __hash__ = object.__hash__


Print = Callable[[Console], None]
WIDE = 200
"""Columns of a page: room for every column of a table."""
COLOURS = {"red": "#d9596b", "yellow": "#b97f1f", "green": "#459150", "cyan": "#15889a"}
"""Colours of a terminal, readable on white and on black."""
CELL = "padding:1px 12px 1px 0;vertical-align:top;border:none;background:none"
HEAD = "font-weight:600;vertical-align:bottom"
TABLE = (
    "border-collapse:collapse;border:none;font-size:13px;line-height:1.4;color:inherit;"
    "font-variant-numeric:tabular-nums"
)


def as_text(show: Print) -> str:
    """The printed text as outside a terminal, without spaces at the ends of lines.

    Without ``force_jupyter`` rich would show it in the notebook around, and write nothing.
    """
    console = Console(file=io.StringIO(), width=TABLE_WIDTH, color_system=None, force_jupyter=False)
    show(console)
    assert isinstance(console.file, io.StringIO)
    return "\n".join(line.rstrip() for line in console.file.getvalue().rstrip().split("\n"))


def as_html(drawn: str, show: Print) -> str:
    """A drawing, and below it the printed parts, each table as a table."""
    collector = Collector()
    show(collector)
    parts = "".join(collector.parts)
    return (
        '<div class="crankcheck" style="font-family:sans-serif;font-size:13px;line-height:1.4;'
        f'text-align:left">{drawn}{parts}</div>'
    )


class Collector(Console):
    """A console that keeps printed objects as HTML."""

    def __init__(self) -> None:
        super().__init__(file=io.StringIO(), width=WIDE, force_jupyter=False)
        self.parts: list[str] = []

    def print(self, *objects: Any, **options: Any) -> None:
        """Keep the objects; nothing is written."""
        style = options.get("style") or ""
        for each in objects:
            self.parts += _html(each, style, plain=options.get("markup") is False)


def _html(printed: object, style: Style | str, *, plain: bool) -> Iterable[str]:
    if isinstance(printed, Group):
        for each in printed.renderables:
            yield from _html(each, style, plain=plain)
    elif isinstance(printed, Table):
        yield _table(printed)
    else:
        text = printed if isinstance(printed, Text) else _text(str(printed), plain=plain)
        if text.plain.strip():
            css = f"margin:4px 0;white-space:pre-wrap;{_css(style)}"
            yield f'<div style="{css}">{_spans(text)}</div>'


def _text(text: str, *, plain: bool) -> Text:
    return Text(text) if plain else render(text)


def _table(table: Table) -> str:
    """A table with its title and heads, if it has any; a grid has none."""
    looks = [
        f"{CELL};text-align:{column.justify}{';white-space:nowrap' * column.no_wrap}"
        for column in table.columns
    ]
    body = "".join(
        _row("td", looks, row)
        for row in zip(*(column.cells for column in table.columns), strict=True)
    )
    heads = [column.header for column in table.columns]
    has_heads = table.show_header and any(map(str, heads))
    head = f"<thead>{_row('th', [f'{look};{HEAD}' for look in looks], heads)}</thead>" * has_heads
    title = (
        f'<div style="font-weight:600;margin-top:10px">{_cell(table.title)}</div>'
        if table.title
        else ""
    )
    margin = "margin:4px 0 12px" if has_heads else "margin:0"
    return f'{title}<table style="{TABLE};{margin}">{head}<tbody>{body}</tbody></table>'


def _row(tag: str, looks: Iterable[str], cells: Iterable[object]) -> str:
    inside = "".join(
        f'<{tag} style="{look}">{_cell(cell)}</{tag}>'
        for look, cell in zip(looks, cells, strict=True)
    )
    return f"<tr>{inside}</tr>"


def _cell(cell: object) -> str:
    """A cell, lines of it one below the other."""
    text = cell if isinstance(cell, Text) else render(str(cell))
    return _spans(text).replace("\n", "<br>")


def _spans(text: Text) -> str:
    css = _css(text.style)
    found = f'<span style="{css}">' if css else "<span>"
    ends = {0, len(text.plain), *(at for span in text.spans for at in (span.start, span.end))}
    places = sorted(ends)
    for start, end in itertools.pairwise(places):
        styles = [_css(span.style) for span in text.spans if span.start <= start < span.end]
        piece = escape(text.plain[start:end])
        css = "".join(styles)
        found += f'<span style="{css}">{piece}</span>' if css else piece
    return f"{found}</span>"


def _css(style: Style | str) -> str:
    """A style of a terminal in CSS; unknown colours are left out."""
    parsed = Style.parse(style) if isinstance(style, str) else style
    colour = COLOURS.get(parsed.color.name, "") if parsed.color else ""
    return (
        f"color:{colour};" * bool(colour)
        + "font-weight:600;" * bool(parsed.bold)
        + "opacity:0.65;" * bool(parsed.dim)
    )
