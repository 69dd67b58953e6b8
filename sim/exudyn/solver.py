"""A set of settings as exudyn's own structures, and read back from them."""

from __future__ import annotations

from typing import Any

from sim.engine import Settings, SettingValue
from sim.exudyn.library import exu
from sim.exudyn.settings import BY_SIZE, MOST_DENSE


def simulation(settings: Settings, dt_s: float, unknowns: int) -> Any:
    """exudyn's settings of a simulation that writes no files and prints nothing of its own.

    Its sensors keep every step, and no step is longer than ``dt_s``. ``unknowns`` counts the
    coordinates and constraints of the system.
    """
    asked = exu.SimulationSettings()
    asked.solution.file.write = False
    asked.solution.sensors.writePeriod = 0.0
    stepping = asked.timeIntegration
    stepping.verboseMode = 0
    stepping.numberOfSteps, stepping.endTime = 1, dt_s
    stepping.adaptiveStep = settings["adaptive_step"] == "enable"
    trapezoidal = settings["integrator"] == "TrapezoidalIndex2"
    stepping.generalizedAlpha.useNewmark = trapezoidal  # as exudyn's own SolveDynamic sets both
    stepping.generalizedAlpha.useIndex2Constraints = trapezoidal
    stepping.generalizedAlpha.spectralRadius = float(settings["spectral_radius"])
    newton = stepping.newton
    newton.relativeTolerance = float(settings["relative_tolerance"])
    newton.absoluteTolerance = float(settings["absolute_tolerance"])
    newton.maxIterations = int(settings["iterations"])
    newton.useModifiedNewton = settings["jacobian"] != "each-iteration"
    newton.modifiedNewtonJacUpdatePerStep = settings["jacobian"] == "each-step"
    linear = str(settings["linear_solver"])
    if linear == BY_SIZE:
        linear = "EigenDense" if unknowns <= MOST_DENSE else "EigenSparse"
    asked.linearSolver.solverType = getattr(exu.LinearSolverType, linear)
    asked.linearSolver.ignoreSingularJacobian = settings["ignore_singular"] == "enable"
    return asked


def held(asked: Any, solver: Any) -> dict[str, SettingValue]:
    """The settings by our names, as the solver and what it is given hold them.

    What ``linear_solver`` came to is ``linear_solver_used``.
    """
    newton, linear = solver.newton, asked.linearSolver
    trapezoidal = asked.timeIntegration.generalizedAlpha.useIndex2Constraints
    per_step = "each-step" if newton.modifiedNewtonJacUpdatePerStep else "as-needed"
    return {
        "timestep_s": float(solver.it.maxStepSize),
        "integrator": "TrapezoidalIndex2" if trapezoidal else "GeneralizedAlpha",
        "spectral_radius": float(asked.timeIntegration.generalizedAlpha.spectralRadius),
        "relative_tolerance": float(newton.relativeTolerance),
        "absolute_tolerance": float(newton.absoluteTolerance),
        "iterations": int(newton.maxIterations),
        "jacobian": per_step if newton.useModifiedNewton else "each-iteration",
        "adaptive_step": "enable" if solver.it.adaptiveStep else "disable",
        "linear_solver_used": str(linear.solverType.name),
        "ignore_singular": "enable" if linear.ignoreSingularJacobian else "disable",
    }
