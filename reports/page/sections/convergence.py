"""Convergence: the error against the step, with the orders and floors that were fitted."""

from __future__ import annotations

import math

import numpy as np

from reports.output.numbers import error_text
from reports.page.sections.section import Section
from reports.quantities import QUANTITIES
from reports.quantities.quantity import tolerance_name
from reports.results.fits.line import LineFit
from reports.results.lines import Line, lines
from reports.results.overview import Report

SHARES = {
    "L": "of longest link",
    "w": "of crank speed",
    "w^2": "of crank speed squared",
    "F": "of largest reaction",
    "F L": "of largest reaction at longest link",
    "M": "of largest torque",
    "T": "of largest kinetic energy",
}
DIAGRAMS = {"place_pure": ("place", "rad, or of longest link")} | {
    f"{tolerance_name(entry.name, each.source)}_pure".replace("-", "_"): (
        each.diagram,
        SHARES.get(entry.share, entry.share),
    )
    for entry in sorted(QUANTITIES.values(), key=lambda entry: entry.role == "drive")
    for each in entry.criteria
    if each.diagram
}
"""What may be drawn, by column of the store: its name, and its unit."""
CURVE = 25
"""Points of a fitted curve."""


def build(report: Report) -> Section:
    """The section."""
    names = {
        name: words
        for name, (words, _) in DIAGRAMS.items()
        if name in report.cells and report.cells[name].notna().any()
    }
    curves = {name: [drawn(report, x) for x in _lines(report, name)] for name in names}
    return Section(
        anchor="convergence",
        title="Error against step",
        template="convergence.html",
        words={
            "scenes": list(report.scenes),
            "quantities": names,
            "rows": [_row(report, line) for line in report.lines],
        },
        embedded={"quantities": curves, "units": {name: DIAGRAMS[name][1] for name in names}},
        scripts=("legend.js", "charts.js", "convergence.js"),
        plotly=True,
    )


def _lines(report: Report, quantity: str) -> tuple[Line, ...]:
    return report.lines if quantity == "place_pure" else lines(report.stored, quantity)


def drawn(report: Report, line: Line) -> dict[str, object]:
    """The measured points of a line, and the curve that was fitted to it."""
    fit = line.fit
    runs = [(dt, e) for dt, e in fit.runs if e > 0.0]
    low, high = fit.used_range_s
    steps = np.geomspace(low, high, CURVE) if math.isfinite(low) else np.zeros(0)
    period_s = line.period_s
    curve = [(period_s / dt, fit.error_at(float(dt))) for dt in steps]
    return {
        "scene": line.scene,
        "look": report.look(line).number,
        "steps": [period_s / dt for dt, _ in runs],
        "error": [e for _, e in runs],
        "curve": [list(point) for point in curve if point[1] is not None],
        "floor": fit.floor,
        "words": line.words,
        "label": _label(fit),
    }


def _label(fit: LineFit) -> str:
    """What the legend says of a line."""
    if fit.kind == "floor":
        return f"floor {error_text(fit.floor)}"
    return f"order {fit.order:.2f}" if fit.kind == "order" else fit.kind


def _row(report: Report, line: Line) -> dict[str, object]:
    """A line of the table of fits."""
    fit = line.fit
    return {
        "scene": line.scene,
        "look": report.look(line),
        "order": fit.order,
        "order_told": _order(fit.order, fit.order_error),
        "floor": fit.floor if math.isfinite(fit.floor) else fit.floor_below,
        "floor_told": _floor(fit.floor, fit.floor_below),
        "finest": fit.runs[0][1] if fit.runs else math.nan,
        "words": line.words,
    }


def _order(order: float, error: float) -> str:
    """The order with what it is uncertain by."""
    if not math.isfinite(order):
        return "\N{EN DASH}"
    doubt = f" \N{PLUS-MINUS SIGN} {error:.2f}" if math.isfinite(error) else ""
    return f"{order:.2f}{doubt}"


def _floor(floor: float, below: float) -> str:
    """The floor, or the largest that there may be."""
    if math.isfinite(floor):
        return error_text(floor)
    return f"below {error_text(below)}" if math.isfinite(below) else "\N{EN DASH}"
