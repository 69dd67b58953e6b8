"""Sessions of engines that are stepped from Python: the work before each step, and the log.

An adapter says how its engine takes one step, where its bodies are, how its driver is turned and
how a body is pushed; the drive, loads and springs of the scene, the log, and forces by the change
of each body's momentum in a step, are here.
"""

import math
import time
from abc import ABC, abstractmethod
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, ClassVar

import numpy as np

from models.array import Array
from models.motion import Forces, State
from models.scene import GROUND, Point, Scene
from models.scene import joints as pairs
from models.scene.joints import Frame
from sim.engine import Drive, Facts, Log, Poses, Settings, SettingValue, drive
from sim.engine.acting import Acting, EngineBodies, Pushes
from sim.engine.measure import across
from sim.engine.momentum_balance import MomentumGain, by_name, forces_by_body, joint_pushes
from sim.engine.ties import RubbingJoint, hinges


@dataclass(frozen=True)
class StepSeries:
    """Steps by the numbers before and after each, (T, ...), the actions on bodies at their origins
    and on blocks without mass, (T, 3) by name, and the friction by joint, (T,)."""

    before: Array
    after: Array
    given: dict[str, Array]
    on_blocks: dict[str, Array]
    rubbed: dict[str, Array]


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
    stuck: ClassVar[float] = 1e-9
    """Rate over the driver's, in a slider per length of the scene, below which a joint with
    friction may stick, by rounding."""
    bodies: EngineBodies
    rubbing: Sequence[RubbingJoint] = ()
    """Joints whose friction the engine has itself."""
    shift: float = 0.0
    acts_at: float = 0.0
    next_look: float = math.inf
    """Steps until which `numbers` has to count the turns of bodies."""

    def __init__(
        self, scene: Scene, state: State, settings: Settings, dt_s: float, driven_by: Drive
    ) -> None:
        self.scene, self.state, self.settings = scene, state, dict(settings)
        self.dt, self.drive, self.start_s, self.done = dt_s, driven_by, state.time_s, 0
        self.names, self.warnings = pairs.bodies(scene), list[str]()

    def begin(self) -> None:
        """Take the first look at the model."""
        given = self.name, self.bodies, self.frames(0.0), self.dt, self.drive
        self.acting = Acting(*given, rubs=self.rubs, rates=self.knows_rates)
        self.pushed, self.before = self.acting.none(), np.full_like(self.numbers(), np.nan)
        if self.drive != "free":
            law = self.scene.driver.law
            self.turn(None, drive.start_speed(law, self.start_s, self.dt, self.shift))

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

    @abstractmethod
    def rate_in(self, rub: RubbingJoint, numbers: Array) -> float:
        """Return the rate of a joint's second body against its first."""

    @abstractmethod
    def gains(self, steps: StepSeries) -> Mapping[str, MomentumGain]:
        """Return the action of joints and drive on each body in each step."""

    def rub(self, rub: RubbingJoint, steps: StepSeries) -> None:
        """Add the friction of a joint to the actions on its bodies."""
        for body, sense in ((rub.first, -1.0), (rub.second, 1.0)):
            steps.given[body][:, 2] += sense * steps.rubbed[rub.joint]

    def joint_forces(self) -> Any:
        """Return the present forces in joints, as the engine has them; else the last step, as
        `StepSeries`, with friction NaN where a joint may stick."""
        now, rubbed = self.numbers(), dict(self.acting.rubbed)
        for rub in self.rubbing:
            rate, size = self.rate_in(rub, now), self.scene.longest_m
            still = self.stuck * (size if rub.joint in self.scene.sliders else 1.0) * self._pace()
            rubbed[rub.joint] = math.nan if abs(rate) <= still else -math.copysign(rub.size, rate)
        return self.before, now, self.pushed.on_bodies, self.acting.on_blocks, rubbed

    def acted(self, rows: Sequence[Any], poses: Poses) -> Forces:
        """Return the forces of samples of `joint_forces`, by default at each step's instant of
        forces."""
        before, after, *actions = zip(*rows, strict=True)
        steps = StepSeries(np.array(before), np.array(after), *map(by_name, actions))
        for rub in self.rubbing:
            self.rub(rub, steps)
        ties, own = [*hinges(self.scene, GROUND)], self.scene.driver.slider
        pushes = joint_pushes(self.scene, ties, self.gains(steps), driven=self.drive != "free")
        if own in steps.on_blocks:  # a block without mass hands the drive's force on to its pin
            steps.on_blocks[own][:, :2] -= pushes.torque[:, None] * across(pushes.across[own])
        times = poses.time_s + self.dt * (self.shift - 0.5)
        forces = forces_by_body(self.scene, pushes, steps.on_blocks, steps.rubbed, times)
        known = np.isfinite(steps.before).all(axis=(1, 2))  # a step led there

        def with_gaps(series: Array) -> Array:
            return np.where(known.reshape(-1, *[1] * (series.ndim - 1)), series, np.nan)

        return forces.each_series(with_gaps)

    def step(self, steps: int) -> None:
        """Advance without logging."""
        self._run(steps, 0, [], None)

    def record(self, steps: int, every: int) -> Log:
        """Advance and log the present state and every ``every``-th step after it."""
        return self._recorded(steps, every, None)

    def record_forces(self, steps: int, every: int) -> Log:
        """Advance and log, with the forces of each logged step."""
        return self._recorded(steps, every, [self.joint_forces()])

    def _recorded(self, steps: int, every: int, forces: list[Any] | None) -> Log:
        first, began = self.done, time.perf_counter()
        rows = [self.numbers()]
        self._run(steps, every, rows, forces)
        return self._logged(first, every, rows, forces, time.perf_counter() - began)

    def _logged(
        self, first: int, every: int, rows: list[Array], forces: list[Any] | None, wall: float
    ) -> Log:
        """Return the log of rows of `numbers`, from the step ``first`` on."""
        at = first + every * np.arange(len(rows), dtype=np.float64)
        whole = np.array(rows)
        good = np.isfinite(whole).reshape(len(whole), -1).all(axis=1)
        count = len(rows) if good.all() else max(int(np.argmin(good)), 1)
        poses = self.poses(whole[:count], self.start_s + self.dt * at[:count])
        warnings = tuple(dict.fromkeys(self.warnings))
        log = Log(poses, (count - 1) * every, count < len(at), warnings, wall)
        return log if forces is None else replace(log, forces=self.acted(forces[:count], poses))

    def _run(self, steps: int, every: int, rows: list[Array], forces: list[Any] | None) -> None:
        for _ in self._steps(steps, every, rows, forces):
            self.once()

    def _steps(
        self, steps: int, every: int, rows: list[Array], forces: list[Any] | None
    ) -> Iterator[None]:
        """Stop where a step is to be taken; add numbers, and forces, after every ``every``-th."""
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
            yield
            self.done += 1
            if every and (k + 1) % every == 0:
                rows.append(self.numbers())
                if forces is not None:
                    forces.append(self.joint_forces())
            elif self.done >= self.next_look:
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

    def facts_of(
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
