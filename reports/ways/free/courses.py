"""Runs of free motion on their way into the page: drawings of the scene, and curves over time."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from models.array import Array
from models.errors import CrankcheckError
from models.motion import Motion
from models.scene import Scene
from reports.compare.free_facts import window_means
from reports.drawing import moving, shape
from reports.output.numbers import duration
from reports.page.sections.section import chosen
from reports.results.lines import Line
from reports.results.overview import Report

INSTANTS = 721
"""Instants of the drawing, over the whole motion."""
CURVES = 5
"""Curves of a run: phase, sensitivity, angular velocity, energy and its means."""
SHORTEST_MS, LONGEST_MS = 4000.0, 20000.0
"""Bounds on the time of one round of the drawing [ms]."""


def sizes_of(report: Report, lines: Sequence[Line]) -> dict[str, int]:
    """Return the size of each traced cell in the page [characters], by key."""
    sizes = {}
    for line in lines:
        scene = report.scenes[line.scene]
        drawn = moving.size_of_drawing(scene, INSTANTS) if scene else 0
        for key in map(str, line.cells["key"]):
            trace = report.stored.trace(key)
            if "phase" in trace:
                sizes[key] = drawn + moving.size_of(CURVES, len(trace["time_s"]))
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
        keys = [key for line in lines for key in map(str, line.cells["key"]) if key in self.sizes]
        ends = [float(self.report.stored.trace(key)["time_s"][-1]) for key in keys]
        lasts_s = max(ends, default=1.0)
        time_s = np.linspace(0.0, lasts_s, INSTANTS)
        truth = self._truth(time_s) if ends else None
        drawn: dict[str, object] = {"drawing": None, "truth": None}
        if self.scene is not None and truth is not None:
            driver = truth.links[self.scene.driver.link]
            courses = np.vstack([driver.theta / math.tau, driver.omega])  # turns, rad/s
            drawing = moving.drawing(self.scene, time_s, truth) | {"until_s": lasts_s}
            truths = {"time_s": time_s, "curves": moving.packed(courses)}
            drawn = {"drawing": drawing, "truth": truths}
        return drawn | {
            "name": self.name,
            "lasts_ms": float(np.clip(1000.0 * lasts_s, SHORTEST_MS, LONGEST_MS)),
            "lines": [self._line(line, time_s, truth) for line in lines if line in own],
        }

    def _truth(self, time_s: Array) -> Motion | None:
        try:
            return None if self.scene is None else shape.true_motion(self.scene, time_s)
        except CrankcheckError:
            return None

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
        curves = _curves(self.scene, trace)
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


def _curves(scene: Scene | None, trace: Mapping[str, Array]) -> dict[str, Array]:
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
