"""An engine with a scene, in the clauses' view: opened at the reference's own state."""

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
from reports.compare.compare import compare, truth_of
from reports.compare.errors import Errors
from sim.engine import Drive, Engine, Facts, ForceSession, Poses, Run, Session, Settings
from sim.engine.settings import SettingError, profile_of, resolved
from sim.own_engine.watched import BrokenContractError
from sim.run import run
from sim.run.check import refuse_other_model, rounding_of

STEPS = 600
"""Default number of steps in a period."""
ROUNDING = 1e-10
"""Largest difference of two ways to a state, over the largest number in it, in double precision."""


class NotTriedError(Exception):
    """Reason why a clause does not apply: the engine declares that it cannot hold the scene, or not
    with that drive, which is no fault; or it does not promise the subject of the clause."""


@dataclass(frozen=True)
class Subject:
    """Subject of a clause."""

    engine: Engine
    scene: Scene

    @property
    def start(self) -> State:
        """The mechanism at time 0."""
        return truth_of(Same(self.scene)).start

    def at(self, time_s: float) -> State:
        """Return the mechanism at a time."""
        return solve(self.scene, np.array([time_s]), bound=False).state()

    def in_scene(self, scene: Scene) -> Subject:
        """Return the engine with another scene."""
        return replace(self, scene=scene)

    def driven_by(self, law: Law) -> Subject:
        """Return the engine with the scene under another law."""
        return self.in_scene(replace(self.scene, driver=replace(self.scene.driver, law=law)))

    def dt_s(self, steps: int = STEPS) -> float:
        """Return the step for ``steps`` steps in a period [s]."""
        return self.scene.driver.law.period_s / steps

    @property
    def rounding(self) -> float:
        """The largest difference of two ways to the same state, over the largest number in it."""
        return max(ROUNDING, rounding_of(self.engine.precision))

    def beyond(self, limit: float) -> float:
        """Return a limit of errors of place, at least the engine's floor."""
        return max(limit, self.engine.floor)

    def refuse_other_model(self, start: State, facts: Facts, dt_s: float, drive: Drive) -> None:
        """Refuse a model that differs from the scene at its start. Raises EngineError."""
        precision = self.engine.precision
        refuse_other_model(self.scene, start, facts, dt_s, drive, precision=precision)

    def settings(self, profile: str = "tuned") -> Settings:
        """Return all settings of a profile."""
        return resolved(profile_of(self.engine, profile), None)

    def opened(
        self,
        profile: str = "tuned",
        drive: Drive = "prescribed",
        start: State | None = None,
        steps: int = STEPS,
    ) -> Session:
        """Open a session at a state, by default that of time 0, with so many steps in a period.
        Raises NotTriedError."""
        state, settings = start or self.start, self.settings(profile)
        try:
            return self.engine.open(self.scene, state, settings, self.dt_s(steps), drive)
        except (BrokenContractError, SettingError):
            raise
        except EngineError as error:
            raise NotTriedError(str(error)) from None

    def reports_forces(self) -> None:
        """Raise NotTriedError if the engine declares that it reports no forces."""
        if self.engine.forces_of == "nothing":
            why = self.engine.no_forces and f": {self.engine.no_forces}"
            raise NotTriedError(f"forces_of is nothing: it reports no forces{why}")

    def force_session(self, profile: str = "tuned", steps: int = STEPS) -> ForceSession:
        """Open as `opened`, for an engine that reports forces. Raises NotTriedError."""
        self.reports_forces()
        return cast(ForceSession, self.opened(profile, steps=steps))

    def acting(self, steps: int) -> Forces:
        """Return the forces of a period, in so many steps, each logged. Raises NotTriedError."""
        forces = self.force_session(steps=steps).record_forces(steps, 1).forces
        if forces is None:
            raise EngineError("record_forces gave a log without forces")
        return forces

    def ran(self, steps_per_turn: int, turns: float, profile: str = "tuned", every: int = 1) -> Run:
        """Return a run from time 0. Raises NotTriedError."""
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
        """Return the errors of a run; None where it logged nothing."""
        return compare(truth_of(Same(self.scene)).beside(done))


def numbers(poses: Poses, names: Sequence[str] = ()) -> Array:
    """Return all positions and velocities of the bodies, a row per sample."""
    rows = []
    for body in (poses.bodies[name] for name in names or sorted(poses.bodies)):
        rows += [body.origin, body.velocity, body.theta[:, None], body.omega[:, None]]
    return np.concatenate(rows, axis=1)


def apart(one: Poses, other: Poses) -> float:
    """Return the difference of two logs of the same instants, over the largest number; infinite
    where they have different numbers of samples, or anything is not finite."""
    a, b = numbers(one), numbers(other)
    if a.shape != b.shape or not (np.isfinite(a).all() and np.isfinite(b).all()):
        return float("inf")
    return float(np.abs(a - b).max() / max(np.abs(a).max(), 1e-300))


Check = Callable[[Subject], Iterator[str]]
"""Check that yields faults in words and numbers, none if the clause is held. Raises NotTriedError
if it does not apply."""


@dataclass(frozen=True)
class Clause:
    """One duty of every engine.

    ``title`` names it, ``why`` the harm of its breach, ``cure`` the place to look at. A clause that
    is not ``of_scenes`` is tried on the first possible scene alone.
    """

    id: str
    title: str
    why: str
    cure: str
    check: Check
    of_scenes: bool = True


def clause(
    id: str, title: str, why: str, cure: str, *, of_scenes: bool = True
) -> Callable[[Check], Clause]:
    """Return the decorator that makes a clause of its check."""
    return lambda check: Clause(id, title, why, cure, check, of_scenes)
