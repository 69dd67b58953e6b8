"""Work-precision: the error against what it costs, on each scene and over all of them."""

from __future__ import annotations

import math
from collections.abc import Sequence

import pandas as pd

from reports.output.numbers import count
from reports.page.sections.section import Section
from reports.results.candidates import Candidate
from reports.results.cost import MEANS, Costs
from reports.results.lines import Line
from reports.results.overview import Report
from reports.results.pareto import front, front_over_all
from reports.way.result_kind import TARGETS

ALL = "all scenes"


def build(report: Report) -> Section:
    """The section."""
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
    """What a variant costs, as a row: times [s], and on how many scenes where not on all."""
    to = [(_known(costs.s_to[target]), costs.part(costs.reached[target])) for target in TARGETS]
    return {
        "look": report.looks[costs.engine, costs.variant, costs.drive],
        "s_per_step": _known(1e-6 * costs.us_per_step),
        "s_per_step_median": _known(1e-6 * costs.us_per_step_median),
        "part": costs.part(costs.timed),
        "to": to,
    }


def _known(number: float) -> float | None:
    """A number; None where there is none."""
    return number if math.isfinite(number) else None


def _scene(report: Report, scene: str) -> dict[str, object]:
    """The lines of one scene, and which of their cells nothing beats."""
    lines = report.lines_of(scene)
    cells = pd.concat([line.cells for line in lines])
    return {
        "name": scene,
        "lines": [_line(report, line) for line in lines],
        "front": _points(cells.set_index("key").loc[front(cells)]),
    }


def _line(report: Report, line: Line) -> dict[str, object]:
    """The cells of a line that ended well."""
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


def _points(cells: pd.DataFrame) -> dict[str, object]:
    """The corners of a front, from the cheapest on."""
    ordered = cells.sort_values("s_per_turn")
    return {"error": list(ordered["place_pure"]), "s_per_turn": list(ordered["s_per_turn"])}


def _over_all(report: Report) -> dict[str, object]:
    """Each set of settings over all scenes: its worst error against its mean cost."""
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
    """One set of settings at every step that ended well on all scenes."""
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
