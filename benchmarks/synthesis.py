"""What synthesis costs: bodies in three positions, beside pylinkage, and a path of 50 points.

Prints mechanisms a second: of three-position tasks with two moving pivots, proposed (two circles
and the tables of a scene) and examined by the reference (assembled, looked at for defects over the
driver's whole way), and pylinkage's `motion_generation` on the same positions, which tries moving
pivots of its own and checks each four-bar by its lengths. Then how near, and in which time, least
squares comes to 50 points of a known coupler curve, plain and blurred. About a minute. It judges
nothing and exits with 0.
"""

import sys

sys.path.pop(0)  # this folder, whose logging.py would hide the standard library's

import gc
import math
import time
from collections.abc import Callable

import numpy as np

from analytic.lectures.synthesis.coupler import coupler_proposals
from analytic.lectures.synthesis.examine import examine
from analytic.lectures.synthesis.path.search import generate
from analytic.lectures.synthesis.path.task import PathTask
from analytic.lectures.synthesis.solutions import solutions_of
from models.lectures.tasks.positions import CouplerTask
from reports.output.write import provenance

TASKS, SEED = 100, 19
POINTS, BLUR = 50, 1e-3


def three_positions(count: int) -> list[CouplerTask]:
    """Random bodies that go on and turn one way."""
    draw = np.random.default_rng(SEED)
    tasks = []
    for _ in range(count):
        way = np.cumsum(draw.uniform(0.1, 0.5, (3, 2)), axis=0)
        turns = np.cumsum(draw.uniform(5.0, 50.0, 3))
        positions = [
            {"point_m": [float(x), float(y)], "angle_deg": float(turn)}
            for (x, y), turn in zip(way, turns, strict=True)
        ]
        moving = [[float(x) for x in draw.uniform(-1.0, 1.0, 2)] for _ in range(2)]
        table = {"name": "x", "source": "a benchmark", "positions": positions, "moving_m": moving}
        tasks.append(CouplerTask.model_validate(table))
    return tasks


def timed(work: Callable[[], int]) -> float:
    """Mechanisms a second of work that says how many it made: the best of three."""
    rates = []
    gc.disable()
    for _ in range(3):
        began = time.perf_counter()
        made = work()
        rates.append(made / (time.perf_counter() - began))
    gc.enable()
    return max(rates)


def proposed(tasks: list[CouplerTask]) -> int:
    return sum(len(coupler_proposals(task)[0]) for task in tasks)


def examined(tasks: list[CouplerTask]) -> int:
    return sum(len([examine(one) for one in coupler_proposals(task)[0]]) for task in tasks)


def pylinkages(tasks: list[CouplerTask]) -> int:
    """Four-bars of pylinkage for the same positions, ten for each task."""
    from pylinkage.synthesis import Pose, motion_generation

    made = 0
    for task in tasks:
        poses = [Pose(place.real, place.imag, angle) for place, angle in task.poses]
        made += len(motion_generation(poses, require_grashof=False, max_solutions=10).solutions)
    return made


def path() -> PathTask:
    """Points of the coupler curve of a crank-rocker 0.1, 0.25, 0.2, 0.3 m, evenly over the crank's
    turn."""
    crank = 0.1 * np.exp(2j * np.pi * np.arange(POINTS) / POINTS)
    arm = 0.3 - crank
    turn = np.arccos((np.abs(arm) ** 2 + 0.25**2 - 0.2**2) / (2.0 * np.abs(arm) * 0.25))
    places = crank + arm / np.abs(arm) * np.exp(1j * turn) * (0.12 + 0.08j)
    return PathTask(tuple(places.tolist()), closed=True)


def blurred(task: PathTask) -> PathTask:
    draw = np.random.default_rng(SEED)
    off = draw.normal(0.0, BLUR * task.radius_m, (POINTS, 2)) @ np.array([1.0, 1.0j])
    return PathTask(tuple((task.array + off).tolist()), closed=True)


def main() -> None:
    tasks = three_positions(TASKS)
    solutions_of(tasks[0])  # imports, and what is kept
    rates = {
        "proposed": timed(lambda: proposed(tasks)),
        "proposed and examined": timed(lambda: examined(tasks)),
    }
    try:
        rates["pylinkage motion_generation"] = timed(lambda: pylinkages(tasks))
    except ImportError:
        print("no pylinkage: pip install --group benchmark\n")
    print(f"three positions, {TASKS} tasks{'':<12}mechanisms a second   over ours, examined")
    for name, rate in rates.items():
        print(f"{name:<34}{rate:>12.0f}{rate / rates['proposed and examined']:>24.2f}")
    print(f"\npath of {POINTS} points, 48 starts{'':<12}time s   RMS over its radius   mechanisms")
    for name, task in (("of a coupler curve", path()), (f"blurred by {BLUR:g}", blurred(path()))):
        began = time.perf_counter()
        search = generate(task, time_s=math.inf)
        took = time.perf_counter() - began
        rms = search.fits[0].rms_m / task.radius_m
        print(f"{name:<34}{took:>12.1f}{rms:>22.1e}{len(search.fits):>13}")
    facts = provenance({})
    print("\n" + ", ".join(f"{name} {value}" for name, value in facts.items() if name != "made"))


if __name__ == "__main__":
    main()
