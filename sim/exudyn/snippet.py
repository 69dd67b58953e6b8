"""exudyn settings as Python."""

from collections.abc import Mapping, Sequence

from sim.engine import Drive, Settings
from sim.exudyn.settings import AS_SHIPPED, BY_NEED, MOST_DENSE, assignments, of_drive
from sim.registry.offers import SnippetWriter, Stepping, alone, comment

DRIVES: Mapping[Drive, str] = {
    "prescribed": "Drive: an ObjectConnectorCoordinate between a NodePointGround and the angle of "
    "the crank's node, velocityLevel = True, offset = speed; all start with matching velocities.",
    "servo": "Drive: a damper between the ground and the angle of the crank's node, {gain:g} speed "
    "(sum over all bodies of mass L^2 + inertia), L the longest link, and a torque of damper times "
    "speed.",
    "free": "Drive: none. All start with the places, velocities and accelerations of the start.",
}
"""Drive of the crank in the measured runs."""
RADIUS = "generalizedAlpha.spectralRadius"
TOLERANCES = ("newton.relativeTolerance", "newton.absoluteTolerance")
REST = (*TOLERANCES, "newton.maxIterations", "adaptiveStep", "newton.residualMode")
"""Settings of time integration that are written for a system of the mechanism alone."""


def exudyn_snippet(
    asked: Settings, defaults: Settings, stepping: Stepping, drive: Drive, head: Sequence[str]
) -> list[str]:
    """Write lines that act on variables ``exu`` (the package) and ``simulationSettings``.

    The integrator and its step, which can only be the whole system's, and the tolerances of
    Newton's method, never above its own. Other differences from exudyn's defaults might spoil the
    rest of a user's system and are in a comment; see `sim.registry.offers.snippet`.
    """
    complete = of_drive(asked, drive)
    how = {
        "turns": [f"{stepping.scaled_by_speed('dt')}."],
        "frames": [
            f"A frame of {stepping.frame} has numberOfSteps = {stepping.substeps}. "
            f"{stepping.scaled_in_frames('these steps')}."
        ],
        "nothing": [],
    }
    lines = [
        *comment(*head),
        "stepping = simulationSettings.timeIntegration",
        *comment(*how[stepping.counted_in(drive)]),
        f"dt = {stepping.dt_s!r}",
        "stepping.numberOfSteps = round((stepping.endTime - stepping.startTime) / dt)",
        f"stepping.solverType = exu.DynamicSolverType.{complete['integrator']}",
    ]
    own, usual = assignments(complete), assignments(defaults)
    other = {path: value for path, value in own.items() if value != usual[path]}
    lower = [path for path in TOLERANCES if own[path] < usual[path]]
    if complete["integrator"] == "GeneralizedAlpha" and RADIUS in other:
        lines.append(f"stepping.{RADIUS} = {own[RADIUS]!r}")
    lines += [f"stepping.{path} = min(stepping.{path}, {own[path]!r})" for path in lower]
    if complete["jacobian"] == "each-step":
        lines.append("stepping.newton.modifiedNewtonJacUpdatePerStep = True  # faster here")
    if complete["jacobian"] == "each-iteration":
        lines.append("stepping.newton.useModifiedNewton = False")
    rest = [f"stepping.{path} = {own[path]!r}" for path in REST if path in {*other} - {*lower}]
    driven = DRIVES[drive].format(gain=float(complete["servo_gain"]))
    return [*lines, *comment(*_alone(rest, complete, defaults), driven)]


def _alone(lines: list[str], complete: Settings, defaults: Settings) -> list[str]:
    """Write the settings of the measured runs for a system of the mechanism alone, after ``lines``
    on its time integration."""
    linear, solver = "simulationSettings.linearSolver", complete["linear_solver"]
    by_need = solver == BY_NEED
    if solver != defaults["linear_solver"] and not by_need:
        lines.append(f"{linear}.solverType = exu.LinearSolverType.{solver}")
    if complete["beam_rounding"] != defaults["beam_rounding"]:
        times = f"{float(complete['beam_rounding']):g}"
        lines.append(f"with beams: Newton's tolerance at least {times} roundings of their pull")
    if complete["ignore_singular"] == "enable" and not by_need:
        lines.append(f"{linear}.ignoreSingularJacobian = True")
    notes = alone("system", lines)
    if by_need:
        notes.append(
            f"Where joints are redundant: {linear}.solverType = exu.LinearSolverType.EigenDense "
            "and ignoreSingularJacobian = True; elsewhere a singular matrix is a fault to be "
            f"reported. Of more than {MOST_DENSE} coordinates and constraints EigenSparse is "
            "faster."
        )
    if complete["residual"] == BY_NEED:
        notes.append(
            "Where joints and drive determine all coordinates: stepping.newton.residualMode = 1, "
            "which counts what changes in these; forces are too small for the tolerance in light "
            "and slow systems, and rounded by more than it in heavy and fast ones."
        )
    return notes


SNIPPET = SnippetWriter("python", AS_SHIPPED, exudyn_snippet)
