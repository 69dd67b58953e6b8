"""Wittenbauer's energy-mass diagram: work over the machine's own reduced moment of inertia, and the
tangents that meet a flywheel to the left of it."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from analytic.lectures.regulation.flywheel import EnergyMass, energy_mass
from analytic.lectures.regulation.steady_cycle import SteadyCycle
from reports.figures.sheet import Panels, sheet
from reports.figures.style import COLUMN_IN, QUIET, SMALL, TINY
from reports.lectures.machine.figures.regulated import CURVE, OTHER, RETURNING, SIDES, Regulated
from reports.output.numbers import readable

TOUCH = {"color": "#1f5f9e", "marker": "o", "markersize": 3.0, "linestyle": "none"}
NARROW = 1e-6
"""A moment of inertia that varies by less than this, over its size, is constant: no diagram."""
EVERY_DEG = 90
PAPER = {"facecolor": "white", "edgecolor": "none", "pad": 0.3, "alpha": 0.85}
ROOM = 0.12
"""Room around the curve, over its size."""


def draw(of: Regulated) -> Figure | None:
    """The diagram; None of a machine of constant moment of inertia."""
    cycle = of.cycle
    diagram = energy_mass(cycle)
    if np.ptp(diagram.inertia) <= NARROW * float(diagram.inertia.max()):
        return None
    high, low = cycle.extreme_speeds_rad_s
    slopes = ((0.5 * high**2, True, OTHER, "max"), (0.5 * low**2, False, RETURNING, "min"))
    entries: list[tuple[Artist, str]] = [(Line2D([], [], **CURVE), "over the cycle")]  # type: ignore[arg-type]  # looks of a line
    for slope, _, look, which in slopes:
        words = f"tan psi {which} = {readable(slope, 5)} J/(kg m²)"
        entries.append((Line2D([], [], **look), words))  # type: ignore[arg-type]  # as above
    notes = [*of.notes, f"The tangents meet in {_origin(cycle)}, the origin of the diagram."]
    title = f"Energy and mass: {cycle.machine.scene.name}"
    figure, (axes,) = sheet(COLUMN_IN, Panels(1, 1, 2.6, *SIDES, 0.2), title, entries, notes)
    axes.plot(diagram.inertia, diagram.work, **CURVE)  # type: ignore[arg-type]  # as above
    _limits(axes, diagram)
    for slope, above, look, _ in slopes:
        height, at = diagram.tangent(slope, above=above)
        axes.axline((0.0, height), slope=slope, **look)  # type: ignore[arg-type]  # as above
        axes.plot(diagram.inertia[at], diagram.work[at], **TOUCH)  # type: ignore[arg-type]  # as above
    _angles(of, axes)
    axes.ticklabel_format(scilimits=(-3, 4), useMathText=False)
    for axis in (axes.xaxis, axes.yaxis):
        axis.get_offset_text().set_fontsize(SMALL)
    axes.set_xlabel("own reduced moment of inertia [kg m²]")
    axes.set_ylabel("work since the start [J]")
    return figure


def _limits(axes: Axes, diagram: EnergyMass) -> None:
    """Room around the curve; tangents run out of it."""
    for put, series in ((axes.set_xlim, diagram.inertia), (axes.set_ylim, diagram.work)):
        room = ROOM * (float(np.ptp(series)) or 1.0)
        put(float(series.min()) - room, float(series.max()) + room)


def _angles(of: Regulated, axes: Axes) -> None:
    """Where the driver stands at some angles; numbers stand to the right of their dots."""
    cycle = of.cycle
    first = cycle.machine.start_rad
    ends = sorted((first, first + cycle.machine.way * cycle.machine.cycle_rad))
    low, high = (math.degrees(each) for each in ends)
    degrees = np.arange(math.ceil(low / EVERY_DEG - 1e-9) * EVERY_DEG, high - 1e-6, EVERY_DEG)
    u = np.clip(cycle.machine.way * (np.radians(degrees) - first), 0.0, cycle.machine.cycle_rad)
    inertia, work = cycle.machine.inertia(u)[0], cycle.energy(u) - cycle.solution.at_borders[0]
    axes.plot(inertia, work, "o", color=QUIET, markersize=2.0, zorder=3)
    for deg, x, y in zip(degrees, inertia, work, strict=True):
        look: dict[str, Any] = {"size": TINY, "color": QUIET, "va": "center", "bbox": PAPER}
        axes.annotate(
            f"{deg:.0f}",
            (x, y),
            (3.0, 0.0),
            textcoords="offset points",
            annotation_clip=True,
            **look,
        )


def _origin(cycle: SteadyCycle) -> str:
    """Where the tangents meet, in the numbers of the axes."""
    inertia = readable(0.0 - cycle.solution.flywheel, 5)
    return f"{inertia} kg m² and {readable(-float(cycle.solution.at_borders[0]), 5)} J"
