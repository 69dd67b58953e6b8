"""Progress of a long command: a bar on a terminal, a line now and then elsewhere."""

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager

from rich.console import Console
from rich.progress import (
    BarColumn,
    MofNCompleteColumn,
    Progress,
    ProgressColumn,
    TextColumn,
    TimeRemainingColumn,
)
from rich.progress import Task as Bar
from rich.text import Text

LINE_S = 10.0
"""Time between two lines where there is no terminal [s]."""


class _StepRate(ProgressColumn):
    def render(self, task: Bar) -> Text:
        speed = task.finished_speed or task.speed
        return Text("" if speed is None else f"{speed:.1f}/s", "progress.data.speed")


@contextmanager
def progress_bar(console: Console, what: str, total: int) -> Iterator[Callable[[], None]]:
    """Show counts, rate and time left while the block runs; yield a function to call after each."""
    if not total:
        yield lambda: None
    elif console.is_terminal:
        columns = (
            TextColumn(f"{what:8}"),
            BarColumn(),
            MofNCompleteColumn(),
            _StepRate(),
            TextColumn("left"),
            TimeRemainingColumn(),
        )
        with Progress(*columns, console=console) as bar:
            task = bar.add_task(what, total=total)
            yield lambda: bar.advance(task)
    else:
        yield _lines(console, what, total)


def _lines(console: Console, what: str, total: int) -> Callable[[], None]:
    """Return a counter of its calls that prints the count after some seconds and at the end."""
    began = last = time.monotonic()
    count = 0

    def advance() -> None:
        nonlocal count, last
        count += 1
        now = time.monotonic()
        if count == total or now - last >= LINE_S:
            last = now
            rate = count / max(now - began, 1e-9)
            console.print(f"{what}: {count} of {total}, {rate:.1f}/s", highlight=False)

    return advance
