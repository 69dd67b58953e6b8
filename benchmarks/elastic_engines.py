"""Engines on elastic links over the number of segments: error against cost, and the order of it.

The elastic coupler of a four-bar, at 10.5 and 5.5 of its frequency over the speed, and the rod of a
slider-crank are given to the engines as 4, 8, 16 and 32 segments with plain and corrected springs,
at the steps that these hold and, up to 16, at half of them; to engines that have beams of their own
as 2, 4, 8 and 16 elements of one, at 720 and 2880 steps a turn. Of the largest deflection: what the
engine is off the exact chain by, that chain off the beam (of elements what they lock by,
estimated), the engine off the beam; the fitted order in 1/n; steps and seconds of a turn, and the
iterations of a step where an engine takes more for segments. Exits with 1 where an engine is not
within 1 % of the beam with 16 plain segments, or not within 1e-3 of the exact chain, or not within
1e-3 of the beam with 8 elements; `--few` leaves out the 32, with which pymunk takes minutes, and
`--beams` all segments.
"""

import sys

sys.path.pop(0)  # this folder, whose logging.py would hide the standard library's

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from models.files.reading import load_scene
from models.scene import Scene
from models.scene.laws import ConstantSpeed
from reports.judge.cell import Cell, examined
from reports.plan.requirements import SPRINGS, held_steps
from reports.protocol.length import Springs
from sim.registry import applying, usual

COUNTS, ELEMENTS = (4, 8, 16, 32), (2, 4, 8, 16)
RATIOS = (10.5, 5.5)
FIRST_RAD_S = 77.37
"""The first frequency of the coupler."""
MOST_BEAM, MOST_CHAIN = 1e-2, 1e-3
MOST_FINER = 16
"""Segments that are run at half the step too."""
Line = tuple[str, Springs, int]
"""An engine, with what, and at how many times the steps."""


def at_ratio(ratio: float) -> Scene:
    """The four-bar at a speed so many times below its coupler's frequency."""
    scene = load_scene("fourbar-elastic")
    law = scene.driver.law
    assert isinstance(law, ConstantSpeed)
    faster = replace(scene.driver, law=replace(law, speed_rad_s=FIRST_RAD_S / ratio))
    return replace(scene, name=f"{scene.name} at r = {ratio:g}", driver=faster)


class Measured(NamedTuple):
    """Engine off chain, chain off beam, engine off beam, of the largest deflection; steps and
    seconds of a turn, iterations of a step where segments take more of them."""

    engine: float = math.nan
    chain: float = math.nan
    beam: float = math.nan
    steps: int = 0
    wall_s: float = math.nan
    iterations: int = 0


def measured(scene: Scene, name: str, springs: Springs, finer: int, count: int) -> Measured:
    """A turn; NaN for what is not known."""
    steps = finer * round(held_steps(scene, count, springs))
    cell = Cell(
        scene,
        name,
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
        print(f"  {name} {count} {springs}: {checked.status}: {checked.reason}")
        return Measured(steps=steps)
    own, beam = errors.worst("segments"), errors.worst("deflection")
    assert beam is not None
    chain = own.pure if own else math.nan
    wall_s = run.cost.wall_s if run.cost else math.nan
    iterations = int(run.settings.get("iterations_of_segments", 0))
    return Measured(chain, errors.elastic.chain, beam.pure, steps, wall_s, iterations)


def order(counts: Sequence[int], found: Sequence[float]) -> float:
    """The slope of the errors over 1/n."""
    return -float(np.polyfit(np.log(counts), np.log(found), 1)[0])


def main() -> int:
    counts = COUNTS[:-1] if "--few" in sys.argv else COUNTS
    chains = () if "--beams" in sys.argv else (s for s in SPRINGS if s != "beam")
    lines: list[Line] = [(e, s, finer) for s in chains for finer in (1, 2) for e in usual()]
    able = applying("beams")
    beams: list[Line] = [(e, "beam", finer) for e in able for finer in (1, 4)]
    missed = False
    for scene in (*map(at_ratio, RATIOS), load_scene("slider-crank-elastic")):
        print(f"\n{scene.name}: shares of the largest deflection")
        print(f"{'engine':8} {'springs':10} {'n':>3} {'finer':>5} {'engine':>9} {'chain':>9} "
              f"{'beam':>9} {'steps':>6} {'s/turn':>8} {'iter.':>6}")  # fmt: skip
        for name, springs, finer in (*lines, *beams):
            every = ELEMENTS if springs == "beam" else counts
            run = [n for n in every if finer == 1 or n <= MOST_FINER]
            rows = [measured(scene, name, springs, finer, n) for n in run]
            for n, row in zip(run, rows, strict=True):
                print(f"{name:8} {springs:10} {n:3} {finer:5} {row.engine:9.1e} "
                      f"{row.chain:9.1e} {row.beam:9.1e} {row.steps:6} {row.wall_s:8.3f} "
                      f"{row.iterations or '':6}")  # fmt: skip
                if n == 16 and springs == "plain":
                    missed |= not (row.beam <= MOST_BEAM and row.engine <= MOST_CHAIN)
                missed |= springs == "beam" and n >= 8 and not row.beam <= MOST_CHAIN
            found = [row.beam for row in rows]
            print(f"{name:8} {springs:10} order in 1/n: {order(run, found):.2f}", flush=True)
    return int(missed)


if __name__ == "__main__":
    sys.exit(main())
