"""Rapier: a world of bodies that move in the plane alone, joined by impulses."""

import math
from importlib import import_module
from importlib.metadata import version
from typing import Any

import numpy as np

from models.array import Array
from models.motion import State
from models.scene import GROUND, Scene
from models.scene import joints as pairs
from models.scene.joints import End, Frame, Prism, Slot
from sim.engine import Drive, Facts, Settings
from sim.engine.acting import Push, Pushes
from sim.engine.heavy_driver import HeavyDriverSession
from sim.engine.settings import shipped_engine
from sim.engine.ties import Hinge, hinges, refuse_driver_angle, refuse_massless, slide_of
from sim.rapier import DECLARATION
from sim.rapier import settings as own

rp: Any = import_module("rapier3d")  # so that types do not depend on installed packages
VERSION = version("rapier3d")
X, Y, TURN = rp.JointAxesMask.LIN_X, rp.JointAxesMask.LIN_Y, rp.JointAxesMask.ANG_Z
NOTHING = rp.JointAxesMask.empty()


class RapierSession(HeavyDriverSession):
    """A session with one world, in which each step is made of semi-implicit sub-steps."""

    name = "rapier"
    tangent = 12.0  # it turns by quaternions

    def __init__(
        self, scene: Scene, state: State, settings: Settings, dt_s: float, driven_by: Drive
    ) -> None:
        own.checked(settings)
        refuse_driver_angle(scene, self.name)
        self.of_substeps = "free_substeps" if driven_by == "free" else "substeps"
        substeps = int(settings[self.of_substeps])
        # The last sweeps of a sub-step leave velocities that fit the positions at its start.
        self.of_velocities = "free_velocity_sweeps" if driven_by == "free" else "velocity_sweeps"
        self.shift = (-1.0 if settings[self.of_velocities] else -0.5) / substeps
        self.acts_at = 0.5 - 0.5 / substeps
        super().__init__(scene, state, settings, dt_s, driven_by, substeps)
        self.world = rp.PhysicsWorld(gravity=(*scene.gravity_m_s2, 0.0))
        self._set()
        self.handle = {GROUND: self.world.add_body(rp.RigidBody.fixed())}
        self.handle |= {name: self._added(name) for name in self.names if name != self.led}
        if self.led:
            self.handle[self.led] = self._heavy()
        self.body = {name: self.world.rigid_bodies[one] for name, one in self.handle.items()}
        for body in self.body.values():
            body.recompute_mass_properties_from_colliders(self.world.colliders)
        self._join()
        self._rub()
        self.motor = self._motor() if driven_by != "free" and self.led is None else None
        self.begin()

    def _set(self) -> None:
        parameters, given = self.world.integration_parameters, self.settings
        parameters.dt = self.dt
        parameters.num_solver_iterations = given[self.of_substeps]
        parameters.num_internal_pgs_iterations = given["sweeps"]
        parameters.num_internal_stabilization_iterations = given[self.of_velocities]
        parameters.normalized_max_linear_velocity = 1e9

    def _added(self, name: str) -> Any:
        mass, inertia = pairs.mass_of(self.scene, name)
        turns = name not in self.fixed
        refuse_massless(self.scene, self.name, name, turns=turns)
        return self.world.add_body(
            self._build(self.frame_of(name), mass, inertia or mass)
            .enabled_translations((True, True, False))
            .enabled_rotations((False, False, turns))
        )

    def _heavy(self) -> Any:
        slides = self.scene.driver.slider is not None
        return self.world.add_body(
            self._build(self.led_frame, self.heavy, self.heavy)
            .gravity_scale(0.0)
            .enabled_translations((slides, slides, False))
            .enabled_rotations((False, False, not slides))
        )

    def _build(self, frame: Frame, mass: float, inertia: float) -> Any:
        return (
            rp.RigidBody.dynamic()
            .position(rp.Isometry3((*frame.origin, 0.0), rotation(frame.theta)))
            .linvel((*frame.velocity, 0.0))
            .angvel((0.0, 0.0, frame.omega))
            .additional_mass_properties(rp.MassProperties((0.0, 0.0, 0.0), mass, (inertia,) * 3))
            .can_sleep(False)
            .allow_fast_rotation(True)
        )

    def _join(self) -> None:
        scene, driver = self.scene, self.scene.driver
        for hinge in hinges(scene, *((GROUND,) if driver.is_inner else (GROUND, driver.link))):
            if not (self.led and {hinge.first, hinge.other} == {GROUND, self.led}):
                self._joint(X | Y, *self.bodies.hinge_ends(hinge))
        for slide in pairs.joints(scene).slides:
            if not self.led or slide.slider.name != driver.slider:
                turns = isinstance(slide, Slot) or slide.body in self.fixed
                self._line(Y if turns else Y | TURN, slide)
            elif isinstance(slide, Slot):
                rider, _ = self.bodies.line_ends(slide)
                self._joint(X | Y, (self.led, (0.0, 0.0)), rider)

    def _line(self, held: Any, slide: Prism | Slot) -> Any:
        slider, (rider, guide) = slide.slider, self.bodies.line_ends(slide)
        lines = slider.direction_rad, slider.direction_rad - pairs.sliding_angle(slider)
        return self._joint(held, guide, rider, lines)

    def _joint(
        self, held: Any, first: End, second: End, lines: tuple[float, float] = (0.0, 0.0)
    ) -> Any:
        """Join places on two bodies, with the joint's x axis at these angles to them."""
        one, other = (
            rp.Isometry3((*place, 0.0), rotation(line))
            for (_, place), line in zip((first, second), lines, strict=True)
        )
        build = rp.GenericJoint.builder(held).local_frame1(one).local_frame2(other)
        ends = (self.handle[name] for name, _ in (first, second))
        return self.world.impulse_joints.insert(*ends, build.build())

    def _rub(self) -> None:
        """Add the constant friction of pins: a motor of speed 0 and limited torque."""
        for rub in self.braked:
            joint = self._joint(NOTHING, (rub.first, (0.0, 0.0)), (rub.second, (0.0, 0.0)))
            self._move(joint, rp.JointAxis.ANG_Z, 0.0, rub.size)

    def _motor(self) -> Any:
        """Return a joint that holds nothing, for the motor of the driver."""
        scene, driver = self.scene, self.scene.driver
        self.axis = rp.JointAxis.ANG_Z if driver.slider is None else rp.JointAxis.LIN_X
        if driver.slider is not None:
            return self._line(NOTHING, slide_of(scene, driver.slider))
        hinge = Hinge(scene.driver_pivot, driver.base, driver.link)
        return self._joint(NOTHING, *self.bodies.hinge_ends(hinge))

    def _move(self, joint: Any, axis: Any, speed: float, most: float | None = None) -> None:
        held = self.world.impulse_joints[joint]
        data = held.data
        data.set_motor_velocity(axis, speed, float(self.settings["motor_1_s"]))
        if most is not None:
            data.set_motor_max_force(axis, most)
        held.data = data

    def once(self) -> None:
        self.world.step()

    def run_motor(self, speed: float) -> None:
        self._move(self.motor, self.axis, speed)

    def lead(self, frame: Frame, push: Push) -> None:
        body = self.body[str(self.led)]
        if self.scene.driver.slider is None:
            body.rotation = rotation(frame.theta)
        else:
            body.translation = (*frame.origin, 0.0)
        body.linvel, body.angvel = (*frame.velocity, 0.0), (0.0, 0.0, frame.omega)
        self._push(body, push)

    def push(self, pushes: Pushes) -> None:
        for name in (name for name in self.names if name != self.led):
            self._push(self.body[name], pushes.on_bodies[name])

    def _push(self, body: Any, push: Push) -> None:
        body.reset_forces()
        body.reset_torques()
        body.add_force((*push[:2], 0.0))
        body.add_torque((0.0, 0.0, push[2]))

    def look(self) -> Array:
        rows = np.empty((len(self.names), 6))
        for row, name in zip(rows, self.names, strict=True):
            body = self.body[name]
            place, turned_by, moves = body.translation, body.rotation, body.linvel
            row[:3] = place.x, place.y, 2.0 * math.atan2(turned_by.k, turned_by.w)
            row[3:] = moves.x, moves.y, body.angvel.z
        return rows

    def facts(self) -> Facts:
        matter = {}
        for name in (name for name in self.names if name != self.led):
            own_mass = self.body[name].mass_properties
            inertia = math.inf if name in self.fixed else own_mass.principal_inertia.z
            matter[name] = own_mass.mass, inertia
        centre = {name: self.bodies.centre[name] for name in matter}
        down, parameters = self.world.gravity, self.world.integration_parameters
        found = {
            self.of_substeps: parameters.num_solver_iterations,
            "sweeps": parameters.num_internal_pgs_iterations,
            self.of_velocities: parameters.num_internal_stabilization_iterations,
        }
        return self.facts_of(VERSION, matter, centre, (down.x, down.y), found)


def rotation(angle: float) -> Any:
    """Return a rotation in the plane; the package's own have single precision."""
    return rp.Rotation3(math.cos(0.5 * angle), 0.0, 0.0, math.sin(0.5 * angle))


ENGINE = shipped_engine(own, VERSION, RapierSession, precision=DECLARATION.precision, floor=2e-6)
