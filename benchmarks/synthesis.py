"""Synthesis: what it costs, and its random tasks and their proofs in engines by the thousand.

    python -m benchmarks.synthesis            # a minute
    python -m benchmarks.synthesis tasks      # 1,000 tasks of each kind: half an hour
    python -m benchmarks.synthesis proofs     # 50 proofs of each kind in three engines: the same

The first prints mechanisms a second: of three-position tasks with two moving pivots, proposed (two
circles and the tables of a scene) and examined by the reference (assembled, looked at for defects
over the driver's whole way), and pylinkage's `motion_generation` on the same positions, which tries
moving pivots of its own and checks each four-bar by its lengths. Then how near, and in which time,
least squares comes to 50 points of a known coupler curve, plain and blurred. It judges nothing and
exits with 0.

The others run the cases of `tests/analytic/lectures/synthesis/random_tasks.py`, write a line for
each to out/synthesis, in a folder for the commit, and continue there when they were cut; the exit
code is 1 where a case fails.
"""

import functools
import gc
import itertools
import json
import math
import multiprocessing
import os
import statistics
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np

from analytic.lectures.synthesis.coupler import coupler_proposals
from analytic.lectures.synthesis.examine import examine
from analytic.lectures.synthesis.path.search import generate
from analytic.lectures.synthesis.path.task import PathTask
from analytic.lectures.synthesis.solutions import solutions_of
from benchmarks.mutants import suites
from models.lectures.tasks.positions import CouplerTask
from reports.output.write import provenance
from reports.workers import one_thread
from tests.analytic.lectures.synthesis.random_tasks import TASKS, hold, proofs

COUNT, SEED = 100, 19
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


def speed() -> None:
    tasks = three_positions(COUNT)
    solutions_of(tasks[0])  # imports, and what is kept
    rates = {
        "proposed": timed(lambda: proposed(tasks)),
        "proposed and examined": timed(lambda: examined(tasks)),
    }
    try:
        rates["pylinkage motion_generation"] = timed(lambda: pylinkages(tasks))
    except ImportError:
        print("no pylinkage: pip install --group benchmark\n")
    print(f"three positions, {COUNT} tasks{'':<12}mechanisms a second   over ours, examined")
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


OUT = Path(__file__).parents[1] / "out" / "synthesis" / suites()["test"].commit
Case = tuple[int, str, dict[str, float]]
"""Number of a task, its fault, and what was measured."""


def tasks_of(kind: str, start: int) -> Iterator[Case]:
    """Random tasks of a kind, whose solutions do what is said of them or not."""
    for number in itertools.count(start):
        try:
            sound, every = hold(kind, number)
            yield number, "", {"solutions": every, "without a defect": sound}
        except Exception as error:  # is the finding
            yield number, f"{type(error).__name__}: {error}", {}


def proofs_of(kind: str, start: int) -> Iterator[Case]:
    """Random mechanisms of a kind, with the largest error of each engine over its limit. One that
    no engine leads through its positions is a fault of the synthesis; one that some do, of the
    others: near a singular position, or with pins much nearer to each other than to the body."""
    for number, off in proofs(kind, start):
        yield number, "" if min(off.values()) <= 1.0 else "no engine leads it", off


SUITES: dict[str, tuple[Callable[[str, int], Iterator[Case]], int]] = {
    "tasks": (tasks_of, 1000),
    "proofs": (proofs_of, 50),
}


def filled(suite: str, kind: str) -> list[Case]:
    """All cases of a kind: those of the file, and then new ones, which are added to it."""
    make, count = SUITES[suite]
    path = OUT / f"{suite}-{kind}.jsonl"
    lines = path.read_text(encoding="utf-8").splitlines() if path.exists() else []
    done: list[Case] = [tuple(json.loads(line)) for line in lines[:count]]
    fresh = make(kind, done[-1][0] + 1 if done else 0)
    for case in itertools.islice(fresh, count - len(done)):
        with path.open("a", encoding="utf-8") as file:
            file.write(json.dumps(case) + "\n")
        done.append(case)
    return done


def run(suite: str) -> int:
    OUT.mkdir(parents=True, exist_ok=True)
    one_thread(os.environ)  # of the children, which start with them
    failed = 0
    with multiprocessing.get_context("spawn").Pool() as pool:
        every = pool.imap(functools.partial(filled, suite), TASKS, chunksize=1)
        for kind, cases in zip(TASKS, every, strict=True):
            faults = [f"    {number}: {fault} {facts}" for number, fault, facts in cases if fault]
            print(f"{kind:<22}{len(cases):>6} {suite}{len(faults):>6} fail", flush=True)
            print(*faults, sep="\n", end="\n" if faults else "", flush=True)
            failed += len(faults)
            facts = [facts for _, _, facts in cases if facts]
            for name in next(iter(facts), {}):
                values = [each[name] for each in facts]
                if suite == "tasks":
                    print(f"    {name} {sum(values):g}")
                    continue
                missed = sum(value > 1.0 for value in values)
                middle, most = statistics.median(values), max(values)
                print(f"    {name:<8}misses {missed}, error over limit {middle:.1e}, {most:.1e}")
    print(", ".join(f"{name} {value}" for name, value in provenance({}).items() if name != "made"))
    return int(failed > 0)


if __name__ == "__main__":
    if len(sys.argv) > 1:
        sys.exit(run(sys.argv[1]))
    speed()
