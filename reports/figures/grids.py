"""Panels for many scenes on one page: equal axes, labels at the outer edges only."""

from __future__ import annotations

import math
from collections.abc import Sequence

from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from reports.figures.sheet import Panels, sheet
from reports.figures.style import PAGE_IN, SMALL, cut

COLUMNS = 4


def grid(
    names: Sequence[str],
    title: str,
    labels: tuple[str, str],
    entries: Sequence[tuple[Artist, str]],
    notes: Sequence[str],
    apart: bool = False,
    height: float = 1.35,
) -> tuple[Figure, list[Axes]]:
    """A page with a panel per name; ``labels`` are those of the two axes.

    Where panels are ``apart`` each has numbers of its own on its vertical axis.
    """
    columns = min(COLUMNS, len(names))
    rows = math.ceil(len(names) / columns)
    panels = Panels(
        rows,
        columns,
        height,
        left=0.46,
        right=0.1,
        top=0.16,
        bottom=0.31,
        between=(0.28 if apart else 0.12, 0.2),
    )
    figure, axes = sheet(PAGE_IN, panels, title, entries, notes)
    box = axes[0].get_position()
    for at, (name, one) in enumerate(zip(names, axes, strict=False)):
        one.set_title(cut(name, box.width * PAGE_IN, SMALL))
        one.tick_params(
            labelbottom=at + columns >= len(names), labelleft=apart or at % columns == 0
        )
    low, right = axes[-1].get_position().y0, axes[columns - 1].get_position().x1
    down = 0.15 / figure.get_figheight()
    figure.text((box.x0 + right) / 2, low - down, labels[0], ha="center", va="top")
    figure.text(0.04 / PAGE_IN, (low + box.y1) / 2, labels[1], rotation=90, ha="left", va="center")
    for one in axes[len(names) :]:
        one.remove()
    return figure, axes[: len(names)]
