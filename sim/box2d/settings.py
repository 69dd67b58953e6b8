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
    "trial",
    SHIPPED | {"joints": Setting("stiffest", "x"), "substeps": Setting(50, "x")},
)
checked = checker(
    {"joints": ("60 Hz", "stiffest")}, {"substeps": (1, 1000), "motor_n_m": (0.0, 1e12)}
)
