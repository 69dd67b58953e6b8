"""The error against the step, with the fitted orders and floors, and against its cost."""

import math
from collections.abc import Sequence

import numpy as np
import pandas as pd

from reports.output.numbers import count, error_text
from reports.page.sections.section import Section
from reports.protocol.way import FIXED, SHRINKS, TARGETS
from reports.quantities import QUANTITIES, quantity
from reports.results.candidates import MEANS, Candidate, Costs, front, front_over_all
from reports.results.line_fit import LineFit
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
    "D": "of largest deflection",
}
DIAGRAMS = {"place_pure": ("place", "rad, or of longest link")} | {
    f"{quantity.tolerance_name(entry.name, each.source)}_pure".replace("-", "_"): (
        each.diagram,
        SHARES.get(entry.share, entry.share),
    )
    for entry in sorted(QUANTITIES.values(), key=lambda entry: entry.role == "drive")
    for each in entry.criteria
    if each.diagram
}
"""Quantities that can be drawn, by column of the store: name and unit."""
CURVE = 25
"""Points of a fitted curve."""


def convergence(report: Report) -> Section:
    """Return the section on the error against the step."""
    names = {
        name: words
        for name, (words, _) in DIAGRAMS.items()
        if name in report.cells and report.cells[name].notna().any()
    }
    own = {name: lines(report.stored, name) for name in names if name != "place_pure"}
    curves = {name: [drawn(report, x) for x in own.get(name, report.lines)] for name in names}
    faceted = report.over_facets
    if faceted:
        for name in names:
            curves[name] += [drawn(report, x) for x in faceted.of(name)]
    both = [*report.lines, *(faceted.lines if faceted else ())]
    over = {"faceted": list(faceted.scenes)} if faceted else {}
    return Section(
        anchor="convergence",
        title="Error against step",
        template="convergence.html",
        words={
            "scenes": list(dict.fromkeys(line.scene for line in both)),
            "quantities": names,
            "rows": [_row(report, line) for line in both],
        },
        embedded={"quantities": curves, "units": {name: DIAGRAMS[name][1] for name in names}}
        | over,
        scripts=("legend.js", "charts.js", "convergence.js"),
        plotly=True,
    )


def drawn(report: Report, line: Line) -> dict[str, object]:
    """Return the measured points of a line, and the curve that was fitted to it."""
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
    if fit.kind == "floor":
        return f"floor {error_text(fit.floor)}"
    return f"order {fit.order:.2f}" if fit.kind == "order" else fit.kind


def _row(report: Report, line: Line) -> dict[str, object]:
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
    if not math.isfinite(order):
        return "\N{EN DASH}"
    doubt = f" \N{PLUS-MINUS SIGN} {error:.2f}" if math.isfinite(error) else ""
    return f"{order:.2f}{doubt}"


def _floor(floor: float, below: float) -> str:
    if math.isfinite(floor):
        return error_text(floor)
    return f"below {error_text(below)}" if math.isfinite(below) else "\N{EN DASH}"


ALL = "all scenes"


def precision(report: Report) -> Section:
    """Return the section on the error against cost."""
    scenes = [_scene(report, name) for name in report.scenes]
    if len(scenes) > 1:
        scenes.insert(0, _over_all(report))
    lost = report.cells[report.cells["status"] != "ok"]
    return Section(
        anchor="precision",
        title="Error against cost",
        template="precision.html",
        words={
            "scenes": [scene["name"] for scene in scenes],
            "over_all": len(scenes) > 1,
            "timed": report.timed,
            "lost": count(len(lost), "run") if len(lost) else "",
            "targets": TARGETS,
            "fixed": [(target, f"error up to {error_text(target, 1)}") for target in FIXED],
            "shrinks": SHRINKS,
            "costs": [_cost(report, each) for each in report.costs] if report.timed else [],
            "means": MEANS,
        },
        embedded={
            "timed": report.timed,
            "settings": {
                report.looks[name].number: told for name, told in report.settings_told.items()
            },
            "scenes": scenes,
        },
        scripts=("legend.js", "charts.js", "precision.js"),
        plotly=True,
    )


def _cost(report: Report, costs: Costs) -> dict[str, object]:
    """Return the cost of a variant as a row: times [s], and the number of scenes where not all."""
    to = [(_known(costs.s_to[target]), costs.part(costs.reached[target])) for target in TARGETS]
    return {
        "look": report.looks[costs.engine, costs.variant, costs.drive],
        "s_per_step": _known(1e-6 * costs.us_per_step),
        "s_per_step_median": _known(1e-6 * costs.us_per_step_median),
        "part": costs.part(costs.timed),
        "to": to,
    }


def _known(number: float) -> float | None:
    return number if math.isfinite(number) else None


def _scene(report: Report, scene: str) -> dict[str, object]:
    lines = report.lines_of(scene)
    cells = pd.concat([line.cells for line in lines])
    best = cells.set_index("key").loc[front(cells)].sort_values("s_per_turn")
    return {
        "name": scene,
        "lines": [_line(report, line) for line in lines],
        "front": {"error": list(best["place_pure"]), "s_per_turn": list(best["s_per_turn"])},
    }


def _line(report: Report, line: Line) -> dict[str, object]:
    cells = line.cells[(line.cells["status"] == "ok") & (line.cells["place_pure"] > 0.0)]
    return {
        "look": report.look(line).number,
        "error": list(cells["place_pure"]),
        "s_per_turn": list(cells["s_per_turn"]),
        "us_per_step": list(cells["us_per_step"]),
        "steps": list(cells["steps_per_turn"]),
        "within": list(cells["verdict"] == "within"),
        "dt_s": list(cells["dt_s"]),
    }


def _over_all(report: Report) -> dict[str, object]:
    """Return each set of settings over all scenes: its worst error against its mean cost."""
    finite = [one for one in report.candidates if math.isfinite(one.worst_error)]
    groups: dict[int, list[Candidate]] = {}
    for one in finite:
        look = report.looks[one.engine, one.variant, one.drive]
        groups.setdefault(look.number, []).append(one)
    unbeaten = sorted(front_over_all(finite), key=lambda one: one.s_per_turn)
    return {
        "name": ALL,
        "lines": [_group(report, look, group) for look, group in groups.items()],
        "front": {
            "error": [one.worst_error for one in unbeaten],
            "s_per_turn": [one.s_per_turn for one in unbeaten],
        },
    }


def _group(report: Report, look: int, group: Sequence[Candidate]) -> dict[str, object]:
    """Return one set of settings at every step that ended well on all scenes."""
    cells = report.cells
    groups = cells.groupby(["engine", "variant", "drive", cells["steps_per_turn"].round(6)])
    within = groups["verdict"].agg(lambda verdicts: bool((verdicts == "within").all()))
    return {
        "look": look,
        "error": [one.worst_error for one in group],
        "s_per_turn": [one.s_per_turn for one in group],
        "us_per_step": [one.us_per_step for one in group],
        "steps": [one.steps_per_turn for one in group],
        "within": [
            bool(within[one.engine, one.variant, one.drive, one.steps_per_turn]) for one in group
        ],
        "worst": [one.worst_scene for one in group],
    }
