"""The error over the driver's place, split into parts that a user can adjust.

A panel for each variant, at one step. The parts come from `reports.results.error_parts`, with sign:
drive, model floor and discretisation add up to the total; the gap of the pins stands beside them.
"""

import math
from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import FuncFormatter, MaxNLocator

from models.scene import Scene, driver
from reports.drawing.moving import told_places
from reports.figures.coinciding import count_coinciding
from reports.figures.drawing import ends
from reports.figures.sheet import corner_words, grid, one_scale, spaced, tenfold
from reports.figures.style import INK, Look, power_of_ten
from reports.output.numbers import floor_words
from reports.results.error_parts import ErrorParts, Split, split, worst_body
from reports.results.lines import Line, label, named
from reports.results.overview import Report, notes

STEPS = 720
"""Steps per turn of the shown cells, or the nearest that ended well: as in verify."""
LOOKS: dict[str, tuple[str, Look]] = {
    "total": ("total", {"color": "#cccccc", "linewidth": 3.0}),
    "drive": ("drive: crank off its commanded angle", {"color": "#2f7d4c", "dashes": (1, 1)}),
    "floor": ("model floor: error at a step of zero", {"color": "#c04a1d", "dashes": (4, 1.5)}),
    "discretisation": ("discretisation: shrinks with the step", {"color": INK}),
    "geometric": ("floor and discretisation, not separated", {"color": INK, "dashes": (7, 1.5)}),
    "gap": ("closure: gap of the pins / L", {"color": "#4a90c9", "dashes": (5, 1.2, 1, 1.2)}),
}
"""Legend and line of each part, in the order of `ErrorParts.curves`."""


def draw(report: Report, name: str) -> Figure | None:
    """Draw the panels of a scene; None where there is nothing to split."""
    lines, scene = report.lines_of(name), report.scenes[name]
    body = None if scene is None else worst_body(lines, report.stored.trace, scene.longest_m)
    if scene is None or body is None:
        return None
    cells = [_cell(line, split(line, report.stored.trace, body, scene.longest_m)) for line in lines]
    unit = "rad" if body.scale == 1.0 else "L"
    titles = [label(named(line)) for line in lines]
    steps = {one.steps_per_turn for one in cells if one is not None}
    at = " and ".join(f"{n:g}" for n in sorted(steps))
    over = driver.driver_axis(scene).rpartition(" [")[0]
    title = f"Error over the {over}: {name}, {body.name}, {at} steps per turn"
    labels = (driver.driver_axis(scene), f"error of {body.name} [unit in the panel]")
    drawn = {part for one in cells if one is not None for part in one.parts.curves}
    entries = [(Line2D([], [], **LOOKS[n][1]), LOOKS[n][0]) for n in LOOKS if n in drawn]
    figure, axes = grid(titles, title, labels, entries, notes(report, lines))
    shown = [(one, panel) for one, panel in zip(cells, axes, strict=True) if one is not None]
    for line, one, panel in zip(lines, cells, axes, strict=True):
        if one is None:
            panel.set(xticks=[], yticks=[])
            panel.text(0.5, 0.5, ends(line) or "no trace", ha="center", transform=panel.transAxes)
        else:
            _panel(panel, one, scene)
    one_scale([panel for _, panel in shown])
    for one, panel in shown:
        room = 0.16 + 0.1 * one.floor.count("\n")
        corner_words(panel, room, f"[{power_of_ten(one.scale)} {unit}]", one.floor)
        count_coinciding(panel, panel.lines)
    return figure


@dataclass(frozen=True)
class ShownCell:
    """The shown cell of a line, words on its floor, and the power of ten of its errors."""

    steps_per_turn: float
    parts: ErrorParts
    floor: str

    @property
    def scale(self) -> float:
        return tenfold(max(float(np.max(np.abs(each))) for each in self.parts.curves.values()))


def _cell(line: Line, parts: Split) -> ShownCell | None:
    """Return the cell that ended well with steps nearest to `STEPS`; None without one."""
    rows = line.cells[(line.cells["status"] == "ok") & line.cells["key"].isin(list(parts.cells))]
    if rows.empty:
        return None
    away = [abs(math.log(n / STEPS)) for n in rows["steps_per_turn"]]
    row = rows.iloc[int(np.argmin(away))]
    if math.isnan(parts.floor):
        floor = "floor not separated"
    else:
        words = floor_words(parts.floor if parts.seen else math.nan, parts.doubt)
        floor = words.replace(" is ", "\nis ").replace(" by ", "\nby ")
    return ShownCell(float(row["steps_per_turn"]), parts.cells[str(row["key"])], floor)


def _panel(axes: Axes, cell: ShownCell, scene: Scene) -> None:
    """Draw the curves of a cell over the driver's place, angles from the first turn on."""
    turn = told_places(scene, cell.parts.driver_rad)
    for name, curve in cell.parts.curves.items():
        axes.plot(turn, curve / cell.scale, **LOOKS[name][1])
    axes.set_xlim(float(turn.min()), float(turn.max()))
    if np.ptp(turn) > 180:
        spaced(axes, 90.0)
    else:
        axes.xaxis.set_major_locator(MaxNLocator(4))
    if scene.driver.slider is None:
        axes.xaxis.set_major_formatter(FuncFormatter(lambda angle, _: f"{angle % 360:g}"))
