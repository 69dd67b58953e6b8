"""What a figure of a store is."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from matplotlib.figure import Figure

from reports.results.overview import Report


@dataclass(frozen=True)
class Drawing:
    """What a figure shows, of one scene and over all of them; None where it has no such form.

    Each gives None where a store has nothing to draw. Files are called ``name-scene`` and ``name``.
    ``drives`` are the kinds of cells that it shows (`reports.way.way.Way.kinds`).
    """

    of: Callable[[Report, str], Figure | None] | None = None
    over_all: Callable[[Report], Figure | None] | None = None
    drives: tuple[str, ...] = ("driven",)
