"""MuJoCo's settings: the two profiles, and the MJCF text of a set of settings."""

import re

from models.mjcf import options
from models.scene import Scene, joints, loads
from sim.engine import Drive, Profile, Setting, Settings, SettingValue
from sim.engine.settings import as_held, checker

INTEGRATORS = ("Euler", "RK4", "implicit", "implicitfast", "discrete")
"""Integrators in MuJoCo's own order."""
CHOICES = {
    "integrator": INTEGRATORS,
    "servo_integrator": INTEGRATORS,
    "solver": ("PGS", "CG", "Newton"),
    "islands": ("enable", "disable"),
    "contact": ("enable", "disable"),
}

RANGES = {
    "iterations": (1, 1_000_000),
    "tolerance": (0.0, 1.0),
    "solref_timeconst_s": (1e-9, 1e9),
    "solref_timeconst_steps": (0.0, 1e9),
    "solref_dampratio": (1e-9, 1e9),
    "solimp_dmin": (1e-4, 0.9999),
    "solimp_dmax": (1e-4, 0.9999),
    "solimp_width": (0.0, 1e9),
    "flywheel_ratio": (1.0, 1e15),
    "servo_gain": (1e-9, 1e15),
    "free_timeconst_steps": (0.0, 1e9),
    "free_inverse_weight_share": (1e-12, 1.0),
}
"""Ranges in MuJoCo, which silently clips impedances to these."""
MORE_ITERATIONS = {"friction": 20, "springs": 20, "contact": 20, "free_weight_share": 4}
"""Iterations by cause, beyond those of pins as stiff as by the compiled weights."""
OF_IMPEDANCE = ("solimp_dmin", "solimp_dmax", "solimp_width")
OF_LOOPS = ("solref_timeconst_s", "solref_dampratio", *OF_IMPEDANCE)
OF_DRIVES = ("flywheel_ratio", "servo_gain", "servo_integrator")
OF_FREE = ("free_timeconst_steps", "free_inverse_weight_share")

FREE_STEPS, FREE_WEIGHT_SHARE = 32.0, 1e-7
"""Time constant of the loop closures in steps, and the share of the bodies' inverse weights, in
free motion: `benchmarks/free_loops.py` compares others."""
SEGMENTS_SHARE = 1e-4
"""Least share for chains of elastic segments: with 16 it costs 4e-8 of the deflection, weights as
compiled 1e-7, and 1e-7 of them 5e-6."""

AS_SHIPPED = Profile(
    "as-shipped",
    "mujoco",
    "MuJoCo's own defaults",
    {
        "integrator": Setting("Euler", "default: semi-implicit Euler"),
        "solver": Setting("Newton", "default"),
        "iterations": Setting(100, "default"),
        "tolerance": Setting(
            1e-8, "default; over flywheel_ratio, so that it means what it does without a flywheel"
        ),
        "solref_timeconst_s": Setting(0.02, "default: loops close with a time constant of 0.02 s"),
        "solref_timeconst_steps": Setting(0.0, "not used: the time constant is given in seconds"),
        "solref_dampratio": Setting(1.0, "default: critical damping"),
        "solimp_dmin": Setting(0.9, "default: constraints give way by 10 % at no gap"),
        "solimp_dmax": Setting(0.95, "default: and by 5 % at gaps over the width"),
        "solimp_width": Setting(0.001, "default [m]"),
        "islands": Setting("enable", "default"),
        "contact": Setting("enable", "default"),
        "close": Setting("", "the pins that `models.mjcf.tree` chooses; names with + or , between"),
        "flywheel_ratio": Setting(options.FLYWHEEL_RATIO, "the drive, not an engine default"),
        "servo_gain": Setting(1e3, "of the drive `servo`, over inertia scale times peak speed"),
        "servo_integrator": Setting("Euler", "default; takes the place of integrator under servo"),
        "free_timeconst_steps": Setting(0.0, "not used: free loops close as driven ones"),
        "free_inverse_weight_share": Setting(1.0, "default: mjModel.body_invweight0 as compiled"),
    },
)
TUNED = Profile(
    "tuned",
    "mujoco",
    "Fourth-order steps and loops as stiff as the step allows",
    dict(AS_SHIPPED.settings)
    | {
        "integrator": Setting("RK4", "between the samples the motion is smooth: 500 x less error"),
        "tolerance": Setting(
            options.TOLERANCE,
            "over flywheel_ratio, as MuJoCo's stopping rule is scaled by the inertia of the whole "
            "model, flywheel included; low enough for cranks of 0.01 rad/s, and 25 % faster than 0",
        ),
        "iterations": Setting(2, "pins give a quadratic problem, which Newton solves in one"),
        "solref_timeconst_steps": Setting(
            options.STIFF_STEPS,
            "with dampratio, 3 dt of stiffness: at 2 dt (the least MuJoCo allows) RK4 resolves the "
            "closing spring badly, above 4 dt it gives way more; found by `crankcheck tune` over "
            "several scenes",
        ),
        "solref_dampratio": Setting(
            options.STIFF_DAMPING,
            "as above; against 4 dt at 1 the worst of all shipped scenes has 1.6 times less error, "
            "and 3 times less in accelerations",
        ),
        "solimp_dmin": Setting(
            options.STIFF_IMPEDANCE, "the most MuJoCo allows: give way by 0.01 % only"
        ),
        "solimp_dmax": Setting(options.STIFF_IMPEDANCE, "as dmin: no dependence on the gap"),
        "servo_integrator": Setting(
            "discrete",
            "a stiff servo explodes under explicit integrators, and implicitfast solves the loops "
            "for the acceleration before the servo acts; takes the place of integrator under servo",
        ),
        "free_timeconst_steps": Setting(
            FREE_STEPS,
            "replaces solref_timeconst_steps in free motion: loops that do not give way need "
            "hardly any correction, and a soft spring takes less energy",
        ),
        "free_inverse_weight_share": Setting(
            FREE_WEIGHT_SHARE,
            "in free motion body_invweight0 times this once compiled: the give of loops follows "
            "it, and solimp alone can not lower it under 0.01 %; MJCF has no attribute for it",
        ),
        "islands": Setting("disable", "one system of loops: 7 % faster, same numbers"),
        "contact": Setting("disable", "nothing touches: 15 % faster, same numbers"),
    },
)


checked = checker(CHOICES, RANGES)


def writing(scene: Scene, settings: Settings, dt_s: float, drive: Drive) -> options.Writing:
    """Return the options of the MJCF text for the settings."""
    checked(settings)
    held = holds(settings, dt_s, drive)
    scale = joints.inertia_scale(scene) * scene.pace_rad_s
    solimp = (*(float(settings[name]) for name in OF_IMPEDANCE), 0.5, 2.0)
    contact = "enable" if touches(scene) else str(settings["contact"])
    damping, driven = float(settings["solref_dampratio"]), holds(settings, dt_s, "prescribed")
    return options.Writing(
        close=tuple(p.strip() for p in re.split("[+,]", str(settings["close"])) if p.strip()),
        option={
            "timestep": dt_s,
            "integrator": str(held["integrator"]),
            "solver": str(settings["solver"]),
            "iterations": _iterations(scene, settings, drive)[0],
            "tolerance": float(held["tolerance"]),
        },
        flag={"island": str(settings["islands"]), "contact": contact},
        connect={"solref": (float(held["solref_timeconst_s"]), damping), "solimp": solimp},
        rubbing={"solref": (float(driven["solref_timeconst_s"]), damping), "solimp": solimp},
        flywheel_ratio=float(settings["flywheel_ratio"]),
        servo_gain=float(settings["servo_gain"]) * scale if drive == "servo" else None,
        delay_s=velocity_shift(settings, drive) * dt_s,
        free=drive == "free",
    )


def _iterations(scene: Scene, settings: Settings, drive: Drive) -> tuple[int, str]:
    """Return the iterations of the settings, or more where a cause needs them, and the cause.

    Pins give a quadratic problem. Friction: its choice of two signs makes the problem more than
    quadratic. Contact: so does its choice to push or not. Springs: the integrator `discrete` solves
    inertia and stiffness together by conjugate gradients, as many of them as there are iterations,
    and gives the run up where they do not converge. Lower weights in free motion: the rounding of
    the first passes remains in so stiff a problem.
    """
    cause = "free_weight_share" if weight_share(scene, settings, drive) != 1 else ""
    if scene.friction:
        cause = "friction"
    elif touches(scene):
        cause = "contact"
    elif scene.springs and integrator(settings, drive) == "discrete":
        cause = "springs"
    return max(int(settings["iterations"]), MORE_ITERATIONS.get(cause, 0)), cause


def touches(scene: Scene) -> bool:
    """True if a cam is held by contact."""
    return any(pair.facets for pair in scene.cams.values())


def weight_share(scene: Scene, settings: Settings, drive: Drive) -> float:
    """Return the ratio of the bodies' inverse weights in free motion to the compiled ones.

    Rounding goes up as the weights go down, and makes chains of elastic segments ring, without
    damping: their weights go down less.
    """
    asked = float(used(settings, drive).get("free_inverse_weight_share", 1.0))
    ringing = any(isinstance(spring, loads.SegmentSpring) for spring in scene.springs.values())
    return max(asked, SEGMENTS_SHARE) if ringing and asked < 1.0 else asked


def held(
    scene: Scene, settings: Settings, drive: Drive, iterations: int, share: float
) -> dict[str, SettingValue]:
    """Return what is found in a model, as settings: its iterations and, in free motion, the ratio
    of the bodies' inverse weights to the compiled ones."""
    given, cause = _iterations(scene, settings, drive)
    told = as_held("iterations", int(settings["iterations"]), given, iterations, cause)
    if touches(scene):
        told |= as_held("contact", str(settings["contact"]), "enable", "enable", "cams")
    if drive != "free":
        return told
    asked, scaled = settings["free_inverse_weight_share"], weight_share(scene, settings, drive)
    cause = "segments" if scaled != asked else ""
    return told | as_held("free_inverse_weight_share", asked, scaled, share, cause)


def holds(settings: Settings, dt_s: float, drive: Drive) -> Settings:
    """Return the settings as MuJoCo has them, with the values that depend on step and drive;
    without the pins that close the loops, which depend on the scene."""
    ratio, tolerance = float(settings["flywheel_ratio"]), float(settings["tolerance"])
    in_force = used(settings, drive)
    own_steps = float(in_force.get("free_timeconst_steps", 0.0))
    steps = own_steps or float(settings["solref_timeconst_steps"])
    return {name: value for name, value in in_force.items() if name != "close"} | {
        "integrator": integrator(settings, drive),
        "tolerance": tolerance / ratio if drive == "prescribed" else tolerance,
        "solref_timeconst_steps": steps,
        "solref_timeconst_s": steps * dt_s if steps else float(settings["solref_timeconst_s"]),
    }


def used(settings: Settings, drive: Drive) -> Settings:
    """Return the settings that have an effect with a drive."""
    idle = OF_DRIVES if drive == "free" else OF_FREE
    return {name: value for name, value in settings.items() if name not in idle}


def in_seconds(settings: Settings) -> tuple[str, ...]:
    """Return the time constant of the loops, if not given in steps."""
    return () if float(settings["solref_timeconst_steps"]) else ("solref_timeconst_s",)


def velocity_shift(settings: Settings, drive: Drive) -> float:
    """Return the instant of a state's velocities, in steps after its positions.

    RK4 steps both together; the others move positions with the new velocity, the mean over the step
    before.
    """
    return 0.0 if integrator(settings, drive) == "RK4" else -0.5


def integrator(settings: Settings, drive: Drive) -> str:
    """Return the integrator of a drive."""
    return str(settings["servo_integrator" if drive == "servo" else "integrator"])
