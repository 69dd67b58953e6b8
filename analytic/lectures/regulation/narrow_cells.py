"""Cells of a cycle that are narrow enough for what happens in them."""

from __future__ import annotations

import numpy as np

from analytic.lectures.regulation.angle_cells import AngleCells
from analytic.lectures.regulation.periodic_newton import repeated
from analytic.lectures.regulation.periodic_solution import PeriodicSolution, WantedSpeed
from analytic.lectures.regulation.unsmooth import rated_breaks
from models.errors import CrankcheckError

RESOLVED, MOST_HALVINGS, MOST_CELLS = 1e-8, 16, 12_000
"""What the highest polynomial of a cell may have of the energy, over the largest, of which what it
leaves out is a hundredth; how often cells are halved for it, and how many there may be."""


def resolved(solution: PeriodicSolution, wanted: WantedSpeed) -> PeriodicSolution:
    """The solution in cells so narrow that their polynomials follow it: a machine that comes
    quickly to the speed of its motor, or a load of short waves, takes narrower ones.

    Raises CrankcheckError where no cells are narrow enough.
    """
    machine = solution.machine
    for _ in range(MOST_HALVINGS):
        rough = np.flatnonzero(solution.roughness > RESOLVED)
        if not rough.size:
            return solution
        if len(solution.cells.widths) + rough.size > MOST_CELLS:
            break
        own = solution.cells
        more = [own.borders, own.borders[rough] + 0.5 * own.widths[rough]]
        if machine.is_rated:
            more.append(rated_breaks(machine, solution.speed_at))
        cells = AngleCells.of(machine.cycle_rad, np.concatenate(more))
        solution = repeated(machine, cells, solution.flywheel, solution, wanted)
    where = machine.theta(solution.cells.borders[np.argmax(solution.roughness)])
    raise CrankcheckError(
        f"{machine.scene.name}: no steady cycle is told: near {machine.scene.driver.link} "
        f"{np.degrees(where) % 360.0:.4g} deg torques change too fast for {MOST_CELLS} cells of a "
        "cycle; give loads of longer waves, or a motor that is less steep over the speed"
    )
