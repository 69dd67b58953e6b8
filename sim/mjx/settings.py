"""MJX's settings: the profiles."""

from sim.engine import Setting, Settings
from sim.engine.settings import check_choices
from sim.mujoco import settings as mujoco
from sim.mujoco.ported import IDLE, profile

DOUBLE = {"precision": Setting("float64", "of JAX: errors are those of MJX, and not of rounding")}
SINGLE = {"precision": Setting("float32", "JAX's default, in which robots are trained")}
CHANGES = {
    "integrator": Setting(
        "Euler",
        "MJX has no velocity term of moving loops, which MuJoCo has had since 3.7.0: with RK4 "
        "they lag as much, and a step takes four times as long",
    ),
    "solref_timeconst_steps": Setting(2.0, "the least that MuJoCo allows"),
    "solref_dampratio": Setting(
        0.5,
        "with 2 dt, the whole gap is closed in a step: 4 times less error than with 1; less than "
        "0.4 flies apart",
    ),
    "servo_integrator": Setting("implicitfast", "MJX has no discrete steps, and Euler explodes"),
}
AS_SHIPPED = profile(mujoco.AS_SHIPPED, "mjx", "MJX's own defaults, in float64", DOUBLE)
CLOSING = "Loops closed within the step, in"
TUNED = profile(mujoco.TUNED, "mjx", f"{CLOSING} float64", CHANGES | DOUBLE)
FLOAT32 = profile(mujoco.TUNED, "mjx", f"{CLOSING} float32", CHANGES | SINGLE, "float32")
VARIANTS = (FLOAT32,)
CHOICES = {
    "integrator": ("Euler", "RK4", "implicitfast"),
    "servo_integrator": ("Euler", "RK4", "implicitfast"),
    "solver": ("CG", "Newton"),
    "precision": ("float64", "float32"),
}


def checked(settings: Settings) -> None:
    """Refuse a setting that MJX does not take. Raises SettingError."""
    check_choices(settings, CHOICES)
    mujoco.checked({**IDLE, **settings})
