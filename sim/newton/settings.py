"""Newton's settings: a profile of its own for each solver but XPBD, which has two."""

from collections.abc import Mapping

from sim.engine import Drive, Profile, Setting, Settings, SettingValue
from sim.engine.settings import checker

OF_SOLVERS: Mapping[str, tuple[str, ...]] = {
    "XPBD": ("iterations", "linear_relaxation", "angular_relaxation"),
    "Kamino": ("iterations", "tolerance", "recovery"),
    "MuJoCo": (
        "iterations", "tolerance", "loop_timeconst_steps", "loop_dampratio", "loop_impedance",
        "integrator", "flywheel_ratio",
    ),
    "Featherstone": ("flywheel_ratio",),
}  # fmt: skip
"""Settings that have an effect, by solver."""

SHIPPED = {
    "solver": Setting("XPBD", "positions corrected joint by joint, in sweeps"),
    "iterations": Setting(2, "default of XPBD: sweeps over all joints; else solver iterations"),
    "linear_relaxation": Setting(0.7, "default of XPBD: share of a gap that a sweep removes"),
    "angular_relaxation": Setting(0.4, "default of XPBD: the same of a tilt out of the plane"),
    "tolerance": Setting(1e-6, "default of Kamino and, in single precision, of MuJoCo Warp"),
    "recovery": Setting(0.01, "default of Kamino: share of a gap that a step removes"),
    "loop_timeconst_steps": Setting(0.0, "default of MuJoCo: 0.02 s, and not in steps"),
    "loop_dampratio": Setting(1.0, "default of MuJoCo"),
    "loop_impedance": Setting(0.0, "default of MuJoCo: 0.9 to 0.95"),
    "integrator": Setting("implicitfast", "default of its solver MuJoCo"),
    "flywheel_ratio": Setting(
        1e6, "armature of the crank over the inertia of the mechanism, in reduced coordinates"
    ),
}
AS_SHIPPED = Profile("as-shipped", "newton", "XPBD with its own defaults", SHIPPED)
TUNED = Profile(
    "tuned",
    "newton",
    "XPBD, swept to the end: the least error of the four, and the least time",
    SHIPPED | {"iterations": Setting(50, "sweeps to the rounding of places")},
)
KAMINO = Profile(
    "kamino",
    "newton",
    "Kamino: equations of all joints, by ADMM",
    SHIPPED
    | {
        "solver": Setting("Kamino", "bodies in the plane of six coordinates, and multipliers"),
        "iterations": Setting(200, "default"),
        "recovery": Setting(1.0, "the whole gap: the default leaves 99 % of it to the next step"),
    },
)
MUJOCO = Profile(
    "mujoco",
    "newton",
    "MuJoCo Warp, by Newton: loops as stiff as a step allows",
    SHIPPED
    | {
        "solver": Setting("MuJoCo", "joint coordinates, loops closed by soft constraints"),
        "iterations": Setting(20, "Newton's method is there after one"),
        "tolerance": Setting(1e-20, "the solver stops by its iterations"),
        "loop_timeconst_steps": Setting(2.0, "the least that MuJoCo allows"),
        "loop_dampratio": Setting(0.5, "with 2 dt, the whole gap is closed in a step"),
        "loop_impedance": Setting(0.9999, "the most that MuJoCo allows"),
        "integrator": Setting("euler", "the same numbers, as nothing is damped"),
    },
)
FEATHERSTONE = Profile(
    "featherstone",
    "newton",
    "Featherstone: joint coordinates",
    SHIPPED | {"solver": Setting("Featherstone", "articulated bodies, as shipped")},
)
VARIANTS = (KAMINO, MUJOCO, FEATHERSTONE)
checked = checker(
    {
        "solver": tuple(OF_SOLVERS),
        "integrator": ("euler", "implicitfast", "implicit", "discrete"),
    },
    {
        "iterations": (1, 100_000),
        "linear_relaxation": (1e-3, 1.0),
        "angular_relaxation": (1e-3, 1.0),
        "tolerance": (0.0, 1.0),
        "recovery": (0.0, 1.0),
        "loop_timeconst_steps": (0.0, 1e9),
        "loop_dampratio": (1e-9, 1e9),
        "loop_impedance": (0.0, 0.9999),
        "flywheel_ratio": (1.0, 1e12),
    },
)


def holds(settings: Settings, dt_s: float, drive: Drive) -> Settings:
    """Return the settings that have an effect with the solver."""
    own: dict[str, SettingValue] = {"solver": settings["solver"]}
    return own | {name: settings[name] for name in OF_SOLVERS[str(settings["solver"])]}


def in_seconds(settings: Settings) -> tuple[str, ...]:
    """Return the time constant of MuJoCo's loops, if it is not given in steps."""
    soft = settings["solver"] == "MuJoCo" and not float(settings["loop_timeconst_steps"])
    return ("loop_timeconst_steps",) if soft else ()
