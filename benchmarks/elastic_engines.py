"""What it costs to say how far an elastic link bends: error against cost over segments and step.

For each engine, number of segments and steps in a turn, profile tuned: the largest difference of
the middle's deflection from the beam with foreshortening, that from the exact chain of as many
segments (both over the largest deflection), and the seconds that a turn takes, timed apart from the
logging run. Rows that no other row of any engine beats in both error and cost are marked: the front
of work and precision. About two minutes. It judges nothing and exits with 0.
"""

from __future__ import annotations

import sys

sys.path.pop(0)  # this folder, whose logging.py would hide the standard library's

import math
import platform
from dataclasses import dataclass

from models.files import load_scene
from models.scene import Scene
from reports.judge.cell import Cell, check
from reports.output.provenance import processor
from reports.plan.elastic import held_steps
from sim.registry import available
from sim.timing import time_run

SCENE = "fourbar-elastic"
PROFILE = "tuned"
SEGMENTS = (4, 8, 16)
FINER = (1, 2, 4)
"""Times as many steps as explicit methods just hold that many segments with."""
AS_NEAR = 1.01
"""Errors over each other that are one and the same on the front: that of the segments."""


@dataclass(frozen=True)
class Row:
    """``beam`` and ``chain`` are errors over the largest deflection, NaN where the run came
    apart; ``turn_s`` is what a turn costs [s]."""

    engine: str
    segments: int
    steps: int
    beam: float
    chain: float
    turn_s: float

    def beaten_by(self, other: Row) -> bool:
        """Whether another row is as near to the beam, and costs less."""
        return other.beam < AS_NEAR * self.beam and other.turn_s < self.turn_s


def row_of(scene: Scene, engine: str, segments: int, steps: int) -> Row:
    """One run beside both truths, and one that is timed."""
    dt_s = scene.driver.law.period_s / steps
    cell = Cell(scene, engine, PROFILE, dt_s, steps, converge=False, segments=segments)
    checked = check(cell)
    worst = [checked.errors and checked.errors.worst(name) for name in ("deflection", "segments")]
    fine = checked.status == "ok"
    beam, chain = (each.pure if each and fine else math.nan for each in worst)
    truth = cell.truth
    timed = time_run(cell.given, truth.start, engine, PROFILE, dt_s=dt_s, steps=steps, repeats=3)
    return Row(engine, segments, steps, beam, chain, timed.best.wall_s)


def main() -> None:
    """All rows of one scene."""
    scene = load_scene(SCENE)
    engines = [one.name for one in available() if one.version]
    rows = [
        row_of(scene, engine, segments, finer * round(held_steps(scene, segments, "plain")))
        for segments in SEGMENTS
        for engine in engines
        for finer in FINER
    ]
    print(f"{SCENE}, profile {PROFILE}, one turn of {scene.driver.law.period_s:.4g} s")
    print(f"{'engine':10}{'segments':>9}{'steps':>8}{'beam / D':>11}{'chain / D':>11}{'turn':>11}")
    for row in rows:
        front = "" if any(map(row.beaten_by, rows)) or math.isnan(row.beam) else "  front"
        print(
            f"{row.engine:10}{row.segments:>9}{row.steps:>8}{row.beam:>11.1e}{row.chain:>11.1e}"
            f"{1e3 * row.turn_s:>8.1f} ms{front}"
        )
    print(f"python {platform.python_version()}, {processor()}")


if __name__ == "__main__":
    main()
