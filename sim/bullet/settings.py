"""Bullet's settings: the two profiles."""

from sim.engine import Profile, Setting, Settings
from sim.engine.settings import checker

AS_SHIPPED = Profile(
    "as-shipped",
    "bullet",
    "Bullet's own defaults, without its damping",
    {
        "erp": Setting(0.2, "default: share of a gap that a step closes"),
        "iterations": Setting(50, "default: most passes over the constraints in a step"),
        "residual": Setting(1e-7, "default: they end at this square of a change of speed"),
        "flywheel_ratio": Setting(100.0, "the drive, not an engine default: see tuned"),
        "servo_gain": Setting(
            1.0, "default: share of its error of speed that a motor corrects in a step"
        ),
    },
)
TUNED = Profile(
    "tuned",
    "bullet",
    "Gaps closed in a step, and constraints solved to rounding",
    dict(AS_SHIPPED.settings)
    | {
        "erp": Setting(
            1.0, "a gap stays at the error of one step over this; above 1 steps overshoot"
        ),
        "iterations": Setting(
            10_000,
            "most scenes need 50; a shaper under a servo thousands, or its error is 50 "
            "times larger",
        ),
        "residual": Setting(
            1e-24, "0 gives the same errors at 50 times the cost, 1e-7 a drive error of 2e-6 rad"
        ),
        "flywheel_ratio": Setting(
            100.0,
            "inertia of the led link over that of the mechanism: with it 20 times fewer passes "
            "suffice; above 1e6 they end early",
        ),
    },
)
checked = checker(
    {},
    {
        "erp": (0.0, 2.0),
        "iterations": (1, 1_000_000),
        "residual": (0.0, 1.0),
        "flywheel_ratio": (0.0, 1e5),
        "servo_gain": (1e-6, 1.0),
    },
)


def in_seconds(settings: Settings) -> tuple[str, ...]:
    """Return the residual, a speed, unless it is rounding."""
    return ("residual",) if float(settings["residual"]) > 1e-20 else ()
