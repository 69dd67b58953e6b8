"""Bullet: a multibody with joint coordinates, its loops closed by point-to-point constraints.

A step takes velocities from forces at the positions before it, corrects them by impulses, and moves
positions with them: velocities belong half a step before the positions. Terms that follow from
velocities in joint coordinates are taken with those, of first order in free motion; so bodies in
free motion have the coordinates of their centres of mass, which have no such terms (`loosened`).
Forces are not read: those of joints of a chain of links are off by 60 % at any step.
"""

import math
import weakref
from collections.abc import Mapping
from dataclasses import replace
from importlib.metadata import version
from typing import Any

import numpy as np

from models.array import Array
from models.errors import EngineError
from models.mjcf.tree import Freedom, LoopPin, Tree
from models.motion import State
from models.scene import GROUND, Point, Scene
from models.scene import joints as pairs
from models.scene.joints import Frame, less, turned
from models.scene.loads import ConstantFriction
from sim.bullet import settings as own
from sim.engine import Drive, Facts, Settings
from sim.engine.acting import Pushes
from sim.engine.imported import imported
from sim.engine.settings import shipped_engine
from sim.engine.ties import refuse_driver_angle, refuse_massless
from sim.engine.tree_session import TreeSession

pb = imported("pybullet")
VERSION = version("pybullet")
ORIGIN, UPRIGHT = (0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0)
UNLIMITED = 1e15
"""Limit of forces [N], torques [N m] and speeds of joints; the package's own are 500 and 100."""
MOST_LINKS = 127
"""Most links of a multibody; the package cuts others off without a word."""


class BulletSession(TreeSession):
    """A session with one multibody, whose fixed base is the ground. Each joint coordinate is a link
    of it, by its row, and counts from the start; the last of a body has its mass."""

    name = "bullet"
    shift = -0.5

    def __init__(
        self, scene: Scene, state: State, settings: Settings, dt_s: float, driven_by: Drive
    ) -> None:
        own.checked(settings)
        refuse_driver_angle(scene, self.name)
        super().__init__(scene, state, settings, dt_s, driven_by)
        driver = scene.driver
        self.led = driver.link if driven_by == "prescribed" and not driver.is_inner else None
        """The body that has the flywheel."""
        self.start = np.array([freedom.ref for freedom in self.freedoms])
        self.rows = list(range(len(self.freedoms)))
        self.link = {GROUND: -1}
        self.origin: dict[str, Point] = {GROUND: (0.0, 0.0)}
        """Origin of each body's link in the frame of the body: its hinge."""
        self.client = pb.connect(pb.DIRECT)
        weakref.finalize(self, pb.disconnect, self.client)
        self.multibody = self._build()
        self._set()
        self._close()
        self.begin()

    def grown(self) -> Tree:
        """Return the tree, loosened in free motion except sliders and pins with friction."""
        scene, tree = self.scene, super().grown()
        if self.drive != "free":
            return tree
        where = pairs.frames(scene, self.state, self.shift * self.dt)
        return loosened(scene, where, tree, *scene.friction)

    def _call(self, what: str, *given: object, **named: object) -> Any:
        """Call a function of the package on this session's world."""
        return getattr(pb, what)(*given, **named, physicsClientId=self.client)

    def _build(self) -> int:
        """Add the multibody: a joint's frame is the link's own, turned as the body at the start."""
        places, turns, centres = [], [], []
        parents: list[int] = []
        for limb in self.tree.limbs:
            hinges = [freedom for freedom in limb.freedoms if freedom.kind == "hinge"]
            anchor = hinges[0].anchor if hinges else (0.0, 0.0)
            arm = turned(anchor, limb.angle_rad)
            x, y = less(limb.offset, self.origin[limb.parent])
            half, parent = 0.5 * limb.angle_rad, self.link[limb.parent]
            more = len(limb.freedoms) - 1
            places += [(x + arm[0], y + arm[1], 0.0)] + more * [ORIGIN]
            turns += [(0.0, 0.0, math.sin(half), math.cos(half))] + more * [UPRIGHT]
            parents += [parent + 1, *(len(parents) + 1 + k for k in range(more))]
            centre = less(pairs.centre_of(self.scene, limb.body), anchor)
            centres += more * [ORIGIN] + [(*centre, 0.0)]
            self.link[limb.body], self.origin[limb.body] = len(parents) - 1, anchor
        count = len(places)
        if count > MOST_LINKS:
            raise EngineError(
                f"{self.scene.name}: it takes {count} joint coordinates, and a multibody of Bullet "
                f"has {MOST_LINKS}; take fewer links or segments"
            )
        slides = [freedom.kind == "slide" for freedom in self.freedoms]
        axes = [(*f.axis, 0.0) if f.kind == "slide" else (0.0, 0.0, 1.0) for f in self.freedoms]
        made: int = self._call(
            "createMultiBody",
            baseMass=0.0,
            linkMasses=[0.0] * count,
            linkCollisionShapeIndices=[-1] * count,
            linkVisualShapeIndices=[-1] * count,
            linkPositions=places,
            linkOrientations=turns,
            linkInertialFramePositions=centres,
            linkInertialFrameOrientations=[UPRIGHT] * count,
            linkParentIndices=parents,
            linkJointTypes=[pb.JOINT_PRISMATIC if s else pb.JOINT_REVOLUTE for s in slides],
            linkJointAxis=axes,
        )
        return made

    def _set(self) -> None:
        """Give the world its settings, and the bodies their masses, rates and friction."""
        scene, chosen, made = self.scene, self.settings, self.multibody
        self._call("setGravity", *scene.gravity_m_s2, 0.0)
        self._call(
            "setPhysicsEngineParameter",
            fixedTimeStep=self.dt,
            numSolverIterations=int(chosen["iterations"]),
            solverResidualThreshold=float(chosen["residual"]),
            erp=float(chosen["erp"]),
        )
        # By itself: a call with this limit is one on the base, whatever its link.
        self._call("changeDynamics", made, -1, maxJointVelocity=UNLIMITED)
        still = {"linearDamping": 0.0, "angularDamping": 0.0, "jointDamping": 0.0}
        for limb in self.tree.limbs:
            row = self.link[limb.body]
            mass, inertia = pairs.mass_of(scene, limb.body)
            turns = any(freedom.kind == "hinge" for freedom in limb.freedoms)
            if limb.body == self.led:
                flywheel = float(chosen["flywheel_ratio"]) * pairs.inertia_scale(scene)
                mass, inertia = mass + flywheel / scene.longest_m**2, inertia + flywheel
            else:
                refuse_massless(scene, self.name, limb.body, turns=turns)
            self._call("changeDynamics", made, row, mass=mass, **still)
            self._call("changeDynamics", made, row, localInertiaDiagonal=(inertia,) * 3)
            for k, freedom in enumerate(limb.freedoms, row + 1 - len(limb.freedoms)):
                rub = scene.friction.get(limb.point) if freedom.kind == "hinge" else None
                rubbed = rub.size if isinstance(rub, ConstantFriction) else 0.0
                self._call("resetJointState", made, k, 0.0, freedom.rate)
                # Without a force it takes off the motor that each joint has at first.
                self._call("setJointMotorControl2", made, k, pb.VELOCITY_CONTROL, force=rubbed)

    def _close(self) -> None:
        made, p2p = self.multibody, pb.JOINT_POINT2POINT
        for pin in self.tree.closures:
            (a, b), (at_a, at_b) = pin.bodies, (self._arm(name, pin.point) for name in pin.bodies)
            links = made, self.link[a], made, self.link[b]
            tie = self._call("createConstraint", *links, p2p, ORIGIN, at_a, at_b)
            self._call("changeConstraint", tie, maxForce=UNLIMITED)

    def _arm(self, body: str, point: str) -> tuple[float, float, float]:
        """Return a point of a body from its centre of mass, as constraints take it."""
        centre = pairs.centre_of(self.scene, body) if body != GROUND else (0.0, 0.0)
        return (*less(pairs.local_point(self.scene, body, point), centre), 0.0)

    def once(self) -> None:
        pb.stepSimulation(self.client)

    def turn(self, place: float | None, speed: float) -> None:
        row, speed = self.driven, self.sense * speed
        if place is None:
            self._call("resetJointState", self.multibody, row, 0.0, speed)
            return
        gain = float(self.settings["servo_gain"])
        if self.drive == "prescribed":
            found = self._call("getJointState", self.multibody, row)[0] + self.start[row]
            late = self.sense * place - found
            if self.freedoms[row].kind == "hinge":
                late = math.remainder(late, math.tau)
            gain, speed = 1.0, speed + late / self.dt
        self._call(
            "setJointMotorControl2",
            self.multibody,
            row,
            pb.VELOCITY_CONTROL,
            targetVelocity=speed,
            force=UNLIMITED,
            velocityGain=gain,
        )

    def frames(self, ahead_s: float) -> Mapping[str, Frame]:
        self.seen = super().frames(ahead_s)
        return self.seen

    def push(self, pushes: Pushes) -> None:
        for name in self.names:
            fx, fy, moment = pushes.on_bodies[name]
            link = self.multibody, self.link[name]
            place = (*self.seen[name].origin, 0.0)
            self._call("applyExternalForce", *link, (fx, fy, 0.0), place, pb.WORLD_FRAME)
            self._call("applyExternalTorque", *link, (0.0, 0.0, moment), pb.WORLD_FRAME)

    def look(self) -> Array:
        found = self._call("getJointStates", self.multibody, self.rows)
        rows = np.array([one[:2] for one in found]).T
        rows[0] += self.start
        return rows

    def facts(self) -> Facts:
        matter, centres = {}, {}
        for name in self.names:
            if name != self.led:
                mass, _, inertia, (x, y, _), *_ = self._call(
                    "getDynamicsInfo", self.multibody, self.link[name]
                )
                matter[name] = mass, inertia[2]
                centres[name] = x + self.origin[name][0], y + self.origin[name][1]
        world = self._call("getPhysicsEngineParameters")
        gravity = world["gravityAccelerationX"], world["gravityAccelerationY"]
        held = {"timestep_s": world["fixedTimeStep"], "iterations": world["numSolverIterations"]}
        return self.facts_of(VERSION, matter, centres, gravity, held)


def loosened(scene: Scene, where: Mapping[str, Frame], tree: Tree, *but: str) -> Tree:
    """Return the tree with each body at its centre of mass on two slides and a hinge of the ground,
    and its pin closed as a loop; as they are those on sliders, and with pins in ``but``."""
    limbs, closures = [], [*tree.closures]
    for limb in tree.limbs:
        if limb.slider is not None or limb.point in but:
            limbs.append(limb)
            continue
        frame, centre, name = where[limb.body], pairs.centre_of(scene, limb.body), limb.body
        (vx, vy), theta = frame.velocity_at(frame.at(centre)), frame.theta
        freedoms = (
            Freedom(f"{name}.x", "slide", (0.0, 0.0), -theta, 0.0, vx),
            Freedom(f"{name}.y", "slide", (0.0, 0.0), 0.5 * math.pi - theta, 0.0, vy),
            replace(limb.freedoms[0], anchor=centre, ref=theta, rate=frame.omega),
        )
        limbs.append(
            replace(limb, parent=GROUND, offset=frame.origin, angle_rad=theta, freedoms=freedoms)
        )
        closures.append(LoopPin(limb.point, (limb.parent, name)))
    return Tree(tuple(limbs), tuple(closures))


ENGINE = shipped_engine(own, VERSION, BulletSession, in_seconds=own.in_seconds)
