"""Figures of regulation: a cycle, and the cycle without a flywheel; and the page of both."""

import base64
import math
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from analytic.lectures.regulation.flywheel import EnergyMass, WantedFlywheel, energy_mass
from analytic.lectures.regulation.steady_cycle import SteadyCycle
from models.array import Array
from models.scene import Scene
from reports.figures.sheet import SIDES, LinePanel, Panels, line_figure, sheet, spaced
from reports.figures.style import COLUMN_IN, INK, QUIET, SMALL, TINY, FigureSet, Look, shorten
from reports.lectures.machine import cycle_rows
from reports.lectures.machine.cycle_rows import CycleSeries, cycle_series
from reports.output.numbers import count, readable
from reports.output.write import crankcheck_version
from reports.page.build import Head, assembled
from reports.page.sections.section import Section

CURVE: Look = {"color": "#1f5f9e", "linewidth": 1.3}
OTHER: Look = {"color": "#c04a1d", "linewidth": 1.0, "linestyle": (0, (4.0, 1.5))}
RETURNING: Look = {"color": "#2f7d4c", "linewidth": 0.8, "linestyle": (0, (6.0, 1.5, 1.0, 1.5))}


@dataclass(frozen=True)
class Regulated:
    """A steady cycle to draw over its driver's angle; ``wanted`` is its flywheel, if any."""

    cycle: SteadyCycle
    wanted: WantedFlywheel | None = None

    @property
    def scene(self) -> Scene:
        return self.cycle.machine.scene

    @cached_property
    def series(self) -> CycleSeries:
        return cycle_series(self.cycle)

    def plot(self, axes: Axes, series: Array, **look: Any) -> None:
        """Draw a series of the cycle (T,)."""
        axes.plot(np.degrees(self.series.theta), series, **look)

    def mark(self, axes: Axes, *, labelled: bool = True) -> None:
        """Set limits, ticks and label of the angle; short numbers on the other axis."""
        axes.set_xlim(*sorted(np.degrees(self.series.theta[[0, -1]])))
        shorten(axes)
        turns = round(self.cycle.machine.cycle_rad / math.tau)
        spaced(axes, 60.0 if turns == 1 else 90.0 * turns / 2.0)
        axes.tick_params(labelbottom=labelled)
        if labelled:
            axes.set_xlabel(f"angle of {self.scene.driver.link} [deg]")

    @property
    def notes(self) -> list[str]:
        """The notes under each figure."""
        cycle, scene = self.cycle, self.scene
        parts = [
            f"crankcheck {crankcheck_version()}; steady cycle at a mean speed of "
            f"{readable(cycle.mean_rad_s, 5)} rad/s",
            f"loads: {', '.join(scene.loads)}" if scene.loads else "no loads",
        ]
        if cycle.drive_n_m:
            parts.append(f"drive: a constant torque of {readable(cycle.drive_n_m, 5)} N m")
        if self.wanted is not None:
            parts.append(f"flywheel: {readable(self.wanted.inertia_kg_m2, 5)} kg m²")
        return [f"{'; '.join(parts)}."]


TOUCH: Look = {"color": "#1f5f9e", "marker": "o", "markersize": 3.0, "linestyle": "none"}
NARROW = 1e-6
"""Variation of the moment of inertia, over its size, below which it is constant: no diagram."""
EVERY_DEG = 90
PAPER: Look = {"facecolor": "white", "edgecolor": "none", "pad": 0.3, "alpha": 0.85}
ROOM = 0.12
"""Room around the curve, over its size."""


def draw_energy_mass(of: Regulated) -> Figure | None:
    """Draw the diagram; None for a machine of constant moment of inertia."""
    cycle = of.cycle
    diagram = energy_mass(cycle)
    if np.ptp(diagram.inertia) <= NARROW * float(diagram.inertia.max()):
        return None
    high, low = cycle.extreme_speeds_rad_s
    slopes = ((0.5 * high**2, True, OTHER, "max"), (0.5 * low**2, False, RETURNING, "min"))
    entries = [(Line2D([], [], **CURVE), "over the cycle")]
    for slope, _, look, which in slopes:
        words = f"tan psi {which} = {readable(slope, 5)} J/(kg m²)"
        entries.append((Line2D([], [], **look), words))
    inertia = readable(0.0 - cycle.solution.flywheel, 5)
    origin = f"{inertia} kg m² and {readable(-float(cycle.solution.at_borders[0]), 5)} J"
    notes = [*of.notes, f"The tangents meet in {origin}, the origin of the diagram."]
    title = f"Energy and mass: {cycle.machine.scene.name}"
    figure, (axes,) = sheet(COLUMN_IN, Panels(1, 1, 2.6, *SIDES, 0.2), title, entries, notes)
    axes.plot(diagram.inertia, diagram.work, **CURVE)
    _limits(axes, diagram)
    for slope, above, look, _ in slopes:
        height, at = diagram.tangent(slope, above=above)
        axes.axline((0.0, height), slope=slope, **look)
        axes.plot(diagram.inertia[at], diagram.work[at], **TOUCH)
    _angles(of, axes)
    axes.ticklabel_format(scilimits=(-3, 4), useMathText=False)
    for axis in (axes.xaxis, axes.yaxis):
        axis.get_offset_text().set_fontsize(SMALL)
    axes.set_xlabel("own reduced inertia [kg m²]")
    axes.set_ylabel("work since the start [J]")
    return figure


def _limits(axes: Axes, diagram: EnergyMass) -> None:
    """Set limits with room around the curve; tangents run beyond it."""
    for put, series in ((axes.set_xlim, diagram.inertia), (axes.set_ylim, diagram.work)):
        room = ROOM * (float(np.ptp(series)) or 1.0)
        put(float(series.min()) - room, float(series.max()) + room)


def _angles(of: Regulated, axes: Axes) -> None:
    """Mark some angles of the driver; numbers are to the right of their dots."""
    cycle = of.cycle
    first = cycle.machine.start_rad
    ends = sorted((first, first + cycle.machine.way * cycle.machine.cycle_rad))
    low, high = (math.degrees(each) for each in ends)
    degrees = np.arange(math.ceil(low / EVERY_DEG - 1e-9) * EVERY_DEG, high - 1e-6, EVERY_DEG)
    u = np.clip(cycle.machine.way * (np.radians(degrees) - first), 0.0, cycle.machine.cycle_rad)
    inertia, work = cycle.machine.inertia(u)[0], cycle.energy(u) - cycle.solution.at_borders[0]
    axes.plot(inertia, work, "o", color=QUIET, markersize=2.0, zorder=3)
    look: Look = {"size": TINY, "color": QUIET, "va": "center", "bbox": PAPER}
    look |= {"textcoords": "offset points", "annotation_clip": True}
    for deg, x, y in zip(degrees, inertia, work, strict=True):
        axes.annotate(f"{deg:.0f}", (x, y), (3.0, 0.0), **look)


MEAN: Look = {"color": INK, "linewidth": 0.7, "linestyle": (0, (5.0, 2.0))}
EXTREME: Look = {"color": "#1f5f9e", "marker": "o", "markersize": 3.2, "linestyle": "none"}
APART = 6.0
"""Ratio of fluctuations above which they have no room in one panel."""


def draw_speed(of: Regulated) -> Figure:
    """Draw one panel; a second, closer one where the flywheel takes most of the fluctuation."""
    cycle, bare = of.cycle, None if of.wanted is None else of.wanted.bare
    with_it = "with the flywheel" if of.wanted is not None else "speed"
    extremes = cycle.fastest, cycle.slowest
    high, low = (readable(math.degrees(cycle.driver_rad(u)), 4) for u in extremes)
    entries = [
        (Line2D([], [], **CURVE), f"{with_it}, delta = {readable(cycle.delta)}"),
        (Line2D([], [], **MEAN), f"mean {readable(cycle.mean_rad_s, 5)} rad/s"),
        (Line2D([], [], **EXTREME), f"extreme at {high} and {low} deg"),
    ]
    notes, curves = list(of.notes), [("", of.series.speed, CURVE)]
    panels = [curves]
    if bare is not None:
        entries.append((Line2D([], [], **OTHER), f"without, delta = {readable(bare.delta)}"))
        both = [("", bare.solution.speed_at(of.series.turned), OTHER), *curves]
        panels = [both, curves] if bare.delta > APART * cycle.delta else [both]
    elif of.wanted is not None:
        notes.append("Without the flywheel there is no steady cycle at this speed.")
    label = f"{of.scene.driver.link} [rad/s]"
    figure, axes = line_figure(
        of, "Speed over a cycle", [LinePanel(label, each) for each in panels], notes, entries,
        height=2.1 if len(panels) == 1 else 1.5,
    )  # fmt: skip
    for one in axes:
        one.axhline(cycle.mean_rad_s, **MEAN)
    at = np.degrees(cycle.machine.theta(np.array(extremes)))
    axes[-1].plot(at, cycle.extreme_speeds_rad_s, **EXTREME)
    return figure


WORK: Look = {"color": INK, "linewidth": 1.2}


def draw_torques(of: Regulated) -> Figure:
    """Draw torques above, and work with its surplus below."""
    series = of.series
    torques = [
        ("driving torque", series.driving, CURVE),
        ("resisting torque", -series.resisting, OTHER),
        ("of weights and springs", series.returning, RETURNING),
    ]
    words = f"work since the start, surplus {readable(of.cycle.surplus_j, 4)} J"
    panels = [
        LinePanel("torque [N m]", [each for each in torques if np.any(each[1])], level=0.0),
        LinePanel("work [J]", [(words, series.work, WORK)], level=0.0),
    ]
    return line_figure(of, "Torques and work", panels, of.notes, height=1.5)[0]


REGULATION_FIGURES = FigureSet[Regulated](
    "", {"speed": draw_speed, "torques": draw_torques, "energy-mass": draw_energy_mass}
)
"""A machine of constant moment of inertia has no energy-mass diagram."""

CAPTIONS: Mapping[str, str] = {
    "speed": "The speed of the driver over the cycle, and its extremes.",
    "torques": "Torques reduced to the driver, and the work that they have done since the start.",
    "energy-mass": "Work over the machine's own reduced moment of inertia, with its tangents "
    "(Wittenbauer); numbers are angles of the driver in deg.",
}


def cycle_section(cycle: SteadyCycle, figures: Mapping[str, bytes]) -> Section:
    """The section of a cycle; ``figures`` are SVG files by their name."""
    return Section(
        anchor="cycle",
        title="Steady cycle",
        template="steady_cycle.html",
        words={
            "driver": cycle.machine.scene.driver.link,
            "heading": cycle_rows.heading(cycle),
            "rows": cycle_rows.number_rows(cycle),
            "works": cycle_rows.work_rows(cycle),
            "notes": cycle_rows.notes(cycle),
            "figures": [
                (name, CAPTIONS.get(name, name), base64.b64encode(svg).decode("ascii"))
                for name, svg in figures.items()
            ],
        },
        styles=("forces.css",),
    )


def flywheel_section(found: WantedFlywheel) -> Section:
    """The section of a flywheel."""
    return Section(
        anchor="flywheel",
        title="Flywheel",
        template="flywheel.html",
        words={
            "heading": cycle_rows.flywheel_heading(found),
            "ways": cycle_rows.way_rows(found),
            "rows": cycle_rows.beside_rows(found),
            "notes": cycle_rows.flywheel_notes(found),
        },
    )


def regulation_page(cycle: SteadyCycle, found: WantedFlywheel | None) -> str:
    """The page of a cycle, or of a flywheel and its cycle, as HTML."""
    figures = REGULATION_FIGURES.pictures(Regulated(cycle, found))
    sections = [cycle_section(cycle, figures)]
    if found is not None:
        sections.insert(0, flywheel_section(found))
    scene = cycle.machine.scene
    facts = ["regulation", count(len(scene.links), "link")]
    facts += [count(len(scene.loads), "load")] * bool(scene.loads)
    facts.append(f"crankcheck {crankcheck_version()}")
    head = Head(f"crankcheck: {scene.name}", facts, made="", first=sections[0].anchor)
    return assembled(head, sections)
