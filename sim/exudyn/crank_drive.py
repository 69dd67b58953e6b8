"""Drive of the crank in exudyn: a constraint of its angle, or a motor; its torque, and the
reactions of all joints.

exudyn solves M q'' + C' lambda = Q at the end of each step, C' the transposed derivatives of the
constraints: for a hinge the place of its second marker less the place of its first, in the ground's
frame; for a prismatic joint the guide's distance from the sliding point, and the angle of the
sliding body; for the drive the angle of the crank.
"""

import math
from typing import Any

import numpy as np

from models.array import Array
from models.errors import EngineError
from models.motion import Forces, SliderForces
from models.scene import GROUND, Scene, Slider
from models.scene.joints import (
    Prism,
    block_name,
    inertia_scale,
    joined_at,
    joints,
    riding_body,
    sliding_angle,
    turned,
)
from models.scene.laws import ConstantSpeed, Law
from models.scene.loads import ConstantFriction, Load, SlideSpring
from sim.engine import Drive, Poses, Settings
from sim.engine import drive as drives
from sim.engine.measure import directions, motion
from sim.engine.refusals import refuse_driver_angle
from sim.exudyn.passive import against, still_rad_s
from sim.exudyn.solver import Multipliers
from sim.exudyn.system import Index, PlaneSystem, items


def speeds(law: Law, start_s: float, dt_s: float, steps: int) -> Array:
    """Return the angular velocity [rad/s] at the start and after each of the ``steps`` that gives
    the angles of the law by the trapezoidal rule, ``theta' = theta + (v + v') dt / 2``: joints
    closed in their rates take it, joints closed in their positions take the angle."""
    first = drives.start_speed(law, start_s, dt_s, 0.0)
    gained = np.cumsum(drives.pushes(law, start_s, dt_s, steps, 0.0))
    return first + dt_s * np.concatenate([[0.0], gained])


class CrankCourse:
    """Angles and speeds of a law at the steps of a run, as functions that exudyn calls.

    Between the steps, where a failed step was cut, they are the law's own. Times count from the
    start of the run, angles from the angle there.
    """

    NEAR = 1e-6
    """Distance from a step, over its length, within which a time counts as that step."""

    def __init__(self, law: Law, start_s: float, dt_s: float) -> None:
        self._law, self._start_s, self._dt = law, start_s, dt_s
        self._first = float(law.at(np.array(start_s))[0])
        self._angles: list[float] = []
        self._speeds: list[float] = []
        self.reach(1)

    def reach(self, steps: int) -> None:
        """Prepare so many steps from the start."""
        if len(self._angles) <= steps:
            longer = max(steps, 2 * len(self._angles))
            turned = drives.angles(self._law, self._start_s, self._dt, 0, longer) - self._first
            self._angles = turned.tolist()
            self._speeds = speeds(self._law, self._start_s, self._dt, longer).tolist()

    def angle(self, _system: object, time_s: float, _item: object, _offset: float) -> float:
        """Return the angle at a time [rad]."""
        step = self._step(time_s)
        if step is not None:
            return self._angles[step]
        return float(self._law.at(np.array(self._start_s + time_s))[0]) - self._first

    def speed(self, _system: object, time_s: float, _item: object, _offset: float) -> float:
        """Return the angular velocity at a time [rad/s]."""
        step = self._step(time_s)
        if step is not None:
            return self._speeds[step]
        return float(self._law.at(np.array(self._start_s + time_s))[1])

    def _step(self, time_s: float) -> int | None:
        """Return the step of a time; None between steps."""
        exact = time_s / self._dt
        near = round(exact)
        return near if abs(exact - near) < self.NEAR and near < len(self._angles) else None


STRAIGHT = 1e-12
"""Largest part of a unit vector across an axis that counts as along it."""


def refuse_undriven(scene: Scene, drive: Drive) -> None:
    """Refuse a joint that this adapter cannot drive in exudyn. Raises EngineError."""
    driver = scene.driver
    if driver.is_crank or drive == "free":
        return
    refuse_driver_angle(scene, "exudyn")
    if drive == "servo":
        raise EngineError(
            f"{scene.name}: exudyn is given a servo for a crank alone, and this driver is "
            f"{driver.joint}; use --drive prescribed"
        )
    if driver.slider is None:
        return
    slider = scene.sliders[driver.slider]
    if driver.is_inner or (slider.link is None and slider.mass_kg == 0.0):
        what = "lies between two moving bodies" if driver.is_inner else "has no mass_kg"
        raise EngineError(
            f"{scene.name}: exudyn is given a driven slider as a coordinate of its body, and "
            f"slider {driver.slider} {what}; take another engine"
        )
    slider_axis(scene)


def slider_axis(scene: Scene) -> tuple[int, float]:
    """Return the coordinate of the driven slider, 0 or 1, and its sense. Raises EngineError for an
    oblique line, which no coordinate follows."""
    driver = scene.driver
    assert driver.slider is not None
    u = turned((1.0, 0.0), scene.sliders[driver.slider].direction_rad)
    along = 0 if abs(u[0]) > abs(u[1]) else 1
    if abs(u[1 - along]) > STRAIGHT:
        raise EngineError(
            f"{scene.name}: exudyn is given a driven slider as a coordinate of its body, and the "
            f"line of {driver.slider} goes along neither x nor y; turn the scene, or take another "
            "engine"
        )
    return along, math.copysign(1.0, u[along])


class CrankDrive:
    """Drive of a system: none in free motion. Constant speeds are parameters; for another law
    exudyn calls back the drive's ``course``."""

    def __init__(
        self,
        scene: Scene,
        made: PlaneSystem,
        settings: Settings,
        drive: Drive,
        start_s: float,
        dt_s: float,
    ) -> None:
        self._law, self._link, self._start_s = scene.driver.law, scene.driver.link, start_s
        self._system = made.system
        self._sense = 1.0
        self.course: CrankCourse | None = None
        self._gain = 0.0
        self._constraint: Index = None
        if drive == "servo":
            gain = float(settings["servo_gain"]) * inertia_scale(scene)
            self._gain = gain * self._law.peak_speed_rad_s
            self._add_motor(made.crank_markers(self._link))
        elif drive == "prescribed" and scene.driver.slider is not None:
            coordinate, self._sense = slider_axis(scene)
            self._constrain(made.place_markers(self._link, coordinate), dt_s)
        elif drive == "prescribed":
            self._constrain(made.crank_markers(self._link, scene.driver.base), dt_s)

    def _constrain(self, ends: list[Any], dt_s: float) -> None:
        """Add a constraint of the speed, or of the angle where the speed changes."""
        told: dict[str, object]
        if isinstance(self._law, ConstantSpeed):
            told = {"velocityLevel": True, "offset": self._law.speed_rad_s}
        else:
            self.course = course = CrankCourse(self._law, self._start_s, dt_s)
            told = {"offsetUserFunction": course.angle, "offsetUserFunction_t": course.speed}
        if self._sense < 0.0:
            told["factor1"] = self._sense
        self._constraint = self._system.AddObject(
            items.ObjectConnectorCoordinate(markerNumbers=ends, **told)
        )

    def _add_motor(self, ends: list[Any]) -> None:
        """Add a damper to the ground, and its torque at the law's speed."""
        law, gain, start_s = self._law, self._gain, self._start_s
        self._system.AddObject(
            items.ObjectConnectorCoordinateSpringDamper(markerNumbers=ends, damping=gain)
        )

        def torque(_system: object, time_s: float, _load: float) -> float:
            return gain * float(law.at(np.array(start_s + time_s))[1])

        steady = isinstance(law, ConstantSpeed)
        self._system.AddLoad(
            items.LoadCoordinate(
                markerNumber=ends[1],
                load=torque(None, 0.0, 0.0),
                loadUserFunction=0 if steady else torque,
            )
        )

    def torque(self, poses: Poses, lambdas: Array, multipliers: Multipliers) -> Array:
        """Return the torque on the crank [N m], or the force on a slider along its line [N], at
        states with these multipliers, a row each."""
        if self._constraint is not None:
            (row,) = multipliers.rows(self._constraint)
            return np.asarray(-lambdas[:, row])
        lag = self._law.at(poses.time_s)[1] - poses.bodies[self._link].omega
        return np.asarray(self._gain * lag)


class BlockLoads:
    """Forces (T, 2) [N] and torques (T,) [N m] on blocks without mass, without their guides': read
    off the motion, as exudyn has no body for them. All forces on such a block add up to nothing:
    the forces of its guide, loads, springs and friction go to its pin."""

    def __init__(self, scene: Scene, poses: Poses) -> None:
        self._scene, self._poses = scene, poses
        self._motion = motion(scene, poses)

    def theta(self, body: str) -> Array:
        """Return the angle of a body or the ground."""
        zero = np.zeros(len(self._poses.time_s))
        return zero if body == GROUND else self._poses.bodies[body].theta

    def force(self, slider: Slider) -> Array:
        """Return all forces on the block, with friction and springs of its line."""
        line = self.theta(slider.on) + slider.direction_rad
        total = np.zeros((len(line), 2))
        for load in self._of(slider):
            if load.point is not None:
                turned = line - slider.direction_rad + sliding_angle(slider)
                angle = load.direction_rad + (turned if load.frame == "body" else 0.0 * line)
                total += self._magnitude(load)[:, None] * directions(angle)
        for friction in self._rubbing(slider.name):
            still = still_rad_s(self._scene) * self._scene.longest_m
            speed = self._motion.sliders[slider.name].speed
            total += against(friction.size, speed, still)[:, None] * directions(line)
        for spring in self._scene.springs.values():
            if isinstance(spring, SlideSpring) and spring.slider == slider.name:
                slid = self._motion.sliders[slider.name]
                pull = spring.rate * (slid.displacement - spring.free)
                total -= (pull + spring.damping * slid.speed)[:, None] * directions(line)
        return total

    def torque(self, slider: Slider) -> Array:
        """Return all torques on the block, with friction of its pin."""
        total = np.zeros(len(self._poses.time_s))
        for load in self._of(slider):
            if load.point is None:
                total += self._magnitude(load)
        if slider.point not in self._scene.sliders:  # else its friction is a line's
            for friction in self._rubbing(slider.point):
                total += self._in_pin(slider, friction)
        return total

    def _in_pin(self, slider: Slider, friction: ConstantFriction) -> Array:
        block = block_name(slider)
        (other,) = (b for b in joined_at(self._scene)[slider.point] if b != block)
        rate = self._omega(slider.on) - self._omega(other)
        return against(friction.size, rate, still_rad_s(self._scene))

    def _omega(self, body: str) -> Array:
        """Return the rate of a body, or of the guide of a block without mass."""
        for slider in self._scene.sliders.values():
            if body == block_name(slider) and body not in self._poses.bodies:
                body = slider.on
                break
        zero = np.zeros(len(self._poses.time_s))
        return zero if body == GROUND else self._poses.bodies[body].omega

    def _of(self, slider: Slider) -> list[Load]:
        name = block_name(slider)
        return [load for load in self._scene.loads.values() if load.body == name]

    def _rubbing(self, joint: str) -> list[ConstantFriction]:
        """Return the friction in a joint."""
        return [
            friction
            for friction in self._scene.friction.values()
            if isinstance(friction, ConstantFriction) and friction.joint == joint
        ]

    def _magnitude(self, load: Load) -> Array:
        x = {"time": self._poses.time_s, "angle": self.theta(self._scene.driver.link)}
        if load.over == "omega":
            return load.magnitude(self._poses.bodies[load.body].omega)
        slid = self._motion.sliders.get(load.slider or "")
        if slid is None:
            return load.magnitude(x[load.over])
        x |= {"displacement": slid.displacement, "speed": slid.speed}
        return load.magnitude(x[load.over], slid.speed)


def reactions(
    scene: Scene,
    made: PlaneSystem,
    multipliers: Multipliers,
    lambdas: Array,
    poses: Poses,
    torque: Array,
) -> Forces:
    """Return the forces at the states of ``poses``, from the multipliers there, a row each."""
    count = len(poses.time_s)
    pins = {
        point: {body: np.zeros((count, 2)) for body in names}
        for point, names in joined_at(scene).items()
    }
    for point, hinges in made.hinge.items():
        for (first, second), joint in hinges.items():
            force = lambdas[:, multipliers.rows(joint)]
            pins[point][first] += force
            pins[point][second] -= force
    sliders = {}
    for slide in joints(scene).slides:
        slider = slide.slider
        normal, moment = lambdas[:, multipliers.rows(made.prismatic[slider.name])].T
        if isinstance(slide, Prism):
            sliders[slider.name] = SliderForces(normal, -moment)
            continue
        blocks = BlockLoads(scene, poses)
        across = directions(blocks.theta(slider.on) + slider.direction_rad + 0.5 * math.pi)
        force = normal[:, None] * across + blocks.force(slider)
        pins[slider.point][riding_body(slide)] += force
        pins[slider.point][block_name(slider)] -= force
        sliders[slider.name] = SliderForces(normal, -blocks.torque(slider))
    in_order = {name: sliders[name] for name in scene.sliders}
    return Forces(poses.time_s, pins, in_order, torque)
