"""Run one scene in one engine."""

from __future__ import annotations

import math
from dataclasses import replace
from numbers import Real

import numpy as np

from models.errors import EngineError, shown
from models.motion import State
from models.scene import Scene
from sim.check import refuse_other_model, refuse_unknown_forces
from sim.drive import pace, period
from sim.engine import Drive, Engine, Run, Settings, Setup
from sim.own_engine.watched import BrokenContractError
from sim.recording import recorded
from sim.registry import applying_beams
from sim.registry import engine as engine_of
from sim.settings import SettingError, profile_of, resolved

LEAST_STEPS_PER_PERIOD = 8
RUNAWAY = 1e6
"""Angular velocity over the pace of the run (`drive.pace`) that counts as diverged."""


def run(
    scene: Scene,
    state: State,
    engine: str | Engine,
    profile: str = "tuned",
    *,
    dt_s: float,
    steps: int,
    every: int = 1,
    drive: Drive = "prescribed",
    settings: Settings | None = None,
    open_m: float = 0.0,
    with_forces: bool = False,
) -> Run:
    """Run ``scene`` from ``state`` for ``steps`` of ``dt_s`` [s], logging every ``every``-th step.

    Joints of ``state`` may be open by ``open_m`` [m], to see what the engine makes of it. With
    forces, the motion has the reactions in all joints and the driving torque.

    Returns
    -------
    Run
        Also for a scene that the engine cannot hold (status ``unsupported``), a run that came
        apart (``diverged``, stopped early) and an engine that failed (``crashed``), with a reason.

    Raises
    ------
    EngineError
        An unknown engine, profile or setting, a missing package, a step that is not positive or
        leaves under 8 steps in a period (`sim.drive.period`), or a model in the engine that is
        not the scene; an engine of the user's own that breaks its contract.
    """
    chosen = engine_of(engine) if isinstance(engine, str) else engine
    told = setup(
        scene,
        state,
        chosen,
        profile,
        dt_s=dt_s,
        steps=steps,
        every=every,
        drive=drive,
        settings=settings,
        with_forces=with_forces,
    )
    check_steps(scene, period(scene, state, drive), dt_s, steps, every)
    blank = Run(
        **vars(told),
        status="ok",
        reason="",
        settings=told.asked,
    )
    if scene.elastic:
        raise EngineError(
            f"{scene.name}: {', '.join(scene.elastic)} bends, and an engine is given rigid "
            "segments for it: `models.cut_scenes.SegmentedScene(scene, count).rigid`"
        )
    try:
        refuse_unknown_forces(scene, chosen, with_forces=with_forces, applying_beams=applying_beams)
        session = chosen.open(scene, state, told.asked, dt_s, drive)
    except (SettingError, BrokenContractError):
        raise
    except EngineError as error:
        return replace(blank, status="unsupported", reason=str(error))
    facts = session.facts()
    refuse_other_model(scene, state, facts, dt_s, drive, open_m)
    # What almost rests may be set going by what acts later: a radian in the whole run, at least.
    own = pace(scene, state, drive)
    runaway = RUNAWAY * max(own, 1.0 / (dt_s * steps)) if own else math.inf
    return recorded(replace(blank, settings=facts.settings), scene, session, facts, runaway)


def setup(
    scene: Scene,
    state: State,
    engine: str | Engine,
    profile: str = "tuned",
    *,
    dt_s: float,
    steps: int,
    every: int = 1,
    drive: Drive = "prescribed",
    settings: Settings | None = None,
    with_forces: bool = False,
) -> Setup:
    """What `run` is asked for with these.

    Raises
    ------
    EngineError
        An unknown engine, profile or setting, or a missing package.
    """
    chosen = engine_of(engine) if isinstance(engine, str) else engine
    return Setup(
        scene=scene.name,
        engine=chosen.name,
        version=chosen.version(),
        profile=profile,
        drive=drive,
        dt_s=dt_s,
        steps=steps,
        every=every,
        start_s=state.time_s,
        reports_accelerations=chosen.reports_accelerations,
        asked=resolved(profile_of(chosen, profile), settings),
        with_forces=with_forces,
        forces_of=chosen.forces_of if with_forces else "nothing",
    )


def check_steps(scene: Scene, period: float, dt_s: float, steps: int, every: int) -> None:
    """Refuse steps that mean nothing; ``period`` is the time that they have to resolve [s]."""
    for name, number in (("dt", dt_s), ("steps", steps), ("every", every)):
        if not isinstance(number, Real):
            raise EngineError(f"{name}: found {shown(number)}; it takes a number")
    if not (np.isfinite(dt_s) and dt_s > 0.0):
        raise EngineError(f"dt: found {dt_s:g} s; it takes a step above 0")
    if period / dt_s < LEAST_STEPS_PER_PERIOD * (1 - 1e-12):
        raise EngineError(
            f"dt: {dt_s:g} s leaves {period / dt_s:.2g} steps in a period of {period:.4g} s of "
            f"{scene.name}; at least {LEAST_STEPS_PER_PERIOD} are needed, so dt up to "
            f"{period / LEAST_STEPS_PER_PERIOD:.3g} s"
        )
    if steps < 1 or every < 1:
        raise EngineError(f"steps: found {steps}, logged every {every}; both are at least 1")
