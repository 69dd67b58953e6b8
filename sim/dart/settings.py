"""DART's settings: the two profiles."""

from sim.engine import Profile, Setting
from sim.engine.settings import checker

SHIPPED = {
    "error_reduction": Setting(0.01, "default: share of a loop's error that a step removes"),
    "force_mixing": Setting(1e-9, "default, and the least: softness of loops"),
    "coriolis": Setting(
        "before", "as it steps: forces of rates use the joint rates of half a step before"
    ),
    "motor_n_m": Setting(1e6, "largest torque [N m] or force [N] of a servo: no other is better"),
}
AS_SHIPPED = Profile("as-shipped", "dart", "DART's own defaults", SHIPPED)
TUNED = Profile(
    "tuned",
    "dart",
    "Errors of loops removed within the step",
    SHIPPED
    | {
        "error_reduction": Setting(
            1.0,
            "the whole error in one step: the error of the lecture's rocker at 1 ms is 4.5e-5 "
            "rad, 8.9e-5 with 0.5, 2.0e-3 with the default",
        ),
        "coriolis": Setting(
            "middle",
            "rates at the positions: the difference of its own Coriolis forces is given as "
            "joint forces; in free motion, errors shrink as dt^2 instead of dt (double "
            "pendulum, 2 s: 2.3e-6 instead of 5.8e-4 of the sensitivity)",
        ),
    },
)
checked = checker(
    {"coriolis": ("before", "middle")},
    {"error_reduction": (0.0, 1.0), "force_mixing": (1e-9, 1.0), "motor_n_m": (0.0, 1e12)},
)
