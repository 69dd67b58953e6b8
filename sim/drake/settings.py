"""Drake's settings: the two profiles.

The give of its loops can not be set: a ball constraint has a near-rigid parameter of
0.1, and a relaxation time of a step, so that a step closes half of a gap.
"""

from sim.engine import Profile, Setting
from sim.engine.settings import checker

SHIPPED = {
    "rotor_inertia": Setting(
        1e3, "of the drive `prescribed`, over inertia scale: the rotor of a heavy motor"
    ),
    "servo_gain": Setting(
        1e3, "of the drive `servo`, over inertia scale times peak speed: damping of its joint"
    ),
    "bias_rates": Setting(
        "before", "products of rates as Drake has them: with rates of half a step before its forces"
    ),
}
AS_SHIPPED = Profile("as-shipped", "drake", "Drake's own solver and rates", SHIPPED)
TUNED = Profile(
    "tuned",
    "drake",
    "A rotor that no mechanism slows down; products of rates at the instant of other forces",
    SHIPPED
    | {
        "rotor_inertia": Setting(
            1e8,
            "an error of the driver of 7e-14 rad at steps of 0.1 rad, and of 7e-9 with 1e3; 1e10 "
            "loosens SAP's test, relative to all momentum: at steps of 1e-4 rad some pass unsolved",
        ),
        "bias_rates": Setting(
            "middle",
            "unless the driver is prescribed, forces given to Drake correct the half step: free "
            "motion is of second order, not first; after 2 s of double-pendulum in steps of 1 "
            "ms its error is 2e-6 rad over its sensitivity, not 6e-4",
        ),
    },
)
checked = checker(
    {"bias_rates": ("before", "middle")}, {"rotor_inertia": (1.0, 1e12), "servo_gain": (1e-9, 1e12)}
)
