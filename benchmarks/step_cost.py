"""Measure what the models of `sim.registry.offers` need: ``python -m benchmarks.step_cost``.

Every shipped scene at constant speed is timed in all engines, with settings that differ in what
they ask for; each is timed in several rounds, far apart, and the least time counts. Takes some
minutes on a machine that does nothing else.
"""

import statistics
from collections.abc import Iterator, Sequence
from contextlib import closing

import numpy as np

from analytic.kinematics import solve
from models.files.reading import load_scene, shipped
from models.motion import State
from models.scene import Scene
from models.scene.laws import ConstantSpeed
from reports.judge.cell import Cell
from reports.sweep.measured import Repeats, timed_in_turns
from reports.tune.attempt import GUESS_US
from reports.workers.isolated import Isolated, Limits
from sim.engine import Settings
from sim.exudyn import knobs as exudyn_knobs
from sim.exudyn.settings import JACOBIANS
from sim.exudyn.settings import TUNED as EXUDYN_TUNED
from sim.mujoco import knobs as mujoco_knobs
from sim.mujoco.knobs import EVALUATIONS
from sim.pymunk import knobs as pymunk_knobs
from sim.pymunk.knobs import PASS_US

ROUNDS = 12
STEPS_PER_TURN = 720.0
ITERATIONS = (2, 10, 50, 150)
TOLERANCES = (1e-4, 1e-8)
Point = tuple[Scene, str, Settings]


def points() -> list[Point]:
    """What is timed: scene, engine, settings over those of profile tuned."""
    scenes = [scene for name in shipped() if _steady(scene := load_scene(name))]
    found: list[Point] = []
    for scene in scenes:
        found += [(scene, "mujoco", {"integrator": name}) for name in EVALUATIONS]
        found += [(scene, "mujoco", {"iterations": number}) for number in (1, 100)]
        found += [
            (scene, "exudyn", {"jacobian": name, "relative_tolerance": tolerance})
            for name in JACOBIANS
            for tolerance in TOLERANCES
        ]
        found += [
            (scene, "pymunk", {"iterations": number, "lines": lines})
            for number in ITERATIONS
            for lines in ("groove", "exact")
        ]
    return found


def _steady(scene: Scene) -> bool:
    """A scene of constant speed: no part of a step's time is the drive's."""
    return isinstance(scene.driver.law, ConstantSpeed)


def start(scene: Scene) -> State:
    """The scene assembled."""
    return solve(scene, np.zeros(1)).state()


def measure(what: Sequence[Point], rounds: int = ROUNDS) -> list[float]:
    """The least time of each point in all rounds [microseconds per step]; NaN where it is lost."""
    cells = [
        (Cell(scene, engine, "tuned", dt_s, 1, converge=False, settings=settings), GUESS_US)
        for scene, engine, settings in what
        for dt_s in [scene.driver.law.period_s / STEPS_PER_TURN]
    ]
    with closing(Isolated[Repeats](Limits())) as isolated:
        timings = timed_in_turns(isolated, cells, rounds)
    return [float("nan") if each is None else min(*each[0], *each[1]) for each in timings]


def fit(counts: Sequence[Sequence[float]], us: Sequence[float]) -> list[float]:
    """What each count takes [microseconds], for the least relative error."""
    rows = np.asarray(counts, dtype=np.float64) / np.asarray(us)[:, None]
    return [float(x) for x in np.linalg.lstsq(rows, np.ones(len(rows)), rcond=None)[0]]


def mujoco(what: Sequence[Point], us: Sequence[float]) -> Iterator[str]:
    """The constants of `sim.mujoco.knobs` as text."""
    known = [(p, t) for p, t in zip(what, us, strict=True) if p[1] == "mujoco" and t == t]
    euler = {p[0].name: t for p, t in known if p[2].get("integrator") == "Euler"}
    scenes = {p[0].name: p[0] for p, _ in known}
    ratio = {
        name: statistics.median(
            t / euler[p[0].name] for p, t in known if p[2].get("integrator") == name
        )
        for name in EVALUATIONS
    }
    yield f"EVALUATIONS = { ({k: round(v, 2) for k, v in ratio.items()}) }"
    rows = [(p[0], t / ratio[str(p[2]["integrator"])]) for p, t in known if "integrator" in p[2]]
    counts = {name: mujoco_knobs.counts(scene, start(scene)) for name, scene in scenes.items()}
    found = fit([counts[scene.name] for scene, _ in rows], [t for _, t in rows])
    yield "STEP_US, BODY_US, LOOP_US = " + ", ".join(f"{x:.3f}" for x in found)
    model = [float(np.dot(counts[scene.name], found)) / t for scene, t in rows]
    yield _off(model)
    tuned = {p[0].name: t for p, t in known if p[2].get("integrator") == "RK4"}
    for number in (1, 100):
        share = [t / tuned[p[0].name] for p, t in known if p[2].get("iterations") == number]
        yield f"# a limit of {number} iterations over one of 2: {statistics.median(share):.3f}"


def pymunk(what: Sequence[Point], us: Sequence[float]) -> Iterator[str]:
    """The constants of `sim.pymunk.knobs` as text."""
    rows, times = [], []
    for (scene, engine, settings), t in zip(what, us, strict=True):
        if engine == "pymunk" and t == t:
            step, body, kinds = pymunk_knobs.counts(
                scene, start(scene), settings["lines"] == "exact"
            )
            passes = [float(settings["iterations"]) * kinds[name] for name in PASS_US]
            rows.append([step, body, kinds["PinJoint"], *passes])
            times.append(t)
    found = fit(rows, times)
    yield "STEP_US, BODY_US, RAIL_US = " + ", ".join(f"{x:.3f}" for x in found[:3])
    each = {name: round(us_pass, 5) for name, us_pass in zip(PASS_US, found[3:], strict=True)}
    yield f"PASS_US = {each}"
    yield _off([float(np.dot(row, found)) / t for row, t in zip(rows, times, strict=True)])


def exudyn(what: Sequence[Point], us: Sequence[float]) -> Iterator[str]:
    """The constants of `sim.exudyn.knobs` as text."""
    tuned = {name: setting.value for name, setting in EXUDYN_TUNED.settings.items()}
    known = [(p, t) for p, t in zip(what, us, strict=True) if p[1] == "exudyn" and t == t]
    rows = [exudyn_knobs.counts(scene, {**tuned, **settings}) for (scene, _, settings), _ in known]
    times = [t for _, t in known]
    found = fit(rows, times)
    yield "STEP_US, ITERATION_US, MATRIX_US = {:.3f}, {:.3f}, {:.4f}".format(*found)
    yield _off([float(np.dot(row, found)) / t for row, t in zip(rows, times, strict=True)])


def _off(ratios: Sequence[float]) -> str:
    """How far a model is off."""
    off = np.abs(np.asarray(ratios) - 1.0)
    return f"# off by {np.median(off):.1%} (median), {np.max(off):.1%} (most)"


if __name__ == "__main__":
    asked = points()
    taken = measure(asked)
    for line in (*mujoco(asked, taken), *pymunk(asked, taken), *exudyn(asked, taken)):
        print(line)
