"""How large the reactions are over the driver's angle: pins and guides, and moments of guides."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from models.array import Array
from reports.describe.frame import acted_on
from reports.drawing.shape import colours_of
from reports.figures.forces.force_turn import SIDES, ForceTurn
from reports.figures.marks import DASHES
from reports.figures.sheet import Panels, sheet
from reports.figures.style import COLUMN_IN, INK

Curve = tuple[str, Array, dict[str, Any]]


def draw(turn: ForceTurn) -> Figure | None:
    """Forces in one panel, moments in one below where there are any; None without reactions."""
    if not turn.has_forces:
        return None
    forces, moments = _forces(turn), _moments(turn)
    if not forces:
        return None
    groups = [("force [N]", forces)] + [("moment [N m]", moments)] * bool(moments)
    panels = Panels(len(groups), 1, 2.1 if len(groups) == 1 else 1.6, *SIDES, between=(0, 0.22))
    entries: list[tuple[Artist, str]] = [
        (Line2D([], [], **look), name) for _, curves in groups for name, _, look in curves
    ]
    title = f"Reactions: {turn.scene.name}"
    figure, axes = sheet(COLUMN_IN, panels, title, entries, turn.notes)
    for one, (label, curves) in zip(axes, groups, strict=True):
        _panel(one, turn, curves)
        one.set_ylabel(label)
        one.tick_params(labelbottom=one is axes[-1])
    axes[-1].set_xlabel(turn.label)
    return figure


def _panel(axes: Axes, turn: ForceTurn, curves: Sequence[Curve]) -> None:
    for _, series, look in curves:
        turn.plot(axes, series, **look)
    turn.mark_axis(axes)


def _forces(turn: ForceTurn) -> list[Curve]:
    """Lengths of the forces of pins, and signed normal forces of guides."""
    colours = colours_of(turn.scene)
    rows = [
        (f"{point} on {body}", np.hypot(*force.T), colours.get(body, INK))
        for point, body, _, force in acted_on(turn.acting)
    ]
    rows += [
        (f"slider {name}, normal (signed)", one.normal, INK)
        for name, one in turn.acting.sliders.items()
    ]
    return [_curve(row, k) for k, row in enumerate(rows)]


def _moments(turn: ForceTurn) -> list[Curve]:
    """The moments of guides that have one."""
    rows = [
        (f"slider {name}, moment", one.moment, INK)
        for name, one in turn.acting.sliders.items()
        if np.nanmax(np.abs(one.moment), initial=0.0) > 0.0
    ]
    return [_curve(row, k) for k, row in enumerate(rows)]


def _curve(row: tuple[str, Array, str], at: int) -> Curve:
    """A curve in its colour, with dashes of its own: bodies share colours."""
    name, series, colour = row
    dashes = DASHES[at % len(DASHES)]
    return name, series, {"color": colour, "linestyle": (0, dashes) if dashes else "-"}
