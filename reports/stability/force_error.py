"""How far the forces of a hard run are off, where they were asked for."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from models.errors import CrankcheckError
from models.scene import Scene
from reports.compare.beside import Beside, Truth
from reports.compare.whole_errors import force_rows
from sim.engine import Run


def force_error(scene: Scene, run: Run, settled_turns: float = 0.0) -> float:
    """The worst error of a reaction, normal force, moment or torque, as a share of the largest of
    its kind, from ``settled_turns`` on; infinite where a number is missing, NaN where there is no
    reference of forces (nothing has a mass, or the motion is not the driver's)."""
    motion = run.motion
    if not run.with_forces or motion is None:
        return math.nan
    first_s = motion.time_s[0] + settled_turns * scene.driver.law.period_s
    kept = slice(min(int(np.searchsorted(motion.time_s, first_s)), motion.time_s.size - 1), None)
    cut = replace(
        motion.each_series(lambda series: series[kept]),
        time_s=motion.time_s[kept],
        forces=motion.forces and motion.forces.stretch(kept),
    )
    settled = replace(
        run, motion=cut, forces_of="states" if kept.start else run.forces_of
    )  # the start, where steps have no forces, is cut off
    beside = Beside.of(Truth(scene, bound=False), settled)
    try:
        rows = force_rows(beside).rows if beside else ()
    except CrankcheckError:
        return math.nan
    sizes = [row.pure if row.finite else math.inf for row in rows if row.kind != "start"]
    return max(sizes, default=math.nan)
