"""Box2D's settings: the two profiles."""

from sim.engine import Profile, Setting, Settings
from sim.engine.settings import SettingError, check_ranges

SHIPPED = {
    "substeps": Setting(4, "default of its examples: in each, joints are solved twice"),
    "joint_swings": Setting(
        0.0,
        "default: 0 leaves the springs that are its joints at 60 Hz; other numbers set another "
        "unit of time, with at most an eighth in a sub-step",
    ),
    "motor_n_m": Setting(1e6, "largest torque [N m] or force [N] of a motor: no other is better"),
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
            "errors shrink with their square (of rates with their number), down to rounding; "
            "best are about 20 for four-bars with a rocker 1000 times as heavy, or at 100 "
            "rad/s, 25 for the shipped free scenes, and 50 for presses, but with more rounding",
        ),
    },
)
RANGES = {"substeps": (1, 1000), "joint_swings": (0.0, 1000.0), "motor_n_m": (0.0, 1e12)}
LEAST_SWINGS = 1e-3


def checked(settings: Settings) -> None:
    """Refuse a number outside its range. Raises SettingError."""
    check_ranges(settings, RANGES)
    if 0.0 < float(settings["joint_swings"]) < LEAST_SWINGS:
        raise SettingError(
            f"setting joint_swings: found {settings['joint_swings']:g}; it takes 0, or "
            f"{LEAST_SWINGS:g} to 1000"
        )
