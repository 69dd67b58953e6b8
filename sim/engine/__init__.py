"""Interface of an engine: a session that is opened, stepped and read; and the result of a run.

One adapter per engine, in a folder of its own, imported only on request (`sim.registry`). An
adapter turns the engine's own coordinates into `Poses`; everything after that is shared.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any, Literal, Protocol

from models.array import Array
from models.motion import Forces, Motion, State
from models.scene import Point, Scene, elastic

Status = Literal["ok", "diverged", "locked", "branch-changed", "timeout", "crashed", "unsupported"]
Drive = Literal["prescribed", "servo", "free"]
"""Prescribed: the crank follows the driver's law, whatever the mechanism does. Servo: a motor of
limited gain keeps its speed. Free: nothing drives it, it is a link like the others, and all
velocities at the start are the state's; the law plays no part."""
SettingValue = float | int | str
Settings = Mapping[str, SettingValue]
Placing = Literal["integrated", "solved"]
"""Integrated: positions follow from velocities, step by step, with the error of the step. Solved:
each step solves for the joints, so positions may be exact to rounding."""
Precision = Literal["double", "single"]
EPSILON: Mapping[Precision, float] = {"double": 2.0**-52, "single": 2.0**-23}
"""Relative distance of two neighbouring numbers."""
AT_ROUNDING = 1e-11
"""A pure error that rounding explains in a run of thousands of steps, in double precision."""
ForcesOf = Literal["nothing", "states", "steps"]
"""Forces that an engine reports. States: forces of a state, at every sample. Steps: forces of the
last step, so that they are NaN at the start of a run."""


@dataclass(frozen=True)
class Unreported:
    """Forces of a scene that an engine does not report: of pins by point, of sliders by name with
    their moments, and the driving torque or force. They are NaN, and are not compared."""

    pins: frozenset[str] = frozenset()
    sliders: frozenset[str] = frozenset()
    torque: bool = False

    def __str__(self) -> str:
        joints = [f"pin {point}" for point in sorted(self.pins)]
        joints += [f"slider {name}" for name in sorted(self.sliders)]
        return " and ".join([*joints, *(["the drive"] * self.torque)])


REPORTED = Unreported()
"""An engine that reports all forces."""


@dataclass(frozen=True)
class Setting:
    """An engine setting: its value, and the profile's reason; ``of_beams``: it acts on beams
    only."""

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

    @property
    def values(self) -> dict[str, SettingValue]:
        """Return the values of the settings."""
        return {name: setting.value for name, setting in self.settings.items()}


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
        """Return the poses with every body changed."""
        return replace(self, bodies={name: change(body) for name, body in self.bodies.items()})


@dataclass(frozen=True)
class Facts:
    """The model as the engine holds it, read back before the first step.

    Mass, inertia about the centre of mass, and that centre in the link's own frame, by body.
    ``velocity_shift`` and ``acceleration_shift`` are the instants of the reported quantities, in
    steps: a velocity logged with the positions of time t belongs to t + velocity_shift * dt.
    ``springs`` are the scene's, by name, as far as the engine has them: rate [N/m or N m/rad],
    damping [N s/m or N m s] and slack length or angle [m or rad]. ``beams`` are the scene's,
    element by element.
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
    beams: Mapping[str, tuple[elastic.Beam, ...]] = field(default_factory=dict)


@dataclass(frozen=True)
class Log:
    """Result of a stretch of stepping: poses at the logged steps, and how it ended.

    ``wall_s`` is the time of stepping and logging, without later computations from the log
    (accelerations, poses). ``stopped`` is the engine's own reason for an early stop; empty at the
    end. ``forces`` belong to the logged steps, if requested: they act at their ``time_s``.
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
        """Read the model as the engine holds it now."""
        ...

    def step(self, steps: int) -> None:
        """Advance without logging, in native code where the engine can."""
        ...

    def record(self, steps: int, every: int) -> Log:
        """Advance and log the current state and every ``every``-th step after it."""
        ...

    def read(self) -> Poses:
        """Read the current state, as poses of one sample."""
        ...


class ForceSession(Session, Protocol):
    """A session of an engine that reports forces."""

    def record_forces(self, steps: int, every: int) -> Log:
        """Advance and log, as `Session.record`, with the forces in all pins and sliders and the
        driving torque. The motion is the same to the bit."""
        ...


@dataclass(frozen=True)
class Batches:
    """Stepping of several sessions of one kind as the worlds of a batch.

    ``record`` takes sessions at their starts, steps, ``every`` and a number of threads; it returns
    the logs in the order of the sessions, as `Session.record`, each with its part of the wall time,
    without that of compiling. The sessions are of no use afterwards. It raises EngineError where
    they do not fit into one batch. ``threads`` is the most that it takes. A world differs from the
    same session alone by no more than the engine's ``floor``; ``why`` it does at all, "" if it is
    the same to the bit.
    """

    record: Callable[[Sequence[Any], int, int, int], Sequence[Log]]
    why: str = ""
    threads: int = 1


@dataclass(frozen=True)
class Engine:
    """A physics engine with its profiles.

    ``version`` gives the installed version. ``check`` raises SettingError for a value, of a
    complete set of settings, that the engine does not take. ``open`` gives a session at a state,
    with settings, step [s] and drive; EngineError where the engine cannot hold the scene. An engine
    without accelerations gives NaN for all. ``holds`` are the settings in a session's facts, for a
    complete set of settings, step and drive. ``placing`` is the source of positions with a complete
    set of settings; errors of integrated positions shrink as the step to the power ``order`` at
    most. ``in_seconds`` names the settings that are times, or losses in a time: without any, errors
    of position depend on the steps in a turn, not on the speed; by default it names all. Where
    ``forces_of`` is not nothing, sessions are `ForceSession`s, and ``unreported`` gives the forces
    of a scene that they leave out with a drive; else ``no_forces`` says why, after "NAME reports no
    forces: ". Without ``applies_loads`` scenes with loads are unsupported, without
    ``applies_constant_friction`` scenes with constant friction, without ``applies_springs`` scenes
    with springs, without ``applies_gears``, ``applies_cams`` (as a relation) and
    ``applies_cams_by_contact`` scenes with these; with springs `Facts.springs` has each. Without
    ``applies_beams`` elastic links come only as segments; with it `Facts.beams` has the beams.
    ``precision`` is that of the engine's numbers, ``floor`` the pure error of places that it leaves
    at any step; ``numbers_with`` gives both where settings choose them. ``batches`` is None for an
    engine that runs one world at a time.
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
    applies_gears: bool = False
    applies_cams: bool = False
    applies_cams_by_contact: bool = False
    applies_beams: bool = False
    precision: Precision = "double"
    floor: float = AT_ROUNDING
    unreported: Callable[[Scene, Drive], Unreported] = lambda scene, drive: REPORTED
    no_forces: str = ""
    numbers_with: Callable[[Settings], tuple[Precision, float]] | None = None
    batches: Batches | None = None

    def numbers(self, settings: Settings) -> tuple[Precision, float]:
        """Return precision and floor with a complete set of settings."""
        chosen = self.numbers_with
        return chosen(settings) if chosen else (self.precision, self.floor)


@dataclass(frozen=True)
class Energy:
    """Kinetic and potential energy [J], (T,), both at the instants of the velocities; the potential
    energy of weights and springs."""

    kinetic_j: Array
    potential_j: Array

    @property
    def total_j(self) -> Array:
        return self.kinetic_j + self.potential_j


@dataclass(frozen=True)
class Cost:
    """Wall time of stepping [s] and the number of steps; logging is part of it when ``logged``."""

    wall_s: float
    steps: int
    logged: bool

    @property
    def us_per_step(self) -> float:
        return 1e6 * self.wall_s / self.steps if self.steps else float("nan")


@dataclass(frozen=True)
class Setup:
    """Request of a run: ``steps`` of ``dt_s`` from ``start_s`` on, logged every ``every``-th.

    ``asked`` is the complete set of requested settings. ``with_forces`` is true if forces were
    requested, of the kind ``forces_of``, but those ``unreported``. ``precision`` and ``floor`` are
    the engine's.
    """

    scene: str
    engine: str
    version: str
    profile: str
    drive: Drive
    dt_s: float
    steps: int = 0
    every: int = 1
    start_s: float = 0.0
    reports_accelerations: bool = True
    asked: Settings = field(default_factory=dict)
    with_forces: bool = False
    forces_of: ForcesOf = "nothing"
    precision: Precision = "double"
    floor: float = AT_ROUNDING
    unreported: Unreported = REPORTED


@dataclass(frozen=True, kw_only=True)
class Run(Setup):
    """One scene in one engine, as requested: the motion, the end, the settings and the cost.

    ``settings`` are the engine's own, after those ``asked``. ``gaps`` holds the opening of each pin
    or slider (T,) [m]. ``velocity_time_s`` and ``acceleration_time_s`` are the instants of the
    reported velocities and accelerations. ``motion``, with the forces, is None where the run never
    started; ``stopped_at_s`` is the last time reached. ``energy`` is kept for free motion, without
    the work of loads, dampers and friction.
    """

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
    energy: Energy | None = None
