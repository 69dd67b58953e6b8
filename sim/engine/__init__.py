"""What an engine is to crankcheck: a session that is opened, stepped and read; and what a run left.

One adapter per engine, in a folder of its own, imported only when it is asked for (`sim.registry`).
An adapter turns the engine's own coordinates into `Poses`; everything after that is shared.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from typing import Literal, Protocol

from models.array import Array
from models.motion import Forces, Motion, State
from models.scene import Point, Scene
from models.scene.elastic import Beam

Status = Literal["ok", "diverged", "locked", "branch-changed", "timeout", "crashed", "unsupported"]
Drive = Literal["prescribed", "servo", "free"]
"""Prescribed: the crank is where the driver's law has it, whatever the mechanism does. Servo: a
motor of limited gain keeps its speed. Free: nothing drives it, it is a link like the others, and
all velocities at the start are those of the state; the law plays no part."""
SettingValue = float | int | str
Settings = Mapping[str, SettingValue]
Placing = Literal["integrated", "solved"]
"""Integrated: places come of velocities, step by step, and are off by what a step leaves out.
Solved: the joints are solved for in each step, so places may be exact to rounding."""
ForcesOf = Literal["nothing", "states", "steps"]
"""What forces an engine reports. States: those that go with a state, at every sample. Steps: what
the last step took, so that they are NaN at the start of a run."""


@dataclass(frozen=True)
class Setting:
    """One engine setting: its value, and why a profile chose it; one ``of_beams`` changes nothing
    where there are none."""

    value: SettingValue
    reason: str
    of_beams: bool = False


@dataclass(frozen=True)
class Profile:
    """A named, complete set of the engine settings that influence accuracy."""

    name: str
    engine: str
    summary: str
    settings: Mapping[str, Setting]


@dataclass(frozen=True)
class BodyPose:
    """Motion of one body's frame.

    ``origin`` (T, 2) [m], ``theta`` (T,) [rad] continuous, ``velocity`` (T, 2) of the origin
    [m/s], ``omega`` (T,) [rad/s]; ``origin_acceleration`` (T, 2) and ``alpha`` (T,) are NaN where
    the engine reports none.
    """

    origin: Array
    theta: Array
    velocity: Array
    omega: Array
    origin_acceleration: Array
    alpha: Array


@dataclass(frozen=True)
class Poses:
    """The bodies of the engine over time, as `models.scene.joints.bodies` names them.

    Velocities belong to ``lag_s`` after the times of the positions.
    """

    time_s: Array
    bodies: Mapping[str, BodyPose]
    lag_s: float = 0.0

    def changed(self, change: Callable[[BodyPose], BodyPose]) -> Poses:
        """The poses with every body changed."""
        return replace(self, bodies={name: change(body) for name, body in self.bodies.items()})


@dataclass(frozen=True)
class Facts:
    """The model as the engine holds it, read back before the first step.

    Mass, inertia about the centre of mass, and that centre in the link's own frame, by body.
    ``velocity_shift`` and ``acceleration_shift`` say, in steps, to which instant the reported
    quantities belong: a velocity logged with the positions of time t belongs to
    t + velocity_shift * dt. ``springs`` are those of the scene by name, as far as the engine is
    given them: rate [N/m or N m/rad], damping [N s/m or N m s] and the length or angle at which
    they are slack [m or rad]. ``beams`` are those of the scene, element by element.
    """

    version: str
    mass_kg: Mapping[str, float]
    inertia_kg_m2: Mapping[str, float]
    centre_m: Mapping[str, Point]
    gravity_m_s2: Point
    start: Poses
    settings: Settings
    velocity_shift: float
    acceleration_shift: float
    springs: Mapping[str, tuple[float, float, float]] = field(default_factory=dict)
    beams: Mapping[str, tuple[Beam, ...]] = field(default_factory=dict)


@dataclass(frozen=True)
class Log:
    """What a stretch of stepping left: poses at the logged steps, and how it ended.

    ``wall_s`` is the time that stepping and logging took; what is computed from the log
    afterwards (accelerations, poses) is not part of it. ``stopped`` says why the engine itself
    went no further, in its own words; empty where it went to the end. ``forces`` are those of the
    logged steps, where they were asked for: their ``time_s`` says when they act.
    """

    poses: Poses
    steps_done: int
    diverged: bool
    warnings: tuple[str, ...]
    wall_s: float
    stopped: str = ""
    forces: Forces | None = None


class Session(Protocol):
    """One opened model, at its initial state."""

    def facts(self) -> Facts:
        """The model as the engine holds it now."""
        ...

    def step(self, steps: int) -> None:
        """Advance without logging, in native code where the engine can."""
        ...

    def record(self, steps: int, every: int) -> Log:
        """Advance and log the current state and every ``every``-th step after it."""
        ...

    def read(self) -> Poses:
        """The current state, as poses of one sample."""
        ...


class ForceSession(Session, Protocol):
    """A session of an engine that reports forces."""

    def record_forces(self, steps: int, every: int) -> Log:
        """As `Session.record`, with the forces in all pins and sliders and the driving torque. The
        motion is the same to the bit."""
        ...


@dataclass(frozen=True)
class Engine:
    """A physics engine with its profiles, and what is asked of it.

    ``version`` gives the installed one. ``check`` raises SettingError for a value, of a complete
    set of settings, that it does not take. ``open`` gives a session at a state, with settings, step
    [s] and drive; EngineError where the engine cannot hold the scene. An engine that does not
    report accelerations gives NaN for all. ``holds`` is what the facts of a session say of a
    complete set of settings, step and drive. How the engine comes by places with a complete set of
    settings is its ``placing``; where they are integrated their errors shrink as the step to the
    power ``order`` at most. ``in_seconds`` names what of a complete set of settings is a time, or a
    loss in a time, of its own: without any, errors of place depend on the steps in a turn, not on
    the speed. An engine that does not say has all of them so. Where ``forces_of`` is something, its
    sessions are `ForceSession`s; without ``applies_loads`` scenes with loads are unsupported,
    without ``applies_constant_friction`` those with friction that is constant, without
    ``applies_springs`` those with springs; with it `Facts.springs` tells of each. Without
    ``applies_beams`` it is given elastic links as segments alone; with it `Facts.beams` tells.
    """

    name: str
    profiles: Mapping[str, Profile]
    version: Callable[[], str]
    check: Callable[[Settings], None]
    open: Callable[[Scene, State, Settings, float, Drive], Session]
    reports_accelerations: bool = True
    holds: Callable[[Settings, float, Drive], Settings] = lambda settings, dt_s, drive: settings
    placing: Callable[[Settings], Placing] = lambda settings: "integrated"
    order: int = 2
    in_seconds: Callable[[Settings], tuple[str, ...]] = tuple
    forces_of: ForcesOf = "nothing"
    applies_loads: bool = False
    applies_constant_friction: bool = False
    applies_springs: bool = False
    applies_beams: bool = False


@dataclass(frozen=True)
class Energy:
    """Kinetic and potential energy [J], (T,), both at the instants that velocities belong to; the
    potential one is that of weights and springs."""

    kinetic_j: Array
    potential_j: Array

    @property
    def total_j(self) -> Array:
        return self.kinetic_j + self.potential_j


@dataclass(frozen=True)
class Cost:
    """Wall time of stepping [s] and the steps it took; logging is part of it when ``logged``."""

    wall_s: float
    steps: int
    logged: bool

    @property
    def us_per_step(self) -> float:
        return 1e6 * self.wall_s / self.steps if self.steps else float("nan")


@dataclass(frozen=True)
class Setup:
    """What a run is asked for: see `Run`, whose own words for the same are held to these."""

    scene: str
    engine: str
    version: str
    profile: str
    drive: Drive
    dt_s: float
    steps: int
    every: int
    start_s: float
    reports_accelerations: bool
    asked: Settings
    with_forces: bool = False
    forces_of: ForcesOf = "nothing"


@dataclass(frozen=True)
class Run:
    """One scene in one engine: what moved, how it ended, with which settings, at which cost.

    ``gaps`` holds per pin or slider how far the bodies that share it have come apart (T,) [m].
    ``velocity_time_s`` and ``acceleration_time_s`` are the instants that the reported velocities
    and accelerations belong to. ``motion`` is None where the run never started; ``stopped_at_s``
    is the last time that was reached. Commanded were ``steps`` of ``dt_s`` from ``start_s`` on,
    logged every ``every``-th: what the log is held to. ``asked`` is the complete set of settings
    that the run was given, and takes to be run again; ``settings`` what the engine then held.
    ``energy`` is kept of free motion, without what loads, dampers and friction do to it.
    ``with_forces`` says that forces were asked for; they are in ``motion``, and of what
    ``forces_of`` the engine says.
    """

    scene: str
    engine: str
    version: str
    profile: str
    drive: Drive
    dt_s: float
    status: Status
    reason: str
    settings: Settings
    motion: Motion | None = None
    gaps: Mapping[str, Array] = field(default_factory=dict)
    velocity_time_s: Array | None = None
    acceleration_time_s: Array | None = None
    stopped_at_s: float = 0.0
    warnings: tuple[str, ...] = ()
    cost: Cost | None = None
    asked: Settings = field(default_factory=dict)
    start_s: float = 0.0
    steps: int = 0
    every: int = 1
    reports_accelerations: bool = True
    energy: Energy | None = None
    with_forces: bool = False
    forces_of: ForcesOf = "nothing"
