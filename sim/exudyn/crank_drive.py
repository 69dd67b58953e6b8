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
from models.motion import Forces
from models.scene import Scene, Slider
from models.scene import joints as pairs
from models.scene.laws import ConstantSpeed, Law
from models.scene.loads import ConstantFriction, Load, SlideSpring
from sim.engine import Drive, Poses, Settings, momentum_balance
from sim.engine import drive as drives
from sim.engine.measure import body_paths, directions, motion
from sim.engine.ties import Hinge, refuse_driver_angle
from sim.exudyn import passive, solver
from sim.exudyn.system import ANGLE, Index, PlaneSystem, items


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
            turned = drives.angles(self._law, self._start_s, self._dt, 0, longer)
            self._angles = turned.tolist()
            self._speeds = speeds(self._law, self._start_s, self._dt, longer).tolist()

    def angle(self, _system: object, time_s: float, _item: object, _offset: float) -> float:
        """Return the angle at a time [rad]."""
        return self._at(time_s, self._angles, 0) - self._first

    def speed(self, _system: object, time_s: float, _item: object, _offset: float) -> float:
        """Return the angular velocity at a time [rad/s]."""
        return self._at(time_s, self._speeds, 1)

    def _at(self, time_s: float, of_steps: list[float], level: int) -> float:
        exact = time_s / self._dt
        near = round(exact)
        if abs(exact - near) < self.NEAR and near < len(of_steps):
            return of_steps[near]
        return float(self._law.at(np.array(self._start_s + time_s))[level])


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
    u = pairs.turned((1.0, 0.0), scene.sliders[driver.slider].direction_rad)
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
        self, made: PlaneSystem, settings: Settings, drive: Drive, start_s: float, dt_s: float
    ) -> None:
        scene, driver = made.scene, made.scene.driver
        self._law, self._link, self._start_s = driver.law, driver.link, start_s
        self._system = made.system
        self._sense = 1.0
        self.course: CrankCourse | None = None
        self._gain = 0.0
        self._constraint: Index = None
        if drive == "free":
            return
        coordinate = ANGLE
        if driver.slider is not None:
            coordinate, self._sense = slider_axis(scene)
        ends = [
            made.coordinate_marker(driver.base),
            made.coordinate_marker(driver.link, coordinate),
        ]
        if drive == "servo":
            gain = float(settings["servo_gain"]) * pairs.inertia_scale(scene)
            self._gain = gain * self._law.peak_speed_rad_s
            self._add_motor(ends)
        else:
            self._constrain(ends, dt_s)

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

    def torque(self, poses: Poses, lambdas: Array, multipliers: solver.Multipliers) -> Array:
        """Return the torque on the crank [N m], or the force on a slider along its line [N], at
        states with these multipliers, a row each."""
        if self._constraint is not None:
            (row,) = multipliers.rows(self._constraint)
            return np.asarray(-lambdas[:, row])
        lag = self._law.at(poses.time_s)[1] - poses.bodies[self._link].omega
        return np.asarray(self._gain * lag)


class BlockLoads:
    """Actions on blocks without mass, without their guides': read off the motion, as exudyn has no
    body for them."""

    def __init__(self, scene: Scene, poses: Poses) -> None:
        self._scene, self._time_s = scene, poses.time_s
        self._paths = body_paths(poses)
        self._motion = motion(scene, poses)
        self._still = passive.still_rad_s(scene)

    def line_rad(self, slider: Slider) -> Array:
        """Return the direction of a line."""
        return self._paths[slider.on].pose.theta + slider.direction_rad

    def on(self, slider: Slider) -> Array:
        """Return force [N] and torque [N m] on the block of a slider, (T, 3)."""
        return np.column_stack([self._force(slider), self._torque(slider)])

    def _force(self, slider: Slider) -> Array:
        """Return all forces, with friction and springs of the line."""
        line, slid = self.line_rad(slider), self._motion.sliders[slider.name]
        total = np.zeros((len(line), 2))
        for load in self._of(slider):
            if load.point is not None:
                turned = line - slider.direction_rad + pairs.sliding_angle(slider)
                angle = load.direction_rad + (turned if load.frame == "body" else 0.0 * line)
                total += self._magnitude(load)[:, None] * directions(angle)
        for friction in self._rubbing(slider.name):
            still = self._still * self._scene.longest_m
            total += passive.against(friction.size, slid.speed, still)[:, None] * directions(line)
        for spring in self._scene.springs.values():
            if isinstance(spring, SlideSpring) and spring.slider == slider.name:
                pull = spring.rate * (slid.displacement - spring.free)
                total -= (pull + spring.damping * slid.speed)[:, None] * directions(line)
        return total

    def _torque(self, slider: Slider) -> Array:
        """Return all torques, with friction of the pin."""
        total = np.zeros(len(self._time_s))
        for load in self._of(slider):
            if load.point is None:
                total += self._magnitude(load)
        if slider.point not in self._scene.sliders:  # else its friction is a line's
            for friction in self._rubbing(slider.point):
                block = pairs.block_name(slider)
                (other,) = (b for b in pairs.joined_at(self._scene)[slider.point] if b != block)
                rate = self._omega(slider.on) - self._omega(other)
                total += passive.against(friction.size, rate, self._still)
        return total

    def _omega(self, body: str) -> Array:
        """Return the rate of a body, or of the guide of a block without mass."""
        guides = {pairs.block_name(slider): slider.on for slider in self._scene.sliders.values()}
        turning = body if body in self._paths else guides[body]
        return self._paths[turning].pose.omega

    def _of(self, slider: Slider) -> list[Load]:
        name = pairs.block_name(slider)
        return [load for load in self._scene.loads.values() if load.body == name]

    def _rubbing(self, joint: str) -> list[ConstantFriction]:
        return [
            friction
            for friction in self._scene.friction.values()
            if isinstance(friction, ConstantFriction) and friction.joint == joint
        ]

    def _magnitude(self, load: Load) -> Array:
        slid = self._motion.sliders.get(load.slider or "")
        if load.over == "omega":
            return load.magnitude(self._paths[load.body].pose.omega)
        x = {"time": self._time_s, "angle": self._paths[self._scene.driver.link].pose.theta}
        if slid is None:
            return load.magnitude(x[load.over])
        x |= {"displacement": slid.displacement, "speed": slid.speed}
        return load.magnitude(x[load.over], slid.speed)


def reactions(
    made: PlaneSystem, multipliers: solver.Multipliers, lambdas: Array, poses: Poses, torque: Array
) -> Forces:
    """Return the forces at the states of ``poses``, from the multipliers there, a row each."""
    blocks = BlockLoads(made.scene, poses)
    slides, ties = made.scene.sliders.values(), pairs.joints(made.scene)
    on_lines = {
        slider.name: lambdas[:, multipliers.rows(made.prismatic[slider.name])].T
        for slider in slides
    }
    pushes = momentum_balance.JointPushes(
        hinges={
            Hinge(hinge.point, hinge.other, hinge.first): lambdas[:, multipliers.rows(joint)]
            for hinge, joint in made.hinge.items()
        },
        across={s.name: directions(blocks.line_rad(s) + 0.5 * math.pi) for s in slides},
        normals={name: normal for name, (normal, _) in on_lines.items()},
        moments={prism.slider.name: -on_lines[prism.slider.name][1] for prism in ties.prisms},
        torque=torque,
        spare=0,
    )
    on_blocks = {slot.slider.name: blocks.on(slot.slider) for slot in ties.slots}
    return momentum_balance.forces_by_body(made.scene, pushes, on_blocks, {}, poses.time_s)
