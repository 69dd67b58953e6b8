"""The figure of beads: how far they are off over time."""

from matplotlib.figure import Figure

from reports.figures.drawing import Drawing, marks
from reports.figures.sheet import Panels, sheet
from reports.figures.style import PAGE_IN
from reports.results.lines import named
from reports.results.overview import Report, notes


def draw(report: Report, name: str) -> Figure | None:
    """The error of the angle over the time, of each line at its finest step."""
    lines, mark_of = report.lines_of(name), marks(report.lines)
    figure, (axes,) = sheet(PAGE_IN, Panels(), f"Bead: {name}", [], notes(report, lines))
    for line in lines:
        trace = report.stored.trace(str(line.cells.iloc[-1]["key"]))
        axes.plot(trace["time_s"], trace["drive"], **mark_of[named(line)].line)
    axes.set_xlabel("time [s]")
    axes.set_ylabel("error of the spoke [rad]")
    return figure


FIGURES = {"bead": Drawing(draw, drives=("bead",))}
