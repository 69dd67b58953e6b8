"""Drive of the crank in exudyn: a constraint of its angle, or a motor; and reactions of all joints.

exudyn solves M q'' + C' lambda = Q at the end of each step, C' the transposed derivatives of the
constraints: for a hinge the place of its second marker less that of its first, in the ground's
frame; for a prismatic joint the guide's distance from the sliding point, and the angle of the
sliding body; for the drive the angle of the crank.
"""

import math

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
from sim.engine.ties import Hinge, block_guides, refuse_driver_angle
from sim.exudyn import acting, solver
from sim.exudyn.system import ANGLE, Index, PlaneSystem

NEAR = 1e-6
"""Distance from a step, over its length, within which a time counts as that step."""
STRAIGHT = 1e-12
"""Largest part of a unit vector across an axis that counts as along it."""


class CrankCourse:
    """Angles and speeds of a law at the steps of a run, as functions that exudyn calls.

    Joints closed in their positions take the angle; those closed in their rates the speed that
    gives it by the trapezoidal rule, ``theta' = theta + (v + v') dt / 2``. Between the steps, where
    a failed step was cut, both are the law's own. Times and angles count from those of the start.
    """

    def __init__(self, law: Law, start_s: float, dt_s: float) -> None:
        self._law, self._start_s, self._dt = law, start_s, dt_s
        self._first = float(law.at(np.array(start_s))[0])
        self._angles: list[float] = []
        self._speeds: list[float] = []
        self.reach(1)

    def reach(self, steps: int) -> None:
        """Prepare so many steps from the start."""
        if len(self._angles) <= steps:
            given, longer = (self._law, self._start_s, self._dt), max(steps, 2 * len(self._angles))
            self._angles = drives.angles(*given, 0, longer).tolist()
            gained = np.concatenate([[0.0], np.cumsum(drives.pushes(*given, longer, 0.0))])
            self._speeds = (drives.start_speed(*given, 0.0) + self._dt * gained).tolist()

    def angle(self, _system: object, time_s: float, _item: object, _offset: float) -> float:
        """Return the angle at a time [rad]."""
        return self._at(time_s, self._angles, 0) - self._first

    def speed(self, _system: object, time_s: float, _item: object, _offset: float) -> float:
        """Return the angular velocity at a time [rad/s]."""
        return self._at(time_s, self._speeds, 1)

    def _at(self, time_s: float, of_steps: list[float], level: int) -> float:
        exact = time_s / self._dt
        near = round(exact)
        if abs(exact - near) < NEAR and near < len(of_steps):
            return of_steps[near]
        return float(self._law.at(np.array(self._start_s + time_s))[level])


def driven_coordinate(scene: Scene, drive: Drive) -> tuple[int, float]:
    """Return the coordinate of the driver's node that is driven, and its sense. Raises EngineError
    for a joint that this adapter cannot drive in exudyn."""
    driver = scene.driver
    if driver.is_crank or drive == "free":
        return ANGLE, 1.0
    refuse_driver_angle(scene, "exudyn")
    if drive == "servo":
        raise EngineError(
            f"{scene.name}: exudyn gets a servo only for a crank, and this driver is "
            f"{driver.joint}; use --drive prescribed"
        )
    if driver.slider is None:
        return ANGLE, 1.0
    slider = scene.sliders[driver.slider]
    u = pairs.turned((1.0, 0.0), slider.direction_rad)
    along = 0 if abs(u[0]) > abs(u[1]) else 1
    fault = ""
    if driver.is_inner:
        fault = f"slider {driver.slider} lies between two moving bodies;"
    elif slider.link is None and slider.mass_kg == 0.0:
        fault = f"slider {driver.slider} has no mass_kg;"
    elif abs(u[1 - along]) > STRAIGHT:
        fault = f"the line of {driver.slider} goes along neither x nor y; turn the scene, or"
    if fault:
        raise EngineError(
            f"{scene.name}: exudyn gets a driven slider as a coordinate of its body, and "
            f"{fault} use another engine"
        )
    return along, math.copysign(1.0, u[along])


class CrankDrive:
    """Drive of a system: none in free motion. Constant speeds are parameters; for another law
    exudyn calls back the drive's ``course``."""

    def __init__(
        self, made: PlaneSystem, settings: Settings, drive: Drive, start_s: float, dt_s: float
    ) -> None:
        driver = made.scene.driver
        self._law, self._link, self._start_s = driver.law, driver.link, start_s
        self.course: CrankCourse | None = None
        self._gain = 0.0
        self._constraint: Index = None
        if drive == "free":
            return
        coordinate, sense = driven_coordinate(made.scene, drive)
        nodes = (driver.base, ANGLE), (driver.link, coordinate)
        ends = [made.coordinate_marker(*node) for node in nodes]
        if drive == "servo":
            scale = float(settings["servo_gain"]) * pairs.inertia_scale(made.scene)
            self._gain = scale * self._law.peak_speed_rad_s
            self._add_motor(made, ends)
            return
        told: dict[str, object] = {"factor1": sense} if sense < 0.0 else {}
        if isinstance(self._law, ConstantSpeed):
            told |= {"velocityLevel": True, "offset": self._law.speed_rad_s}
        else:
            self.course = course = CrankCourse(self._law, start_s, dt_s)
            told |= {"offsetUserFunction": course.angle, "offsetUserFunction_t": course.speed}
        self._constraint = made.add("ObjectConnectorCoordinate", markerNumbers=ends, **told)

    def _add_motor(self, made: PlaneSystem, ends: list[Index]) -> None:
        """Add a damper to the ground, and its torque at the law's speed."""
        law, gain, start_s = self._law, self._gain, self._start_s
        made.add("ObjectConnectorCoordinateSpringDamper", markerNumbers=ends, damping=gain)

        def torque(_system: object, time_s: float, _load: float) -> float:
            return gain * float(law.at(np.array(start_s + time_s))[1])

        told = {} if isinstance(law, ConstantSpeed) else {"loadUserFunction": torque}
        made.add("LoadCoordinate", markerNumber=ends[1], load=torque(None, 0.0, 0.0), **told)

    def torque(self, poses: Poses, lambdas: Array, multipliers: solver.Multipliers) -> Array:
        """Return the torque on the crank [N m], or the force on a slider along its line [N], at
        states with these multipliers, a row each."""
        if self._constraint is not None:
            (row,) = multipliers.rows(self._constraint)
            return np.asarray(-lambdas[:, row])
        lag = self._law.at(poses.time_s)[1] - poses.bodies[self._link].omega
        return np.asarray(self._gain * lag)


class BlockLoads:
    """Actions on blocks without mass but for their guides', from the motion: exudyn has no body."""

    def __init__(self, scene: Scene, poses: Poses) -> None:
        self._scene, self._time_s = scene, poses.time_s
        self._paths, self._guides = body_paths(poses), block_guides(scene)
        self._motion = motion(scene, poses)

    def line_rad(self, slider: Slider) -> Array:
        """Return the direction of a line."""
        return self._paths[slider.on].pose.theta + slider.direction_rad

    def on(self, slider: Slider) -> Array:
        """Return force [N] and torque [N m] on the block of a slider, (T, 3), with friction, and
        springs along the line."""
        scene, block, line = self._scene, pairs.block_name(slider), self.line_rad(slider)
        slid, still = self._motion.sliders[slider.name], acting.still_rad_s(scene)
        force, torque, along = np.zeros((len(line), 2)), np.zeros(len(line)), directions(line)
        for load in (one for one in scene.loads.values() if one.body == block):
            if load.point is None:
                torque += self._magnitude(load)
                continue
            turned = line - slider.direction_rad + pairs.sliding_angle(slider)
            angle = load.direction_rad + (turned if load.frame == "body" else 0.0 * line)
            force += self._magnitude(load)[:, None] * directions(angle)
        for one in scene.friction.values():
            assert isinstance(one, ConstantFriction)
            if one.joint == slider.name:
                least = still * scene.longest_m
                force += acting.against(one.size, slid.speed, least)[:, None] * along
            elif one.joint == slider.point and one.joint not in scene.sliders:
                (other,) = (b for b in pairs.joined_at(scene)[slider.point] if b != block)
                turning = slider.on, self._guides.get(other, other)
                own, against = (self._paths[body].pose.omega for body in turning)
                torque += acting.against(one.size, own - against, still)
        for spring in scene.springs.values():
            if isinstance(spring, SlideSpring) and spring.slider == slider.name:
                pull = spring.rate * (slid.displacement - spring.free)
                force -= (pull + spring.damping * slid.speed)[:, None] * along
        return np.column_stack([force, torque])

    def _magnitude(self, load: Load) -> Array:
        x = {"time": self._time_s, "angle": self._paths[self._scene.driver.link].pose.theta}
        if load.slider is None:
            return load.magnitude(x[load.over])
        slid = self._motion.sliders[load.slider]
        x |= {"displacement": slid.displacement, "speed": slid.speed}
        return load.magnitude(x[load.over], slid.speed)


def reactions(
    made: PlaneSystem, multipliers: solver.Multipliers, lambdas: Array, poses: Poses, torque: Array
) -> Forces:
    """Return the forces at the states of ``poses``, from the multipliers there, a row each."""
    blocks, ties = BlockLoads(made.scene, poses), pairs.joints(made.scene)
    rows = {key: lambdas[:, multipliers.rows(made.hinge[key])] for key in made.hinge}
    lines = {key: lambdas[:, multipliers.rows(made.prismatic[key])] for key in made.scene.sliders}
    sliders = made.scene.sliders.items()
    pushes = momentum_balance.JointPushes(
        hinges={Hinge(h.point, h.other, h.first): force for h, force in rows.items()},
        across={name: directions(blocks.line_rad(s) + 0.5 * math.pi) for name, s in sliders},
        normals={name: push[:, 0] for name, push in lines.items()},
        moments={prism.slider.name: -lines[prism.slider.name][:, 1] for prism in ties.prisms},
        torque=torque,
        spare=0,
    )
    on_blocks = {slot.slider.name: blocks.on(slot.slider) for slot in ties.slots}
    return momentum_balance.forces_by_body(made.scene, pushes, on_blocks, {}, poses.time_s)
