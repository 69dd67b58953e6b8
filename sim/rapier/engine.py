"""Rapier: a world of bodies that move in the plane alone, joined by impulses."""

import math
from importlib import import_module
from importlib.metadata import version
from typing import Any

import numpy as np

from models.array import Array
from models.errors import EngineError
from models.motion import State
from models.scene import GROUND, Point, Scene
from models.scene import joints as pairs
from models.scene.joints import Frame, Prism, Slot, less, turned
from models.scene.laws import ConstantSpeed
from models.scene.loads import ConstantFriction
from sim.engine import Drive, Engine, Facts, Settings
from sim.engine.acting import Pushes, SliderCourse
from sim.engine.stepped import BodySession
from sim.engine.ties import hinges, refuse_driver_angle, refuse_massless, slide_of
from sim.rapier import DECLARATION
from sim.rapier import settings as own

rp: Any = import_module("rapier3d")  # so that types do not depend on what is installed
VERSION = version("rapier3d")
X, Y, TURN = rp.JointAxesMask.LIN_X, rp.JointAxesMask.LIN_Y, rp.JointAxesMask.ANG_Z
NOTHING = rp.JointAxesMask.empty()
HEAVY = 1e9
"""Inertia of a led driver over the mechanism's: nothing that is read has as many digits."""
SHARE = 0.5
"""Share of its error of place that a motor corrects in a step."""


class RapierSession(BodySession):
    """A session with one world, in which each step is made of semi-implicit sub-steps.

    A driven crank or slider on the ground is a body so heavy that nothing moves it: unlike a
    kinematic one it changes its speed within a step.
    """

    name = "rapier"

    def __init__(
        self, scene: Scene, state: State, settings: Settings, dt_s: float, driven_by: Drive
    ) -> None:
        own.checked(settings)
        refuse_driver_angle(scene, self.name)
        self.substeps = int(settings["substeps"])
        # The last sweeps of a sub-step leave velocities that fit the positions at its start.
        self.of_velocities = "free_velocity_sweeps" if driven_by == "free" else "velocity_sweeps"
        self.shift = (-1.0 if settings[self.of_velocities] else -0.5) / self.substeps
        self.acts_at = 0.5 - 0.5 / self.substeps
        super().__init__(scene, state, settings, dt_s, driven_by)
        self.world = rp.PhysicsWorld(gravity=(*scene.gravity_m_s2, 0.0))
        self._set()
        self.fixed = {p.body for p in pairs.joints(scene).prisms if p.slider.on == GROUND}
        self.handle = {GROUND: self.world.add_body(rp.RigidBody.fixed())}
        self.handle |= {n: self._added(n, self.where[n]) for n in self.names if n != self.led}
        if self.led:
            self.handle[self.led] = self._led(self.led)
        self.body = {name: self.world.rigid_bodies[one] for name, one in self.handle.items()}
        for body in self.body.values():
            body.recompute_mass_properties_from_colliders(self.world.colliders)
        self._join()
        self._rub()
        self.motor = self._motor() if driven_by != "free" and self.led is None else None
        self.begin(self.bodies)

    def _set(self) -> None:
        held, given = self.world.integration_parameters, self.settings
        held.dt = self.dt
        held.num_solver_iterations = given["substeps"]
        held.num_internal_pgs_iterations = given["sweeps"]
        held.num_internal_stabilization_iterations = given[self.of_velocities]
        held.normalized_max_linear_velocity = 1e9

    def _added(self, name: str, frame: Frame) -> Any:
        mass, inertia = pairs.mass_of(self.scene, name)
        turns = name not in self.fixed
        refuse_massless(self.name, name, mass, inertia, turns=turns)
        return self.world.add_body(
            self._build(frame, self.bodies.centre[name], mass, inertia or mass)
            .enabled_translations((True, True, False))
            .enabled_rotations((False, False, turns))
        )

    def _led(self, name: str) -> Any:
        """Add the heavy driver; a block without mass is a body here too."""
        scene, driver = self.scene, self.scene.driver
        heavy = self.heavy = HEAVY * pairs.inertia_scale(scene) / scene.driver_arm_m**2
        slides = driver.slider is not None
        if driver.slider is None:
            frame, centre = self.where[name], self.bodies.centre[name]
        else:
            slider = scene.sliders[driver.slider]
            state, point = self.state, slider.point
            frame = Frame(state.position[point], 0.0, state.velocity[point], 0.0)
            frame = self.where.get(name, frame)
            centre = self.bodies.centre.get(name, (0.0, 0.0))
            way = turned((self.state.displacement[slider.name], 0.0), slider.direction_rad)
            self.base = less(frame.at(centre), way)
        return self.world.add_body(
            self._build(frame, centre, heavy, heavy)
            .gravity_scale(0.0)
            .enabled_translations((slides, slides, False))
            .enabled_rotations((False, False, not slides))
        )

    def _build(self, frame: Frame, centre: Point, mass: float, inertia: float) -> Any:
        place = frame.at(centre)
        return (
            rp.RigidBody.dynamic()
            .position(rp.Isometry3((*place, 0.0), rotation(frame.theta)))
            .linvel((*frame.velocity_at(place), 0.0))
            .angvel((0.0, 0.0, frame.omega))
            .additional_mass_properties(rp.MassProperties((0.0, 0.0, 0.0), mass, (inertia,) * 3))
            .can_sleep(False)
            .allow_fast_rotation(True)
        )

    def _join(self) -> None:
        scene, driver = self.scene, self.scene.driver
        for hinge in hinges(scene, *((GROUND,) if driver.is_inner else (GROUND, driver.link))):
            names = hinge.first, hinge.other
            if not (self.led and set(names) == {GROUND, self.led}):
                self._pin(X | Y, names, hinge.point)
        for slide in pairs.joints(scene).slides:
            if not self.led or slide.slider.name != driver.slider:
                turns = isinstance(slide, Slot) or slide.body in self.fixed
                self._line(Y if turns else Y | TURN, slide)
            elif isinstance(slide, Slot):
                rider = pairs.riding_body(slide)
                anchor = self.bodies.anchor(rider, slide.slider.point)
                self._joint(X | Y, (self.led, rider), ((0.0, 0.0), anchor))

    def _pin(self, held: Any, names: tuple[str, str], point: str) -> Any:
        first, other = (self.bodies.anchor(name, point) for name in names)
        return self._joint(held, names, (first, other))

    def _line(self, held: Any, slide: Prism | Slot) -> Any:
        slider, rider = slide.slider, pairs.riding_body(slide)
        start = less(slider.through_m, self.bodies.centre[slider.on])
        tip = self.bodies.anchor(rider, slider.point)
        lines = slider.direction_rad, slider.direction_rad - pairs.sliding_angle(slider)
        return self._joint(held, (slider.on, rider), (start, tip), lines)

    def _joint(
        self,
        held: Any,
        names: tuple[str, str],
        places: tuple[Point, Point],
        lines: tuple[float, float] = (0.0, 0.0),
    ) -> Any:
        """Join places on two bodies, with the joint's x axis at these angles to them."""
        one, other = (
            rp.Isometry3((*place, 0.0), rotation(line))
            for place, line in zip(places, lines, strict=True)
        )
        build = rp.GenericJoint.builder(held).local_frame1(one).local_frame2(other)
        ends = (self.handle[name] for name in names)
        return self.world.impulse_joints.insert(*ends, build.build())

    def _rub(self) -> None:
        """Add the constant friction of pins: a motor of speed 0 and limited torque."""
        scene = self.scene
        guides = {pairs.block_name(s.slider): s.slider.on for s in pairs.joints(scene).slots}
        for pin, friction in scene.friction.items():
            if pin in scene.sliders or not isinstance(friction, ConstantFriction):
                continue
            names = pairs.joined_at(scene).get(pin, ())
            if len(names) != 2:
                raise EngineError(
                    f"{scene.name}: friction.{pin}: {len(names)} bodies meet there, and two rub on "
                    "one another; use a pin of two, or a slider"
                )
            first, other = (guides.get(name, name) for name in names)
            if {first, other} != {GROUND, self.led}:
                joint = self._joint(NOTHING, (first, other), ((0.0, 0.0), (0.0, 0.0)))
                self._move(joint, rp.JointAxis.ANG_Z, 0.0, friction.size)

    def _motor(self) -> Any:
        """Return a joint that holds nothing, for the motor of the driver."""
        scene, driver = self.scene, self.scene.driver
        self.axis = rp.JointAxis.ANG_Z if driver.slider is None else rp.JointAxis.LIN_X
        if driver.slider is not None:
            slide = slide_of(scene, driver.slider)
            self.track = SliderCourse(self.bodies, slide, self.dt)
            return self._line(NOTHING, slide)
        at = float(driver.law.at(np.array([self.start_s]))[0][0])
        apart = self.where[driver.link].theta - self.where[driver.base].theta
        self.ahead = math.tau * round((apart - at) / math.tau)
        return self._pin(NOTHING, (driver.base, driver.link), scene.driver_pivot)

    def _move(self, joint: Any, axis: Any, speed: float, most: float | None = None) -> None:
        held = self.world.impulse_joints[joint]
        data = held.data
        data.set_motor_velocity(axis, speed, float(self.settings["motor_1_s"]))
        if most is not None:
            data.set_motor_max_force(axis, most)
        held.data = data

    def _stands(self) -> float:
        """Return the present coordinate of a driver with a motor."""
        driver, frames = self.scene.driver, self.frames(0.0)
        if driver.slider is None:
            return frames[driver.link].theta - frames[driver.base].theta - self.ahead
        self.track.follow(frames)
        return self.track.course.value

    def once(self) -> None:
        self.world.step()

    def turn(self, place: float | None, speed: float) -> None:
        if self.motor is not None:
            if place is not None and self.drive == "prescribed":
                speed += SHARE * (place - self._stands()) / self.dt
            self._move(self.motor, self.axis, speed)
            return
        before, gain, law = speed, 0.0, self.scene.driver.law
        if not isinstance(law, ConstantSpeed):
            now = self.start_s + self.dt * (self.done + self.shift)
            before, after = law.at(np.array([now, now + self.dt]))[1].tolist()
            gain = after - before
        # A gain in equal parts, each before the sub-step's motion.
        mean, sub = before + 0.5 * gain * (1.0 + 1.0 / self.substeps), self.dt / self.substeps
        if self.scene.driver.slider is None:
            mean -= mean**3 * sub**2 / 12.0  # it turns by quaternions along tangents
        moves = self.dt * mean
        self._lead(None if place is None else place + self.dt * speed - moves, before, gain)

    def _lead(self, place: float | None, speed: float, gain: float) -> None:
        """Set the heavy driver's coordinate and its rate, and push it to gain speed in a step."""
        body, driver = self.body[str(self.led)], self.scene.driver
        push = self.heavy * gain / self.dt
        body.reset_forces()
        body.reset_torques()
        if driver.slider is None:
            if place is not None:
                body.rotation = rotation(place)
            body.angvel = (0.0, 0.0, speed)
            body.add_torque((0.0, 0.0, push))
            return
        slider = self.scene.sliders[driver.slider]
        u, v = turned((1.0, 0.0), slider.direction_rad)
        if place is not None:
            x, y = self.base
            body.translation = (x + place * u, y + place * v, 0.0)
        body.linvel = (speed * u, speed * v, 0.0)
        body.add_force((push * u, push * v, 0.0))

    def push(self, pushes: Pushes) -> None:
        for name in (name for name in self.names if name != self.led):
            fx, fy, moment = pushes.on_bodies[name]
            body = self.body[name]
            body.reset_forces()
            body.reset_torques()
            body.add_force((fx, fy, 0.0))
            body.add_torque((0.0, 0.0, moment))

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
            held = self.body[name].mass_properties
            inertia = math.inf if name in self.fixed else held.principal_inertia.z
            matter[name] = held.mass, inertia
        centre = {name: self.bodies.centre[name] for name in matter}
        down, held = self.world.gravity, self.world.integration_parameters
        found = {
            "substeps": held.num_solver_iterations,
            "sweeps": held.num_internal_pgs_iterations,
            self.of_velocities: held.num_internal_stabilization_iterations,
        }
        return self.told(VERSION, matter, centre, (down.x, down.y), found)


def rotation(angle: float) -> Any:
    """Return a rotation in the plane; the package's own functions of angles are in single
    precision."""
    return rp.Rotation3(math.cos(0.5 * angle), 0.0, 0.0, math.sin(0.5 * angle))


ENGINE = Engine(
    "rapier",
    {"as-shipped": own.AS_SHIPPED, "tuned": own.TUNED},
    version=lambda: VERSION,
    check=own.checked,
    open=RapierSession,
    reports_accelerations=False,
    applies_loads=True,
    applies_constant_friction=True,
    applies_springs=True,
    precision=DECLARATION.precision,
    floor=2e-6,
    no_forces="its impulses are those of the last sub-step, in rows made orthogonal",
)
