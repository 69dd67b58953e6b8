"""Box2D's settings: the two profiles."""

from sim.engine import Profile, Setting
from sim.engine.settings import checker

SHIPPED = {
    "substeps": Setting(4, "default of its examples: each sweeps the joints twice"),
    "joints": Setting("60 Hz", "default: their springs, or an eighth of the sub-steps' rate"),
    "motor_n_m": Setting(1e6, "most torque [N m] or force [N] of a motor: as good as any"),
}
AS_SHIPPED = Profile("as-shipped", "box2d", "Box2D's own defaults", SHIPPED)
TUNED = Profile(
    "tuned",
    "box2d",
    "Joints as stiff as the sub-step allows, and more sub-steps",
    SHIPPED
    | {
        "joints": Setting(
            "stiffest",
            "by theory: springs of 60 Hz give way by w^2 / (2 pi 60)^2 of the length at any step; "
            "in a slower unit of time they are bound by the sub-step, and errors of second order",
        ),
        "substeps": Setting(
            20,
            "errors fall as their square until places are rounded, rates as their number; chosen "
            "on a four-bar with a rocker 1000 times as heavy, tried on the shipped scenes; rounded "
            "velocities cost energy in free motion with 50",
        ),
    },
)
checked = checker(
    {"joints": ("60 Hz", "stiffest")}, {"substeps": (1, 1000), "motor_n_m": (0.0, 1e12)}
)
