"""An engine with a scene, as the clauses look at it: opened at the reference's own state."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import cast

import numpy as np

from analytic.kinematics import solve
from models.array import Array
from models.errors import EngineError
from models.motion import Forces, State
from models.scene import Same, Scene
from models.scene.laws import Law
from reports.compare.beside import Beside, truth_of
from reports.compare.compare import compare
from reports.compare.errors import Errors
from sim.engine import Drive, Engine, ForceSession, Poses, Run, Session, Settings
from sim.engine.settings import SettingError, profile_of, resolved
from sim.own_engine.watched import BrokenContractError
from sim.run import run

STEPS = 600
"""Steps in a period, where a clause says nothing else."""
ROUNDING = 1e-10
"""What two ways to the same state may differ by, over the largest number in it."""


class NotTriedError(Exception):
    """Why a clause has nothing to look at: the engine says that it can not hold the scene, or not
    with that drive, which is no fault of its; or it does not promise what the clause is of."""


@dataclass(frozen=True)
class Subject:
    """What a clause is put to."""

    engine: Engine
    scene: Scene

    @property
    def start(self) -> State:
        """The mechanism at time 0."""
        return truth_of(Same(self.scene)).start

    def at(self, time_s: float) -> State:
        """The mechanism at a time."""
        return solve(self.scene, np.array([time_s]), bound=False).state()

    def in_scene(self, scene: Scene) -> Subject:
        """The engine with another scene."""
        return replace(self, scene=scene)

    def driven_by(self, law: Law) -> Subject:
        """The engine with the scene under another law."""
        return self.in_scene(replace(self.scene, driver=replace(self.scene.driver, law=law)))

    def dt_s(self, steps: int = STEPS) -> float:
        """A step of which so many are a period [s]."""
        return self.scene.driver.law.period_s / steps

    def settings(self, profile: str = "tuned") -> Settings:
        """All settings of a profile."""
        return resolved(profile_of(self.engine, profile), None)

    def opened(
        self,
        profile: str = "tuned",
        drive: Drive = "prescribed",
        start: State | None = None,
        steps: int = STEPS,
    ) -> Session:
        """A new session at a state, that of time 0 if none, with so many steps in a period. Raises
        NotTriedError."""
        state, settings = start or self.start, self.settings(profile)
        try:
            return self.engine.open(self.scene, state, settings, self.dt_s(steps), drive)
        except (BrokenContractError, SettingError):
            raise
        except EngineError as error:
            raise NotTriedError(str(error)) from None

    def reports_forces(self) -> None:
        """Raises NotTriedError where the engine says that it reports no forces."""
        if self.engine.forces_of == "nothing":
            raise NotTriedError("forces_of says that it reports no forces")

    def force_session(self, profile: str = "tuned", steps: int = STEPS) -> ForceSession:
        """As `opened`, of an engine that reports forces. Raises NotTriedError."""
        self.reports_forces()
        return cast(ForceSession, self.opened(profile, steps=steps))

    def acting(self, steps: int) -> Forces:
        """The forces of a period, in so many steps, each logged. Raises NotTriedError."""
        forces = self.force_session(steps=steps).record_forces(steps, 1).forces
        if forces is None:
            raise EngineError("record_forces gave a log without forces")
        return forces

    def ran(self, steps_per_turn: int, turns: float, profile: str = "tuned", every: int = 1) -> Run:
        """A run from time 0. Raises NotTriedError."""
        try:
            done = run(
                self.scene,
                self.start,
                self.engine,
                profile,
                dt_s=self.dt_s(steps_per_turn),
                steps=round(turns * steps_per_turn),
                every=every,
            )
        except (BrokenContractError, SettingError):
            raise
        except EngineError:
            raise NotTriedError("the session is not the scene (EC21)") from None
        if done.status == "unsupported":
            raise NotTriedError(done.reason)
        return done

    def errors(self, done: Run) -> Errors | None:
        """The errors of a run; None where it logged nothing."""
        return compare(Beside.of(truth_of(Same(self.scene)), done))


def numbers(poses: Poses, names: Sequence[str] = ()) -> Array:
    """All positions and velocities of the bodies, a row per sample."""
    rows = []
    for body in (poses.bodies[name] for name in names or sorted(poses.bodies)):
        rows += [body.origin, body.velocity, body.theta[:, None], body.omega[:, None]]
    return np.concatenate(rows, axis=1)


def apart(one: Poses, other: Poses) -> float:
    """How far two logs of the same instants differ, over the largest number; infinite where they
    do not have as many samples, or anything is not finite."""
    a, b = numbers(one), numbers(other)
    if a.shape != b.shape or not (np.isfinite(a).all() and np.isfinite(b).all()):
        return float("inf")
    return float(np.abs(a - b).max() / max(np.abs(a).max(), 1e-300))


Check = Callable[[Subject], Iterator[str]]
"""Yields what is wrong, in words and numbers: nothing where the clause is held. Raises
NotTriedError where there is nothing to look at."""


@dataclass(frozen=True)
class Clause:
    """One thing that every engine has to do.

    ``title`` says what, ``why`` what goes wrong otherwise, ``cure`` what to look at. A clause that
    is not ``of_scenes`` is put to the first scene alone that it can be put to.
    """

    id: str
    title: str
    why: str
    cure: str
    check: Check
    of_scenes: bool = True
