"""How MuJoCo's loops should close where nothing drives: by weights and springs, what is left.

`python benchmarks/free_loops.py [COUNT]` runs shipped scenes that are let go, and COUNT four-bars
drawn at random (8) that swing under gravity, for 4 s at 1 ms by the profile `tuned`, with the
bodies' inverse weights scaled down (`free_inverse_weight_share`) and loops drawn back over so many
steps (`free_timeconst_steps`, 0: as driven). Printed are the largest error of the phase over its
growth G [rad], of the random ones the median and the worst, and what the reactions cost: the torque
on the free crank, which has none, over the largest reaction and the longest link. The settings of
the profile were chosen on the shipped scenes; the random ones had no part in it. About two minutes.
It judges nothing and exits with 0, with 2 for a COUNT that is none.
"""

import statistics
import sys
from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

if __name__ == "__main__":  # run as a file: the packages are beside this folder
    sys.path[0] = str(Path(__file__).resolve().parents[1])

import crankcheck
from models.scene import Scene
from models.scene.hard import fourbar
from reports.output.write import processor
from sim.engine import SettingValue
from sim.registry import engine

SCENES = ("fourbar-swing", "fourbar-double-rocker-swing", "press-motor", "fourbar-chain")
COUNT, SEED, DT_S, DURATION_S = 8, 15, 1e-3, 4.0
SETTINGS = (
    (1.0, 0.0),
    (1.0, 32.0),
    *((share, 32.0) for share in (1e-4, 1e-6, 1e-7, 1e-8, 1e-10)),
    *((1e-7, steps) for steps in (8.0, 16.0, 24.0, 48.0)),
)
"""Shares of the inverse weights, and time constants in steps."""


def main(words: Sequence[str]) -> int:
    """Print the table."""
    if len(words) > 1 or not all(word.isdigit() and int(word) for word in words):
        print(f"{' '.join(words)}: how many random four-bars? a number from 1 on", file=sys.stderr)
        return 2
    random = list(four_bars(int(words[0]) if words else COUNT))
    shipped = [crankcheck.load_scene(name) for name in SCENES]
    print(f"phase over G [rad], MuJoCo tuned, {DURATION_S:g} s at dt {DT_S:g} s; seed {SEED}")
    heads = "".join(f"{name.removeprefix('fourbar-'):>20}" for name in SCENES)
    print(f"{'share':>7}{'steps':>6}{heads}{'random: median':>16}{'worst':>9}{'torque':>9}")
    for share, steps in SETTINGS:
        settings = {"free_inverse_weight_share": share, "free_timeconst_steps": steps}
        phases = [phase(scene, settings) for scene in shipped]
        others = [phase(scene, settings) for scene in random]
        torque = max(idle_torque(scene, settings) for scene in random)
        told = "".join(f"{off:20.1e}" for off in phases)
        told += f"{statistics.median(others):16.1e}{max(others):9.1e}{torque:9.1e}"
        print(f"{share:7.0e}{steps:6g}{told}")
    print(
        f"crankcheck {crankcheck.__version__}, mujoco {engine('mujoco').version()}, {processor()}"
    )
    return 0


def four_bars(count: int) -> Iterator[Scene]:
    """So many four-bars under gravity, spun at 5 rad/s; those of fewer are the first of more."""
    draw = np.random.default_rng(SEED)
    made = 0
    while made < count:
        lengths = draw.uniform(0.1, 0.4, 4).tolist()
        scene = fourbar(f"random-{made}", *lengths, source="drawn at random", speed_rad_s=5.0)
        scene = replace(scene, gravity_m_s2=(0.0, -9.81))
        try:
            crankcheck.run(scene, "mujoco", dt_s=DT_S, duration_s=10 * DT_S, drive="free")
        except crankcheck.CrankcheckError:
            continue  # it can not be assembled at its start
        made += 1
        yield scene


def phase(scene: Scene, settings: dict[str, SettingValue]) -> float:
    """The largest error of the phase over its growth [rad]; inf for a run that ended early."""
    done = let_go(scene, settings)
    rows = crankcheck.compare(done.mechanism, done).frame()
    worst = rows[(rows["quantity"] == "phase") & (rows["kind"] == "total")]["maximum_pure"]
    return float(worst.max()) if done.status == "ok" and len(worst) else float("inf")


def idle_torque(scene: Scene, settings: dict[str, SettingValue]) -> float:
    """The torque on the free crank over the largest reaction and the longest link."""
    forces = let_go(scene, settings, forces=True).motion.forces
    largest = max(np.abs(f).max() for by in forces.pins.values() for f in by.values())
    return float(np.abs(forces.torque).max() / (largest * scene.longest_m))


def let_go(
    scene: Scene, settings: dict[str, SettingValue], forces: bool = False
) -> crankcheck.Simulation:
    return crankcheck.run(
        scene,
        "mujoco",
        dt_s=DT_S,
        duration_s=DURATION_S,
        drive="free",
        settings=settings,
        forces=forces,
    )


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
