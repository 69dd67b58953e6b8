"""Box2D's settings: the two profiles."""

from sim.engine import Profile, Setting
from sim.engine.settings import checker

SHIPPED = {
    "substeps": Setting(4, "default of its examples: solver steps in a step"),
    "joints": Setting("60 Hz", "default"),
    "motor_n_m": Setting(1e6, "most torque [N m] or force [N] of a motor: as good as any"),
}
AS_SHIPPED = Profile("as-shipped", "box2d", "Box2D's own defaults", SHIPPED)
TUNED = Profile(
    "tuned",
    "box2d",
    "More sub-steps: the only thing that stiffens its joints",
    SHIPPED
    | {
        "substeps": Setting(
            50,
            "joints are springs of 60 Hz or a quarter of the sub-steps' rate, which nothing of the "
            "package changes: they give way with the sub-step",
        )
    },
)
checked = checker({"joints": ("60 Hz", "stiffest")}, {"substeps": (1, 1000), "motor_n_m": (0.0, 1e12)})
