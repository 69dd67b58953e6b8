"""Box2D's settings: the two profiles."""

from sim.engine import Profile, Setting
from sim.engine.settings import checker

SHIPPED = {
    "substeps": Setting(4, "default of its examples: in each, joints are solved twice"),
    "joint_swings": Setting(
        0.0,
        "default: none in a step, but 60 Hz of the springs that are its joints; more come by "
        "another unit of time, and at most an eighth in a sub-step",
    ),
    "motor_n_m": Setting(1e6, "most torque [N m] or force [N] of a motor: as good as any"),
}
AS_SHIPPED = Profile("as-shipped", "box2d", "Box2D's own defaults", SHIPPED)
TUNED = Profile(
    "tuned",
    "box2d",
    "Joints as stiff as the sub-step allows, and more sub-steps",
    SHIPPED
    | {
        "joint_swings": Setting(
            100.0,
            "by theory: 60 Hz give way by (w / 377 rad/s)^2 of the length at any step, n swings in "
            "a step by (w dt / 2 pi n)^2; above an eighth of the sub-steps nothing changes",
        ),
        "substeps": Setting(
            25,
            "errors fall as their square, of rates as their number, until numbers are rounded; "
            "about 20 by a four-bar whose rocker is 1000 times as heavy, and one at 100 rad/s; 25 "
            "by the shipped free scenes; presses ask for 50, which round more",
        ),
    },
)
checked = checker(
    {}, {"substeps": (1, 1000), "joint_swings": (0.0, 1000.0), "motor_n_m": (0.0, 1e12)}
)
