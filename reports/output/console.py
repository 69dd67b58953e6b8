"""The terminal at its width, or a file or pipe; printing to them, and numbers for a reader."""

import contextlib
import errno
import math
import os
import re
import sys
from collections.abc import Container, Iterable, Mapping, Sequence
from pathlib import Path

import numpy as np
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


def say_whole(console: Console, *texts: str) -> None:
    """Print each text that is not empty as `say`, its lines as long as they are, and nothing in it
    that acts on a terminal."""
    for text in filter(None, texts):
        console.print(harmless(text), highlight=False, markup=False, soft_wrap=True)


def put(console: Console, path: Path | None, text: str, what: str) -> None:
    """Write a text into a file and say what it is, or to the terminal for None. Raises
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
    never wrapped, unless all ``wraps``, as is text below a head in ``whole``. What is too wide ends
    in an ellipsis there and below a head in ``cut``, and goes on in the next line elsewhere.
    ``least`` has widths of columns by head.
    `reports.output.formats.table` writes the same heads and rows in Markdown."""
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


NONE = "\N{EN DASH}"
"""Text for a missing number."""
DIGITS = 6
"""Significant digits of an embedded number: more than a screen shows."""


def short(value: float, digits: int = 2) -> str:
    """Return 7.5e-4 for 0.00075; a number that is not finite by its name."""
    mantissa, _, exponent = f"{value:.{digits - 1}e}".partition("e")
    return f"{mantissa}e{int(exponent)}" if exponent else mantissa


def error_text(value: float | None, digits: int = 2) -> str:
    """Return a pure error with few digits, such as 2.7e-4; a dash where there is none."""
    if value is None or not math.isfinite(value):
        return NONE
    if value == 0.0:
        return "0"
    return short(value, digits)


def readable(value: float, digits: int = 3) -> str:
    """Return a number with few digits: 0.0123, 345, 6.7e-5; one that is not finite by its name."""
    if value == 0.0 or 1e-3 <= abs(value) < 1e5:
        return f"{value:.{digits}g}" if abs(value) < 10.0**digits else f"{value:.0f}"
    mantissa, e, exponent = short(value, digits).partition("e")
    return f"{mantissa.rstrip('0').rstrip('.') if e else mantissa}{e}{exponent}"


def duration(value_s: float | None) -> str:
    """Return a time in the unit that gives it one to three digits before the point."""
    if value_s is None or not math.isfinite(value_s):
        return NONE
    for unit, size in (("s", 1.0), ("ms", 1e-3), ("\N{MICRO SIGN}s", 1e-6)):
        if value_s >= 0.9995 * size:
            return f"{_three(value_s / size)} {unit}"
    return f"{_three(value_s / 1e-9)} ns"


def _three(value: float) -> str:
    """Return three significant digits, without an exponent."""
    places = 2 if value < 9.995 else 1 if value < 99.95 else 0
    return f"{value:.{places}f}"


def count(number: int, noun: str, plural: str | None = None) -> str:
    """Return a number with its noun: 1 scene, 2 scenes."""
    return f"{number} {noun if number == 1 else plural or noun + 's'}"


def listed(words: Sequence[str], last: str = "and") -> str:
    """Return words as a list in a sentence: a, b and c."""
    if len(words) < 2:
        return "".join(words)
    return f"{', '.join(words[:-1])} {last} {words[-1]}"


def finite(value: object, digits: int | None = None) -> object:
    """Return a value, and all that it holds, for JSON: numbers that are not finite are None.

    Numbers are cut to so many significant ``digits``, if given, and whole ones have no point.
    """
    if isinstance(value, Mapping):
        return {str(key): finite(each, digits) for key, each in value.items()}
    if isinstance(value, np.ndarray | list | tuple):
        return [finite(each, digits) for each in value]
    number = value.item() if isinstance(value, np.generic) else value
    if not isinstance(number, float):
        return number
    if digits is None or not math.isfinite(number):
        return number if math.isfinite(number) else None
    near = number if number.is_integer() else float(f"{number:.{digits}g}")
    return int(near) if near.is_integer() and abs(near) < 1e15 else near


VALUES = ((10, "X"), (9, "IX"), (5, "V"), (4, "IV"), (1, "I"))


def roman(number: int) -> str:
    """Return IV for 4; of numbers from 1 to 39."""
    letters = ""
    for value, own in VALUES:
        letters += own * (number // value)
        number %= value
    return letters
