"""Conversion of a set of settings to exudyn's own structures, and back."""

from collections.abc import Iterator
from contextlib import contextmanager
from functools import reduce
from typing import Any

import numpy as np

from models.array import Array
from sim.engine import Settings, SettingValue
from sim.exudyn.settings import BY_NEED, MOST_DENSE, NEWTON, RESIDUALS, assignments
from sim.exudyn.system import Index, exu, quiet

FREE = 1e-9
"""Singular value of the constraints, over the largest, below which a motion is unconstrained."""


def simulation(
    settings: Settings, dt_s: float, *, of_rates: bool = False, rounding_n: float = 0.0
) -> Any:
    """Return exudyn's settings of a simulation without files and output of its own.

    Its sensors keep every step, and no step is longer than ``dt_s``. With loads ``of_rates``
    Newton's method takes their change in a step into account: without, it does not converge for a
    steep motor. With beams the tolerance stays above the rounding ``rounding_n`` of their forces.
    """
    asked = exu.SimulationSettings()
    asked.solution.file.write = False
    asked.solution.sensors.writePeriod = 0.0
    stepping = asked.timeIntegration
    stepping.verboseMode = 0
    stepping.numberOfSteps, stepping.endTime = 1, dt_s
    stepping.computeLoadsJacobian = 2 if of_rates else 0
    trapezoidal = settings["integrator"] == "TrapezoidalIndex2"
    stepping.generalizedAlpha.useNewmark = trapezoidal  # as exudyn's own SolveDynamic sets both
    stepping.generalizedAlpha.useIndex2Constraints = trapezoidal
    for path, value in assignments(settings).items():
        *folders, name = path.split(".")
        setattr(reduce(getattr, folders, stepping), name, value)
    least = float(settings["beam_rounding"]) * rounding_n
    stepping.newton.absoluteTolerance = max(float(settings["absolute_tolerance"]), least)
    if (linear := str(settings["linear_solver"])) != BY_NEED:
        asked.linearSolver.solverType = getattr(exu.LinearSolverType, linear)
    asked.linearSolver.ignoreSingularJacobian = settings["ignore_singular"] == "enable"
    return asked


ROUNDINGS = 4096.0
"""Least absolute tolerance of forces, over the rounding of inertia: the residual keeps 8 roundings
of the largest reaction, which was up to 20 times the inertia of random mechanisms."""


def initialized(system: Any, asked: Any, settings: Settings, inertia_n: float = 0.0) -> Any:
    """Make a solver of the system, at its start, with the linear solver and the residual that it
    needs if these are ``by-need``; a residual of forces below the rounding ``inertia_n`` of inertia
    is never reached."""
    solver = exu.MainSolverImplicitSecondOrder()
    if BY_NEED in (settings["linear_solver"], settings["residual"]):
        with quiet([]):  # it warns of the redundancy that is searched here
            solver.InitializeSolver(system, asked)
        if settings["linear_solver"] == BY_NEED:
            held_by, kinds = constraints(solver, system), exu.LinearSolverType
            own = kinds.EXUdense
            if solver.GetODE2size() + solver.GetAEsize() > MOST_DENSE:
                own = kinds.EigenSparse
            elif _rank(held_by) < np.count_nonzero(np.any(held_by != 0.0, axis=1)):
                own = kinds.EigenDense
            asked.linearSolver.solverType = own
        if settings["residual"] == BY_NEED:
            newton, size = asked.timeIntegration.newton, solver.GetODE2size()
            enough = solver.GetAEsize() >= size
            if enough and _rank(constraints(solver, system, of_rates=1.0)) == size:
                newton.residualMode = 1
            else:
                newton.absoluteTolerance = max(newton.absoluteTolerance, ROUNDINGS * inertia_n)
    solver.InitializeSolver(system, asked)
    return solver


def _rank(held_by: Array) -> int:
    """Return the rank of constraints; a point on a line has an empty one."""
    real = held_by[np.any(held_by != 0.0, axis=1)]
    return int(np.linalg.matrix_rank(real / np.abs(real).max(axis=1, keepdims=True), tol=1e-9))


def constraints(solver: Any, system: Any, of_rates: float = 0.0) -> Array:
    """Return the present derivatives of the constraints with respect to the coordinates, and those
    with respect to their rates times ``of_rates`` (a constant speed has no others), a row each.
    The solver has to be initialized again after this, `per_drive` and `multipliers`."""
    count = solver.GetODE2size()
    size = count + solver.GetAEsize()
    solver.SetSystemJacobian(np.zeros((size, size)))
    solver.ComputeJacobianAE(system, 1.0, of_rates)
    return np.array(solver.GetSystemJacobian())[count:, :count]


def per_drive(solver: Any, system: Any) -> Array:
    """Return the accelerations of all coordinates over the drive's, the last of the constraints;
    these leave some coordinates of bending links free, which follow by their inertia."""
    held_by = constraints(solver, system)
    asked = np.zeros(len(held_by))
    asked[-1] = 1.0
    moved = np.asarray(np.linalg.lstsq(held_by, asked, rcond=None)[0])
    _, sizes, ways = np.linalg.svd(held_by)
    loose = ways[np.count_nonzero(sizes > FREE * sizes[0]) :]
    if len(loose):
        solver.ComputeMassMatrix(system)
        heavy = loose @ np.array(solver.GetSystemMassMatrix())
        moved -= loose.T @ np.linalg.lstsq(heavy @ loose.T, heavy @ moved, rcond=None)[0]
    return moved


def multipliers(solver: Any, system: Any, accelerations: Array) -> Array:
    """Return the multipliers of the constraints for accelerations, at the present state."""
    held_by = constraints(solver, system)
    solver.ComputeMassMatrix(system)
    solver.ComputeODE2RHS(system)
    asked = np.array(solver.GetSystemResidual())[: len(accelerations)]
    left = asked - np.array(solver.GetSystemMassMatrix()) @ accelerations
    return np.asarray(np.linalg.lstsq(held_by.T, left, rcond=None)[0])


def held(asked: Any, solver: Any, settings: Settings) -> dict[str, SettingValue]:
    """Return the settings by crankcheck's names, as the solver and its input hold them.

    Choices by need are ``residual_used`` and ``linear_solver_used``; ``loads_jacobian_used`` is
    there where loads depend on speeds, ``absolute_tolerance_used`` where rounding sets it.
    """
    newton, linear = solver.newton, asked.linearSolver
    trapezoidal = asked.timeIntegration.generalizedAlpha.useIndex2Constraints
    per_step = "each-step" if newton.modifiedNewtonJacUpdatePerStep else "as-needed"
    told: dict[str, SettingValue] = {
        "timestep_s": float(solver.it.maxStepSize),
        "integrator": "TrapezoidalIndex2" if trapezoidal else "GeneralizedAlpha",
        "spectral_radius": float(asked.timeIntegration.generalizedAlpha.spectralRadius),
        **{name: getattr(newton, own) for name, own in NEWTON.items()},
        "jacobian": per_step if newton.useModifiedNewton else "each-iteration",
        "adaptive_step": "enable" if solver.it.adaptiveStep else "disable",
        "residual_used": RESIDUALS[newton.residualMode],
        "linear_solver_used": str(linear.solverType.name),
        "ignore_singular": "enable" if linear.ignoreSingularJacobian else "disable",
    }
    rounded = settings["beam_rounding"] or settings["residual"] == BY_NEED
    if rounded and newton.absoluteTolerance > settings["absolute_tolerance"]:
        told["absolute_tolerance_used"] = told.pop("absolute_tolerance")
    if asked.timeIntegration.computeLoadsJacobian:
        told["loads_jacobian_used"] = "enable"
    return told


class Multipliers:
    """Multipliers at the end of each of exudyn's steps; ``first`` are those of the start, where the
    system does not hold them itself."""

    def __init__(self, system: Any, first: Array | None) -> None:
        self._system, self._first = system, first
        self._times_s: list[float] = []
        self._rows: list[Array] = []

    def rows(self, index: Index) -> list[int]:
        """Return the rows of a joint."""
        return [int(row) for row in self._system.systemData.GetObjectLTGAE(index)]

    @contextmanager
    def kept(self, steps_done: int) -> Iterator[None]:
        """Keep the multipliers of now, ``steps_done`` steps after the start, and of each step."""
        state = self._system.systemData
        now = np.array(state.GetAECoordinates())
        self._times_s = [float(state.GetTime())]
        self._rows = [now if steps_done or self._first is None else self._first]

        def keep(system: Any, time_s: float) -> bool:
            if time_s > self._times_s[-1]:  # a stretch calls it at its own start as well
                self._times_s.append(time_s)
                self._rows.append(np.array(system.systemData.GetAECoordinates()))
            return True

        self._system.SetPostStepUserFunction(keep)
        try:
            yield
        finally:
            self._system.SetPostStepUserFunction(0)

    def at(self, time_s: Array) -> Array:
        """Return the multipliers of some of the steps, by times on exudyn's clock; a row each."""
        clock = np.array(self._times_s)
        near = 0.5 * (clock[1:] + clock[:-1])  # the last part of a cut step ends at the step
        return np.array(self._rows)[np.searchsorted(near, time_s)]
