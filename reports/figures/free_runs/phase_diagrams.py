"""Phase diagrams: the driver's angular velocity over its angle, of each run over the truth."""

from __future__ import annotations

from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import MaxNLocator

from reports.figures.free_runs.courses import TRUTH
from reports.figures.free_runs.free_run import free_runs
from reports.figures.grids import grid
from reports.figures.style import INK
from reports.results.overview import Report


def draw(report: Report, name: str) -> Figure | None:
    """A panel for each run, all with the same axes; None where no run has an angular velocity."""
    shown = free_runs(report, name)
    runs = [run for run in shown.runs if "omega" in run.trace] if shown else []
    if shown is None or not runs:
        return None
    unit, size = shown.unit
    entries = [
        (Line2D([], [], **TRUTH), "truth, integrated"),
        (Line2D([], [], color=INK, linewidth=0.7), "run"),
    ]
    labels = (f"angle of {shown.scene.driver.link} [{unit}]", "angular velocity [rad/s]")
    title = f"Phase diagram: {name}, step {shown.steps}"
    figure, axes = grid([run.name for run in runs], title, labels, entries, shown.notes)
    for one in axes[1:]:
        one.sharex(axes[0])
        one.sharey(axes[0])
    for run, panel in zip(runs, axes, strict=True):
        panel.plot(shown.angle / size, shown.omega, **TRUTH)
        angle, speed = run.portrait()
        panel.plot(angle / size, speed, color=run.mark.colour, linewidth=0.7)
        panel.xaxis.set_major_locator(MaxNLocator(4))
    return figure
