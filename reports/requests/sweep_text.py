"""What came of a sweep on the terminal: what was run, and what to choose."""

from __future__ import annotations

from pathlib import Path

from rich.console import Console

from models.errors import harmless
from reports.output.console import say
from reports.output.numbers import count
from reports.results.lines import lines
from reports.results.recommend import recommendations
from reports.results.table import noise_line, recommendation_table
from reports.store.reader import Stored, read_store
from reports.sweep.running import Done


def show_sweep(console: Console, folder: Path, number: int, done: Done) -> None:
    """Print what of so many cells was run now, what failed, and what to do with it."""
    console.print(
        f"{count(number, 'cell')}: {done.ran} run now, {number - done.ran} were there; "
        f"{done.timed} timed now"
    )
    for status, reasons in sorted(done.failed.items()):
        console.print(f"  {sum(reasons.values())} {status}, such as", highlight=False)
        for reason, _ in reasons.most_common(2):
            say(console, f"    {reason}")
    stored = f"stored in {folder}; next: crankcheck report {folder} -o report.html"
    console.print(harmless(stored), markup=False)
    found = read_store(folder)
    if not found.timings.empty:
        _recommend(console, found)


def _recommend(console: Console, stored: Stored) -> None:
    """What to choose, of all that the store holds."""
    console.print()
    older = len(stored.cells) - sum(len(line.cells) for line in lines(stored))
    if older:
        console.print(f"left out: {older} cells of earlier runs, whose names stand for others now")
    console.print(recommendation_table(recommendations(stored), console.width))
    console.print(noise_line(stored), highlight=False)
