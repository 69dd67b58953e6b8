"""Base of all results: the text that the command prints, as a terminal, a notebook, a page and
Markdown show it.

The HTML needs no scripts or style sheets, and has the colours of the notebook, light or dark.
"""

from __future__ import annotations

import io
import itertools
import os
from collections.abc import Callable, Iterable, Mapping, Sequence
from html import escape
from pathlib import Path
from typing import Any

from markupsafe import Markup
from rich.console import Console, Group
from rich.markup import render
from rich.style import Style
from rich.table import Table
from rich.text import Text

from reports.output.console import TABLE_WIDTH, tell
from reports.output.formats import counted, plain, table


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
Convert = Callable[[Text | Table, Style | str], str]
COMMENT = 60_000
"""Bytes of Markdown; a comment on GitHub takes 65,536."""
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


def present(console: Console, format: str, page: Callable[[], str], *shows: Print) -> None:
    """Print an answer, or the ``page`` of it in Markdown (``format`` md); append that to the
    summary of the job where GitHub names a file for it."""
    summary = os.environ.get("GITHUB_STEP_SUMMARY")
    text = page() if summary or format == "md" else ""
    if format == "md":
        console.print(text, end="", markup=False, highlight=False, soft_wrap=True)
    for show in shows if format != "md" else ():
        show(console)
    if not summary:
        return
    try:
        with Path(summary).open("a", encoding="utf-8") as file:
            file.write(text)
    except OSError as error:
        tell([f"GITHUB_STEP_SUMMARY {summary}: {error.strerror}; nothing is added to it"])


def as_markdown(title: str, *shows: Print) -> str:
    """The printed parts below a title, in `COMMENT` bytes; further parts are counted."""
    collector = Collector(_markdown)
    for show in shows:
        show(collector)
    parts = counted(filter(None, collector.parts), COMMENT, "parts")
    return "\n\n".join([f"## crankcheck {title}", *parts]) + "\n"


def as_page(title: str, facts: Mapping[str, str], drawn: str, *shows: Print) -> str:
    """A page of the drawings and the printed parts."""
    from reports.page.build import Head, assembled  # which nothing else here needs
    from reports.page.sections.section import Section

    command, _, verdict = title.partition(": ")
    head = Head(f"crankcheck {command}", [verdict], facts["made"], "verdict")
    words = {"shown": Markup(as_html(drawn, *shows))}
    return assembled(head, [Section("verdict", "Verdict", "shown.html", words)])


def as_html(drawn: str, *shows: Print) -> str:
    """A drawing, and below it the printed parts, each table as a table."""
    collector = Collector(_html)
    for show in shows:
        show(collector)
    parts = "".join(collector.parts)
    return (
        '<div class="crankcheck" style="font-family:sans-serif;font-size:13px;line-height:1.4;'
        f'text-align:left">{drawn}{parts}</div>'
    )


class Collector(Console):
    """A console that keeps printed objects as HTML or Markdown."""

    def __init__(self, convert: Convert) -> None:
        super().__init__(file=io.StringIO(), width=WIDE, force_jupyter=False)
        self.parts: list[str] = []
        self.convert = convert

    def print(self, *objects: Any, **options: Any) -> None:
        """Keep the objects; nothing is written."""
        style, plain = options.get("style") or "", options.get("markup") is False
        for printed in objects:
            for each in printed.renderables if isinstance(printed, Group) else [printed]:
                text = each if isinstance(each, Text | Table) else _text(str(each), plain=plain)
                self.parts.append(self.convert(text, style))


def _html(printed: Text | Table, style: Style | str) -> str:
    if isinstance(printed, Table):
        return _table(printed)
    css = f"margin:4px 0;white-space:pre-wrap;{_css(style)}"
    return f'<div style="{css}">{_spans(printed)}</div>' * bool(printed.plain.strip())


def _markdown(printed: Text | Table, style: Style | str) -> str:
    if isinstance(printed, Text):
        return "  \n".join(plain(line) for line in printed.plain.splitlines())
    rows = [[_flat(cell) for cell in row] for row in _rows(printed)]
    heads = [_flat(each.header) + ":" * (each.justify == "right") for each in printed.columns]
    if not printed.show_header or not any(heads):
        return "\n".join(f"- {plain(' '.join(row))}" for row in rows)
    title = f"**{plain(_flat(printed.title))}**\n\n" * bool(printed.title)
    return title + table(heads, rows, COMMENT // 3, "rows")


def _rows(table: Table) -> Iterable[Sequence[object]]:
    return zip(*(column.cells for column in table.columns), strict=True)


def _flat(cell: object) -> str:
    return (cell if isinstance(cell, Text) else render(str(cell))).plain


def _text(text: str, *, plain: bool) -> Text:
    return Text(text) if plain else render(text)


def _table(table: Table) -> str:
    """A table with its title and heads, if it has any; a grid has none."""
    looks = [
        f"{CELL};text-align:{column.justify}{';white-space:nowrap' * column.no_wrap}"
        for column in table.columns
    ]
    body = "".join(_row("td", looks, row) for row in _rows(table))
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
