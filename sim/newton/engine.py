"""Newton: links and joints, loops closed by ball joints, stepped by one of its solvers."""

import math
import time
from collections.abc import Callable, Sequence
from copy import copy
from importlib.metadata import PackageNotFoundError, version
from typing import Any, ClassVar, Self

import numpy as np

from models.array import Array
from models.errors import EngineError
from models.mjcf.forces import planned
from models.mjcf.tree import Limb, driven_freedom
from models.motion import State
from models.scene import GROUND, Point, Scene
from models.scene import joints as pairs
from models.scene.joints import Frame, turned
from sim.compiling import compiling
from sim.engine import Batches, Drive, Facts, Log, Settings
from sim.engine.acting import Push, Pushes
from sim.engine.heavy_driver import HeavyDriverSession
from sim.engine.settings import shipped_engine
from sim.engine.ties import refuse_driver_angle, refuse_massless
from sim.newton import DECLARATION
from sim.newton import settings as own
from sim.newton.solvers import MAXIMAL, made, newton, register, wp


def _version() -> str:
    """Return the version, with that of the MuJoCo of its solver."""
    try:
        return f"{version('newton')} (mujoco {version('mujoco')})"
    except PackageNotFoundError:
        return version("newton")


VERSION = _version()


class View:
    """A state, and its arrays, which on the processor numpy sees as they are."""

    def __init__(self, state: Any) -> None:
        self.state = state
        names = "body_q", "body_qd", "body_f", "joint_q", "joint_qd"
        self.body_q, self.body_qd, self.body_f, self.joint_q, self.joint_qd = (
            getattr(state, name).numpy() for name in names
        )


class NewtonSession(HeavyDriverSession):
    """A session with one world on the processor. A step moves by the velocities at its end."""

    name = "newton"
    tangent = math.inf
    shift = -0.5
    taped: ClassVar[bool] = False
    """True if its steps are to be differentiated."""

    def __init__(
        self, scene: Scene, state: State, settings: Settings, dt_s: float, driven_by: Drive
    ) -> None:
        own.checked(settings)
        refuse_driver_angle(scene, self.name)
        if driven_by == "servo" or (driven_by != "free" and scene.driver.is_inner):
            raise EngineError(
                f"{scene.name}: motors in newton are not offered by crankcheck; drive a link on "
                "the ground, prescribed"
            )
        super().__init__(scene, state, settings, dt_s, driven_by, 1)
        self.rubbing, self.solver_name = [], str(settings["solver"])
        self.maximal = self.solver_name in MAXIMAL
        self.tree = planned(scene, state, delay_s=self.shift * dt_s)
        self.builder, self.first_rate = self._builder(), 0
        self.model = self.builder.finalize(device="cpu", requires_grad=self.taped)
        self.from_value, self.end, self.driven = 0.0, (0.0, 0.0), (0, 0)
        if self.led:
            driven, _ = driven_freedom(scene, self.tree.limbs)
            names = [freedom.name for limb in self.tree.limbs for freedom in limb.freedoms]
            self.driven = (names.index(driven),) * 2
            self.from_value = float(scene.driver.law.at(np.array([state.time_s]))[0][0])
        self._start([self])
        self.begin()

    @classmethod
    def record_together(
        cls, sessions: Sequence[Self], steps: int, every: int, threads: int
    ) -> list[Log]:
        """Record sessions as the worlds of a batch (`sim.engine.Batches`)."""
        once = cls._put_together(sessions)
        began = time.perf_counter()
        each = [(one, [one.numbers()]) for one in sessions]
        series = [one._steps(steps, every, rows, None) for one, rows in each]
        for _ in zip(*series, strict=True):
            once()
        wall = (time.perf_counter() - began) / len(sessions)
        return [one._logged(0, every, rows, None, wall) for one, rows in each]

    @classmethod
    def _put_together(cls, sessions: Sequence[Self]) -> Callable[[], None]:
        """Make a model of the worlds of all sessions, which see it from then on; return its
        step."""
        one, bodies = sessions[0], sessions[0].model.body_count
        if not one.maximal:
            raise EngineError(
                f"newton: crankcheck runs batches of {' and '.join(sorted(MAXIMAL))}; "
                f"{one.solver_name} reads all worlds for each"
            )
        builder = newton.ModelBuilder()
        register(builder, one.solver_name)
        counts = one.model.joint_coord_count, one.model.joint_dof_count
        for k, each in enumerate(sessions):
            builder.add_world(each.builder)
            own = {name: row + k * bodies for name, row in each.index.items()}
            each.index = own | {GROUND: -1}
            at, rate = each.driven
            each.driven = at + k * counts[0], rate + k * counts[1]
            each.first_rate = k * counts[1]
        whole = copy(one)
        whole.model = builder.finalize(device="cpu")
        whole._start(sessions)
        for each in sessions:
            each.begin()  # with the speed of its own instant

        def once() -> None:
            whole.advance()
            for each in sessions:
                each.now = whole.now
                each.settle()

        return once

    def _builder(self) -> Any:
        builder = newton.ModelBuilder()
        register(builder, self.solver_name)
        builder.gravity = wp.vec3(*self.scene.gravity_m_s2, 0.0)
        self.index, self.ends = {GROUND: -1}, list[tuple[Array, Array]]()
        for limb in self.tree.limbs:
            self.index[limb.body] = self._link(builder, limb.body)
        self.joint = [self._joint(builder, limb) for limb in self.tree.limbs]
        for roots in self._articulations():
            builder.add_articulation(roots)
        for closure in self.tree.closures:
            first, last = sorted(closure.bodies, key=[*self.index].index)
            ends = [row(self.bodies.anchor(name, closure.point), 0.0) for name in (first, last)]
            builder.add_joint_ball(self.index[first], self.index[last], **self._ends(*ends))
        return builder

    def _link(self, builder: Any, name: str) -> int:
        (mass, inertia), frame = pairs.mass_of(self.scene, name), self.frame_of(name)
        led = name == self.led
        if led:  # nothing is read of it, and it may have no mass
            mass, inertia = 1.0, pairs.inertia_scale(self.scene)
        else:
            turns = name not in self.fixed
            refuse_massless(self.scene, self.name, name, turns=turns)
        return int(
            builder.add_link(
                xform=wp.transform(*row(frame.origin, frame.theta)),
                mass=mass,
                inertia=wp.mat33(np.diag([inertia or mass] * 3)),
                lock_inertia=True,
                is_kinematic=led and self.maximal,
                label=name,
            )
        )

    def _joint(self, builder: Any, limb: Limb) -> int:
        """Add the joint of a limb, whose coordinates count from the start."""
        kinds = [freedom.kind for freedom in limb.freedoms]
        if limb.body == self.led and len(kinds) > 1:
            raise EngineError(
                f"{self.scene.name}: the driven block has no mass of its own, and newton drives a "
                "body; give it one"
            )
        axis = next((each.axis_rad for each in limb.freedoms if each.kind == "slide"), 0.0)
        anchor = next((each.anchor for each in limb.freedoms if each.kind == "hinge"), (0.0, 0.0))
        ahead = turned(anchor, limb.angle_rad)
        place = limb.offset[0] + ahead[0], limb.offset[1] + ahead[1]
        ends = self._ends(
            row(self.bodies.from_centre(limb.parent, place), limb.angle_rad + axis),
            row(self.bodies.from_centre(limb.body, anchor), axis),
        )
        flywheel = 0.0
        if limb.body == self.led and not self.maximal:
            flywheel = float(self.settings["flywheel_ratio"]) * pairs.inertia_scale(self.scene)
            flywheel /= self.scene.driver_arm_m**2
        along, about = (
            newton.ModelBuilder.JointDofConfig(axis=way, armature=flywheel)
            for way in (wp.vec3(1.0, 0.0, 0.0), wp.vec3(0.0, 0.0, 1.0))
        )
        between = self.index[limb.parent], self.index[limb.body]
        if kinds == ["hinge"]:
            return int(builder.add_joint_revolute(*between, axis=about, **ends))
        if kinds == ["slide"]:
            return int(builder.add_joint_prismatic(*between, axis=along, **ends))
        return int(
            builder.add_joint_d6(*between, linear_axes=[along], angular_axes=[about], **ends)
        )

    def _ends(self, parent: Array, child: Array) -> dict[str, Any]:
        """Keep the frames of a joint in its bodies, and return them for the builder."""
        self.ends.append((parent, child))
        return {"parent_xform": wp.transform(*parent), "child_xform": wp.transform(*child)}

    def _articulations(self) -> list[list[int]]:
        """Return the joints of each tree on the ground, the limbs being depth first."""
        trees: list[list[int]] = []
        for limb, joint in zip(self.tree.limbs, self.joint, strict=True):
            if limb.parent == GROUND:
                trees.append([])
            trees[-1].append(joint)
        return trees

    def _start(self, sessions: Sequence[Self]) -> None:
        """Put the states of the start of sessions, this one or those of a batch, into the model."""
        self.control = self.model.control()
        with compiling():
            for compiled in (False, True):
                self.solver = made(self.model, self.settings, self.dt)
                self.now, self.next, self.between = (View(self.model.state()) for _ in range(3))
                for each in sessions:
                    each.now = self.now
                    each.put_rates()
                if not compiled:
                    self.advance()

    def put_rates(self) -> None:
        """Put the velocities of the start into the model."""
        now, rates = self.now, [each.rate for limb in self.tree.limbs for each in limb.freedoms]
        now.joint_qd[self.first_rate : self.first_rate + len(rates)] = rates
        for name in self.names:
            now.body_qd[self.index[name]] = twist(self.frame_of(name))
        if not self.maximal:
            newton.eval_fk(self.model, now.state.joint_q, now.state.joint_qd, now.state)

    def advance(self) -> None:
        """Step the model."""
        self.solver.step(self.now.state, self.next.state, self.control, None, self.dt)
        self.now, self.next = self.next, self.now

    def once(self) -> None:
        self.advance()
        self.settle()

    def settle(self) -> None:
        """Put the led body at the end of the step, for Kamino, which does not move it there."""
        if self.led and self.solver_name == "Kamino":
            self._lead(*self.end)

    def turn(self, place: float | None, speed: float) -> None:
        begin = self.from_value if place is None else place
        self.end = begin + self.dt * speed, speed
        ahead = self.solver_name == "XPBD" and place is not None  # it closes joints at the end
        self._lead(self.end[0] if ahead else begin, speed)

    def _lead(self, place: float, speed: float) -> None:
        """Put the led body where its driver's coordinate is ``place``."""
        self.led_by = place, speed
        number, frame = self.index[str(self.led)], self.led_at(place, speed)
        self.now.body_q[number] = row(frame.origin, frame.theta)
        self.now.body_qd[number] = twist(frame)
        at, rate = self.driven
        self.now.joint_q[at], self.now.joint_qd[rate] = place - self.from_value, speed

    def led_at(self, place: float, speed: float) -> Frame:
        """Return the frame of the led body where its driver's coordinate is ``place``."""
        ahead, slider = place - self.from_value, self.scene.driver.slider
        (x, y), theta = self.led_frame.origin, self.led_frame.theta
        if slider is None:
            return Frame((x, y), theta + ahead, (0.0, 0.0), speed)
        u, v = turned((1.0, 0.0), self.scene.sliders[slider].direction_rad)
        return Frame((x + ahead * u, y + ahead * v), theta, (speed * u, speed * v), 0.0)

    def lead(self, frame: Frame, push: Push) -> None:
        raise NotImplementedError

    def run_motor(self, speed: float) -> None:
        raise NotImplementedError

    def push(self, pushes: Pushes) -> None:
        forces = self.now.body_f
        for name in (name for name in self.names if name != self.led):
            fx, fy, moment = pushes.on_bodies[name]
            forces[self.index[name]] = fx, fy, 0.0, 0.0, 0.0, moment

    def look(self) -> Array:
        rows = [self.index[name] for name in self.names]
        there = self.now if self.maximal else self._at_rates()
        q = self.now.body_q[rows].astype(np.float64)
        rate = there.body_qd[rows].astype(np.float64)
        theta = 2.0 * np.arctan2(q[:, 5], q[:, 6])
        return np.column_stack([q[:, :2], theta, rate[:, :2], rate[:, 5]])

    def _at_rates(self) -> Any:
        """Return the bodies at the instant of the joint rates."""
        now, there = self.now, self.between
        tree = slice(sum(len(limb.freedoms) for limb in self.tree.limbs))  # loops come after it
        there.joint_q[:] = now.joint_q
        there.joint_q[tree] += self.shift * self.dt * now.joint_qd[tree]
        newton.eval_fk(self.model, there.state.joint_q, now.state.joint_qd, there.state)
        return there

    def facts(self) -> Facts:
        mass, inertia = self.model.body_mass.numpy(), self.model.body_inertia.numpy()
        matter = {
            name: (
                float(mass[self.index[name]]),
                math.inf if name in self.fixed else float(inertia[self.index[name]][2, 2]),
            )
            for name in self.names
            if name != self.led
        }
        centre = {name: self.bodies.centre[name] for name in matter}
        x, y, _ = self.model.gravity.numpy().reshape(-1, 3)[0]
        held = own.holds(self.settings, self.dt, self.drive)
        return self.facts_of(VERSION, matter, centre, (float(x), float(y)), held)


def row(place: Point, angle: float) -> Array:
    """Return the numbers of a transform in the plane: place and quaternion."""
    half = 0.5 * angle
    return np.array([*place, 0.0, 0.0, 0.0, math.sin(half), math.cos(half)])


def twist(frame: Frame) -> tuple[float, ...]:
    """Return the velocity of a frame's origin and its rate of turning."""
    return (*frame.velocity, 0.0, 0.0, 0.0, frame.omega)


ENGINE = shipped_engine(
    own,
    VERSION,
    NewtonSession,
    holds=own.holds,
    in_seconds=own.in_seconds,
    precision=DECLARATION.precision,
    floor=2e-6,
    applies_constant_friction=False,
    batches=Batches(NewtonSession.record_together),
)
