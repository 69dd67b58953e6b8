"""Printed parts of an answer as a terminal, Markdown and HTML show them.

The HTML needs no scripts or style sheets, and has the colours of the notebook, light or dark.
"""

from __future__ import annotations

import io
import os
from collections.abc import Callable, Iterable, Sequence
from html import escape
from pathlib import Path
from typing import Any

from rich.console import Console, Group
from rich.markup import render
from rich.style import Style
from rich.table import Table
from rich.text import Text

from reports.output.console import TABLE_WIDTH, tell
from reports.output.formats import counted, plain, table

Print = Callable[[Console], None]
Convert = Callable[[Text | Table, Style | str], str]
COMMENT = 60_000
"""Bytes of Markdown; a comment on GitHub takes 65,536."""
WIDE = 200
"""Columns of a page: room for every column of a table."""
STYLES = Console(force_jupyter=False)
"""The console that knows the styles by name."""
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


def present(
    console: Console, format: str, title: str, *shows: Print, page: Callable[[], str] | None = None
) -> None:
    """Print the parts of an answer, or its Markdown (``format`` md): the ``page``, or the parts
    below a title, the last first; append that to the summary of the job where GitHub names one."""
    summary = os.environ.get("GITHUB_STEP_SUMMARY")
    made = page or (lambda: as_markdown(title, *reversed(shows)))
    text = made() if summary or format == "md" else ""
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
    return "\n\n".join([f"## crankcheck {plain(title)}", *parts]) + "\n"


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
        style, literal = options.get("style") or "", options.get("markup") is False
        for printed in objects:
            for each in printed.renderables if isinstance(printed, Group) else [printed]:
                text = each if isinstance(each, Table) else _text(each, literal=literal)
                self.parts.append(self.convert(text, style))


def _html(printed: Text | Table, style: Style | str) -> str:
    if isinstance(printed, Table):
        return _table(printed)
    css = f"margin:4px 0;white-space:pre-wrap;{_css(style)}"
    return f'<div style="{css}">{_spans(printed)}</div>' * bool(printed.plain.strip())


def _markdown(printed: Text | Table, style: Style | str) -> str:
    if isinstance(printed, Text):
        return "  \n".join(plain(line) for line in printed.plain.splitlines())
    rows = [[_text(cell).plain for cell in row] for row in _rows(printed)]
    heads = [_text(each.header).plain + ":" * (each.justify == "right") for each in printed.columns]
    if not printed.show_header or not any(heads):
        return "\n".join(f"- {plain(' '.join(row))}" for row in rows)
    title = f"**{plain(_text(printed.title).plain)}**\n\n" * bool(printed.title)
    return title + table(heads, rows, COMMENT // 3, "rows")


def _rows(table: Table) -> Iterable[Sequence[object]]:
    return zip(*(column.cells for column in table.columns), strict=True)


def _text(cell: object, *, literal: bool = False) -> Text:
    """A text, or the one of a ``literal`` string or of markup."""
    if isinstance(cell, Text):
        return cell
    return Text(str(cell)) if literal else render(str(cell))


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
    style = "font-weight:600;margin-top:10px"
    title = f'<div style="{style}">{_cell(table.title)}</div>' if table.title else ""
    margin = "margin:4px 0 12px" if has_heads else "margin:0"
    return f'{title}<table style="{TABLE};{margin}">{head}<tbody>{body}</tbody></table>'


def _row(tag: str, looks: Iterable[str], cells: Iterable[object]) -> str:
    pairs = zip(looks, cells, strict=True)
    inside = (f'<{tag} style="{look}">{_cell(cell)}</{tag}>' for look, cell in pairs)
    return f"<tr>{''.join(inside)}</tr>"


def _cell(cell: object) -> str:
    """A cell, lines of it one below the other."""
    return _spans(_text(cell)).replace("\n", "<br>")


def _spans(text: Text) -> str:
    """The pieces of a text, each in its style."""
    pieces = ((escape(piece), _css(own or text.style)) for piece, own, _ in text.render(STYLES))
    return "".join(f'<span style="{css}">{piece}</span>' if css else piece for piece, css in pieces)


def _css(style: Style | str) -> str:
    """A style of a terminal in CSS; unknown colours are left out."""
    parsed = Style.parse(style) if isinstance(style, str) else style
    colour = COLOURS.get(parsed.color.name, "") if parsed.color else ""
    return (
        f"color:{colour};" * bool(colour)
        + "font-weight:600;" * bool(parsed.bold)
        + "opacity:0.65;" * bool(parsed.dim)
    )
