"""Panels for many scenes on one page: equal axes, labels at the outer edges only."""

from __future__ import annotations

import math
from collections.abc import Sequence

from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from reports.figures.sheet import EDGE, Panels, folded, sheet
from reports.figures.style import PAGE_IN, SIZE, SMALL, TINY, Look, cut

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
    height *= 1.0 if columns > 2 else 1.5
    across, down = 0.28 if apart else 0.12, 0.2
    upright = folded(labels[1], rows * height + (rows - 1) * down, SIZE)
    left = 0.35 + 0.115 * len(upright)
    panels = Panels(rows, columns, height, left, 0.1, 0.16, 0.31, (across, down))
    figure, axes = sheet(PAGE_IN, panels, title, entries, notes)
    box = axes[0].get_position()
    for at, (name, one) in enumerate(zip(names, axes, strict=False)):
        one.set_title(cut(name, box.width * PAGE_IN, SMALL))
        one.tick_params(
            labelbottom=at + columns >= len(names), labelleft=apart or at % columns == 0
        )
    low, right = axes[-1].get_position().y0, axes[columns - 1].get_position().x1
    under = low - 0.15 / figure.get_figheight()
    figure.text((box.x0 + right) / 2, under, labels[0], ha="center", va="top")
    middle = (low + box.y1) / 2
    words: Look = {"rotation": 90, "va": "center", "multialignment": "center"}
    figure.text(EDGE / PAGE_IN, middle, "\n".join(upright), **words)
    for one in axes[len(names) :]:
        one.remove()
    return figure, axes[: len(names)]


def tenfold(largest: float) -> float:
    """The power of ten that a panel of series up to ``largest`` is drawn in."""
    return 10.0 ** math.floor(math.log10(largest)) if largest > 0.0 else 1.0


def corner_words(axes: Axes, room: float, left: str, right: str) -> None:
    """Words in the upper corners of a panel, which is made higher by that part of itself."""
    low, high = axes.get_ylim()
    axes.set_ylim(low, high + room * (high - low))
    paper = {"facecolor": "white", "edgecolor": "none", "pad": 0.5}  # over a tick behind
    words: Look = {"va": "top", "size": TINY, "transform": axes.transAxes, "bbox": paper}
    axes.text(0.03, 0.96, left, ha="left", **words)
    axes.text(0.97, 0.96, right, ha="right", **words)
