"""Box2D 3: bodies in the plane, soft joints, solved in sub-steps in single precision."""

import math
from importlib import import_module
from importlib.metadata import version
from typing import Any

import numpy as np

from models.array import Array
from models.motion import State
from models.scene import GROUND, Scene
from models.scene import joints as pairs
from models.scene.joints import Prism, Slot, less, turned
from sim.box2d import settings as own
from sim.engine import Drive, Engine, Facts, Settings
from sim.engine.acting import Pushes
from sim.engine.stepped import BodySession
from sim.engine.ties import hinges, refuse_driver_angle, refuse_massless

b2: Any = import_module("pyb2d3")  # ships no stubs
VERSION = version("pyb2d3")
SLOW_S = 1.0 / 64.0


class Box2dSession(BodySession):
    """A session with one world."""

    name = "box2d"

    def __init__(
        self, scene: Scene, state: State, settings: Settings, dt_s: float, driven_by: Drive
    ) -> None:
        own.checked(settings)
        refuse_driver_angle(scene, self.name)
        super().__init__(scene, state, settings, dt_s, driven_by)
        self.substeps = int(settings["substeps"])
        self.pace = 1.0
        if settings["joints"] == "stiffest":
            self.pace = 2.0 ** math.ceil(math.log2(SLOW_S * self.substeps / dt_s))
        gx, gy = scene.gravity_m_s2
        self.world = b2.World(gravity=(gx / self.pace**2, gy / self.pace**2))
        self.world.sleeping_enabled = False
        self.world.continuous_enabled = False
        self.body: dict[str, Any] = {GROUND: self.world.create_static_body()}
        self.fixed = {p.body for p in pairs.joints(scene).prisms if p.slider.on == GROUND}
        for name in self.names:
            self.body[name] = self._body(name)
        self.motor: Any = None
        self._join()
        self.begin(self.bodies)

    def _body(self, name: str) -> Any:
        frame, centre = self.where[name], self.bodies.centre[name]
        place = frame.at(centre)
        u, v = frame.velocity_at(place)
        given = {
            "position": place,
            "linear_velocity": (u / self.pace, v / self.pace),
            "angular_velocity": frame.omega / self.pace,
            "enable_sleep": False,
        }
        if name == self.led:
            body = self.world.create_kinematic_body(**given)
            body.set_transform(place, rotation(frame.theta))
            return body
        mass, inertia = pairs.mass_of(self.scene, name)
        turns = name not in self.fixed
        refuse_massless(self.name, name, mass, inertia, turns=turns)
        body = self.world.create_dynamic_body(**given, fixed_rotation=not turns)
        matter = b2.MassData()
        matter.mass, matter.rotational_inertia, matter.center = mass, inertia, (0.0, 0.0)
        body.mass_data = matter
        body.set_transform(place, rotation(frame.theta))
        return body

    def _join(self) -> None:
        scene, driver = self.scene, self.scene.driver
        firm = (GROUND,) if driver.is_inner else (GROUND, driver.link)
        for hinge in hinges(scene, *firm):
            names = hinge.first, hinge.other
            driving = hinge.point == scene.driver_pivot and set(names) == {driver.link, driver.base}
            if driving and self.led:
                continue
            joint = self.world.create_revolute_joint(
                self.body[names[0]],
                self.body[names[1]],
                local_anchor_a=self.bodies.anchor(names[0], hinge.point),
                local_anchor_b=self.bodies.anchor(names[1], hinge.point),
                enable_motor=driving and self.drive != "free",
                max_motor_torque=float(self.settings["motor_n_m"]),
            )
            if driving:
                self.motor, self.sense = joint, 1.0 if names[1] == driver.link else -1.0
        for slide in pairs.joints(scene).slides:
            if not (self.led and slide.slider.name == driver.slider):
                self._slide(slide)

    def _slide(self, slide: Prism | Slot) -> None:
        slider, rider = slide.slider, pairs.riding_body(slide)
        ends = {
            "local_anchor_a": less(slider.through_m, self.bodies.centre[slider.on]),
            "local_anchor_b": self.bodies.anchor(rider, slider.point),
            "local_axis_a": turned((1.0, 0.0), slider.direction_rad),
            "enable_spring": False,
        }
        bodies = self.body[slider.on], self.body[rider]
        if isinstance(slide, Slot):
            self.world.create_wheel_joint(*bodies, **ends)
        else:
            angle = pairs.sliding_angle(slider)
            self.world.create_prismatic_joint(*bodies, **ends, reference_angle=angle)

    def once(self) -> None:
        self.world.step(self.pace * self.dt, self.substeps)

    def turn(self, place: float | None, speed: float) -> None:
        speed /= self.pace
        if self.motor is not None:
            self.motor.motor_speed = self.sense * speed
            return
        body, driver = self.body[self.scene.driver.link], self.scene.driver
        if driver.slider is None:
            if place is not None:
                body.set_transform(body.position, rotation(place))
            body.angular_velocity = speed

    def push(self, pushes: Pushes) -> None:
        for name in self.names:
            fx, fy, moment = (each / self.pace**2 for each in pushes.on_bodies[name])
            self.body[name].apply_force_to_center((fx, fy))
            self.body[name].apply_torque(moment)

    def look(self) -> Array:
        rows = np.empty((len(self.names), 6))
        for row, name in zip(rows, self.names, strict=True):
            body = self.body[name]
            row[:2], turned_by = body.position, body.rotation
            row[2] = math.atan2(turned_by.s, turned_by.c)
            row[3:5], row[5] = body.linear_velocity, body.angular_velocity
        rows[:, 3:] *= self.pace
        return rows

    def facts(self) -> Facts:
        matter = {}
        for name in self.names:
            if name != self.led:
                own_mass = self.body[name].mass_data
                inertia = own_mass.rotational_inertia if name not in self.fixed else math.inf
                matter[name] = own_mass.mass, inertia
        centre = {name: self.bodies.centre[name] for name in matter}
        gravity = self.world.gravity
        return self.told(
            VERSION, matter, centre, (self.pace**2 * gravity[0], self.pace**2 * gravity[1]), {}
        )


def rotation(angle: float) -> Any:
    """Return a rotation; the package's own functions of angles are approximations."""
    turned_by = b2.Rot(0.0)
    turned_by.c, turned_by.s = math.cos(angle), math.sin(angle)
    return turned_by


ENGINE = Engine(
    "box2d",
    {"as-shipped": own.AS_SHIPPED, "tuned": own.TUNED},
    version=lambda: VERSION,
    check=own.checked,
    open=Box2dSession,
    reports_accelerations=False,
    applies_loads=True,
    applies_springs=True,
    precision="single",
    floor=5e-6,
)
