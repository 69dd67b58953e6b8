"""Newton's solvers: how each is made with the settings of a session."""

import warnings
from collections.abc import Mapping
from typing import Any

from models.errors import EngineError
from sim.engine import Settings
from sim.engine.imported import imported, imported_warp

newton = imported("newton")
wp = imported_warp()
solvers = imported("newton.solvers")
MAXIMAL = frozenset({"XPBD", "Kamino"})
"""Solvers of bodies by their places, which take a led body as it is put. In the others, of joint
coordinates, it has a flywheel."""


def register(builder: Any, solver: str) -> None:
    """Prepare a model for a solver that has attributes of its own."""
    if solver == "Kamino":
        solvers.SolverKamino.Config.register_custom_attributes(builder)
    elif solver == "MuJoCo":
        solvers.SolverMuJoCo.register_custom_attributes(builder)


def made(model: Any, settings: Settings, dt_s: float) -> Any:
    """Return the solver of a model. Raises EngineError where it refuses the model."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of the versions of MuJoCo that it was tried with
        try:
            return MAKERS[str(settings["solver"])](model, settings, dt_s)
        except (ValueError, TypeError, NotImplementedError, RuntimeError) as error:
            said = str(error).partition("\n")[0]
            raise EngineError(f"newton: {settings['solver']} refuses the model: {said}") from None


def _xpbd(model: Any, settings: Settings, dt_s: float) -> Any:
    return solvers.SolverXPBD(
        model,
        iterations=int(settings["iterations"]),
        joint_linear_relaxation=float(settings["linear_relaxation"]),
        joint_angular_relaxation=float(settings["angular_relaxation"]),
    )


def _kamino(model: Any, settings: Settings, dt_s: float) -> Any:
    config = solvers.SolverKamino.Config()
    config.constraints.alpha = float(settings["recovery"])
    config.padmm.max_iterations = int(settings["iterations"])
    for name in ("primal_tolerance", "dual_tolerance", "compl_tolerance"):
        setattr(config.padmm, name, float(settings["tolerance"]))
    return solvers.SolverKamino(model, config)


def _mujoco(model: Any, settings: Settings, dt_s: float) -> Any:
    solver = solvers.SolverMuJoCo(
        model,
        iterations=int(settings["iterations"]),
        integrator=str(settings["integrator"]),
        disable_contacts=True,
    )
    there = solver.mjw_model
    there.opt.warn_overflow = 0
    there.opt.tolerance.fill_(float(settings["tolerance"]) / float(settings["flywheel_ratio"]))
    steps, impedance = float(settings["loop_timeconst_steps"]), float(settings["loop_impedance"])
    if steps:
        solref = wp.vec2(steps * dt_s, float(settings["loop_dampratio"]))
        there.eq_solref.fill_(solref)
    if impedance:
        for row in there.eq_solimp.numpy().reshape(-1, 5):
            row[:2] = impedance
    return solver


def _featherstone(model: Any, settings: Settings, dt_s: float) -> Any:
    return solvers.SolverFeatherstone(model)


MAKERS: Mapping[str, Any] = {
    "XPBD": _xpbd,
    "Kamino": _kamino,
    "MuJoCo": _mujoco,
    "Featherstone": _featherstone,
}
