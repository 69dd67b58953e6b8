"""What turns the crank in exudyn: a constraint of its angle, or a motor; and the torque of it."""

import math
from typing import Any

import numpy as np

from models.array import Array
from models.errors import EngineError
from models.scene import Scene
from models.scene.joints import inertia_scale, turned
from models.scene.laws import ConstantSpeed, Law
from sim.engine import Drive, Poses, Settings
from sim.engine import drive as drives
from sim.exudyn.solver import Multipliers
from sim.exudyn.system import Index, PlaneSystem, items


def speeds(law: Law, start_s: float, dt_s: float, steps: int) -> Array:
    """The angular velocity [rad/s] at the start and after each of the ``steps``, of which the
    trapezoidal rule, ``theta' = theta + (v + v') dt / 2``, makes the angles of the law: joints that
    are closed in their rates take it, those that are closed in their places the angle."""
    first = drives.start_speed(law, start_s, dt_s, 0.0)
    gained = np.cumsum(drives.pushes(law, start_s, dt_s, steps, 0.0))
    return first + dt_s * np.concatenate([[0.0], gained])


class CrankCourse:
    """The angles and speeds of a law at the steps of a run, as functions that exudyn calls.

    Between the steps, where a step that failed was cut, they are those of the law itself. Times
    count from the start of the run, angles from the angle there.
    """

    NEAR = 1e-6
    """Over the step: what is no nearer to a step lies between two."""

    def __init__(self, law: Law, start_s: float, dt_s: float) -> None:
        self._law, self._start_s, self._dt = law, start_s, dt_s
        self._first = float(law.at(np.array(start_s))[0])
        self._angles: list[float] = []
        self._speeds: list[float] = []
        self.reach(1)

    def reach(self, steps: int) -> None:
        """Be ready for so many steps from the start."""
        if len(self._angles) <= steps:
            longer = max(steps, 2 * len(self._angles))
            turned = drives.angles(self._law, self._start_s, self._dt, 0, longer) - self._first
            self._angles = turned.tolist()
            self._speeds = speeds(self._law, self._start_s, self._dt, longer).tolist()

    def angle(self, _system: object, time_s: float, _item: object, _offset: float) -> float:
        """The angle at a time [rad]."""
        step = self._step(time_s)
        if step is not None:
            return self._angles[step]
        return float(self._law.at(np.array(self._start_s + time_s))[0]) - self._first

    def speed(self, _system: object, time_s: float, _item: object, _offset: float) -> float:
        """The angular velocity at a time [rad/s]."""
        step = self._step(time_s)
        if step is not None:
            return self._speeds[step]
        return float(self._law.at(np.array(self._start_s + time_s))[1])

    def _step(self, time_s: float) -> int | None:
        """Which step a time is; none between them."""
        exact = time_s / self._dt
        near = round(exact)
        return near if abs(exact - near) < self.NEAR and near < len(self._angles) else None


STRAIGHT = 1e-12
"""Of a unit vector: what counts as along an axis."""


def refuse_undriven(scene: Scene, drive: Drive) -> None:
    """Raise EngineError for a joint that exudyn is given nothing to drive with."""
    driver = scene.driver
    if driver.is_crank or drive == "free":
        return
    if any(load.over == "angle" for load in scene.loads.values()):
        raise EngineError(
            f"{scene.name}: a load goes with the driver's angle, and exudyn is given that of a "
            f"crank alone; this driver is {driver.joint}"
        )
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
    """The coordinate that the driven slider runs along, 0 or 1, and its sense. Raises EngineError
    for an oblique line, along which no coordinate goes."""
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
    """The drive of a system: nothing where it is free. Constant speeds are parameters; exudyn calls
    back for those of another law, whose ``course`` it then has."""

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
        """A constraint of the speed, or of the angle where the speed changes."""
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
        """A damper to the ground, and the torque that it has at the law's speed."""
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
        """What it exerts on the crank [N m], or on a slider along its line [N], at states with such
        multipliers, a row each."""
        if self._constraint is not None:
            (row,) = multipliers.rows(self._constraint)
            return np.asarray(-lambdas[:, row])
        lag = self._law.at(poses.time_s)[1] - poses.bodies[self._link].omega
        return np.asarray(self._gain * lag)
