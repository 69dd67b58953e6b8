"""Figures of a store's free runs beside the reference: per line the finest run that ended well."""

import math
from dataclasses import dataclass

import numpy as np
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import MaxNLocator

from models.array import Array
from models.scene import Scene
from reports.compare import free_facts, last_turn
from reports.describe.facts import describe_law
from reports.drawing.shape import true_motion
from reports.figures.drawing import Mark, around, marks
from reports.figures.sheet import Panels, corner_words, grid, one_scale, sheet, tenfold
from reports.figures.style import INK, PAGE_IN, Look, logarithmic, mark_zero, power_of_ten, shorten
from reports.output.numbers import duration, short
from reports.results.lines import named
from reports.results.overview import Report, notes

INSTANTS = 2401
"""Instants of the drawn reference."""
BETWEEN = 8
"""Parts of the way from one sample to the next in a phase diagram."""
TURNS = 4
"""Number of turns from which on angles are shown in turns."""
TRUTH: Look = {"color": "#cccccc", "linewidth": 3.0}
LEAST = 1e-12
"""Errors of phase below which there is rounding alone."""
RAW: Look = {"linewidth": 0.5}
MEANS: Look = {"linewidth": 1.6}


@dataclass(frozen=True)
class FreeRun:
    """A run with its name, its step [s] and its look; series over ``time_s``, (T,)."""

    name: str
    dt_s: float
    mark: Mark
    trace: last_turn.Trace

    @property
    def time_s(self) -> Array:
        return self.trace["time_s"]

    @property
    def angle(self) -> Array:
        """The driver's angle [rad], its turns counted as in the reference."""
        return self.trace["driver_rad"] + self.trace["phase"]

    @property
    def energy(self) -> Array | None:
        """Change of energy, over the largest kinetic energy; None without energy."""
        if "energy" not in self.trace:
            return None
        largest = float(np.max(self.trace["kinetic"]))
        return self.trace["energy"] / largest if largest > 0.0 else None

    def portrait(self) -> tuple[Array, Array]:
        """Return angle [rad] and angular velocity [rad/s] between the samples as well: cubics with
        the logged angles and speeds at both of their ends (Hermite)."""
        t, angle, omega = self.time_s, self.angle, self.trace["omega"]
        h, share = np.diff(t)[:, None], np.linspace(0.0, 1.0, BETWEEN, endpoint=False)
        a, v, w = angle[:-1, None], omega[:-1, None] * h, omega[1:, None] * h
        rise = np.diff(angle)[:, None]
        c, d = 3.0 * rise - 2.0 * v - w, v + w - 2.0 * rise
        places = a + share * (v + share * (c + share * d))
        speeds = (v + share * (2.0 * c + share * 3.0 * d)) / h
        return np.append(places, angle[-1]), np.append(speeds, omega[-1])


@dataclass(frozen=True)
class FreeRuns:
    """The runs of a scene beside the reference; its driver has ``angle`` [rad] and ``omega``
    [rad/s] at ``time_s``, (T,)."""

    scene: Scene
    runs: tuple[FreeRun, ...]
    time_s: Array
    angle: Array
    omega: Array
    notes: tuple[str, ...]

    @property
    def unit(self) -> tuple[str, float]:
        """Unit of angles: its name, and its size [rad]."""
        if float(np.ptp(self.angle)) > TURNS * math.tau:
            return "turns", math.tau
        return "deg", math.radians(1.0)

    @property
    def steps(self) -> str:
        """Steps of the runs, in words."""
        return " and ".join(duration(dt) for dt in sorted({run.dt_s for run in self.runs}))


def free_runs(report: Report, name: str) -> FreeRuns | None:
    """Return the runs of a scene; None where the store has no scene, or no traced run of it."""
    scene = report.scenes[name]
    mark_of = marks(report.lines)
    lines = [line for line in report.of_kind("let go") if line.scene == name]
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


def courses(report: Report, name: str) -> Figure | None:
    """Draw angle and angular velocity of the driver over time, the runs over the reference, and
    their error; None where nothing of the scene is a free motion."""
    shown = free_runs(report, name)
    if shown is None:
        return None
    entries = [(Line2D([], [], **TRUTH), "truth, integrated")]
    entries += [(Line2D([], [], **run.mark.line), run.name) for run in shown.runs]
    panels = Panels(3, 1, 1.3, 0.55, 0.1, 0.12, between=(0.15, 0.12))
    title = f"Let go: {name}, step {shown.steps}"
    figure, (angle, speed, phase) = sheet(PAGE_IN, panels, title, entries, shown.notes)
    unit, size = shown.unit
    driver = shown.scene.driver.link
    angle.plot(shown.time_s, shown.angle / size, **TRUTH)
    speed.plot(shown.time_s, shown.omega, **TRUTH)
    mark_zero(speed, shown.omega)
    sizes: list[float] = []
    for run in shown.runs:
        line = run.mark.line | {"linewidth": 0.9}
        angle.plot(run.time_s, run.angle / size, **line)
        if "omega" in run.trace:
            speed.plot(run.time_s, run.trace["omega"], **line)
        judged = np.abs(run.trace["phase"] / run.trace["growth"])
        largest = np.maximum.accumulate(np.nan_to_num(judged))
        phase.plot(run.time_s, np.where(judged > 0.0, judged, np.nan), **line | {"linewidth": 0.3})
        phase.plot(run.time_s, np.where(largest > 0.0, largest, np.nan), **line)
        sizes += [float(e) for e in largest[len(largest) // 50 :] if e > LEAST]
    logarithmic(phase, "y", *around(sizes), ticks=6)
    angle.set_ylabel(f"angle of {driver} [{unit}]")
    speed.set_ylabel("speed [rad/s]")
    phase.set_ylabel("error of angle / G [rad]")
    phase.set_xlabel("time [s]; thick: the largest error so far")
    for panel in (angle, speed, phase):
        panel.set_xlim(0.0, float(shown.time_s[-1]))
    for panel in (angle, speed):
        shorten(panel)
        panel.tick_params(labelbottom=False)
    return figure


def energy_change(report: Report, name: str) -> Figure | None:
    """Draw the change of the energy of each run: as it is, and as means over windows, whose last
    less the first is the drift. A panel for each, in its own power of ten; None where none has
    an energy."""
    shown = free_runs(report, name)
    runs = [run for run in shown.runs if run.energy is not None] if shown else []
    if shown is None or not runs:
        return None
    entries = [
        (Line2D([], [], color=INK, **RAW), "energy less the work of loads and dampers, as it is"),
        (Line2D([], [], color=INK, **MEANS), "means over windows"),
    ]
    title = f"Change of energy over the largest kinetic energy: {name}, step {shown.steps}"
    labels = ("time [s]", "change of energy / largest kinetic energy")
    titles = [run.name for run in runs]
    figure, axes = grid(titles, title, labels, entries, shown.notes)
    corners = []
    for run, panel in zip(runs, axes, strict=True):
        assert run.energy is not None
        means = free_facts.window_means(shown.scene, run.time_s, run.energy)  # NaN at both ends
        scale = tenfold(float(np.nanmax(np.abs(run.energy))))
        panel.plot(run.time_s, run.energy / scale, color=run.mark.colour, **RAW)
        panel.plot(run.time_s, means / scale, color=run.mark.colour, **MEANS)
        panel.set_xlim(0.0, float(shown.time_s[-1]))
        known = means[np.isfinite(means)]
        drift = f"drift {short(float(known[-1] - known[0]))}" if known.size else ""
        corners.append((f"[{power_of_ten(scale)}]", drift))
    one_scale(axes)
    for panel, words in zip(axes, corners, strict=True):
        corner_words(panel, 0.18, *words)
    return figure


def phase_diagrams(report: Report, name: str) -> Figure | None:
    """Draw the driver's angular velocity over its angle, of each run over the reference, all with
    the same axes; None where no run has an angular velocity."""
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
