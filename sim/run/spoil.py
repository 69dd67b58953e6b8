"""An engine spoilt on purpose: opened as usual, then changed at chosen steps.

The file ``spoiler`` in the engine's folder does it: it changes the model in the engine, not its
log.
"""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Literal, Protocol, cast

import numpy as np

from models.array import Array
from models.motion import State
from models.scene import Point, Scene
from sim.engine import Drive, Engine, Facts, Log, Poses, Session, Settings
from sim.registry import capability
from sim.run import joined, stretch

WrongSetting = Literal["few-iterations", "first-order", "light-drive", "semi-implicit"]
"""Faults by settings alone: an iterative solver ends after one over the size, errors shrink as dt,
the drive is a share of its proper strength, velocities belong between the positions."""


@dataclass(frozen=True)
class Opening:
    """Arguments that opened a session."""

    scene: Scene
    state: State
    settings: Settings
    dt_s: float
    drive: Drive


@dataclass(frozen=True)
class Post:
    """A round post fixed to the ground: its centre and radius [m]."""

    centre: Point
    radius_m: float


class Spoiler(Protocol):
    """Faults for the sessions of one engine. Every size of 0 changes nothing."""

    @property
    def wrong_settings(self) -> Mapping[WrongSetting, Callable[[float], Settings]]:
        """Return the settings by their fault, as far as the engine has them, by a size above 0."""
        ...

    def open_loop(self, session: Session) -> None:
        """Remove the joint that closes the loop."""
        ...

    def soften(self, session: Session, opening: Opening, share: float) -> None:
        """Let the joints yield, at each step, by a share more of their load."""
        ...

    def slip(self, session: Session, by_m: float) -> None:
        """Move the joint that closes the loop on one of its two bodies [m]."""
        ...

    def pull(self, session: Session, gravity_m_s2: float) -> None:
        """Add gravity, downwards."""
        ...

    def load(self, session: Session, share: float) -> None:
        """Make the last body heavier by a share of its mass."""
        ...

    def turn(self, session: Session, angle_rad: float) -> None:
        """Turn the last body."""
        ...

    def block(self, session: Session, opening: Opening, body: str, post: Post) -> None:
        """Put a post in the way of a link, which from now on can touch it."""
        ...

    def round_state(self, session: Session, relative: float) -> None:
        """Round all positions and velocities, see `rounded`."""
        ...

    def damp(self, session: Session, per_s: float) -> None:
        """Take this part [1/s] of the speeds of all joints, or bodies, from now on."""
        ...

    def slow(self, session: Session, share: float) -> None:
        """Let the last joint, or body, be slower to turn by a share of its inertia."""
        ...

    def spin(self, session: Session, by_rad_s: float) -> None:
        """Add to the angular velocity of the last joint, or body, alone."""
        ...

    def quicken(self, session: Session, share: float) -> None:
        """Make all velocities larger by a share: they still fit the joints, not the energy."""
        ...

    def hold_back(self, session: Session, by_s: float, before: Array | None = None) -> Array:
        """Take back of all positions the change by velocities that are newer by ``by_s``, since the
        velocities ``before``; return the present velocities."""
        ...

    def lose(self, session: Session) -> None:
        """Make the velocity of the last body NaN."""
        ...


Spoil = Callable[[Spoiler, Session, Opening, int], None]
"""Action on a session after so many steps."""


def spoiler(engine: str) -> Spoiler:
    """Return the spoiler of an engine. Raises EngineError where it has none."""
    return cast(Spoiler, capability(engine, "spoiler"))


def spoilt(engine: Engine, at: tuple[int, ...], spoil: Spoil) -> Engine:
    """Return the engine with sessions that are spoilt after the steps ``at``, in rising order.

    The check of the model before the run (`sim.run.check`) can see faults after 0 steps.
    """

    def opened(
        scene: Scene, state: State, settings: Settings, dt_s: float, drive: Drive
    ) -> SpoiltSession:
        session = engine.open(scene, state, settings, dt_s, drive)
        opening = Opening(scene, state, settings, dt_s, drive)
        return SpoiltSession(session, opening, at, spoil, spoiler(engine.name))

    return replace(engine, open=opened)


class SpoiltSession:
    """A session that is stepped in stretches, and spoilt between them."""

    def __init__(
        self,
        session: Session,
        opening: Opening,
        at: tuple[int, ...],
        spoil: Spoil,
        tools: Spoiler,
    ) -> None:
        self._session, self._opening, self._spoil, self._tools = session, opening, spoil, tools
        self._ahead, self._done = list(at), 0
        self._meddle()

    def facts(self) -> Facts:
        """Read the model as the engine holds it now."""
        return self._session.facts()

    def read(self) -> Poses:
        """Read the current state."""
        return self._session.read()

    def step(self, steps: int) -> None:
        """Advance without logging."""
        for count in self._stretches(steps, 1):
            self._session.step(count)
            self._advance(count)

    def record(self, steps: int, every: int) -> Log:
        """Advance and log; spoilt only at samples, so that all are logged."""
        logs: list[Log] = []
        for count in self._stretches(steps, every):
            logs.append(self._session.record(count, every))
            self._advance(count)
            if logs[-1].diverged:
                break
        parts = [stretch(log.poses, slice(int(k > 0), None)) for k, log in enumerate(logs)]
        return replace(
            logs[-1],
            poses=joined(parts),
            steps_done=sum(log.steps_done for log in logs),
            wall_s=sum(log.wall_s for log in logs),
        )

    def _stretches(self, steps: int, every: int) -> list[int]:
        """Cut the next ``steps`` where the session is to be spoilt, or at the next sample."""
        cuts = {math.ceil((at - self._done) / every) * every for at in self._ahead}
        edges = [0, *sorted(cut for cut in cuts if 0 < cut < steps), steps]
        return [b - a for a, b in pairwise(edges)]

    def _advance(self, count: int) -> None:
        self._done += count
        self._meddle()

    def _meddle(self) -> None:
        """Spoil the session, once, if due."""
        due = [at for at in self._ahead if at <= self._done]
        if due:
            self._ahead = self._ahead[len(due) :]
            self._spoil(self._tools, self._session, self._opening, self._done)


def rounded(values: Array, relative: float) -> Array:
    """Round mantissas to multiples of ``relative``; 2^-24 makes them float32."""
    if not relative:
        return values
    mantissa, exponent = np.frexp(values)
    return np.asarray(np.ldexp(np.rint(mantissa / relative) * relative, exponent))
