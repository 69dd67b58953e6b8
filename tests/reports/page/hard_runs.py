"""A matrix of hard cases as the page gets it: real runs of shipped scenes, some of which fail."""

import itertools
import math

import numpy as np

from analytic.kinematics import solve
from models.array import Array
from models.files.reading import load_scene
from models.scene import Scene
from reports.drawing.moving import INSTANTS, displacements, drawing, moving_points
from reports.output.write import provenance
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
        name=f"{name}-steps", group=group, title=title, source=load_scene(name).source,
        truth="The closed form at every instant.",
        expected="follows, with an error that falls with the square of the step",
        parameter="steps in a turn", unit="", values=STEPS,
        labels=tuple(f"{value:g}" for value in STEPS), good=("ok",), within=WITHIN,
    )  # fmt: skip


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
    gap = max(float(np.max(np.abs(gap))) for gap in done.gaps.values()) / scene.longest_m
    at_s, at_rad = (math.nan, math.nan) if outcome == "ok" else (0.4, 4.0)
    found = Graded(
        case=case.name, engine=engine, profile=profile, value=steps, label=f"{steps:g}",
        outcome=outcome,
        reason=done.reason or ("" if outcome == "ok" else f"place is off by {error:.2g}"),
        error=error, gap=gap, drive=0.0, sine=0.7, at_s=at_s, at_driver_rad=at_rad,
        steps=round(2 * steps), dt_s=dt_s, wall_s=0.01, grid=steps != BETWEEN,
    )  # fmt: skip
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
    title = f"{scene.name} in {found.label} steps a turn"
    drawn, rows = drawing(scene, time_s[kept]), displacements(scene, trace, time_s[kept])
    named = {k: getattr(found, k) for k in ("case", "engine", "profile", "value", "label")}
    return Picture(**named, title=title, drawing=drawn, rows=rows)


def critical(case: CaseFacts, runs: list[Graded]) -> Critical:
    bad = max((run.value for run in runs if run.outcome != "ok"), default=math.nan)
    good = min((run.value for run in runs if not run.value <= bad), default=math.nan)
    ends = next((run.outcome for run in runs if run.value == bad), "ok")
    words = "nowhere" if math.isnan(good) else f"holds down to {good:g}"
    words += "" if math.isnan(bad) else f"; then {ends}"
    engine, profile = runs[0].engine, runs[0].profile
    command = f"crankcheck stability {case.name} --engine {engine}"
    return Critical(case.name, engine, profile, good, bad, ends, words, command)


def matrix() -> Matrix:
    runs, pictures, ends = [], [], []
    cases = {name: case_of(name) for name in SCENES}
    for name, (engine, profile) in itertools.product(SCENES, LINES):
        found = [graded(name, engine, profile, steps) for steps in (*STEPS, BETWEEN)]
        runs += [one for one, _ in found]
        pictures += [picture for _, picture in found if picture is not None]
        ends.append(critical(cases[name], [one for one, _ in found]))
    facts = provenance({"mujoco": "4.0.0", "pymunk": "7.3.1"})
    return Matrix(facts, tuple(cases.values()), tuple(runs), tuple(ends), tuple(pictures))
