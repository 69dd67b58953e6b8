"""Engines on elastic links over the number of segments: error against cost, and the order of it.

The elastic coupler of a four-bar, at 10.5 and 5.5 of its frequency over the speed, is given to the
engines as 4, 8, 16 and 32 segments with plain and corrected springs, at the steps that these
hold and at half of them. Of the largest deflection: what the engine is off the exact chain by, that
chain off the beam, the engine off the beam; the fitted order in 1/n; the seconds of a turn. Exits
with 1 where an engine is not within 1 % of the beam with 16 plain segments, or not within 1e-3 of
the exact chain; `--few` leaves out the 32, whose exact chain takes most of the time.
"""

from __future__ import annotations

import sys

sys.path.pop(0)  # this folder, whose logging.py would hide the standard library's

import math
from dataclasses import replace

import numpy as np

from models.files import load_scene
from models.laws import ConstantSpeed
from models.scene import Scene
from reports.judge.cell import Cell, Springs, examined
from reports.plan.elastic import SPRINGS, held_steps
from sim.registry import usual

COUNTS = (4, 8, 16, 32)
RATIOS = (10.5, 5.5)
FIRST_RAD_S = 77.37
"""The first frequency of the coupler."""
MOST_BEAM, MOST_CHAIN = 1e-2, 1e-3


def at_ratio(ratio: float) -> Scene:
    """The four-bar at a speed so many times below its coupler's frequency."""
    scene = load_scene("fourbar-elastic")
    law = scene.driver.law
    assert isinstance(law, ConstantSpeed)
    faster = replace(scene.driver, law=replace(law, speed_rad_s=FIRST_RAD_S / ratio))
    return replace(scene, name=f"{scene.name} at r = {ratio:g}", driver=faster)


def measured(
    scene: Scene, engine: str, count: int, springs: Springs, finer: int
) -> tuple[float, float, float, float]:
    """Engine off chain, chain off beam, engine off beam, seconds of a turn; NaN for none."""
    steps = finer * round(held_steps(scene, count, springs))
    cell = Cell(
        scene,
        engine,
        "tuned",
        scene.driver.law.period_s / steps,
        steps,
        converge=False,
        segments=count,
        springs=springs,
    )
    checked, run = examined(cell)
    errors = checked.errors
    if checked.status != "ok" or errors is None or errors.elastic is None or run is None:
        print(f"  {engine} {count} {springs}: {checked.status}: {checked.reason}")
        return (math.nan,) * 4
    own, beam = errors.worst("segments"), errors.worst("deflection")
    assert own is not None
    assert beam is not None
    return own.pure, errors.elastic.chain, beam.pure, run.cost.wall_s if run.cost else math.nan


def order(counts: tuple[int, ...], found: list[float]) -> float:
    """The slope of the errors over 1/n."""
    return -float(np.polyfit(np.log(counts), np.log(found), 1)[0])


def main() -> int:
    counts = COUNTS[:-1] if "--few" in sys.argv else COUNTS
    missed = False
    for scene in map(at_ratio, RATIOS):
        print(f"\n{scene.name}: shares of the largest deflection, seconds of a turn")
        print(f"{'engine':8} {'springs':10} {'n':>3} {'finer':>5} {'engine':>9} {'chain':>9} "
              f"{'beam':>9} {'s/turn':>8}")  # fmt: skip
        lines = [(e, s, finer) for s in SPRINGS for finer in (1, 2) for e in usual()]
        table = {
            (*line, n): measured(scene, line[0], n, line[1], line[2])
            for n in counts
            for line in lines
        }
        for engine, springs, finer in lines:
            beams = []
            for n in counts:
                own, chain, beam, wall = table[engine, springs, finer, n]
                print(f"{engine:8} {springs:10} {n:3} {finer:5} {own:9.1e} {chain:9.1e} "
                      f"{beam:9.1e} {wall:8.3f}")  # fmt: skip
                beams.append(beam)
                if n == 16 and springs == "plain":
                    missed |= not (beam <= MOST_BEAM and own <= MOST_CHAIN)
            print(f"{engine:8} {springs:10} order in 1/n: {order(counts, beams):.2f}", flush=True)
    return int(missed)


if __name__ == "__main__":
    sys.exit(main())
