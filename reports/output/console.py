"""The terminal at its width, or a file or pipe that may be full or closed; and printing to them."""

import contextlib
import errno
import os
import re
import sys
from collections.abc import Container, Iterable, Mapping, Sequence
from pathlib import Path

import typer
from rich.console import Console, RenderableType
from rich.table import Table
from rich.text import Text

from models.errors import harmless
from reports.output.write import write

TABLE_WIDTH = 100
UNWRITABLE = (errno.ENOSPC, errno.EDQUOT, errno.EFBIG, errno.EIO, errno.EBADF)


class Terminal(Console):
    """A console that leaves a broken pipe to the command."""

    def on_broken_pipe(self) -> None:
        """Raise BrokenPipeError, where rich would exit with 1: out of tolerance."""
        raise BrokenPipeError(errno.EPIPE, "the reader of the output is gone")


def terminal(stderr: bool = False) -> Terminal:
    """Return the terminal at its width; a file or a pipe at the width of the tables."""
    stream = sys.stderr if stderr else sys.stdout
    wide = stream is not None and stream.isatty()
    return Terminal(stderr=stderr, width=None if wide else TABLE_WIDTH)


def forget_odd_sizes() -> None:
    """Remove an invalid size of the terminal: libraries make lines of any width from it."""
    for name in ("COLUMNS", "LINES"):
        if not re.fullmatch("[1-9][0-9]{0,3}", os.environ.get(name, "80"), re.ASCII):
            del os.environ[name]


def readable_everywhere() -> None:
    """Write characters that the encoding of the output can not hold (ASCII) as escapes."""
    for stream in (sys.stdout, sys.stderr):
        if stream is not None and hasattr(stream, "reconfigure"):
            stream.reconfigure(errors="backslashreplace")


def tell(lines: Sequence[str]) -> None:
    """Print the faults of a read file, if any, on standard error; an unwritable one is no fault."""
    if lines:
        with contextlib.suppress(OSError):
            typer.echo("\n".join((f"crankcheck: {lines[0]}", *lines[1:])), err=True)


def give_up_output() -> None:
    """Send the rest of the output nowhere: buffered text could not be written either."""
    with contextlib.suppress(OSError, ValueError):  # not a real file, in a test
        nowhere = os.open(os.devnull, os.O_WRONLY)
        os.dup2(nowhere, sys.stdout.fileno())
        os.close(nowhere)


def say(console: Console, text: str, style: str = "") -> None:
    """Print a text in which nothing is markup, and no number is coloured."""
    console.print(text, style=style, highlight=False, markup=False)


def say_each(console: Console, texts: Iterable[str], style: str = "dim") -> None:
    """Print texts as `say`, each a paragraph."""
    for text in texts:
        say(console, text, style)


def print_each(console: Console, tables: Iterable[Table]) -> None:
    """Print tables, an empty line below each."""
    for table in tables:
        console.print(table, "")


def say_whole(console: Console, *texts: str) -> None:
    """Print each text that is not empty as `say`, its lines as long as they are, and nothing in it
    that acts on a terminal."""
    for text in filter(None, texts):
        console.print(harmless(text), highlight=False, markup=False, soft_wrap=True)


def put(console: Console, path: Path | None, text: str, what: str) -> None:
    """Write a text into a file and name it, or to the terminal for None. Raises
    CrankcheckError where the system refuses."""
    if path is None:
        console.file.write(text)
        return
    write(path, text)
    say(console, harmless(f"{path}: {what}"))


def plain_table(title: str | None = None, style: str = "bold", gap: int = 1) -> Table:
    """Return a table without lines, ``gap`` spaces after every column; its title on the left."""
    padding = (0, gap, 0, 0)
    return Table(title=title, title_justify="left", title_style=style, box=None, padding=padding)


def grid(
    heads: Iterable[str],
    rows: Iterable[Sequence[RenderableType]] = (),
    title: str | None = None,
    *,
    style: str = "bold",
    gap: int = 2,
    whole: Container[str] = (),
    cut: Container[str] = (),
    wraps: bool = False,
    least: Mapping[str, int] | None = None,
) -> Table:
    """Return a `plain_table` of rows. A head that ends in a colon is over numbers, on the right and
    never wrapped, unless all ``wraps``, as is text below a head in ``whole``. A text that is too
    wide ends in an ellipsis there and below a head in ``cut``, and continues in the next line
    elsewhere. ``least`` has widths of columns by head. `reports.output.formats.table` writes the
    same heads and rows in Markdown."""
    shown = plain_table(title, style, gap)
    for head in heads:
        number = head.endswith(":")
        ends = number or head in whole or head in cut
        shown.add_column(
            head.removesuffix(":"),
            justify="right" if number else "left",
            no_wrap=(number and not wraps) or head in whole,
            overflow="ellipsis" if ends else "fold",
            min_width=(least or {}).get(head),
        )
    for row in rows:
        shown.add_row(*row)
    return shown


def show_rows(
    console: Console, rows: Sequence[Mapping[str, object]], columns: Sequence[str]
) -> None:
    """Print a table of rows, each a mapping by column; a number below 1e-6 as 0."""
    heads = [column.replace("_", " ") for column in columns]
    cells = ([_cell(row.get(column)) for column in columns] for row in rows)
    console.print(grid(heads, cells), highlight=False)


def _cell(value: object) -> str:
    if isinstance(value, bool):
        return "yes" if value else ""
    if isinstance(value, list):
        return ", ".join(map(str, dict.fromkeys(value)))
    if isinstance(value, Mapping):
        return ", ".join(f"{name} {_cell(each)}" for name, each in value.items())
    if isinstance(value, float):
        return f"{0.0 if abs(value) < 1e-6 else value:.6g}"
    return "" if value is None else str(value)


def show_failed(
    console: Console, head: str, findings: Iterable[tuple[str, str]], remedy: str = ""
) -> None:
    """Print failures under a head, each a rule and its finding, and the tried remedy, if any."""
    console.print(Text(harmless(head), "bold red"))
    for rule, text in findings:
        hanging(console, f"  {rule} ", harmless(text))
    if remedy:
        hanging(console, "  cure: ", remedy, style="cyan")


def hanging(console: Console, head: str, text: str, style: str = "") -> None:
    """Print a paragraph whose later lines stand below its text."""
    laid = Table.grid(padding=0)
    laid.add_column(no_wrap=True)
    laid.add_column(overflow="fold")
    laid.add_row(Text(head, style), Text(text, style))
    console.print(laid)
