"""Scene by scene: the mechanism in motion with the engines over it; its error or free course."""

import json
import math
import shlex
from collections.abc import Hashable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from analytic.structure.mobility import analyse
from models.array import Array
from models.errors import CrankcheckError
from models.motion import Motion
from models.scene import Scene
from reports.compare.free_facts import window_means
from reports.describe.facts import describe_law, facts
from reports.drawing import moving, shape
from reports.judge.rules import RULES
from reports.output.numbers import duration, floor_words
from reports.page.sections.errors import DIAGRAMS, SHARES
from reports.page.sections.section import BUDGET, Section, chosen, steps_held
from reports.quantities import QUANTITIES
from reports.results.error_parts import CurveBody, ErrorParts, Split, split, worst_body
from reports.results.lines import Line, value_text
from reports.results.overview import Report
from sim.engine.settings import profile_of
from sim.registry import engine

CURVES = 5
"""Curves of a cell: total, drive, floor, discretisation and gap; then those of the other bodies."""


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
            "settings": {
                report.looks[name].number: told for name, told in report.settings_told.items()
            },
            "rules": {name: rule.title for name, rule in RULES.items()},
        },
        scripts=(
            "legend.js",
            "charts.js",
            "mechanism.js",
            "stage.js",
            "parts.js",
            "motion.js",
            "copying.js",
        ),
        plotly=True,
    )


def _sizes(report: Report, scene: Scene) -> dict[str, int]:
    """Return the size of each traced cell of a scene in the page [characters], by key."""
    rows = (
        2 * len(moving.moving_points(scene))
        + len(moving.drawn_links(scene))
        + CURVES
        + len(scene.links)
    )
    traces = {
        str(key): report.stored.trace(str(key))
        for line in report.lines_of(scene.name)
        for key in line.cells["key"]
    }
    return {key: moving.size_of(rows, len(one["time_s"])) for key, one in traces.items() if one}


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
            "floor": "" if parts is None else _floor(parts),
            "command": _command(line),
            "cells": [
                _known(row) | drawn.get(str(row["key"]), {"off": None, "parts": None})
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


def _known(row: Mapping[Hashable, Any]) -> dict[str, object]:
    """Return the facts of a cell: its end, its failed rules, and errors with their limits."""
    limits = {
        name: row.get(name.replace("_pure", "_limit_pure"), math.nan)
        for name in map(str, row)
        if name.endswith("_pure") and not name.endswith("_limit_pure")
    }
    return {
        "steps": row["steps_per_turn"],
        "verdict": row["verdict"] if row["status"] == "ok" else f"{row['status']}: {row['reason']}",
        "failed": str(row.get("failed_rules") or "").replace(",", " ").split(),
        "errors": [
            [*_quantity(name), float(f"{row[name]:.3g}"), _finite(limit)]
            for name, limit in limits.items()
            if math.isfinite(row[name]) and name != "place_pure"  # the worst of angle and place
        ],
    }


def _quantity(column: str) -> tuple[str, str]:
    """Return name and unit of a column of pure errors."""
    if column in DIAGRAMS:
        return DIAGRAMS[column]
    words = column.removesuffix("_pure").replace("_differenced", ", from logged places")
    entry = QUANTITIES.get(words.partition(",")[0])
    return words, SHARES.get(entry.share, entry.share) if entry else ""


def _finite(limit: float) -> float | None:
    return float(f"{limit:.3g}") if math.isfinite(limit) else None


def _command(line: Line) -> str:
    """Return the command that repeats a cell of a line, to which its steps a turn are added; a
    variant with settings of its own names them as differences from its profile."""
    first = line.cells.iloc[0]
    words = ["crankcheck", "sweep", line.scene, "--engine", line.engine]
    words += ["--profile", str(first["profile"]), "--turns", f"{first['turns']:g}", "--no-timing"]
    try:
        usual = dict(profile_of(engine(line.engine), str(first["profile"])).values)
    except CrankcheckError:  # not installed here
        usual = dict(line.settings)
    for name, value in line.settings.items():
        if value != usual.get(name):
            words += ["--set", f"{line.engine}.{name}={value_text(value)}"]
    return shlex.join([*words, "-o", "again", "--steps-per-turn"])


def _floor(found: Split) -> str:
    if not math.isfinite(found.floor):
        return f"Model floor not separated: {found.why}." if found.why else ""
    floor = floor_words(found.floor if found.seen else math.nan, found.doubt)
    return f"Extrapolated to a step of zero: {floor}."


INSTANTS = 721
"""Instants of the drawing, over the whole motion."""
FREE_CURVES = 5
"""Curves of a run: phase, sensitivity, angular velocity, energy and its means."""
SHORTEST_MS, LONGEST_MS = 4000.0, 20000.0
"""Bounds on the time of one round of the drawing [ms]."""


def sizes_of(report: Report, lines: Sequence[Line]) -> dict[str, int]:
    """Return the size of each traced cell in the page [characters], by key."""
    sizes = {}
    for line in lines:
        scene = report.scenes[line.scene]
        rows = (
            0
            if scene is None
            else 2 * len(moving.moving_points(scene)) + len(moving.drawn_links(scene))
        )
        for key in map(str, line.cells["key"]):
            trace = report.stored.trace(key)
            if "phase" in trace:
                sizes[key] = moving.size_of(rows, INSTANTS) + moving.size_of(
                    FREE_CURVES, len(trace["time_s"])
                )
    return sizes


@dataclass(frozen=True)
class FreeCourses:
    """A scene in free motion on its way into the page; of each line ``held`` cells are drawn."""

    report: Report
    name: str
    scene: Scene | None
    sizes: Mapping[str, int]
    held: int
    truths: dict[bytes, Motion] = field(default_factory=dict)
    """Motions by their instants: all engines have the same."""

    def embedded(self) -> dict[str, object]:
        """Return the scene with its drawings; without a drawing where the store has no readable
        text of it, or no run that moved."""
        lines, own = self.report.lines_of(self.name), self.report.of_kind("free")
        time_s = self._instants(lines)
        ran = any(str(key) in self.sizes for line in lines for key in line.cells["key"])
        truth = self._truth(time_s) if ran else None
        lasts_s = float(time_s[-1])
        return {
            "name": self.name,
            "drawing": truth and self._drawing(time_s, truth),
            "lasts_ms": float(np.clip(1000.0 * lasts_s, SHORTEST_MS, LONGEST_MS)),
            "truth": truth and self._driver(time_s, truth),
            "lines": [self._line(line, time_s, truth) for line in lines if line in own],
        }

    def _drawing(self, time_s: Array, truth: Motion) -> dict[str, object]:
        assert self.scene is not None
        return moving.drawing(self.scene, time_s, truth) | {"until_s": float(time_s[-1])}

    def _instants(self, lines: Sequence[Line]) -> Array:
        """Return equal parts of the longest run of a scene."""
        ends = [
            float(self.report.stored.trace(str(key))["time_s"][-1])
            for line in lines
            for key in line.cells["key"]
            if str(key) in self.sizes
        ]
        return np.linspace(0.0, max(ends, default=1.0), INSTANTS)

    def _truth(self, time_s: Array) -> Motion | None:
        try:
            return None if self.scene is None else shape.true_motion(self.scene, time_s)
        except CrankcheckError:
            return None

    def _driver(self, time_s: Array, truth: Motion) -> dict[str, object]:
        """Return angle [turns] and angular velocity of the driver, over time."""
        assert self.scene is not None
        driver = truth.links[self.scene.driver.link]
        return {
            "time_s": time_s,
            "curves": moving.packed(np.vstack([driver.theta / math.tau, driver.omega])),
        }

    def _line(self, line: Line, time_s: Array, truth: Motion | None) -> dict[str, object]:
        steps = dict(zip(line.cells["key"], map(float, line.cells["dt_s"]), strict=True))
        return {
            "look": self.report.look(line).number,
            "cells": [
                {"dt": duration(steps[key]), "dt_s": steps[key]} | self._cell(key, time_s, truth)
                for key in chosen(line, dict(self.sizes), self.held)
            ],
        }

    def _cell(self, key: str, time_s: Array, truth: Motion | None) -> dict[str, object]:
        """Return the error of a run in the drawing, and its curves at its own instants by name."""
        trace = self.report.stored.trace(key)
        curves = run_curves(self.scene, trace)
        off = None
        if self.scene is not None and truth is not None:
            instants = trace["time_s"].tobytes()
            if instants not in self.truths:
                self.truths[instants] = shape.true_motion(self.scene, trace["time_s"])
            off = moving.displacements(self.scene, trace, time_s, self.truths[instants])
        return {
            "off": off,
            "time_s": trace["time_s"],
            "names": list(curves),
            "curves": moving.packed(np.vstack(list(curves.values()))),
        }


def run_curves(scene: Scene | None, trace: Mapping[str, Array]) -> dict[str, Array]:
    """Return the curves of a free run by name: its phase [rad] and phase over the sensitivity, the
    driver's angle [turns] and angular velocity, and the change of its energy over the largest
    kinetic energy, as it is and as means over windows."""
    curves = {"phase": trace["phase"], "phase_judged": trace["phase"] / trace["growth"]}
    if scene is not None and f"theta.{scene.driver.link}" in trace:
        # The log may count its turns from elsewhere: the reference and its error do not.
        curves["angle"] = (trace["driver_rad"] + trace["phase"]) / math.tau
    if "omega" in trace:
        curves["speed"] = trace["omega"]
    largest = float(np.max(trace["kinetic"])) if "kinetic" in trace else 0.0
    if largest > 0.0:
        curves["energy"] = trace["energy"] / largest
        if scene is not None:
            curves["energy_mean"] = window_means(scene, trace["time_s"], curves["energy"])
    return curves
