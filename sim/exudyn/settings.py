"""exudyn's settings: the two profiles, and their form in its own structures."""

from typing import Any

from sim.engine import Drive, Placing, Profile, Setting, Settings
from sim.engine.settings import checker

INTEGRATORS = ("GeneralizedAlpha", "TrapezoidalIndex2")
"""Implicit integrators; explicit ones take no joints."""
JACOBIANS = ("as-needed", "each-step", "each-iteration")
"""Updates of the matrix of Newton's method: where it converges slowly, at each step, or always."""
RESIDUALS = ("forces", "increments")
"""Residuals of Newton's method: forces and gaps in N and m alike, or changes of the coordinates."""
BY_NEED = "by-need"
"""Choices of crankcheck by the system at the start; see the reasons of `TUNED`."""
MOST_DENSE = 60
NEWTON = {
    "relative_tolerance": "relativeTolerance",
    "absolute_tolerance": "absoluteTolerance",
    "iterations": "maxIterations",
}
"""exudyn's own names of the settings of Newton's method."""
SWITCH = ("enable", "disable")
CHOICES = {
    "integrator": INTEGRATORS,
    "jacobian": JACOBIANS,
    "adaptive_step": SWITCH,
    "residual": (*RESIDUALS, BY_NEED),
    "linear_solver": ("EXUdense", "EigenDense", "EigenSparse", BY_NEED),
    "ignore_singular": SWITCH,
}
RANGES = {
    **dict.fromkeys(("spectral_radius", "free_spectral_radius"), (0.0, 1.0)),
    **dict.fromkeys(("relative_tolerance", "absolute_tolerance"), (0.0, 1.0)),
    "iterations": (1, 1_000_000),
    "beam_rounding": (0.0, 1e9),
    "servo_gain": (1e-9, 1e15),
}
"""Ranges in exudyn, and useful limits where it has none."""

AS_SHIPPED = Profile(
    "as-shipped",
    "exudyn",
    "exudyn's own defaults",
    {
        "integrator": Setting(
            "GeneralizedAlpha", "default: joints closed in their places (index 3)"
        ),
        "spectral_radius": Setting(
            0.9, "default: damps motion faster than the step by 10 % a step"
        ),
        "free_spectral_radius": Setting(
            0.9, "replaces the other with the drive `free`: default, the same"
        ),
        "residual": Setting("forces", "default: residualMode 0, forces and gaps alike"),
        "relative_tolerance": Setting(1e-8, "default: of Newton's method, over the first residual"),
        "absolute_tolerance": Setting(1e-10, "default: of the residual"),
        "beam_rounding": Setting(
            0.0,
            "for beams: the least absolute tolerance, over the rounding of their forces",
            of_beams=True,
        ),
        "iterations": Setting(25, "default: the most that Newton's method may take"),
        "jacobian": Setting("as-needed", "default: useModifiedNewton, updated where it is slow"),
        "adaptive_step": Setting(
            "enable",
            "default: a failed step is cut; to end at each sample exudyn is called step by "
            "step, and computes Newton's matrix again in each, which takes a third less time "
            "than a simulation in one go",
        ),
        "linear_solver": Setting("EXUdense", "default"),
        "ignore_singular": Setting("disable", "default: redundant joints end the run"),
        "servo_gain": Setting(1e3, "of the drive `servo`, over inertia scale times peak speed"),
    },
)
TUNED = Profile(
    "tuned",
    "exudyn",
    "Vibration of the start damped at once, Newton's matrix at each step, redundant joints allowed",
    dict(AS_SHIPPED.settings)
    | {
        "spectral_radius": Setting(
            0.4,
            "accelerations start with an error, a part of their change in a step, which rings "
            "for 60 steps with 0.9 and for 5 with 0.4; 0.4 rings least over all shipped scenes, "
            "and 0 has 2.6 times the error of velocities",
        ),
        "free_spectral_radius": Setting(
            0.9,
            "with the drive `free`: the start has the correct accelerations, so nothing rings, "
            "and damping would slow the motion itself: in 10 s of fourbar-swing, steps of 1 ms, "
            "0.4 loses 20 times the energy that 0.9 loses, and has 1.8 times the error over its "
            "sensitivity; 1 diverges",
        ),
        "residual": Setting(
            BY_NEED,
            "increments of the coordinates, if joints and drive determine them all: they mean "
            "the same for all masses, speeds and loads. Forces and gaps end the iterations too "
            "soon in light and slow mechanisms, whose forces are below the tolerance, or beside "
            "a heavy load, and never in heavy and fast ones, whose forces are rounded by more. "
            "If inertia determines some coordinates, increments would leave their accelerations "
            "open: forces, with a tolerance above the rounding of inertia",
        ),
        "beam_rounding": Setting(
            16.0,
            "for beams: no residual is below the rounding of their axial force; with a lower "
            "tolerance steps fail and are cut, which excites vibration: the deflection of "
            "fourbar-elastic with 8 elements has an error of 0.08 % at 720 steps a turn, and "
            "0.02 % with this; finer runs and those of 16 elements break down",
            of_beams=True,
        ),
        "jacobian": Setting(
            "each-step",
            "as with single steps; in one go a step takes 3 iterations instead of 8, for a "
            "matrix, and two thirds of the time",
        ),
        "linear_solver": Setting(
            BY_NEED,
            "EXUdense; EigenDense if joints are redundant at the start, as it uses no more of "
            f"them than needed; EigenSparse above {MOST_DENSE} coordinates and constraints, "
            "where it is 1.5 to 14 times faster",
        ),
        "ignore_singular": Setting("enable", "joints that are redundant take any share of a force"),
    },
)


checked = checker(CHOICES, RANGES)


def of_drive(settings: Settings, drive: Drive) -> Settings:
    """Return the settings that exudyn holds with a drive, from a complete set."""
    if drive != "free":
        return settings
    return {**settings, "spectral_radius": settings["free_spectral_radius"]}


def of_rigid(settings: Settings) -> Settings:
    """Return the settings that exudyn holds without beams."""
    return {n: v for n, v in settings.items() if not AS_SHIPPED.settings[n].of_beams}


def placing(settings: Settings) -> Placing:
    """Return the source of positions: with joints closed in their rates they are integrated."""
    return "integrated" if settings["integrator"] == "TrapezoidalIndex2" else "solved"


def assignments(settings: Settings) -> dict[str, Any]:
    """Return exudyn's own settings of time integration, by their paths in it, that a complete set
    determines by itself."""
    return {
        "adaptiveStep": settings["adaptive_step"] == "enable",
        "generalizedAlpha.spectralRadius": settings["spectral_radius"],
        **{f"newton.{own}": settings[name] for name, own in NEWTON.items()},
        "newton.residualMode": int(settings["residual"] == "increments"),
        "newton.useModifiedNewton": settings["jacobian"] != "each-iteration",
        "newton.modifiedNewtonJacUpdatePerStep": settings["jacobian"] == "each-step",
    }
