"""An engine for tests: it returns the poses of an exact motion, with an error put in on purpose."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from typing import get_args

import numpy as np
from numpy.typing import NDArray

from analytic.kinematics import solve
from models.array import Array
from models.errors import EngineError
from models.motion import Motion, State
from models.scene import GROUND, Scene
from models.scene.joints import blocks, bodies, centre_of, mass_of, sliding_angle
from sim.engine import (
    AT_ROUNDING,
    REPORTED,
    BodyPose,
    Drive,
    Facts,
    ForcesOf,
    Log,
    Placing,
    Poses,
    Precision,
    Profile,
    Setting,
    Settings,
    Unreported,
)
from sim.engine.settings import check_ranges
from sim.run.spoil import rounded

TUNED = Profile("tuned", "fake", "as exact as told", {"knob": Setting(1, "there has to be one")})


@dataclass(frozen=True)
class FakeEngine:
    """An engine whose answer is known: ``exact(scene, time_s)`` with an error that ``disturb`` puts
    into the poses, velocities sampled ``velocity_shift`` steps away from the positions. It follows
    the driver's law under any drive that it does not refuse. ``fails_after`` steps it raises, after
    ``diverges_after`` it says that it has diverged, and in ``stopped`` why."""

    exact: Callable[[Scene, Array], Motion] = solve
    disturb: Callable[[Poses], Poses] = lambda poses: poses
    velocity_shift: float = 0.0
    fails_after: int | None = None
    diverges_after: int | None = None
    stopped: str = ""
    refuses: str = ""
    drives: tuple[Drive, ...] = get_args(Drive)
    changes: Callable[[Facts], Facts] = lambda facts: facts
    name: str = "fake"
    reports_accelerations: bool = True
    order: int = 2
    forces_of: ForcesOf = "nothing"
    precision: Precision = "double"
    floor: float = AT_ROUNDING
    applies_loads: bool = False
    applies_constant_friction: bool = False
    applies_springs: bool = False
    no_forces: str = ""
    profiles: Mapping[str, Profile] = field(
        default_factory=lambda: {"tuned": TUNED, "as-shipped": replace(TUNED, name="as-shipped")}
    )

    def version(self) -> str:
        return "1.0"

    def check(self, settings: Settings) -> None:
        """Its knob is a number from 0 on."""
        check_ranges(settings, {name: (0, math.inf) for name in settings if name == "knob"})

    def holds(self, settings: Settings, dt_s: float, drive: Drive) -> Settings:
        return settings

    def placing(self, settings: Settings) -> Placing:
        """It has its places from the reference."""
        return "solved"

    def numbers(self, settings: Settings) -> tuple[Precision, float]:
        return self.precision, self.floor

    def unreported(self, scene: Scene, drive: Drive) -> Unreported:
        return REPORTED

    def in_seconds(self, settings: Settings) -> tuple[str, ...]:
        return ()

    def open(
        self, scene: Scene, state: State, settings: Settings, dt_s: float, drive: Drive
    ) -> FakeSession:
        if self.refuses:
            raise EngineError(self.refuses)
        if drive not in self.drives:
            raise EngineError(f"the fake engine was set to refuse drive {drive}")
        return FakeSession(self, scene, state.time_s, settings, dt_s)


ENGINE = FakeEngine()


class FakeSession:
    """A session that only counts its steps."""

    def __init__(
        self, engine: FakeEngine, scene: Scene, start_s: float, settings: Settings, dt_s: float
    ) -> None:
        self._engine, self._scene, self._start_s = engine, scene, start_s
        self._settings, self._dt, self._done = settings, dt_s, 0

    def facts(self) -> Facts:
        scene = self._scene
        held = {name: mass_of(scene, name) for name in bodies(scene)}
        start = exact_poses(scene, self._engine, np.array([self._start_s]), self._dt)
        return self._engine.changes(
            Facts(
                version="1.0",
                mass_kg={name: mass for name, (mass, _) in held.items()},
                inertia_kg_m2={name: inertia for name, (_, inertia) in held.items()},
                centre_m={name: centre_of(scene, name) for name in held},
                gravity_m_s2=scene.gravity_m_s2,
                start=start,
                settings=dict(self._settings),
                velocity_shift=self._engine.velocity_shift,
                acceleration_shift=0.0,
                springs={n: (s.rate, s.damping, s.free) for n, s in scene.springs.items()},
            )
        )

    def step(self, steps: int) -> None:
        self._done += steps

    def record(self, steps: int, every: int) -> Log:
        engine = self._engine
        if engine.fails_after is not None and self._done + steps > engine.fails_after:
            raise RuntimeError("the fake engine fails, as told")
        at = self._done + every * np.arange(steps // every + 1, dtype=np.float64)
        limit = np.inf if engine.diverges_after is None else engine.diverges_after
        at = at[at <= max(limit, self._done)]
        poses = exact_poses(self._scene, engine, self._start_s + self._dt * at, self._dt)
        diverged = self._done + steps > limit
        self._done += steps
        stopped = engine.stopped if diverged else ""
        return Log(engine.disturb(poses), int(at[-1]), diverged, (), 1e-6 * steps, stopped)

    def read(self) -> Poses:
        time_s = np.array([self._start_s + self._dt * self._done])
        return self._engine.disturb(exact_poses(self._scene, self._engine, time_s, self._dt))


def exact_poses(scene: Scene, engine: FakeEngine, time_s: Array, dt_s: float) -> Poses:
    """The true poses, velocities sampled where the engine has them."""
    here = _poses(scene, engine.exact(scene, time_s))
    if engine.velocity_shift == 0.0:
        return here
    there = _poses(scene, engine.exact(scene, time_s + engine.velocity_shift * dt_s))

    def mixed(name: str, body: BodyPose) -> BodyPose:
        other = there.bodies[name]
        return replace(body, velocity=other.velocity, omega=other.omega)

    bodies = {name: mixed(name, body) for name, body in here.bodies.items()}
    return Poses(time_s, bodies, engine.velocity_shift * dt_s)


def _poses(scene: Scene, motion: Motion) -> Poses:
    """Frames of the bodies from the motion of their points; rates are rounded in a way of its own,
    as a solver's are."""
    frames = {}
    for link in scene.links.values():
        point, local = next(iter(link.points.items()))
        turn, track = motion.links[link.name], motion.points[point]
        arm = complex(*local) * np.exp(1j * turn.theta)
        frames[link.name] = BodyPose(
            track.position - _pair(arm),
            turn.theta,
            track.velocity - _pair(1j * turn.omega * arm),
            turn.omega,
            track.acceleration - _pair((1j * turn.alpha - turn.omega**2) * arm),
            turn.alpha,
        )
    for name, slider in blocks(scene).items():
        track, zero = motion.points[slider.point], np.zeros(len(motion.time_s))
        guide = None if slider.on == GROUND else motion.links[slider.on]
        frames[name] = BodyPose(
            track.position,
            (guide.theta if guide else zero) + sliding_angle(slider),
            track.velocity,
            guide.omega if guide else zero,
            track.acceleration,
            guide.alpha if guide else zero,
        )
    return Poses(motion.time_s, frames).changed(_rounded)


def _rounded(body: BodyPose) -> BodyPose:
    rates = ("velocity", "omega", "origin_acceleration", "alpha")
    return replace(body, **{name: rounded(getattr(body, name), 2.0**-47) for name in rates})


def _pair(number: NDArray[np.complex128]) -> Array:
    return np.stack([number.real, number.imag], axis=-1)


def turned_link(link: str, error_rad: Callable[[Array], Array]) -> Callable[[Poses], Poses]:
    """An error of one link's angle, as a function of time [s] -> [rad]."""

    def disturb(poses: Poses) -> Poses:
        body = poses.bodies[link]
        wrong = replace(body, theta=body.theta + error_rad(poses.time_s))
        return replace(poses, bodies={**poses.bodies, link: wrong})

    return disturb
