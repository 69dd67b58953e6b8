"""Box2D 3: bodies in the plane, soft joints, solved in sub-steps in single precision."""

import math
from importlib import import_module
from importlib.metadata import version
from typing import Any

import numpy as np

from models.array import Array
from models.errors import EngineError
from models.motion import State
from models.scene import GROUND, Scene
from models.scene import joints as pairs
from models.scene.joints import Frame, Prism, Slot, turned
from sim.box2d import DECLARATION
from sim.box2d import settings as own
from sim.engine import Drive, Facts, Settings
from sim.engine.acting import Push, Pushes
from sim.engine.heavy_driver import HeavyDriverSession
from sim.engine.settings import shipped_engine
from sim.engine.ties import Hinge, RubbingJoint, hinges, refuse_driver_angle, refuse_massless

b2: Any = import_module("pyb2d3")  # ships no stubs
VERSION = version("pyb2d3")
JOINT_HZ = 60.0
"""Rate of the springs that are Box2D's joints, but at most an eighth of that of its sub-steps."""


class Box2dSession(HeavyDriverSession):
    """A session with one world."""

    name = "box2d"
    tangent = 3.0

    def __init__(
        self, scene: Scene, state: State, settings: Settings, dt_s: float, driven_by: Drive
    ) -> None:
        own.checked(settings)
        refuse_driver_angle(scene, self.name)
        substeps = int(settings["substeps"])
        # A sub-step moves by the velocities at its end.
        self.shift = -0.5 / substeps if driven_by == "free" else 0.0
        self.acts_at = 0.5 - 0.5 / substeps
        super().__init__(scene, state, settings, dt_s, driven_by, substeps)
        self.time_unit = 1.0
        """Unit of time here over the world's: it gives joints another rate than 60 Hz."""
        if swings := float(settings["joint_swings"]):
            self.time_unit = 2.0 ** round(math.log2(swings / (JOINT_HZ * dt_s)))
        gx, gy = scene.gravity_m_s2
        self.world = b2.World(gravity=(gx / self.time_unit**2, gy / self.time_unit**2))
        self.world.sleeping_enabled = False
        self.world.continuous_enabled = False
        self.body: dict[str, Any] = {GROUND: self.world.create_static_body()}
        self.body |= {n: self._body(n) for n in self.names if n != self.led}
        if self.led:
            heavy = self.heavy, self.heavy
            self.body[self.led] = self._placed(self.led_frame, *heavy, gravity_scale=0.0)
        self.motor: Any = None
        self._join()
        self.begin()

    def _body(self, name: str) -> Any:
        refuse_massless(self.scene, self.name, name, turns=name not in self.fixed)
        mass, inertia = pairs.mass_of(self.scene, name)
        own = inertia or mass * self.scene.longest_m**2
        return self._placed(self.frame_of(name), mass, own)

    def _placed(self, frame: Frame, mass: float, inertia: float, **more: float) -> Any:
        """Add a body with its centre of mass at the origin of its frame."""
        body = self.world.create_dynamic_body(position=frame.origin, enable_sleep=False, **more)
        matter = b2.MassData()
        matter.mass, matter.rotational_inertia, matter.center = mass, inertia, (0.0, 0.0)
        body.mass_data = matter
        self._set(body, frame)
        return body

    def _set(self, body: Any, frame: Frame) -> None:
        body.set_transform(frame.origin, rotation(frame.theta))
        u, v = frame.velocity
        body.linear_velocity = u / self.time_unit, v / self.time_unit
        body.angular_velocity = frame.omega / self.time_unit

    def _join(self) -> None:
        scene, driver = self.scene, self.scene.driver
        firm = (GROUND,) if driver.is_inner else (GROUND, driver.link)
        has_motor = self.drive != "free" and not self.led
        for hinge in hinges(scene, *firm):
            names = hinge.first, hinge.other
            driving = hinge.point == scene.driver_pivot and set(names) == {driver.link, driver.base}
            if not (driving and self.led):
                joint = self._pin(hinge, driven=driving and has_motor)
                if driving:
                    self.motor, self.sense = joint, 1.0 if names[1] == driver.link else -1.0
        for slide in pairs.joints(scene).slides:
            name = slide.slider.name
            if name != driver.slider or not self.led:
                self._slide(slide, driven=name == driver.slider and has_motor)
            elif isinstance(slide, Slot):
                (rider, anchor), _ = self.bodies.line_ends(slide)
                self.world.create_revolute_joint(
                    self.body[self.led],
                    self.body[rider],
                    local_anchor_a=(0.0, 0.0),
                    local_anchor_b=anchor,
                )
        for rub in self.braked:
            self._rub(rub)

    def _rub(self, rub: RubbingJoint) -> None:
        """Add a motor of speed 0 and limited torque, which holds neither place nor angle."""
        self.world.create_motor_joint(
            self.body[rub.first],
            self.body[rub.second],
            max_force=0.0,
            max_torque=rub.size / self.time_unit**2,
            correction_factor=0.0,
        )

    def _pin(self, hinge: Hinge, *, driven: bool) -> Any:
        (first, here), (other, there) = self.bodies.hinge_ends(hinge)
        return self.world.create_revolute_joint(
            self.body[first],
            self.body[other],
            local_anchor_a=here,
            local_anchor_b=there,
            enable_motor=driven,
            max_motor_torque=float(self.settings["motor_n_m"]) / self.time_unit**2,
        )

    def _slide(self, slide: Prism | Slot, *, driven: bool) -> None:
        slider, ((rider, tip), (guide, start)) = slide.slider, self.bodies.line_ends(slide)
        ends = {
            "local_anchor_a": start,
            "local_anchor_b": tip,
            "local_axis_a": turned((1.0, 0.0), slider.direction_rad),
            "enable_spring": False,
        }
        bodies = self.body[guide], self.body[rider]
        if isinstance(slide, Prism):
            joint = self.world.create_prismatic_joint(
                *bodies,
                **ends,
                reference_angle=b2.relative_angle(
                    rotation(pairs.sliding_angle(slider)), rotation(0.0)
                ),
                enable_motor=driven,
                max_motor_force=float(self.settings["motor_n_m"]) / self.time_unit**2,
            )
            if driven:
                self.motor, self.sense = joint, 1.0
        elif driven:
            raise EngineError(
                f"{self.scene.name}: its driver is the slider {slider.name}, a block without mass; "
                "box2d moves no point along a line by a motor; give the block a mass, or "
                "drive it prescribed"
            )
        else:
            self.world.create_wheel_joint(*bodies, **ends)

    def once(self) -> None:
        self.world.step(self.time_unit * self.dt, self.substeps)

    def run_motor(self, speed: float) -> None:
        self.motor.motor_speed = self.sense * speed / self.time_unit

    def lead(self, frame: Frame, push: Push) -> None:
        self._set(self.body[str(self.led)], frame)
        self._push(str(self.led), push)

    def push(self, pushes: Pushes) -> None:
        for name in (name for name in self.names if name != self.led):
            self._push(name, pushes.on_bodies[name])

    def _push(self, name: str, push: Push) -> None:
        """Act on a body in the next step alone."""
        fx, fy, moment = (each / self.time_unit**2 for each in push)
        self.body[name].apply_force_to_center((fx, fy))
        self.body[name].apply_torque(moment)

    def look(self) -> Array:
        rows = []
        for name in self.names:
            body = self.body[name]
            place, turned_by, moves = body.position, body.rotation, body.linear_velocity
            angle = math.atan2(turned_by.s, turned_by.c)
            rows.append((place.x, place.y, angle, moves.x, moves.y, body.angular_velocity))
        found = np.array(rows, dtype=np.float64)
        found[:, 3:] *= self.time_unit
        return found

    def facts(self) -> Facts:
        matter = {}
        for name in self.names:
            if name != self.led:
                own_mass = self.body[name].mass_data
                inertia = own_mass.rotational_inertia if name not in self.fixed else math.inf
                matter[name] = own_mass.mass, inertia
        centre = {name: self.bodies.centre[name] for name in matter}
        gravity = self.world.gravity
        return self.facts_of(
            VERSION,
            matter,
            centre,
            (self.time_unit**2 * gravity[0], self.time_unit**2 * gravity[1]),
            {},
        )


def rotation(angle: float) -> Any:
    """Return a rotation; the package's own functions of angles are approximations."""
    turned_by = b2.Rot(0.0)
    turned_by.c, turned_by.s = math.cos(angle), math.sin(angle)
    return turned_by


ENGINE = shipped_engine(
    own,
    VERSION,
    Box2dSession,
    in_seconds=lambda settings: () if settings["joint_swings"] else ("joint_swings",),
    precision=DECLARATION.precision,
    floor=1.4e-6,
)
