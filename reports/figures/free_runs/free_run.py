"""What the figures of free runs are drawn of: of each line its finest run that ended well."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from models.array import Array
from models.scene import Scene
from reports.compare.free.energy_drift import window_means
from reports.compare.last_turn import Trace
from reports.describe.facts import describe_law
from reports.drawing.shape import true_motion
from reports.figures.marks import Mark, marks
from reports.output.numbers import duration
from reports.results.lines import named
from reports.results.origin import notes
from reports.results.overview import Report

INSTANTS = 2401
"""At which the truth is drawn."""
BETWEEN = 8
"""Parts of the way from one sample to the next in a phase diagram."""
TURNS = 4
"""From so many turns on, angles are told in turns."""


@dataclass(frozen=True)
class FreeRun:
    """A run with its name, its step [s] and its look; series over ``time_s``, (T,)."""

    name: str
    dt_s: float
    mark: Mark
    trace: Trace

    @property
    def time_s(self) -> Array:
        return self.trace["time_s"]

    @property
    def angle(self) -> Array:
        """The driver's angle [rad], its turns counted as the truth counts them."""
        return self.trace["driver_rad"] + self.trace["phase"]

    @property
    def energy(self) -> Array | None:
        """What the energy changed by since the start, over the largest kinetic energy; None where
        the engine has none."""
        if "energy" not in self.trace:
            return None
        largest = float(np.max(self.trace["kinetic"]))
        return self.trace["energy"] / largest if largest > 0.0 else None

    def portrait(self) -> tuple[Array, Array]:
        """Angle [rad] and angular velocity [rad/s] between the samples as well: cubics with the
        logged angles and speeds at both of their ends (Hermite)."""
        t, angle, omega = self.time_s, self.angle, self.trace["omega"]
        h, share = np.diff(t)[:, None], np.linspace(0.0, 1.0, BETWEEN, endpoint=False)
        a, v, w = angle[:-1, None], omega[:-1, None] * h, omega[1:, None] * h
        rise = np.diff(angle)[:, None]
        c, d = 3.0 * rise - 2.0 * v - w, v + w - 2.0 * rise
        places = a + share * (v + share * (c + share * d))
        speeds = (v + share * (2.0 * c + share * 3.0 * d)) / h
        return np.append(places, angle[-1]), np.append(speeds, omega[-1])

    def energy_means(self, scene: Scene) -> Array:
        """The energy as means over the windows of its drift, NaN at both ends."""
        assert self.energy is not None
        return window_means(scene, self.time_s, self.energy)


@dataclass(frozen=True)
class FreeRuns:
    """The runs of a scene beside the truth, whose driver has ``angle`` [rad] and ``omega`` at
    ``time_s``."""

    scene: Scene
    runs: tuple[FreeRun, ...]
    time_s: Array
    angle: Array
    omega: Array
    notes: tuple[str, ...]

    @property
    def unit(self) -> tuple[str, float]:
        """What angles are told in: its name, and its size [rad]."""
        if float(np.ptp(self.angle)) > TURNS * math.tau:
            return "turns", math.tau
        return "deg", math.radians(1.0)

    @property
    def steps(self) -> str:
        """The steps of the runs, in words."""
        return " and ".join(duration(dt) for dt in sorted({run.dt_s for run in self.runs}))


def free_runs(report: Report, name: str) -> FreeRuns | None:
    """The runs of a scene; None where the store has no scene, or no run of it with its course."""
    scene = report.scenes[name]
    mark_of = marks(report.lines)
    lines = [line for line in report.free_lines if line.scene == name]
    runs = []
    for line in lines:
        done = line.cells[line.cells["status"] == "ok"]
        traced = [
            (float(dt_s), report.stored.trace(str(key)))
            for key, dt_s in done[["key", "dt_s"]].itertuples(index=False)
        ]
        traced = [(dt, trace) for dt, trace in traced if "phase" in trace]
        if traced:
            dt_s, trace = traced[-1]
            runs.append(FreeRun(report.look(line).name, dt_s, mark_of[named(line)], trace))
    if scene is None or not runs:
        return None
    time_s = np.linspace(0.0, max(float(run.time_s[-1]) for run in runs), INSTANTS)
    driver = true_motion(scene, time_s).links[scene.driver.link]
    start = f"{scene.driver.link} {describe_law(scene)}."
    told = (start, *notes(report, lines))
    return FreeRuns(scene, tuple(runs), time_s, driver.theta, driver.omega, told)
