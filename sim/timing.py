"""Time the stepping of a scene in an engine, alone or with its logging."""

from __future__ import annotations

import gc
import statistics
import time
from dataclasses import dataclass

from models.motion import State
from models.scene import Scene
from sim.check import refuse_unknown_forces
from sim.drive import period
from sim.engine import Cost, Drive, Engine, Session, Settings
from sim.recording import chunks
from sim.registry import applying_beams
from sim.registry import engine as engine_of
from sim.run import check_steps
from sim.settings import profile_of, resolved


@dataclass(frozen=True)
class Timing:
    """Wall times [s] of several repeats of the same ``steps``; logging is part when ``logged``."""

    walls_s: tuple[float, ...]
    steps: int
    logged: bool

    @property
    def best(self) -> Cost:
        """The fastest repeat: the one that was disturbed least."""
        return Cost(min(self.walls_s), self.steps, self.logged)

    @property
    def median(self) -> Cost:
        """The middle repeat."""
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

    Each repeat opens a new session and steps it warm first; the collector is off meanwhile.
    Raises EngineError as `run` does, and for a scene that the engine cannot hold.
    """
    chosen = engine_of(engine) if isinstance(engine, str) else engine
    asked = resolved(profile_of(chosen, profile), settings)
    check_steps(scene, period(scene, state, drive), dt_s, steps, max(every, 1))
    refuse_unknown_forces(scene, chosen, with_forces=False, applying_beams=applying_beams)
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
    """Wall time of the steps [s]."""
    if every:
        return sum(session.record(n, every).wall_s for n in chunks(steps, every))
    began = time.perf_counter()
    session.step(steps)
    return time.perf_counter() - began
