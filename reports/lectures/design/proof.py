"""The proof of a mechanism: an engine runs it, and its positions are checked."""

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from analytic.kinematics import solve
from analytic.lectures.synthesis.design import Asked, AskedAngle, AskedPlace
from analytic.lectures.synthesis.examine import Examined, passing_times
from models.array import Array
from models.lectures.shipped_tables import TaskTable
from models.motion import Motion
from models.scene import Scene
from sim.run import run

STEPS_PER_TURN = 720.0
LEVERS = 6
"""Number of samples that interpolate a place between two of them: their polynomial has less error
than the drive of an engine, some 1e-12."""
OF_LONGEST, DEGREES = 1e-3, 0.1
"""Default tolerances of a position: share of the longest link, and angle."""


@dataclass(frozen=True)
class Met:
    """Result of an engine (or the reference) for a requirement at a position: its error [m or rad]
    and limit, NaN where it reached no such position (``reason``)."""

    engine: str
    profile: str
    position: int
    driver_rad: float
    asked: Asked
    off: float
    limit: float
    reason: str = ""

    @property
    def within(self) -> bool:
        """True if the position is met."""
        return self.off <= self.limit


def proven(
    examined: Examined,
    task: TaskTable,
    engine: str,
    profile: str = "tuned",
    steps_per_turn: float = STEPS_PER_TURN,
) -> list[Met]:
    """Run an examined mechanism in an engine, and check it when its driver has the stated angles.

    Returns
    -------
    list[Met]
        A result for each requirement at each position; a failed run has its reason.

    Raises
    ------
    EngineError
        An unknown engine or profile, or a missing package.
    """
    scene = examined.scene
    at_s = passing_times(scene.driver.law, [p.driver_rad for p in examined.positions])
    dt_s = scene.driver.law.period_s / steps_per_turn
    steps = math.ceil(at_s.max() / dt_s) + LEVERS
    state = solve(scene, np.zeros(1), bound=False).state(0)
    done = run(scene, state, engine, profile, dt_s=dt_s, steps=steps)
    motion = None if done.motion is None else _between(done.motion, at_s)
    reason = "" if done.status == "ok" else f"{done.status}: {done.reason}"
    return list(_met(examined, task, engine, profile, motion, reason))


def by_reference(examined: Examined, task: TaskTable) -> list[Met]:
    """The results of the reference, as in `proven`."""
    at_s = passing_times(examined.scene.driver.law, [p.driver_rad for p in examined.positions])
    motion = solve(examined.scene, at_s, bound=False)
    return list(_met(examined, task, "reference", "", motion, ""))


def _met(
    examined: Examined,
    task: TaskTable,
    engine: str,
    profile: str,
    motion: Motion | None,
    reason: str,
) -> Iterator[Met]:
    for number, position in enumerate(examined.positions, 1):
        for asked in position.asked:
            off = math.nan if motion is None else float(np.abs(asked.off(motion))[number - 1])
            limit = limit_of(asked, examined.scene, task)
            yield Met(engine, profile, number, position.driver_rad, asked, off, limit, reason)


def limit_of(asked: Asked, scene: Scene, task: TaskTable) -> float:
    """The tolerance of a position [rad or m]: the task's, or the default."""
    if isinstance(asked, AskedAngle):
        return math.radians(DEGREES if task.tolerance_deg is None else task.tolerance_deg)
    return OF_LONGEST * scene.longest_m if task.tolerance_m is None else task.tolerance_m


def in_words(asked: Asked) -> str:
    """The requirement in words, for a table."""
    if isinstance(asked, AskedAngle):
        return f"angle of {asked.link}"
    return f"place of {asked.point if isinstance(asked, AskedPlace) else asked.slider}"


def unit_of(asked: Asked) -> str:
    """The unit of the error of a requirement."""
    return "rad" if isinstance(asked, AskedAngle) else "m"


def _between(motion: Motion, at_s: Array) -> Motion:
    """A logged motion interpolated at instants; NaN at instants that it did not reach."""
    t = motion.time_s
    dt = float(t[1] - t[0]) if len(t) > 1 else 1.0
    first = np.clip(np.floor((at_s - t[0]) / dt).astype(int) - LEVERS // 2 + 1, 0, None)
    there = (first + LEVERS <= len(t)) & (at_s >= t[0] - 1e-9 * dt)
    rows = np.where(there, first, 0)[:, None] + np.arange(LEVERS)
    rows = np.minimum(rows, len(t) - 1)
    along = (at_s - t[0]) / dt - np.where(there, first, 0)
    weights = np.where(there[:, None], _lagrange(along), np.nan)

    def read(series: Array) -> Array:
        return np.asarray(np.einsum("tk,tk...->t...", weights, series[rows]))

    return replace(motion.each_series(read), time_s=at_s)


def _lagrange(along: Array) -> Array:
    """The weights of samples 0, 1, 2 ... at places along them, (T, `LEVERS`)."""
    nodes = np.arange(LEVERS)
    weights = np.ones((len(along), LEVERS))
    for k in nodes:
        for other in nodes[nodes != k]:
            weights[:, k] *= (along - other) / (k - other)
    return weights
