"""Record a run stretch by stretch, until its end or until it comes apart."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import cast

import numpy as np

from models.array import Array
from models.motion import Forces
from models.scene import Scene
from sim.energy import energy
from sim.engine import BodyPose, Cost, Facts, ForceSession, Log, Poses, Run, Session, Status
from sim.measure import gaps, motion
from sim.own_engine.watched import BrokenContractError

CHUNK_STEPS = 4000
"""Steps between two looks at whether the run has diverged."""


def chunks(steps: int, every: int) -> list[int]:
    """Lengths of the stretches, each a multiple of ``every`` but the last."""
    chunk = max(CHUNK_STEPS // every, 1) * every
    return [min(chunk, steps - done) for done in range(0, steps, chunk)]


def recorded(blank: Run, scene: Scene, session: Session, facts: Facts, runaway: float) -> Run:
    """The run, chunk by chunk, until its end or until it comes apart."""
    every = blank.every
    logs: list[Poses] = []
    acting: list[Forces] = []
    record = cast(ForceSession, session).record_forces if blank.with_forces else session.record
    opened: list[Mapping[str, Array]] = []
    warnings: list[str] = []
    wall, done = 0.0, 0
    status: Status = "ok"
    reason = ""
    for count in chunks(blank.steps, every):
        try:
            log = record(count, every)
        except BrokenContractError:
            raise
        except Exception as error:  # whatever an engine throws is a row of the result
            status, reason = "crashed", f"{type(error).__name__}: {error}"
            break
        wall, done = wall + log.wall_s, done + count
        warnings += [w for w in log.warnings if w not in warnings]
        apart_m = gaps(scene, log.poses)
        sound, fault = _sound(scene, log, apart_m, runaway)
        kept = slice(1 if logs else 0, sound)  # a stretch begins where the one before it ended
        opened.append({name: gap[kept] for name, gap in apart_m.items()})
        logs.append(stretch(log.poses, kept))
        if log.forces is not None:
            acting.append(log.forces.stretch(kept))
        if fault:
            status, reason = "diverged", fault
            break
    if not logs:
        logs, opened = [facts.start], [gaps(scene, facts.start)]
    poses = joined(logs)
    forces = None
    if acting:
        forces = replace(Forces.joined(acting), drive_unit=scene.driver.effort_unit)
    return replace(
        blank,
        status=status,
        reason=reason,
        motion=replace(motion(scene, poses), forces=forces),
        gaps={name: np.concatenate([each[name] for each in opened]) for name in opened[0]},
        energy=energy(scene, poses) if blank.drive == "free" else None,
        velocity_time_s=poses.time_s + facts.velocity_shift * blank.dt_s,
        acceleration_time_s=poses.time_s + facts.acceleration_shift * blank.dt_s,
        stopped_at_s=float(poses.time_s[-1]),
        warnings=tuple(warnings),
        cost=Cost(wall, done, logged=True),
    )


def _sound(scene: Scene, log: Log, apart_m: Mapping[str, Array], runaway: float) -> tuple[int, str]:
    """How many samples of a log hold together, and what came apart after them.

    A joint that is open by more than the longest link, or a link that spins faster than
    ``runaway`` [rad/s], a million times the pace of the run, is not a mechanism any more.
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
    """Some of the samples, one after the other."""

    def cut(body: BodyPose) -> BodyPose:
        return BodyPose(**{name: array[kept] for name, array in vars(body).items()})

    return replace(poses.changed(cut), time_s=poses.time_s[kept])


def joined(logs: Sequence[Poses]) -> Poses:
    """Stretches of samples one after the other."""
    if len(logs) == 1:
        return logs[0]

    def join(bodies: Sequence[BodyPose]) -> BodyPose:
        return BodyPose(
            **{name: np.concatenate([vars(b)[name] for b in bodies]) for name in vars(bodies[0])}
        )

    bodies = {name: join([log.bodies[name] for log in logs]) for name in logs[0].bodies}
    return replace(logs[0], time_s=np.concatenate([log.time_s for log in logs]), bodies=bodies)
