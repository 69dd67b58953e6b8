"""Speed against error of batches: the cost of a step of one world, and the error of the worst."""

import math
from collections.abc import Mapping, Sequence

from matplotlib.lines import Line2D

from reports.figures.drawing import around
from reports.figures.sheet import ONE, sheet
from reports.figures.style import COLUMN_IN, TINY, logarithmic, saved, styled
from reports.output.palette import COLOURS

TITLE = "Speed and error of batches"
NOTE = "A point is a batch of so many worlds; dashed: in several threads."


def batches_picture(cells: Sequence[Mapping[str, object]]) -> str:
    """Draw rows of cells (`reports.judge.rows.cell_row`) as SVG, a curve for each engine and scene
    from the smallest batch to the largest; "" for less than two batches."""
    curves: dict[tuple[str, bool], list[tuple[float, float, str]]] = {}
    for cell in cells:
        cost, error = cell.get("batch_us_per_step"), cell.get("batch_error")
        if isinstance(cost, float) and isinstance(error, float) and 0.0 < error < math.inf:
            name = f"{cell['scene']}, {cell['engine']} {cell['profile']}"
            own = curves.setdefault((name, cell["threads"] != 1), [])
            own.append((cost, error, str(cell["worlds"])))
    points = [point for curve in curves.values() for point in curve]
    if len(points) < 2:
        return ""
    names = [*dict.fromkeys(name for name, _ in curves)]
    colour = {name: COLOURS[k % len(COLOURS)] for k, name in enumerate(names)}
    with styled():
        entries = [(Line2D([], [], color=colour[name], marker="o", ms=3), name) for name in names]
        figure, (axes,) = sheet(COLUMN_IN, ONE, TITLE, entries, [NOTE], 1)
        for (name, threaded), curve in curves.items():
            costs, errors, _ = zip(*curve, strict=True)
            line = "--" if threaded else "-"
            axes.plot(costs, errors, marker="o", ms=3, color=colour[name], linestyle=line)
            for cost, error, worlds in curve:
                axes.annotate(worlds, (cost, error), (2, 3), textcoords="offset points", size=TINY)
        logarithmic(axes, "x", *around(cost for cost, _, _ in points))
        logarithmic(axes, "y", *around(error for _, error, _ in points))
        axes.set_xlabel("cost per world and step [µs]")
        axes.set_ylabel("largest error: angle [rad], place / L [-]")
    return saved(figure, "svg", TITLE).decode()
