"""Simbody's settings: the two profiles."""

from sim.engine import Placing, Profile, Setting, Settings
from sim.engine.settings import checker

INTEGRATORS = (
    "RungeKuttaMerson",
    "RungeKutta3",
    "RungeKuttaFeldberg",
    "Verlet",
    "SemiExplicitEuler2",
    "CPodes",
)
SHIPPED = {
    "integrator": Setting("RungeKuttaMerson", "default: fourth order"),
    "steps": Setting("controlled", "default: as many in a step as the accuracy needs"),
    "accuracy": Setting(1e-3, "default: error of controlled steps, over the size of a number"),
    "constraint_tolerance": Setting(
        1e-4,
        "default, in m and rad: joints are closed by projection where they open farther; over the "
        "largest length or coordinate where that is above 1 m",
    ),
    "servo_integrator": Setting("CPodes", "implicit: for the stiff motor of the drive `servo`"),
    "servo_gain": Setting(1e3, "of the drive `servo`, over inertia scale times peak speed"),
}
AS_SHIPPED = Profile("as-shipped", "simbody", "OpenSim's own defaults", SHIPPED)
TUNED = Profile(
    "tuned",
    "simbody",
    "Joints closed to rounding, and steps cut where they need it",
    SHIPPED
    | {
        "accuracy": Setting(
            1e-8,
            "free motion keeps its phase to 1e-7, and mechanisms that nearly reach a singular "
            "position have errors of 1e-9, and come apart with fixed steps of 5 ms",
        ),
        "constraint_tolerance": Setting(
            1e-12,
            "errors of angles and of forces are 1e-11 at 1 ms; with 1e-11 the projections show "
            "as jumps of 2e-10 from sample to sample, below it rounding of angles of many turns "
            "dominates",
        ),
    },
)
SOLVED = 1e-10
"""Constraint tolerance at which positions are those of closed joints, not of the steps."""
checked = checker(
    {"integrator": INTEGRATORS, "servo_integrator": INTEGRATORS, "steps": ("fixed", "controlled")},
    {
        "accuracy": (1e-13, 0.1),
        "constraint_tolerance": (1e-14, 0.1),
        "servo_gain": (1e-9, 1e15),
    },
)


def placing(settings: Settings) -> Placing:
    """Return the source of positions."""
    return "solved" if float(settings["constraint_tolerance"]) <= SOLVED else "integrated"
