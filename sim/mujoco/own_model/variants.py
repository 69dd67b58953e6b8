"""What is changed of a model at run time to see what it costs: something off, or the recommended
settings. Its profiles say which."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

import mujoco  # type: ignore[import-untyped]  # ships no stubs

from models.mjcf.options import STIFF_DAMPING, STIFF_IMPEDANCE, STIFF_STEPS
from sim.engine import Profile, Setting, Settings, SettingValue
from sim.mujoco.settings import INTEGRATORS
from sim.own_models import Advised
from sim.settings import SettingError, check_choices

AS_WRITTEN, RECOMMENDED = "as-written", "recommended"
KEPT, STIFF = "as-written", "stiff"
INTEGRATOR = "RK4"
TOLERANCE = 1e-16
"""Of the solver, recommended: below it no error falls any more, and it costs no iteration where the
only constraints are pins, which Newton solves in one."""
STIFF_SOLIMP = (STIFF_IMPEDANCE, STIFF_IMPEDANCE, 0.001, 0.5, 2.0)
OFF: Mapping[str, Any] = {
    "contacts": mujoco.mjtDisableBit.mjDSBL_CONTACT,
    "springs": mujoco.mjtDisableBit.mjDSBL_SPRING,
    "damping": mujoco.mjtDisableBit.mjDSBL_DAMPER,
    "friction": mujoco.mjtDisableBit.mjDSBL_FRICTIONLOSS,
    "limits": mujoco.mjtDisableBit.mjDSBL_LIMIT,
    "actuators": mujoco.mjtDisableBit.mjDSBL_ACTUATION,
    "gravity": mujoco.mjtDisableBit.mjDSBL_GRAVITY,
}
"""What can be off, and MuJoCo's flag for it."""
SOLVERS = ("PGS", "CG", "Newton")
SOLVER = "Newton"
LEAST: Mapping[str, int] = {"iterations": 100, "ls_iterations": 50}
"""Iterations of the solver, recommended: MuJoCo's own; a model that allows more keeps them."""
CHOICES = {"integrator": (KEPT, *INTEGRATORS), "loops": (KEPT, STIFF)}


def profiles(present: Iterable[str], advised: Advised) -> dict[str, Profile]:
    """The lines of a model: as written, without each of what is ``present``, and recommended."""
    lines = [
        _profile(AS_WRITTEN, "the file as it is"),
        *(
            _profile(f"{what}-off", f"as written, without {what}", off=what)
            for what in dict.fromkeys(("contacts", *present))
        ),
        _profile(
            RECOMMENDED,
            f"{'fourth-order steps, and ' * advised.integrator}loops as stiff as the step allows",
            integrator=INTEGRATOR if advised.integrator else KEPT,
            loops=STIFF,
            off="contacts" if advised.contacts_off else "",
        ),
    ]
    return {line.name: line for line in lines}


def _profile(
    name: str, summary: str, integrator: str = KEPT, loops: str = KEPT, off: str = ""
) -> Profile:
    return Profile(
        name,
        "mujoco",
        summary,
        {
            "integrator": Setting(integrator, "the file's own, or the recommended one"),
            "loops": Setting(loops, "solref and solimp of the loops, and the solver"),
            "off": Setting(off, "what is switched off, with + between"),
        },
    )


def stiff_solref(dt_s: float) -> tuple[float, float]:
    """Time constant [s] and damping ratio of a loop, recommended at a step; in six digits, as it is
    to be pasted."""
    return float(f"{STIFF_STEPS * dt_s:.6g}"), STIFF_DAMPING


def checked(settings: Settings) -> None:
    """Refuse values that mean nothing here. Raises SettingError."""
    check_choices(settings, CHOICES)
    for name in _names(settings):
        if name not in OFF:
            raise SettingError(f"setting off: found {name!r}; it takes {', '.join(OFF)}")


def applied(model: Any, loops: Iterable[int], settings: Settings, dt_s: float) -> None:
    """Set a model, whose loops are these equalities, to the settings and the step."""
    checked(settings)
    model.opt.timestep = dt_s
    if settings["integrator"] != KEPT:
        model.opt.integrator = INTEGRATORS.index(str(settings["integrator"]))
    for name in _names(settings):
        model.opt.disableflags |= int(OFF[name])
    if settings["loops"] == STIFF:
        model.opt.tolerance = min(TOLERANCE, float(model.opt.tolerance))
        model.opt.solver = SOLVERS.index(SOLVER)
        for name, least in LEAST.items():
            setattr(model.opt, name, max(least, int(getattr(model.opt, name))))
        for loop in loops:
            model.eq_solref[loop] = stiff_solref(dt_s)
            model.eq_solimp[loop] = STIFF_SOLIMP


def held(model: Any, loops: Iterable[int], settings: Settings) -> dict[str, SettingValue]:
    """The settings, and what MuJoCo holds of all that decides accuracy."""
    opt = model.opt
    told: dict[str, SettingValue] = {
        **settings,
        "timestep_s": float(opt.timestep),
        "integrator_held": INTEGRATORS[int(opt.integrator)],
        "solver": SOLVERS[int(opt.solver)],
        **{name: int(getattr(opt, name)) for name in LEAST},
        "tolerance": float(opt.tolerance),
        "disableflags": int(opt.disableflags),
    }
    rows = [
        " ".join(f"{number:g}" for number in (*model.eq_solref[loop], *model.eq_solimp[loop]))
        for loop in loops
    ]
    return told | {"loops_solref_solimp": "; ".join(dict.fromkeys(rows))}


def _names(settings: Settings) -> list[str]:
    return [name for name in str(settings["off"]).split("+") if name]
