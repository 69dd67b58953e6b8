"""The cycle that a machine repeats is found: its energy by Newton's method, its extremes of speed.

A scene whose driver is driven at constant speed runs with that mean speed: its drive is taken as a
constant torque, which closes the balance of work. One that is let go has its loads alone: where one
of them follows the speed they settle it, else they have to balance, and the speed of its start is
the mean one.
"""

from __future__ import annotations

import numpy as np

from analytic.lectures.regulation.angle_cells import AngleCells
from analytic.lectures.regulation.mean_balance import other_way, settled_speed
from analytic.lectures.regulation.narrow_cells import resolved
from analytic.lectures.regulation.periodic_newton import repeated
from analytic.lectures.regulation.periodic_solution import PeriodicSolution, WantedSpeed
from analytic.lectures.regulation.steady_cycle import SteadyCycle
from analytic.lectures.regulation.turning_machine import TurningMachine
from analytic.lectures.regulation.unsmooth import breaks, rated_breaks
from models.array import Array
from models.errors import CrankcheckError

CLOSED = 1e-6
"""The work that loads alone may be short of in a cycle, over what drives: tables have six digits.
It is made up by a constant torque."""
ROUNDS = 6
"""Searches for the places of the extremes."""
ROUGHLY, CLOSELY = 18, 40
"""Halvings of an interval of nodes for them: speeds do not change there to first order."""
STILL = 1e-11
"""A fluctuation below this is rounding."""


def steady_cycle(machine: TurningMachine, flywheel_kg_m2: float = 0.0) -> SteadyCycle:
    """The cycle that a machine repeats with a flywheel more on its driver.

    Raises
    ------
    StallError
        Its masses hold too little energy to carry it round.
    CrankcheckError
        Loads that do not balance at any speed, or have tables that end before.
    """
    cells = AngleCells.of(machine.cycle_rad, breaks(machine))
    scene = machine.scene
    law_speed = abs(float(scene.driver.law.at(np.zeros(1))[1][0]))
    if scene.is_free and machine.is_rated:
        wanted = WantedSpeed(None)
        speed = settled_speed(machine)
    elif law_speed == 0.0:
        raise CrankcheckError(
            f"{scene.name}: no load follows the speed, and it starts from rest: any speed would "
            "do, and it has no cycle of its own; give the mean one as speed_rad_s in [driver], or "
            "a load over the speed, such as that of a motor"
        )
    else:
        wanted, speed = WantedSpeed(law_speed), law_speed
    solution = repeated(machine, cells, flywheel_kg_m2, speed, wanted)
    if scene.is_free:
        _check_closed(solution)
    if machine.is_rated:
        # Rows of tables over the speed are passed somewhere on the way: cut there.
        more = rated_breaks(machine, solution.speed_at)
        cells = AngleCells.of(machine.cycle_rad, np.concatenate([cells.borders, more]))
        solution = repeated(machine, cells, flywheel_kg_m2, solution, wanted)
    return _with_extremes(resolved(solution, wanted), wanted)


def _with_extremes(solution: PeriodicSolution, wanted: WantedSpeed) -> SteadyCycle:
    """The solution whose mean speed is right to rounding, and where its speed is largest and
    smallest."""
    mean = wanted.mean_rad_s
    for _ in range(ROUNDS):
        if mean is None:
            break
        rough = SteadyCycle(solution, *_extremes(solution, ROUGHLY))
        if abs(rough.mean_rad_s / mean - 1.0) <= 1e-14:
            break
        wanted = WantedSpeed(mean, (rough.fastest, rough.slowest))
        solution = repeated(solution.machine, solution.cells, solution.flywheel, solution, wanted)
    return SteadyCycle(solution, *_extremes(solution, CLOSELY))


def _extremes(solution: PeriodicSolution, halvings: int) -> tuple[float, float]:
    """The angles u at which the speed is largest and smallest, where its slope is 0."""
    u = np.sort(np.concatenate([solution.cells.borders, solution.cells.nodes.ravel()]))
    speed = solution.speed_at(u)
    if np.ptp(speed) <= STILL * speed.max():
        return 0.0, 0.0
    at = np.array([np.argmax(speed), np.argmin(speed)])
    low, high = u[np.maximum(at - 1, 0)], u[np.minimum(at + 1, len(u) - 1)]
    signs = np.array([1.0, -1.0])
    for _ in range(halvings):
        middle = 0.5 * (low + high)
        rising = _pull(solution, middle) * signs > 0.0
        low, high = np.where(rising, middle, low), np.where(rising, high, middle)
    best = 0.5 * (low + high)
    return float(best[0]), float(best[1])


def _pull(solution: PeriodicSolution, u: Array) -> Array:
    """J w dw/du: what the torques leave for a change of the speed [N m]."""
    inertia, slope = solution.machine.inertia(u)
    speed = np.sqrt(2.0 * solution.energy_at(u) / (inertia + solution.flywheel))
    torque = solution.machine.torque(u, speed) + solution.drive
    return np.asarray(torque - 0.5 * slope * speed**2)


def _check_closed(solution: PeriodicSolution) -> None:
    """Refuse loads that follow no speed and do not balance over the cycle."""
    machine = solution.machine
    whole = machine.cycle_rad
    put_in = solution.cells.integral(np.maximum(solution.torque, 0.0))
    short = solution.drive * whole
    if abs(short) > CLOSED * put_in:
        scene = machine.scene
        way = "lose" if short > 0.0 else "gain"
        raise CrankcheckError(
            f"{scene.name}: no steady cycle: over {np.degrees(whole):.6g} deg its loads {way} "
            f"{abs(short):.6g} J at any speed; add a torque on {scene.driver.link} of "
            f"{machine.way * solution.drive:.12g} N m, or a load that follows the speed"
        )


def cycle_of(machine: TurningMachine) -> SteadyCycle:
    """The steady cycle, of a machine that starts from rest to the side that its loads drive it to.
    Raises as `steady_cycle`."""
    try:
        return steady_cycle(machine)
    except CrankcheckError:
        if machine.scene.driver.law.at(np.zeros(1))[1][0] != 0.0:
            raise
        try:
            return steady_cycle(other_way(machine))
        except CrankcheckError:
            pass
        raise
