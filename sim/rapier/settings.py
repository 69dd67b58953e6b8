"""Rapier's settings: the two profiles."""

from sim.engine import Profile, Setting
from sim.engine.settings import checker

SHIPPED = {
    "substeps": Setting(4, "default: num_solver_iterations of its parameters; driven motion"),
    "free_substeps": Setting(4, "default: the same, in free motion"),
    "sweeps": Setting(1, "default: over all joints in a sub-step, with the errors of positions"),
    "velocity_sweeps": Setting(1, "default: after them, for velocities alone; driven motion"),
    "free_velocity_sweeps": Setting(1, "default: the same, in free motion"),
    "motor_1_s": Setting(1e6, "gain of a motor by speed, per inertia: no other is better"),
}
AS_SHIPPED = Profile("as-shipped", "rapier", "Rapier's own defaults", SHIPPED)
TUNED = Profile(
    "tuned",
    "rapier",
    "Joints solved to the end in each sub-step; no velocities alone in free motion",
    SHIPPED
    | {
        "substeps": Setting(
            6,
            "errors shrink with their square; more cost more than they gain, as rounding is as "
            "large",
        ),
        "free_substeps": Setting(
            2,
            "single precision loses what forces add to a velocity in a sub-step, so more of "
            "them drift faster; chosen from 2, 4, 6 and 10 on the shipped free scenes",
        ),
        "sweeps": Setting(40, "if masses differ a hundredfold, fewer leave joints open"),
        "velocity_sweeps": Setting(
            100,
            "many fit the positions at the sub-step's start; fewer are of first order, and none "
            "as rough as rounded positions; chosen with the other two on the shaper with its "
            "heavy ram, tried on a four-bar with a rocker 1000 times as heavy, and at 100 rad/s",
        ),
        "free_velocity_sweeps": Setting(
            0, "each costs energy: the loss would be a hundred times as large"
        ),
    },
)
checked = checker(
    {},
    {
        **dict.fromkeys(("substeps", "free_substeps", "sweeps"), (1, 1000)),
        **dict.fromkeys(("velocity_sweeps", "free_velocity_sweeps"), (0, 1000)),
        "motor_1_s": (0.0, 1e9),
    },
)
