"""A matrix of hard cases as the page gets it: real runs of shipped scenes, some of which fail."""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np

from analytic.kinematics import solve
from models.array import Array
from models.files import load_scene
from models.scene import Scene
from reports.drawing.moving import INSTANTS, displacements, drawing, moving_points
from reports.output.provenance import provenance
from reports.stability.matrix import CaseFacts, Critical, Graded, Matrix, Outcome, Picture
from sim.engine import Run
from sim.run import run

LINES = tuple((e, p) for e in ("mujoco", "pymunk") for p in ("as-shipped", "tuned"))
STEPS = (360.0, 90.0, 30.0, 12.0)
BETWEEN = 60.0
"""A value that stands for one that a bisection looked at."""
WITHIN = 1e-2
SCENES = {
    "fourbar-lecture-1": ("Large steps", "Crank-rocker in ever larger steps"),
    "slider-crank-offset": ("Large steps", "Offset slider-crank in ever larger steps"),
    "shaper": ("Heavy slides", "Shaper: a heavy ram on a slotted lever"),
}


def case_of(name: str) -> CaseFacts:
    group, title = SCENES[name]
    return CaseFacts(
        name=f"{name}-steps",
        group=group,
        title=title,
        source=load_scene(name).source,
        truth="The closed form at every instant.",
        expected="follows, with an error that falls with the square of the step",
        parameter="steps in a turn",
        unit="",
        values=STEPS,
        labels=tuple(f"{value:g}" for value in STEPS),
        good=("ok",),
        within=WITHIN,
    )


def graded(name: str, engine: str, profile: str, steps: float) -> tuple[Graded, Picture | None]:
    """Two turns of a scene in so many steps each, graded by its error alone."""
    scene, case = load_scene(name), case_of(name)
    dt_s = scene.driver.law.period_s / steps
    state = solve(scene, np.zeros(1)).state()
    done = run(scene, state, engine, profile, dt_s=dt_s, steps=round(2 * steps))
    error = _place(scene, done)
    outcome: Outcome = "ok" if error <= WITHIN else "degraded"
    if done.status == "diverged" or not error < 1.0:
        outcome = "diverged"
    found = Graded(
        case=case.name,
        engine=engine,
        profile=profile,
        value=steps,
        label=f"{steps:g}",
        outcome=outcome,
        reason=done.reason or ("" if outcome == "ok" else f"place is off by {error:.2g}"),
        error=error,
        gap=max(float(np.max(np.abs(gap))) for gap in done.gaps.values()) / scene.longest_m,
        drive=0.0,
        sine=0.7,
        at_s=math.nan if outcome == "ok" else 0.4,
        at_driver_rad=math.nan if outcome == "ok" else 4.0,
        steps=round(2 * steps),
        dt_s=dt_s,
        wall_s=0.01,
        grid=steps != BETWEEN,
    )
    return found, None if outcome == "ok" else _picture(scene, found, done)


def _place(scene: Scene, done: Run) -> float:
    truth = solve(scene, done.motion.time_s, bound=False)
    off = [done.motion.points[p].position - truth.points[p].position for p in moving_points(scene)]
    return float(np.max(np.abs(off))) / scene.longest_m


def _picture(scene: Scene, found: Graded, done: Run) -> Picture:
    time_s = done.motion.time_s
    kept = np.unique(np.linspace(0, len(time_s) - 1, INSTANTS).astype(int))
    trace: dict[str, Array] = {"time_s": time_s[kept]}
    for name, point in done.motion.points.items():
        trace[f"x.{name}"], trace[f"y.{name}"] = point.position[kept].T
    for name, link in done.motion.links.items():
        trace[f"theta.{name}"] = link.theta[kept]
    return Picture(
        case=found.case,
        engine=found.engine,
        profile=found.profile,
        value=found.value,
        label=found.label,
        title=f"{scene.name} in {found.label} steps a turn",
        drawing=drawing(scene, time_s[kept]),
        rows=displacements(scene, trace, time_s[kept]),
    )


def critical(case: CaseFacts, runs: list[Graded]) -> Critical:
    """How far one line holds."""
    bad = max((run.value for run in runs if run.outcome != "ok"), default=math.nan)
    good = min((run.value for run in runs if not run.value <= bad), default=math.nan)
    ends = next((run.outcome for run in runs if run.value == bad), "ok")
    words = "nowhere" if math.isnan(good) else f"holds down to {good:g}"
    words += "" if math.isnan(bad) else f"; then {ends}"
    shown = runs[0]
    command = f"crankcheck stability {case.name} --engine {shown.engine}"
    return Critical(case.name, shown.engine, shown.profile, good, bad, ends, words, command)


def matrix(scenes: Mapping[str, object] = SCENES) -> Matrix:
    """The matrix of some scenes in both engines with both profiles."""
    runs: list[Graded] = []
    pictures: list[Picture] = []
    critical_values = []
    for name in scenes:
        for engine, profile in LINES:
            found = [graded(name, engine, profile, steps) for steps in (*STEPS, BETWEEN)]
            runs += [one for one, _ in found]
            pictures += [picture for _, picture in found if picture is not None]
            critical_values.append(critical(case_of(name), [one for one, _ in found]))
    return Matrix(
        facts=provenance({"mujoco": "4.0.0", "pymunk": "7.3.1"}),
        cases=tuple(case_of(name) for name in scenes),
        runs=tuple(runs),
        critical=tuple(critical_values),
        pictures=tuple(pictures),
    )
