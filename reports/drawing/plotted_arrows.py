"""Forces and the bar of their scale, drawn with matplotlib."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.axes import Axes

from models.array import Array
from models.motion import Motion
from reports.drawing.force_arrows import ForceArrows
from reports.drawing.shape import colours_of

INK = "#1f2933"
"""Everything that has not the colour of a link."""


def draw_arrows(axes: Axes, arrows: ForceArrows, motion: Motion, index: int) -> None:
    """The forces at a sample, each in the colour of the body that it acts on."""
    colours = colours_of(arrows.scene)
    for arrow in arrows.at(motion, index):
        colour = colours.get(arrow.body, INK)
        end = arrow.head(arrows.size)[1:].mean(axis=0) if arrow.is_whole else arrow.tip
        axes.plot(*np.array([arrow.tail, end]).T, color="white", linewidth=3.2, zorder=6)
        axes.plot(*np.array([arrow.tail, end]).T, color=colour, linewidth=1.6, zorder=6)
        if arrow.is_whole:
            look: dict[str, Any] = {"facecolor": colour, "edgecolor": "white", "linewidth": 0.5}
            axes.fill(*arrow.head(arrows.size).T, zorder=7, **look)


def scale_bar(axes: Axes, arrows: ForceArrows, box: tuple[Array, Array], fontsize: float) -> None:
    """How long a force is drawn, in the lower right corner of the box."""
    if not arrows.bar_n:
        return
    long = arrows.bar_n * arrows.m_per_n
    right, low = float(box[1][0]) - 0.03 * arrows.size, float(box[0][1]) + 0.03 * arrows.size
    tick = 0.012 * arrows.size
    ends = [right - long, right - long, right - long, right, right, right]
    high = [low - tick, low + tick, low, low, low + tick, low - tick]
    axes.plot(ends, high, color=INK, linewidth=1.2, zorder=8)
    axes.annotate(
        f"{arrows.bar_n:g} N",
        (right - long / 2, low),
        (0, 2.5),
        textcoords="offset points",
        ha="center",
        va="bottom",
        fontsize=fontsize,
        color=INK,
        zorder=8,
    )
