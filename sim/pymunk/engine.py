"""pymunk (Chipmunk): every joint an impulse constraint, solved by iteration at each step."""

import math
import time
from dataclasses import replace

import numpy as np
import pymunk
import pymunk.batch

from models.array import Array
from models.motion import State
from models.scene import Point, Scene, laws
from sim.engine import Drive, Facts, Log, Poses, Settings
from sim.engine import drive as drives
from sim.engine.measure import centred
from sim.engine.settings import as_held, shipped_engine
from sim.pymunk import settings as own
from sim.pymunk.acting import SpaceActing
from sim.pymunk.arcs import Arcs
from sim.pymunk.bodies import FIELDS, WIDTH, chain_springs, rows_of
from sim.pymunk.convergence import iterations
from sim.pymunk.driven_joint import driven_joint
from sim.pymunk.native import moves_freely
from sim.pymunk.reactions import BEFORE, Reactions
from sim.pymunk.space import build

ROOM = 64
"""Spare numbers of memory: the buffer may not grow memory that is not its own."""
VERSION = str(pymunk.version)
VELOCITY_SHIFT = 0.5
"""Chipmunk moves positions with the velocity of the step before: it belongs half a step later."""


class PymunkSession:
    """A session with one space."""

    def __init__(
        self, scene: Scene, state: State, settings: Settings, dt_s: float, drive: Drive
    ) -> None:
        own.checked(settings)
        self._scene, self._dt, self._settings = scene, dt_s, settings
        self._start_s, self._done = state.time_s, 0
        self._model = build(
            scene,
            state,
            drive=drive,
            exact_lines=settings["lines"] == "exact",
            with_springs=settings["springs"] == "native",
            delay_s=VELOCITY_SHIFT * dt_s,
            dt_s=dt_s,
        )
        self._space = self._model.space
        self._iterations = iterations(settings, self._model)
        self._space.iterations = self._iterations
        self._space.damping = float(settings["damping"])
        bias = float(settings["error_bias"])
        for constraint in self._space.constraints:
            constraint.error_bias = bias
        if self._space.shapes:  # Chipmunk's own bias of joints and of contacts is one number
            self._space.collision_bias = bias
            if bias == 0.0:  # all of an error is corrected, except the slop, by default 0.1 m
                self._space.collision_slop = 0.0
        law = scene.driver.law
        inner = scene.driver.is_inner and drive == "prescribed"
        self._coasts = drive == "free" or (isinstance(law, laws.ConstantSpeed) and not inner)
        self._turn = driven_joint(self._model, dt_s, drive)
        if drive != "free":
            self._turn(None, drives.start_speed(law, state.time_s, dt_s, VELOCITY_SHIFT))
        self._buffer = pymunk.batch.Buffer()
        self._memory = np.empty(0)
        self._rows = rows_of(self._model)
        self._acting = SpaceActing(self._model, dt_s, drive)
        # Pins are closed for the arcs of a step in free motion, if a step corrects the whole error.
        wanted = settings["free_paths"] == "arcs" and float(settings["error_bias"]) == 0.0
        bent = wanted and drive == "free" and not chain_springs(scene)
        self._arcs = Arcs(self._space.constraints, dt_s) if bent else None

    def facts(self) -> Facts:
        """Read the space as pymunk holds it now; only freely moving bodies have a mass."""
        free = {name: body for name, body in self._model.bodies.items() if moves_freely(body)}
        space, asked = self._space, int(self._settings["iterations"])
        cause = "segments" if self._iterations > asked else ""
        biases = {float(constraint.error_bias) for constraint in space.constraints}
        return Facts(
            version=VERSION,
            mass_kg={n: b.mass for n, b in free.items()},
            inertia_kg_m2={n: b.moment for n, b in free.items() if math.isfinite(b.moment)},
            centre_m={n: _sum(self._model.centre[n], b.center_of_gravity) for n, b in free.items()},
            gravity_m_s2=(space.gravity[0], space.gravity[1]),
            start=self.read(),
            settings=dict(self._settings)
            | {
                "timestep_s": self._dt,
                **as_held("iterations", asked, self._iterations, int(space.iterations), cause),
                "damping": float(space.damping),
                **({"error_bias": biases.pop()} if len(biases) == 1 else {}),
                **({"collision_slop_of_cams": space.collision_slop} if space.shapes else {}),
            },
            velocity_shift=VELOCITY_SHIFT,
            acceleration_shift=0.0,
            springs=self._acting.springs(),
        )

    def step(self, steps: int) -> None:
        """Advance without logging."""
        self._advance(steps, 0)

    def record(self, steps: int, every: int) -> Log:
        """Advance and log; one batch call per logged step appends all bodies to one buffer."""
        return self._recorded(steps, every)[0]

    def record_forces(self, steps: int, every: int) -> Log:
        """Advance and log with the forces of each logged step; the first sample has none."""
        bent = self._arcs is not None
        reactions = Reactions(self._model, self._rows, self._dt, bent=bent)
        log, rows = self._recorded(steps, every, reactions)
        count = len(log.poses.time_s)
        before, after = rows[1::2][: max(count - 1, 0)], rows[0::2][:count]
        return replace(log, forces=reactions.forces(before, after, log.poses.time_s))

    def _recorded(
        self, steps: int, every: int, reactions: Reactions | None = None
    ) -> tuple[Log, Array]:
        """Return the log, and the rows of the buffer: with ``reactions`` each step has two."""
        at = self._done + every * np.arange(steps // every + 1, dtype=np.float64)
        each = 1 if reactions is None else 2
        began = time.perf_counter()
        self._make_room(each * len(at))
        self._log()
        self._advance(steps, every, reactions)
        rows = np.frombuffer(self._buffer.float_buf(), dtype=np.float64).copy()
        wall = time.perf_counter() - began
        rows = rows.reshape(each * (len(at) - 1) + 1, -1, WIDTH)
        good = np.isfinite(rows[::each]).all(axis=(1, 2))
        count = len(at) if good.all() else int(np.argmin(good))
        poses = self._poses(rows[::each][:count], at[:count])
        return Log(poses, (count - 1) * every, count < len(at), (), wall), rows

    def read(self) -> Poses:
        """Read the current state."""
        self._make_room(1)
        self._log()
        rows = np.frombuffer(self._buffer.float_buf(), dtype=np.float64).copy()
        return self._poses(rows.reshape(1, -1, WIDTH), np.array([float(self._done)]))

    def _make_room(self, samples: int) -> None:
        """Empty the buffer, after lending it memory for the samples; it leaks its own memory."""
        need = samples * (len(self._rows) + 1) * WIDTH + ROOM
        if len(self._memory) < need:
            self._memory = np.empty(need)
            self._buffer.set_float_buf(self._memory)
        self._buffer.clear()

    def _log(self) -> None:
        pymunk.batch.get_space_bodies(self._space, FIELDS, self._buffer)

    def _advance(self, steps: int, every: int, reactions: Reactions | None = None) -> None:
        """Step; log after every ``every``-th step, or never if it is 0."""
        bare = not (reactions or self._acting or self._arcs)
        if bare and self._coasts:
            self._coast(steps, every)
        else:
            self._each(steps, every, reactions)
        self._done += steps

    def _coast(self, steps: int, every: int) -> None:
        """Step with a free crank, or one of constant speed; logging slows tight loops little."""
        step, dt = self._space.step, self._dt
        log, space, buffer = pymunk.batch.get_space_bodies, self._space, self._buffer
        if every == 1:
            for _ in range(steps):
                step(dt)
                log(space, FIELDS, buffer)
            return
        for _ in range(steps // every if every else 0):
            for _ in range(every):
                step(dt)
            log(space, FIELDS, buffer)
        for _ in range(steps % every if every else steps):
            step(dt)

    def _turns(self, steps: int) -> list[tuple[float, float]]:
        """Return the angle and the speed of the crank before each of the next steps."""
        law, first = self._scene.driver.law, self._done + 1
        theta = drives.angles(law, self._start_s, self._dt, first, first + steps - 1)
        chord = drives.chords(law, self._start_s, self._dt, first, first + steps - 1)
        return list(zip((theta - chord * self._dt).tolist(), chord.tolist(), strict=True))

    def _each(self, steps: int, every: int, reactions: Reactions | None) -> None:
        """Step with the crank on its law and all actions, and log every ``every``-th step; with
        ``reactions`` also before it, with the impulses of its joints.

        A step turns the crank by speed * dt before the other bodies' velocities are solved for, so
        the crank is set back by the next step's turn and ends at the law's angle, with the speed of
        the next step.
        """
        space, dt, turn = self._space, self._dt, self._turn
        turns = [] if self._coasts else self._turns(steps)
        acting = self._acting if self._acting else None
        if acting is not None:
            ends = self._done + 1 + np.arange(steps, dtype=np.float64)
            acting.look_ahead(self._start_s + dt * ends)
        for k in range(steps):
            if turns:
                turn(*turns[k])
            if acting is not None:
                acting.apply(k)
            if self._arcs is not None:
                self._arcs.bend()
            logged = every > 0 and (k + 1) % every == 0
            if logged and reactions is not None:
                pymunk.batch.get_space_bodies(space, BEFORE, self._buffer)
            space.step(dt)
            if logged:
                self._log()
                if reactions is not None:
                    reactions.read(self._acting.pulled(), self._acting.rubbed)

    def _poses(self, rows: Array, at: Array) -> Poses:
        """Return the poses of the links' own frames from the bodies' centres of gravity."""
        lag = VELOCITY_SHIFT * self._dt
        poses = {
            name: centred(rows[:, row, :3], rows[:, row, 3:], None, self._model.centre[name], lag)
            for name, row in self._rows.items()
        }
        return Poses(self._start_s + self._dt * at, poses, lag)


def _sum(a: Point, b: Point) -> Point:
    return a[0] + b[0], a[1] + b[1]


ENGINE = shipped_engine(
    own,
    VERSION,
    PymunkSession,
    in_seconds=own.in_seconds,
    applies_gears=True,
    applies_cams=True,
    applies_cams_by_contact=True,
)
