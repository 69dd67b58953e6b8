"""What a turn of a mechanism with elastic links costs: the reference beside the rigid one, and
beside an engine.

The shipped elastic scenes over a turn at 361 instants, in this process, all kinds taking turns in
rounds: the periodic motion, that from the quasi-static shape, the same with its doubt, the exact
chain of 16 segments; MuJoCo's chain of as many at 5000 steps a turn, which its RK4 holds. Prints
milliseconds, and times those of the rigid reference and of the engine. On a machine that does
nothing else: ``OPENBLAS_NUM_THREADS=1 python benchmarks/elastic.py``.
"""

import sys

sys.path.pop(0)  # this folder, whose logging.py would hide the standard library's

import gc
import platform
import time
from collections.abc import Callable
from importlib.metadata import version

import numpy as np

from analytic.elastic.discretisation import REFERENCE, Discretisation, Segments
from analytic.elastic.elastic_motion import DrivenElasticMotion
from analytic.elastic.engine_start import segment_start
from analytic.forces.kinetostatics import forces
from analytic.kinematics import solve
from models.files.reading import load_scene, names_of_scenes
from models.scene import Scene
from models.scene.cut_scenes import SegmentedScene
from models.scene.elastic import Shape
from reports.output.write import processor
from sim.run import run

INSTANTS, ROUNDS, COUNT, STEPS = 361, 2, 16, 5000


def calls(scene: Scene) -> dict[str, Callable[[], object]]:
    """What is timed, by name."""
    turn = scene.driver.law.period_s
    time_s = np.linspace(0.0, turn, INSTANTS)
    own = SegmentedScene(scene, COUNT)
    state = segment_start(own, "periodic")

    def rigid() -> object:
        return solve(scene, time_s), forces(scene, time_s)

    def elastic(
        start: Shape, by: Discretisation = REFERENCE, *, doubt: bool = False
    ) -> Callable[[], object]:
        def follow() -> object:  # anew: what it has worked out it keeps
            motion = DrivenElasticMotion(scene, turn, by, start, stiffened=True)
            return motion.doubt(time_s) if doubt else motion.at(time_s)

        return follow

    return {
        "rigid": rigid,
        "rigid again (A/A)": rigid,
        "periodic": elastic("periodic"),
        "quasi-static": elastic("quasi-static"),
        "periodic, with doubt": elastic("periodic", doubt=True),
        "quasi-static, with doubt": elastic("quasi-static", doubt=True),
        f"chain of {COUNT}, quasi-static": elastic("quasi-static", Segments(COUNT)),
        f"MuJoCo, chain of {COUNT}": lambda: run(
            own.rigid, state, "mujoco", dt_s=turn / STEPS, steps=STEPS, every=STEPS // 100
        ),
    }


def milliseconds(scene: Scene) -> dict[str, float]:
    """The least time of each call, the calls taking turns in rounds."""
    found: dict[str, float] = {}
    every = calls(scene)
    gc.disable()
    for _ in range(ROUNDS):
        for name, call in every.items():
            start = time.perf_counter()
            call()
            spent = 1e3 * (time.perf_counter() - start)
            found[name] = min(found.get(name, np.inf), spent)
    gc.enable()
    return found


def main() -> None:
    """Print the tables."""
    for name in names_of_scenes("elastic"):
        scene = load_scene(name)
        found = milliseconds(scene)
        engine = found[f"MuJoCo, chain of {COUNT}"]
        print(f"{name:34}       ms    x rigid   x MuJoCo")
        for call, spent in found.items():
            print(f"  {call:32} {spent:8.1f} {spent / found['rigid']:10.1f} {spent / engine:10.2f}")
    print(
        f"numpy {version('numpy')}, mujoco {version('mujoco')}, Python {platform.python_version()}"
    )
    print(processor())


main()
