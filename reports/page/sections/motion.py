"""Scene by scene: the mechanism in motion with the engines over it, and its error by parts."""

import json
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from analytic.structure.mobility import analyse
from models.array import Array
from models.errors import CrankcheckError
from models.scene import Scene
from reports.describe.facts import describe_law, facts
from reports.drawing import moving
from reports.output.numbers import floor_words
from reports.page.sections import cell
from reports.page.sections.section import BUDGET, Section, chosen, steps_held
from reports.results.error_parts import CurveBody, ErrorParts, Split, split, worst_body
from reports.results.lines import Line
from reports.results.overview import Report

CURVES = 5
"""Curves of a cell: total, drive, floor, discretisation and gap; then those of the other bodies."""
SCRIPTS = (
    *("legend.js", "charts.js", "mechanism.js", "stage.js", "parts.js", "copying.js"),
    *("cell.js", "motion.js"),
)


def build(report: Report, room: int = BUDGET) -> Section | None:
    """Return the section; None where no scene of the store can be drawn."""
    scenes = [scene for scene in report.scenes.values() if scene is not None]
    if not scenes:
        return None
    sizes = {key: size for scene in scenes for key, size in _sizes(report, scene).items()}
    steps = steps_held(sizes, report.lines, room)
    return Section(
        anchor="motion",
        title="Scene by scene",
        template="motion.html",
        words={
            "scenes": [scene_words(scene) for scene in scenes],
            "thinned": steps < max(len(line.cells) for line in report.lines),
            "held": steps,
        },
        embedded={
            "scenes": [_DrawnScene(report, scene, sizes, steps).embedded() for scene in scenes],
            "judged": sorted(
                {report.look(x).number for x in report.lines if x.cells["gated"].all()}
            ),
            **cell.words_of(report),
        },
        scripts=SCRIPTS,
        plotly=True,
    )


def _sizes(report: Report, scene: Scene) -> dict[str, int]:
    """Return the size of each traced cell of a scene in the page [characters], by key."""
    keys = [str(key) for line in report.lines_of(scene.name) for key in line.cells["key"]]
    traces = {key: report.stored.trace(key) for key in keys}
    more = CURVES + len(scene.links)
    return {
        key: moving.size_of_drawing(scene, len(one["time_s"]), more)
        for key, one in traces.items()
        if one
    }


def scene_words(scene: Scene) -> dict[str, object]:
    """Return a scene in words: its source, its driver, and its facts from theory."""
    try:
        theory = facts(scene, analyse(scene))
    except CrankcheckError:
        theory = []
    return {
        "name": scene.name,
        "source": scene.source,
        "note": scene.note,
        "driver": f"{scene.driver.joint}, {describe_law(scene)}",
        "facts": theory,
    }


@dataclass(frozen=True)
class _DrawnScene:
    """A scene on its way into the page. Cells with the same instants share one axis."""

    report: Report
    scene: Scene
    sizes: dict[str, int]
    held: int
    axes: dict[str, int] = field(default_factory=dict)

    def embedded(self) -> dict[str, object]:
        lines = self.report.lines_of(self.scene.name)
        time_s = self._instants(lines)
        body = worst_body(lines, self.report.stored.trace, self.scene.longest_m)
        drawn = [self._line(line, time_s, body) for line in lines]
        return {
            "drawing": moving.drawing(self.scene, time_s),
            "body": None if body is None else {"name": body.name, "turns": body.scale == 1.0},
            "lines": drawn,
            "axes": [json.loads(axis) for axis in self.axes],
        }

    def _instants(self, lines: Sequence[Line]) -> Array:
        """Return the instants of the drawing: of a run that ended well, if there is one."""
        trace = self.report.stored.trace
        times = [
            trace(str(key)).get("time_s", np.zeros(0))
            for line in lines
            for key in line.cells["key"][line.cells["status"] == "ok"]
        ]
        longest = max(times, key=len, default=np.zeros(0))
        return longest if len(longest) > 1 else moving.instants(self.scene)

    def _line(self, line: Line, time_s: Array, body: CurveBody | None) -> dict[str, object]:
        trace = self.report.stored.trace
        parts = None if body is None else split(line, trace, body, self.scene.longest_m)
        drawn = {
            key: {
                "off": moving.displacements(self.scene, trace(key), time_s),
                "parts": self._parts(parts.cells.get(key), trace(key)) if parts else None,
            }
            for key in chosen(line, self.sizes, self.held)
        }
        return {
            "look": self.report.look(line).number,
            "command": cell.command(line),
            "floor": "" if parts is None else _floor(parts),
            "cells": [
                cell.cell_facts(line, row)
                | drawn.get(str(row["key"]), {"off": None, "parts": None})
                for row in line.cells.to_dict("records")
            ],
        }

    def _parts(
        self, parts: ErrorParts | None, trace: Mapping[str, Array]
    ) -> dict[str, object] | None:
        if parts is None:
            return None
        axis = json.dumps(self._axis(parts), default=float)
        shared = np.isin(trace["time_s"], parts.time_s)
        curves = dict(parts.curves)
        for series, values in trace.items():
            if series.startswith(("angle.", "displacement.")):
                scale = 1.0 if series.startswith("angle.") else self.scene.longest_m
                curves[CurveBody(series, scale).name] = values[shared] / scale
        return {
            "names": list(curves),
            "curves": moving.packed(np.vstack(list(curves.values()))),
            "axis": self.axes.setdefault(axis, len(self.axes)),
        }

    def _axis(self, parts: ErrorParts) -> dict[str, object]:
        """Return the driver's place [deg or m], from the first turn on, and the period part [%]."""
        part = (parts.time_s - parts.time_s[0]) / self.scene.driver.law.period_s
        return {
            "angle": [round(float(a), 6) for a in moving.told_places(self.scene, parts.driver_rad)],
            "part": [round(100.0 * float(p), 3) for p in part],
        }


def _floor(found: Split) -> str:
    if not math.isfinite(found.floor):
        return f"Model floor not separated: {found.why}." if found.why else ""
    floor = floor_words(found.floor if found.seen else math.nan, found.doubt)
    return f"Extrapolated to a step of zero: {floor}."
