"""MuJoCo Warp's settings: the two profiles."""

from sim.engine import Setting, Settings
from sim.engine.settings import check_choices
from sim.mujoco import settings as mujoco
from sim.mujoco.ported import IDLE, profile

LEAST = Setting(1e-6, "default: it takes no less from a model; over flywheel_ratio")
WEIGHTS = Setting(1.0, "default: in single precision, less is lost in the rounding of the inertia")
AS_SHIPPED = profile(
    mujoco.AS_SHIPPED, "mujoco-warp", "MuJoCo Warp's own defaults", {"tolerance": LEAST}
)
TUNED = profile(
    mujoco.TUNED,
    "mujoco-warp",
    "As MuJoCo's profile tuned, in single precision",
    {"free_inverse_weight_share": WEIGHTS},
)
CHOICES = {"solver": ("CG", "Newton")}


def checked(settings: Settings) -> None:
    """Refuse a setting that MuJoCo Warp does not take. Raises SettingError."""
    check_choices(settings, CHOICES)
    mujoco.checked({**IDLE, **settings})
