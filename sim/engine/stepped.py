"""Sessions of engines that are stepped from Python: what is done before each step, and the log.

An adapter says how its engine takes one step, where its bodies are, how its driver is turned and
how a body is pushed; the drive, loads and springs of the scene, whole turns and the log are here.
"""

import math
import time
from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import ClassVar, cast

import numpy as np

from models.array import Array
from models.errors import EngineError
from models.mjcf.forces import planned
from models.mjcf.tree import Tree, driven_freedom
from models.motion import Forces, State
from models.scene import GROUND, Point, Scene
from models.scene import joints as pairs
from models.scene.joints import FIXED, Frame
from sim.engine import (
    BodyPose,
    Drive,
    Facts,
    Log,
    Poses,
    Settings,
    SettingValue,
    drive,
    measure,
    tree_poses,
)
from sim.engine.acting import Acting, EngineBodies, Pushes, centres
from sim.engine.tree_reactions import RateChange, forces_of, rubs

TURN_BETWEEN = 1.0
"""Largest turn of a body between two looks at its angle [rad], where an engine counts no turns."""


class SteppedSession(ABC):
    """A session with one model, in steps of ``dt`` [s]; ``done`` steps are behind it.

    A subclass opens its model, and then calls `begin`. Forces act ``acts_at`` steps after the
    positions before a step, velocities belong ``shift`` steps after the positions. An engine that
    ``rubs`` has the friction of sliders itself. With ``knows_rates`` `frames` has the velocities of
    its instant, for dampers and motors.
    """

    name: ClassVar[str]
    rubs: ClassVar[bool] = False
    knows_rates: ClassVar[bool] = False
    shift: float = 0.0
    acts_at: float = 0.0

    def __init__(
        self, scene: Scene, state: State, settings: Settings, dt_s: float, driven_by: Drive
    ) -> None:
        self.scene, self.state, self.settings = scene, state, dict(settings)
        self.dt, self.drive, self.start_s, self.done = dt_s, driven_by, state.time_s, 0
        self.warnings: list[str] = []

    def begin(self, placed: EngineBodies) -> None:
        """Take the first look at the model, whose bodies are ``placed``."""
        self.placed = placed
        given = self.name, placed, self.frames(0.0), self.dt, self.drive
        self.acting = Acting(*given, rubs=self.rubs, rates=self.knows_rates)
        self.pushed, self.before = self.acting.none(), np.full_like(self.numbers(), np.nan)
        if self.drive != "free":
            law = self.scene.driver.law
            self.turn(None, drive.start_speed(law, self.start_s, self.dt, self.shift))
        fastest = max(abs(omega) for omega in (*self.state.omega.values(), self._pace()))
        self._look_every = max(1, int(TURN_BETWEEN / max(fastest * self.dt, 1e-9)))

    def _pace(self) -> float:
        return drive.pace(self.scene, self.state, self.drive)

    @abstractmethod
    def once(self) -> None:
        """Take one step."""

    @abstractmethod
    def turn(self, place: float | None, speed: float) -> None:
        """Set the driver before a step: at a position from which the speed brings it to the law's
        position at its end. None is where it is, at the start."""

    @abstractmethod
    def push(self, pushes: Pushes) -> None:
        """Give all bodies their forces and moments for the next step alone."""

    @abstractmethod
    def numbers(self) -> Array:
        """Return the present state as numbers, angles with their whole turns."""

    @abstractmethod
    def frames(self, ahead_s: float) -> Mapping[str, Frame]:
        """Return the frames of all bodies and the ground, so much later by their velocities."""

    @abstractmethod
    def poses(self, rows: Array, time_s: Array) -> Poses:
        """Return the poses of samples of `numbers`, (T, ...)."""

    def acted(self, rows: Sequence[object], poses: Poses) -> Forces:
        """Return the forces of samples of `joint_forces`."""
        raise NotImplementedError

    def joint_forces(self) -> object:
        """Return the present forces in joints, as the engine has them."""
        raise NotImplementedError

    def step(self, steps: int) -> None:
        """Advance without logging."""
        self._run(steps, 0, [], None)

    def record(self, steps: int, every: int) -> Log:
        """Advance and log the present state and every ``every``-th step after it."""
        return self._recorded(steps, every, None)

    def record_forces(self, steps: int, every: int) -> Log:
        """Advance and log, with the forces of each logged step."""
        return self._recorded(steps, every, [self.joint_forces()])

    def _recorded(self, steps: int, every: int, forces: list[object] | None) -> Log:
        at = self.done + every * np.arange(steps // every + 1, dtype=np.float64)
        began = time.perf_counter()
        rows = [self.numbers()]
        self._run(steps, every, rows, forces)
        wall = time.perf_counter() - began
        whole = np.array(rows)
        good = np.isfinite(whole).reshape(len(whole), -1).all(axis=1)
        count = len(rows) if good.all() else max(int(np.argmin(good)), 1)
        poses = self.poses(whole[:count], self.start_s + self.dt * at[:count])
        warnings = tuple(dict.fromkeys(self.warnings))
        log = Log(poses, (count - 1) * every, count < len(at), warnings, wall)
        return log if forces is None else replace(log, forces=self.acted(forces[:count], poses))

    def _run(self, steps: int, every: int, rows: list[Array], forces: list[object] | None) -> None:
        """Take the steps; add numbers, and forces, after every ``every``-th."""
        turns = self._turns(steps) if self.drive != "free" else []
        if self.acting:
            times = self.done + self.acts_at + np.arange(steps, dtype=np.float64)
            self.acting.look_ahead(self.start_s + self.dt * times)
        for k in range(steps):
            if forces is not None:
                self.before = rows[-1] if k % every == 0 else self.numbers()
            if turns:
                self.turn(*turns[k])
            if self.acting:
                self.pushed = self.acting.pushes(k, self.frames(self.acts_at * self.dt))
                self.push(self.pushed)
            self.once()
            self.done += 1
            if every and (k + 1) % every == 0:
                rows.append(self.numbers())
                if forces is not None:
                    forces.append(self.joint_forces())
            elif self.done % self._look_every == 0:
                self.numbers()  # not to lose a turn

    def _turns(self, steps: int) -> list[tuple[float, float]]:
        """Return the place and the speed of the driver before each of the next steps."""
        law, first = self.scene.driver.law, self.done
        theta = drive.angles(law, self.start_s, self.dt, first, first + steps - 1)
        chord = drive.chords(law, self.start_s, self.dt, first, first + steps - 1)
        return list(zip(theta.tolist(), chord.tolist(), strict=True))

    def read(self) -> Poses:
        """Read the present state."""
        now = np.array([self.start_s + self.dt * self.done])
        return self.poses(self.numbers()[None], now)

    def told(
        self,
        version: str,
        matter: Mapping[str, tuple[float, float]],
        centre: Mapping[str, Point],
        gravity: Point,
        held: Mapping[str, SettingValue],
    ) -> Facts:
        """Return the facts: mass and inertia by body, centres in the links' frames, gravity, and
        settings as the engine holds them."""
        return Facts(
            version=version,
            mass_kg={name: mass for name, (mass, _) in matter.items()},
            inertia_kg_m2={n: inertia for n, (_, inertia) in matter.items() if inertia < math.inf},
            centre_m=centre,
            gravity_m_s2=gravity,
            start=self.read(),
            settings={**self.settings, "timestep_s": self.dt, **held},
            velocity_shift=self.shift,
            acceleration_shift=0.0,
            springs=self.acting.springs,
        )


class BodySession(SteppedSession):
    """A session of an engine of free bodies, each with its origin at its centre of mass, but a
    driven body that nothing moves: its origin is its pivot.

    A subclass adds its bodies to ``placed.centre`` in order.
    """

    def __init__(
        self, scene: Scene, state: State, settings: Settings, dt_s: float, driven_by: Drive
    ) -> None:
        super().__init__(scene, state, settings, dt_s, driven_by)
        driver = scene.driver
        self.led = driver.link if driven_by == "prescribed" and not driver.is_inner else None
        """The body that is led along the driver's law, kinematic in most engines."""
        self.where = pairs.frames(scene, state, self.shift * dt_s)
        centre = centres(scene)
        if self.led and driver.slider is None:
            centre[self.led] = pairs.local_point(scene, self.led, scene.driver_pivot)
        self.bodies = EngineBodies(scene, state, centre=centre)
        self.names = pairs.bodies(scene)
        self._angles = np.array([self.where[name].theta for name in self.names])

    @abstractmethod
    def look(self) -> Array:
        """Return x, y, angle (but for whole turns), and their rates, of all bodies, (B, 6)."""

    def numbers(self) -> Array:
        rows = self.look()
        behind = np.round((self._angles - rows[:, 2]) / math.tau)
        rows[:, 2] += math.tau * behind
        self._angles = rows[:, 2]
        return rows

    def frames(self, ahead_s: float) -> Mapping[str, Frame]:
        now = self.numbers()
        then = (now[:, :3] + ahead_s * now[:, 3:]).tolist()
        found = {
            name: Frame((x, y), theta, (0.0, 0.0), 0.0)
            for name, (x, y, theta) in zip(self.names, then, strict=True)
        }
        return {GROUND: FIXED} | found

    def poses(self, rows: Array, time_s: Array) -> Poses:
        lag = self.shift * self.dt
        centre = self.bodies.centre
        place, rate = rows[:, :, :3], rows[:, :, 3:]
        found = {
            name: measure.centred(place[:, k], rate[:, k], None, centre[name], lag)
            for k, name in enumerate(self.names)
        }
        return Poses(time_s, found, lag)


def refuse_driver_between(scene: Scene, engine: str, why: str) -> None:
    """Refuse a driver between two moving bodies. Raises EngineError."""
    if scene.driver.is_inner:
        raise EngineError(f"{scene.name}: its driver is {scene.driver.joint}; {engine} {why}")


def _frame(pose: BodyPose) -> Frame:
    """Return the only sample of a pose."""
    (x, y), (u, v) = pose.origin[0].tolist(), pose.velocity[0].tolist()
    return Frame((x, y), float(pose.theta[0]), (u, v), float(pose.omega[0]))


class TreeSession(SteppedSession):
    """A session of an engine whose bodies hang on one another by joint coordinates, with loops
    closed at pins (`models.mjcf.tree`). The frames of its bodies are those of the links."""

    def __init__(
        self, scene: Scene, state: State, settings: Settings, dt_s: float, driven_by: Drive
    ) -> None:
        super().__init__(scene, state, settings, dt_s, driven_by)
        self.tree = self.grown()
        self.freedoms = [own for limb in self.tree.limbs for own in limb.freedoms]
        """The joint coordinates, in the order of the limbs and of each one's joints."""
        self.driven, self.sense = 0, 1.0
        """RateChange of the driven coordinate, and its sense against the driver's own."""
        if driven_by != "free":
            driven, self.sense = driven_freedom(scene, self.tree.limbs)
            self.driven = next(k for k, own in enumerate(self.freedoms) if own.name == driven)
        self.rubbing = rubs(scene, self.tree.limbs, sliders=self.rubs)
        self.names = pairs.bodies(scene)
        centre = dict.fromkeys((GROUND, *self.names), (0.0, 0.0))
        self.bodies = EngineBodies(scene, state, centre=centre)

    def grown(self) -> Tree:
        """Return the tree, with the rates of its coordinates at the engine's own instant."""
        return planned(self.scene, self.state, delay_s=self.shift * self.dt)

    def joint_forces(self) -> object:
        """Return what shows the forces of the last step: the change of the rates in it."""
        q, rate = self.numbers()[:2]
        push = (rate - self.before[1]) / self.dt
        rubbed = {rub.joint: rub.on_second(rate[rub.row], self._pace()) for rub in self.rubbing}
        acting = self.acting
        on_bodies, on_blocks = self.pushed.on_bodies, acting.on_blocks
        return RateChange(np.stack([q, rate, push]), on_bodies, on_blocks, acting.rubbed | rubbed)

    def acted(self, rows: Sequence[object], poses: Poses) -> Forces:
        return forces_of(
            self.scene,
            self.tree.limbs,
            self.rubbing,
            cast(Sequence[RateChange], rows),
            poses.time_s,
            self.dt,
            driven=self.drive != "free",
        )

    @abstractmethod
    def look(self) -> Array:
        """Return the joint coordinates, their rates and, where known, accelerations, of `freedoms`,
        as these count them, (2, n) or (3, n)."""

    def numbers(self) -> Array:
        return self.look()

    def frames(self, ahead_s: float) -> Mapping[str, Frame]:
        q, rate, *push = self.look()
        gained = ahead_s * np.nan_to_num(push[0] if push else np.zeros_like(q))
        then = (q + ahead_s * (rate + 0.5 * gained))[None], (rate + gained)[None]
        found = tree_poses.body_poses(self.tree.limbs, *then, np.zeros((1, len(q))))
        return {GROUND: FIXED} | {name: _frame(pose) for name, pose in found.items()}

    def poses(self, rows: Array, time_s: Array) -> Poses:
        lag, known = self.shift * self.dt, rows.shape[1] > 2
        q, rate = rows[:, 0], rows[:, 1]
        push = rows[:, 2] if known else np.full_like(q, np.nan)
        found = Poses(time_s, tree_poses.body_poses(self.tree.limbs, q, rate, push, lag), lag)
        return found if known else found.changed(unpushed)


def unpushed(pose: BodyPose) -> BodyPose:
    """Return the pose without accelerations; a body that only slides would keep its alpha of 0."""
    return replace(
        pose,
        origin_acceleration=np.full_like(pose.origin, np.nan),
        alpha=np.full_like(pose.theta, np.nan),
    )
