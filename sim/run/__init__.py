"""Run of one scene in one engine, stretch by stretch, and timing of its stepping."""

import gc
import math
import statistics
import time
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from numbers import Real
from typing import Any, cast

import numpy as np

from models.array import Array
from models.errors import EngineError, shown
from models.motion import Forces, State
from models.scene import Scene
from sim.engine import (
    REPORTED,
    BodyPose,
    Cost,
    Drive,
    Engine,
    Facts,
    ForceSession,
    Log,
    Poses,
    Run,
    Session,
    Settings,
    Setup,
    Status,
)
from sim.engine.drive import pace, period
from sim.engine.measure import energy, gaps, motion
from sim.engine.settings import SettingError, profile_of, resolved
from sim.own_engine.watched import BrokenContractError
from sim.registry import applying
from sim.registry import engine as engine_of
from sim.run.check import refuse_other_model, refuse_unknown_forces

CHUNK_STEPS = 4000
"""Steps between two checks for divergence."""
LEAST_STEPS_PER_PERIOD = 8
RUNAWAY = 1e6
"""Least angular velocity that counts as diverged, over the pace of the run (`drive.pace`)."""


@dataclass(frozen=True)
class Opened:
    """A session at the start of a run, which is ``blank``, with the facts of its model; links that
    spin faster than ``runaway`` [rad/s] are no mechanism any more."""

    blank: Run
    scene: Scene
    session: Session
    facts: Facts
    runaway: float


def chunks(steps: int, every: int) -> list[int]:
    """Return the lengths of the stretches, each a multiple of ``every`` except the last."""
    chunk = max(CHUNK_STEPS // every, 1) * every
    return [min(chunk, steps - done) for done in range(0, steps, chunk)]


def recorded(opened: Opened, *, rates: bool) -> Run:
    """Record the run, chunk by chunk, until its end or divergence."""
    blank, session, every = opened.blank, opened.session, opened.blank.every
    record = cast(ForceSession, session).record_forces if blank.with_forces else session.record
    stretches = ((count, partial(record, count, every)) for count in chunks(blank.steps, every))
    return followed(opened, stretches, rates=rates)


def followed(
    opened: Opened, stretches: Iterable[tuple[int, Callable[[], Log]]], *, rates: bool
) -> Run:
    """Return the run whose stretches are so many steps each, recorded as they are called."""
    blank, scene, facts = opened.blank, opened.scene, opened.facts
    logs: list[Poses] = []
    acting: list[Forces] = []
    apart: list[Mapping[str, Array]] = []
    warnings: list[str] = []
    wall, done = 0.0, 0
    status: Status = "ok"
    reason = ""
    for count, record in stretches:
        try:
            log = record()
        except BrokenContractError:
            raise
        except Exception as error:  # any error of an engine is a row of the result
            status, reason = "crashed", f"{type(error).__name__}: {error}"
            break
        wall, done = wall + log.wall_s, done + count
        warnings += [w for w in log.warnings if w not in warnings]
        apart_m = gaps(scene, log.poses)
        sound, fault = _sound(scene, log, apart_m, opened.runaway)
        kept = slice(1 if logs else 0, sound)  # a stretch begins where the one before it ended
        apart.append({name: gap[kept] for name, gap in apart_m.items()})
        logs.append(stretch(log.poses, kept))
        if log.forces is not None:
            acting.append(log.forces.stretch(kept))
        if fault:
            status, reason = "diverged", fault
            break
    if not logs:
        logs, apart = [facts.start], [gaps(scene, facts.start)]
    poses = joined(logs)
    forces = None
    if acting:
        forces = replace(Forces.joined(acting), drive_unit=scene.driver.effort_unit)
    return replace(
        blank,
        status=status,
        reason=reason,
        motion=replace(motion(scene, poses, rates=rates), forces=forces),
        gaps={name: np.concatenate([each[name] for each in apart]) for name in apart[0]},
        energy=energy(scene, poses) if blank.drive == "free" else None,
        velocity_time_s=poses.time_s + facts.velocity_shift * blank.dt_s,
        acceleration_time_s=poses.time_s + facts.acceleration_shift * blank.dt_s,
        stopped_at_s=float(poses.time_s[-1]),
        warnings=tuple(warnings),
        cost=Cost(wall, done, logged=True),
    )


def _sound(scene: Scene, log: Log, apart_m: Mapping[str, Array], runaway: float) -> tuple[int, str]:
    """Return the number of sound samples of a log, and the fault after them.

    A joint that is open by more than the longest link, or a link that spins faster than ``runaway``
    [rad/s], a million times the pace of the run, is not a mechanism any more.
    """
    poses = log.poses
    joints_hold = [gap <= scene.longest_m for gap in apart_m.values()]  # not where it is NaN
    links_hold = [np.abs(poses.bodies[link].omega) <= runaway for link in scene.links]
    bad = ~np.logical_and.reduce([*joints_hold, *links_hold])
    count = int(np.argmax(bad)) if bad.any() else len(bad)
    if count == len(bad) and not log.diverged:
        return count, ""
    when = float(poses.time_s[min(count, len(bad) - 1)])
    if log.stopped and count == len(bad):
        return count, f"stopped after {when:.6g} s: {log.stopped}"
    return max(count, 1), f"came apart at {when:.6g} s"


def stretch(poses: Poses, kept: slice) -> Poses:
    """Return some of the samples, one after the other."""

    def cut(body: BodyPose) -> BodyPose:
        return BodyPose(**{name: array[kept] for name, array in vars(body).items()})

    return replace(poses.changed(cut), time_s=poses.time_s[kept])


def joined(logs: Sequence[Poses]) -> Poses:
    """Join stretches of samples one after the other."""
    if len(logs) == 1:
        return logs[0]

    def join(bodies: Sequence[BodyPose]) -> BodyPose:
        return BodyPose(
            **{name: np.concatenate([vars(b)[name] for b in bodies]) for name in vars(bodies[0])}
        )

    bodies = {name: join([log.bodies[name] for log in logs]) for name in logs[0].bodies}
    return replace(logs[0], time_s=np.concatenate([log.time_s for log in logs]), bodies=bodies)


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
    rates: bool = True,
) -> Run:
    """Run ``scene`` from ``state`` for ``steps`` of ``dt_s`` [s], logging every ``every``-th step.

    Joints of ``state`` may be open by ``open_m`` [m], to see the engine's reaction. With forces,
    the motion has the reactions in all joints and the driving torque. Without ``rates``, those of
    points and sliders are NaN, which saves time where places alone are compared.

    Returns
    -------
    Run
        Also for a scene that the engine cannot hold (status ``unsupported``), a run whose joints
        opened (``diverged``, stopped early) and an engine that failed (``crashed``), with a reason.

    Raises
    ------
    EngineError
        An unknown engine, profile or setting, a missing package, a step that is not positive or
        leaves under 8 steps in a period (`sim.engine.drive.period`), or a model in the engine that
        is not the scene; a user's own engine that breaks its contract.
    """
    options: Any = {"dt_s": dt_s, "steps": steps, "every": every, "drive": drive}
    options |= {"settings": settings, "with_forces": with_forces}
    opened = opened_run(scene, state, engine, profile, open_m, **options)
    return recorded(opened, rates=rates) if isinstance(opened, Opened) else opened


def opened_run(
    scene: Scene,
    state: State,
    engine: str | Engine,
    profile: str = "tuned",
    open_m: float = 0.0,
    **options: Any,
) -> Opened | Run:
    """Return the session of `run` at its start, looked at; or the run that it can not begin."""
    chosen = engine_of(engine) if isinstance(engine, str) else engine
    requested = setup(scene, state, chosen, profile, **options)
    dt_s, steps, drive = requested.dt_s, requested.steps, requested.drive
    check_steps(scene, period(scene, state, drive), dt_s, steps, requested.every)
    blank = Run(**vars(requested), status="ok", reason="", settings=requested.asked)
    if scene.elastic:
        raise EngineError(
            f"{scene.name}: {', '.join(scene.elastic)} bends, and an engine gets rigid segments "
            "for it: `models.scene.cut_scenes.SegmentedScene(scene, count).rigid`"
        )
    try:
        refuse_unknown_forces(scene, chosen, with_forces=requested.with_forces, applying=applying)
        session = chosen.open(scene, state, requested.asked, dt_s, drive)
    except (SettingError, BrokenContractError):
        raise
    except EngineError as error:
        return replace(blank, status="unsupported", reason=str(error))
    facts = session.facts()
    refuse_other_model(scene, state, facts, dt_s, drive, open_m, requested.precision)
    # Later loads may move a scene that almost rests: a radian in the whole run, at least.
    own = pace(scene, state, drive)
    runaway = RUNAWAY * max(own, 1.0 / (dt_s * steps)) if own else math.inf
    return Opened(replace(blank, settings=facts.settings), scene, session, facts, runaway)


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
    rates: bool = True,
) -> Setup:
    """Return the request of `run` with these arguments; ``rates`` are no part of it.

    Raises
    ------
    EngineError
        An unknown engine, profile or setting, or a missing package.
    """
    chosen = engine_of(engine) if isinstance(engine, str) else engine
    asked = resolved(profile_of(chosen, profile), settings)
    precision, floor = chosen.numbers(asked)
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
        asked=asked,
        with_forces=with_forces,
        forces_of=chosen.forces_of if with_forces else "nothing",
        precision=precision,
        floor=floor,
        unreported=chosen.unreported(scene, drive) if with_forces else REPORTED,
    )


def check_steps(scene: Scene, period: float, dt_s: float, steps: int, every: int) -> None:
    """Refuse useless steps; ``period`` is the time that they have to resolve [s]."""
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


@dataclass(frozen=True)
class Timing:
    """Wall times [s] of several repeats of the same ``steps``, with logging when ``logged``."""

    walls_s: tuple[float, ...]
    steps: int
    logged: bool

    @property
    def best(self) -> Cost:
        """Fastest repeat: the least disturbed."""
        return Cost(min(self.walls_s), self.steps, self.logged)

    @property
    def median(self) -> Cost:
        """Middle repeat."""
        return Cost(statistics.median(self.walls_s), self.steps, self.logged)


def time_run(
    scene: Scene,
    state: State,
    engine: str | Engine,
    profile: str = "tuned",
    *,
    dt_s: float,
    steps: int,
    every: int = 0,
    repeats: int = 5,
    drive: Drive = "prescribed",
    settings: Settings | None = None,
) -> Timing:
    """Time the stepping alone, or with logging where ``every`` is above 0.

    Each repeat opens a new session and steps it warm first; the collector is off meanwhile. Raises
    EngineError as `run`, and for a scene that the engine cannot hold.
    """
    chosen = engine_of(engine) if isinstance(engine, str) else engine
    asked = resolved(profile_of(chosen, profile), settings)
    check_steps(scene, period(scene, state, drive), dt_s, steps, max(every, 1))
    refuse_unknown_forces(scene, chosen, with_forces=False, applying=applying)
    walls = []
    collecting = gc.isenabled()
    gc.disable()
    try:
        for _ in range(repeats):
            session = chosen.open(scene, state, asked, dt_s, drive)
            session.step(max(steps // 10, 1))
            walls.append(_wall(session, steps, every))
    finally:
        if collecting:
            gc.enable()
    return Timing(tuple(walls), steps, logged=every > 0)


def _wall(session: Session, steps: int, every: int) -> float:
    if every:
        return sum(session.record(n, every).wall_s for n in chunks(steps, every))
    began = time.perf_counter()
    session.step(steps)
    return time.perf_counter() - began
