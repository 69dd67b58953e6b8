"""What stands in columns on a terminal, without lines: tables, and paragraphs that hang."""

from __future__ import annotations

from rich.console import Console
from rich.table import Table
from rich.text import Text


def plain_table(title: str | None = None, style: str = "bold", gap: int = 1) -> Table:
    """A table without lines, ``gap`` spaces after every column; its title stands on the left."""
    padding = (0, gap, 0, 0)
    return Table(title=title, title_justify="left", title_style=style, box=None, padding=padding)


def hanging(console: Console, head: str, text: str, style: str = "") -> None:
    """Print a paragraph whose later lines stand below its text."""
    grid = Table.grid(padding=0)
    grid.add_column(no_wrap=True)
    grid.add_column(overflow="fold")
    grid.add_row(Text(head, style), Text(text, style))
    console.print(grid)
