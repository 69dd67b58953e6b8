"""A family of mechanisms over the crank's angle: a panel for position, velocity and acceleration,
each with all members."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.artist import Artist
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import MaxNLocator

from reports.figures.marks import COLOURS, DASHES
from reports.figures.sheet import Panels, sheet
from reports.figures.style import COLUMN_IN, PAGE_IN, mark_zero, shorten, styled
from reports.lectures.drawing.workbook.family_curves import KINDS, FamilyCurves

TICKS_DEG = [1, 1.5, 3, 4.5, 6, 9, 10]
"""Steps of an axis of angles, within a power of ten."""


def draw_family(
    curves: FamilyCurves, title: str, notes: Sequence[str], kinds: Sequence[str] = KINDS
) -> Figure:
    """The figure: a row for each of the ``kinds``, below each other over one axis."""
    rows = [curves.of_kind(kind) for kind in kinds]
    wide = len(rows[0])
    looks = [_look(k) for k in range(len(curves.values))]
    entries: list[tuple[Artist, str]] = [
        (Line2D([], [], **look), member) for look, member in zip(looks, curves.members, strict=True)
    ]
    height = 1.25 if len(rows) > 1 else 1.9
    panels = Panels(len(rows), wide, height, 0.52, 0.08, 0.12, between=(0.5, 0.13))
    width = COLUMN_IN if wide == 1 else PAGE_IN
    with styled():
        figure, axes = sheet(width, panels, title, entries, notes)
        for at, one in enumerate(axes):
            chart = rows[at // wide][at % wide]
            mark_zero(one, *chart.curves)
            for angle, curve, look in zip(curves.angles_deg, chart.curves, looks, strict=True):
                one.plot(angle, curve, **look)
            _mark_angles(one, curves)
            shorten(one)
            one.set_ylabel(chart.label)
            is_lowest = at // wide == len(rows) - 1
            one.tick_params(labelbottom=is_lowest)
            if is_lowest:
                one.set_xlabel("angle of the crank [deg]")
    return figure


def _mark_angles(axes: Any, curves: FamilyCurves) -> None:
    """Limits of the axis of angles, and numbers at parts of a turn."""
    ends = [end for angle in curves.angles_deg for end in (np.min(angle), np.max(angle))]
    axes.set_xlim(min(ends), max(ends))
    axes.xaxis.set_major_locator(MaxNLocator(9, steps=TICKS_DEG))


def _look(k: int) -> dict[str, Any]:
    """The curve of a member: a hue of its own, and dashes for where there are none."""
    dashes = DASHES[k % len(DASHES)]
    shades = COLOURS[k % len(COLOURS)]
    colour = shades[1 + k // len(COLOURS) % (len(shades) - 1)]
    return {"color": colour, "linestyle": (0, dashes) if dashes else "-", "linewidth": 1.0}
