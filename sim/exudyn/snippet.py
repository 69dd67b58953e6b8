"""exudyn settings as Python."""

from collections.abc import Mapping, Sequence

from sim.engine import Drive, Settings
from sim.exudyn.settings import AS_SHIPPED, BY_NEED, MOST_DENSE, NEWTON, TOLERANCES, of_drive
from sim.registry.offers import SnippetWriter, Stepping, alone, comment

DRIVES: Mapping[Drive, str] = {
    "prescribed": "Drive: an ObjectConnectorCoordinate between a NodePointGround and the angle of "
    "the crank's node, velocityLevel = True, offset = speed; all start with the velocities that go "
    "with it.",
    "servo": "Drive: a damper between the ground and the angle of the crank's node, {gain:g} speed "
    "(sum over all bodies of mass L^2 + inertia), L the longest link, and a torque of damper times "
    "speed.",
    "free": "Drive: none. All start with the places, velocities and accelerations of the start.",
}
"""Drive of the crank in the measured runs."""


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
    damped = complete["integrator"] == "GeneralizedAlpha"
    if damped and complete["spectral_radius"] != defaults["spectral_radius"]:
        radius = float(complete["spectral_radius"])
        lines.append(f"stepping.generalizedAlpha.spectralRadius = {radius!r}")
    driven = DRIVES[drive].format(gain=float(complete["servo_gain"]))
    return [*lines, *_newton(complete, defaults), *comment(*_alone(complete, defaults), driven)]


def _newton(complete: Settings, defaults: Settings) -> list[str]:
    """Write the tolerances of Newton's method, if lower than by default, and its matrix."""
    lines = []
    for name in TOLERANCES:
        if float(complete[name]) < float(defaults[name]):
            own = f"stepping.newton.{NEWTON[name]}"
            lines.append(f"{own} = min({own}, {float(complete[name])!r})")
    if complete["jacobian"] == "each-step":
        lines.append("stepping.newton.modifiedNewtonJacUpdatePerStep = True  # faster here")
    if complete["jacobian"] == "each-iteration":
        lines.append("stepping.newton.useModifiedNewton = False")
    return lines


def _alone(complete: Settings, defaults: Settings) -> list[str]:
    """Write the settings of the measured runs for a system of the mechanism alone."""
    lines = [
        f"stepping.newton.{NEWTON[name]} = {float(complete[name])!r}"
        for name in TOLERANCES
        if float(complete[name]) > float(defaults[name])
    ]
    if complete["iterations"] != defaults["iterations"]:
        lines.append(f"stepping.newton.maxIterations = {int(complete['iterations'])}")
    if complete["adaptive_step"] == "disable":
        lines.append("stepping.adaptiveStep = False")
    if complete["residual"] == "increments":
        lines.append("stepping.newton.residualMode = 1")
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
            "and ignoreSingularJacobian = True; elsewhere a singular matrix is a fault to be told "
            f"of. Of more than {MOST_DENSE} coordinates and constraints EigenSparse is faster."
        )
    if complete["residual"] == BY_NEED:
        notes.append(
            "Where joints and drive determine all coordinates: stepping.newton.residualMode = 1, "
            "which counts what changes in these; forces are too small for the tolerance in light "
            "and slow systems, and rounded by more than it in heavy and fast ones."
        )
    return notes


SNIPPET = SnippetWriter("python", AS_SHIPPED, exudyn_snippet)
