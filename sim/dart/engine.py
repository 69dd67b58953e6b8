"""DART: joint coordinates, loops closed by impulses, places stepped with the new velocities."""

import importlib
import math
from collections.abc import Mapping
from importlib.metadata import version
from typing import Any

import numpy as np

from models.array import Array
from models.mjcf.forces import planned
from models.mjcf.tree import Freedom, Limb, LoopPin
from models.motion import State
from models.scene import GROUND, Point, Scene
from models.scene import joints as pairs
from sim.dart import settings as own
from sim.engine import Drive, Facts, Settings
from sim.engine.acting import Pushes
from sim.engine.settings import shipped_engine
from sim.engine.ties import refuse_massless
from sim.engine.tree_session import TreeSession

dartpy: Any = importlib.import_module("dartpy")  # ships no stubs
VERSION = version("dartpy")
OUT = (0.0, 0.0, 1.0)
"""Axis of all hinges: out of the plane."""
TRIFLE = 1e-30
"""Mass [kg] and inertia [kg m^2] of the body between two joints in series: DART warns of 0, and
this is lost in the rounding of any other."""
UNLIKE = 1e-12
"""Share of the pace by which speeds of a servo differ from step to step, up and down in turn: DART
leaves a servo out of a step that begins with its speed to the last digit, whatever may pull."""


class DartSession(TreeSession):
    """A session with one world, with one skeleton, the tree."""

    name = "dart"
    shift = -0.5
    rubs = True

    def __init__(
        self, scene: Scene, state: State, settings: Settings, dt_s: float, driven_by: Drive
    ) -> None:
        own.checked(settings)
        super().__init__(scene, state, settings, dt_s, driven_by)
        self.world = dartpy.simulation.World()
        self.world.setGravity([*scene.gravity_m_s2, 0.0])
        self.world.setTimeStep(dt_s)
        asleep = self.world.getDeactivationOptions()
        asleep.mEnabled = False
        self.world.setDeactivationOptions(asleep)
        self.skeleton = dartpy.dynamics.Skeleton()
        self.joints: list[Any] = []
        self.body: dict[str, Any] = {GROUND: None}
        for limb in self.tree.limbs:
            self.body[limb.body] = self._body(limb)
        self.ref = np.array([one.ref for one in self.freedoms])
        now = planned(scene, state).limbs
        self.start_rates = np.array([one.rate for limb in now for one in limb.freedoms])
        self.skeleton.setVelocities(np.array([one.rate for one in self.freedoms]))
        self.motor = self.joints[self.driven]
        self._drive()
        for rub in self.rubbing:
            if rub.row != self.driven or driven_by != "prescribed":  # else it moves nothing
                self.joints[rub.row].setCoulombFriction(0, rub.size)
        self.world.addSkeleton(self.skeleton)
        self.loops = [self._loop(closure) for closure in self.tree.closures]
        for loop in self.loops:
            self.world.getConstraintSolver().addConstraint(loop)
        self.begin()

    def _body(self, limb: Limb) -> Any:
        """Add the bodies of a limb, one for each of its joints, and return the last."""
        mass, inertia = pairs.mass_of(self.scene, limb.body)
        if self.drive != "prescribed" or limb.body != self.scene.driver.link:
            turns = limb.slider is None or len(limb.freedoms) > 1
            refuse_massless(self.scene, self.name, limb.body, turns=turns)
        body, place = self.body[limb.parent], placed(limb.offset, limb.angle_rad)
        for freedom in limb.freedoms:
            joint, body = self._joint(freedom, body, place)
            self.joints.append(joint)
            body.setInertia(matter(TRIFLE, TRIFLE, (0.0, 0.0)))
            place = np.eye(4)
        body.setInertia(matter(mass, inertia, pairs.centre_of(self.scene, limb.body)))
        return body

    def _joint(self, freedom: Freedom, base: Any, place: Array) -> tuple[Any, Any]:
        """Add one joint to a body, or the ground, with its own body at ``place`` of that."""
        if freedom.kind == "hinge":
            joint, body = self.skeleton.createRevoluteJointAndBodyNodePair(base)
            joint.setAxis(OUT)
        else:
            joint, body = self.skeleton.createPrismaticJointAndBodyNodePair(base)
            joint.setAxis([*freedom.axis, 0.0])
        pivot = placed(freedom.anchor, 0.0)
        joint.setTransformFromParentBodyNode(dartpy.math.Isometry3(place @ pivot))
        joint.setTransformFromChildBodyNode(dartpy.math.Isometry3(pivot))
        return joint, body

    def _drive(self) -> None:
        """Give the driven joint its motor."""
        kinds = dartpy.dynamics
        if self.drive == "prescribed":
            self.motor.setActuatorType(kinds.VELOCITY)
        elif self.drive == "servo":
            most = float(self.settings["motor_n_m"])
            self.motor.setActuatorType(kinds.SERVO)
            self.motor.setForceLowerLimit(0, -most)
            self.motor.setForceUpperLimit(0, most)
        self.from_law = float(self.scene.driver.law.at(np.array([self.start_s]))[0][0])

    def _loop(self, closure: LoopPin) -> Any:
        """Close a loop. DART ties the places of two bodies that meet at one: a start that is open
        there is closed meanwhile, by a shift of the body that carries nothing of the other."""
        order = [GROUND, *(limb.body for limb in self.tree.limbs)]
        first, last = sorted(closure.bodies, key=order.index)
        here, there = (
            where(self.body[name]) @ [*pairs.local_point(self.scene, name, closure.point), 0.0, 1.0]
            for name in (first, last)
        )
        joint = self.body[last].getParentJoint()
        kept, base = joint.getTransformFromParentBodyNode(), where(joint.getParentBodyNode())
        shifted = kept.matrix()
        shifted[:3, 3] += base[:3, :3].T @ (here - there)[:3]
        joint.setTransformFromParentBodyNode(dartpy.math.Isometry3(shifted))
        held = [self.body[name] for name in (last, first) if name != GROUND]
        loop = dartpy.constraint.BallJointConstraint(*held, here[:3])
        joint.setTransformFromParentBodyNode(kept)
        return loop

    def _run(self, *asked: Any) -> None:
        self._settle()
        super()._run(*asked)

    def _settle(self) -> None:
        """Set two numbers that DART has once for the loops of all worlds."""
        for loop in self.loops[:1]:
            loop.setErrorReductionParameter(float(self.settings["error_reduction"]))
            loop.setConstraintForceMixing(float(self.settings["force_mixing"]))

    def once(self) -> None:
        """Take one step; DART forgets its commands, joint forces and the motor's rate, after it."""
        tree = self.skeleton
        given = np.zeros(len(self.freedoms))
        if self.settings["coriolis"] == "middle":
            rates = tree.getVelocities()
            given += tree.getCoriolisForces()
            now = (
                self.start_rates
                if not self.done
                else rates + 0.5 * self.dt * tree.getAccelerations()
            )
            tree.setVelocities(now)
            given -= tree.getCoriolisForces()
            tree.setVelocities(rates)
        if self.drive != "free":
            given[self.driven] = self.rate
        tree.setCommands(given)
        self.world.step()

    def turn(self, place: float | None, speed: float) -> None:
        if place is None:
            self.motor.setVelocity(0, self.sense * speed)
            return
        rate = self.sense * speed
        if self.drive == "prescribed":
            stands = self.sense * (place - self.from_law)
            rate += (stands - self.motor.getPosition(0)) / self.dt
        else:
            rate += (-1.0) ** self.done * UNLIKE * self._pace()
        self.rate = rate

    def push(self, pushes: Pushes) -> None:
        for name in self.names:
            fx, fy, moment = pushes.on_bodies[name]
            self.body[name].addExtForce([fx, fy, 0.0], [0.0, 0.0, 0.0], False, True)
            self.body[name].addExtTorque([0.0, 0.0, moment], False)

    def look(self) -> Array:
        tree = self.skeleton
        return np.stack([self.ref + tree.getPositions(), tree.getVelocities()])

    def facts(self) -> Facts:
        found, centre = {}, {}
        for name in self.names:
            body = self.body[name]
            inertia = float(body.getInertia().getMoment()[2, 2])
            if body.getMass() > TRIFLE:
                found[name] = body.getMass(), inertia if inertia > TRIFLE else math.inf
            x, y, _ = body.getLocalCOM()
            centre[name] = float(x), float(y)
        x, y, _ = self.world.getGravity()
        return self.facts_of(VERSION, found, centre, (float(x), float(y)), self._held())

    def _held(self) -> Mapping[str, float]:
        """Return the settings as DART holds them."""
        held = {}
        for loop in self.loops[:1]:
            self._settle()
            held["error_reduction"] = float(loop.getErrorReductionParameter())
            held["force_mixing"] = float(loop.getConstraintForceMixing())
        return held


def placed(place: Point, angle: float) -> Array:
    """Return the transform of a frame at a place and an angle of another."""
    c, s = pairs.turned((1.0, 0.0), angle)
    return np.array([[c, -s, 0.0, place[0]], [s, c, 0.0, place[1]], [0, 0, 1, 0], [0, 0, 0, 1]])


def where(body: Any) -> Array:
    """Return the transform of a body in the plane; None is the ground."""
    return np.eye(4) if body is None else np.asarray(body.getWorldTransform().matrix())


def matter(mass: float, inertia: float, centre: Point) -> Any:
    """Return the inertia of a body; that about the axes of the plane moves nothing."""
    about = max(inertia, TRIFLE) * np.diag([0.5, 0.5, 1.0])
    return dartpy.dynamics.Inertia(max(mass, TRIFLE), [*centre, 0.0], about)


ENGINE = shipped_engine(own, VERSION, DartSession)
