"""A system in exudyn: opened, stepped, and read back as poses."""

from __future__ import annotations

import time
from typing import Any

import numpy as np

from models.array import Array
from models.errors import EngineError
from models.laws import ConstantSpeed
from models.motion import State
from models.poses import inertia_scale
from models.scene import Point, Scene
from sim.engine import BodyPose, Drive, Facts, Log, Poses, Settings
from sim.exudyn.crank import CrankCourse
from sim.exudyn.library import VERSION, exu, items, plain, quiet
from sim.exudyn.settings import checked
from sim.exudyn.solver import constraints, held, initialized, simulation
from sim.exudyn.system import build, masses

LEAST_DT_S = 1e-9
"""exudyn takes an end of a run that is 1e-10 s away for reached."""
LEVELS = ("Coordinates", "Coordinates_t", "Coordinates_tt")
WIDTH = 3
"""Coordinates of a body: x, y, angle."""


class ExudynSession:
    """One system with its solver. exudyn's clock begins at 0, whatever the time of the law."""

    def __init__(
        self, scene: Scene, state: State, settings: Settings, dt_s: float, drive: Drive
    ) -> None:
        checked(settings)
        if dt_s < LEAST_DT_S:
            raise EngineError(
                f"dt: found {dt_s:g} s; exudyn ends a step to 1e-10 s, so it takes "
                f"{LEAST_DT_S:g} s or more"
            )
        self._scene, self._settings, self._dt, self._drive = scene, settings, dt_s, drive
        self._start_s, self._done = state.time_s, 0
        self._course: CrankCourse | None = None
        self._heard: list[str] = []
        with quiet(self._heard):
            self._model = build(scene, state, prescribed=drive == "prescribed")
            self._system = self._model.system
            if drive != "free":
                self._drive_crank(drive)
            self._sensors = self._sense()
            self._system.Assemble()
            self._asked = simulation(settings, dt_s)
            self._solver = initialized(self._system, self._asked, settings)
            if self._course is not None:
                self._set_off(self._course)

    def _drive_crank(self, drive: Drive) -> None:
        """Add what turns the crank. Constant speeds are parameters; exudyn calls back for those of
        another law."""
        law = self._scene.driver.law
        ends = self._model.crank_markers(self._scene.driver.link)
        if drive == "servo":
            gain = float(self._settings["servo_gain"]) * inertia_scale(self._scene)
            self._add_motor(ends, gain * law.peak_speed_rad_s)
            return
        told: dict[str, object]
        if isinstance(law, ConstantSpeed):
            told = {"velocityLevel": True, "offset": law.speed_rad_s}
        else:
            self._course = course = CrankCourse(law, self._start_s, self._dt)
            told = {"offsetUserFunction": course.angle, "offsetUserFunction_t": course.speed}
        self._system.AddObject(items.ObjectConnectorCoordinate(markerNumbers=ends, **told))

    def _add_motor(self, ends: list[Any], gain: float) -> None:
        """A damper to the ground, and the torque that it has at the law's speed."""
        self._system.AddObject(
            items.ObjectConnectorCoordinateSpringDamper(markerNumbers=ends, damping=gain)
        )
        law, start_s = self._scene.driver.law, self._start_s

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

    def _sense(self) -> list[Any]:
        """A sensor for each level of each body's coordinates."""
        return [
            self._system.AddSensor(
                items.SensorNode(
                    nodeNumber=node,
                    storeInternal=True,
                    writeToFile=False,
                    outputVariableType=getattr(exu.OutputVariableType, level),
                )
            )
            for node in self._model.node.values()
            for level in LEVELS
        ]

    def _set_off(self, course: CrankCourse) -> None:
        """Start with the rates that go with the crank's, and accelerations that go with its own.

        exudyn leaves out what a driver's acceleration adds to its initial ones, and the trapezoidal
        rule would alternate about the true ones ever after.
        """
        own, rates = exu.ConfigurationType.Initial, self._system.systemData
        law = self._scene.driver.law
        _, omega, alpha = (float(x) for x in law.at(np.array(self._start_s)))
        ratio = self._per_crank()
        if self._asked.timeIntegration.generalizedAlpha.useIndex2Constraints:
            first = course.speed(None, 0.0, None, 0.0)
            rates.SetODE2Coordinates_t(
                np.add(rates.GetODE2Coordinates_t(own), (first - omega) * ratio), own
            )
        push = np.add(rates.GetODE2Coordinates_tt(), alpha * ratio)
        rates.SetODE2Coordinates_tt(push, own)
        self._asked.timeIntegration.generalizedAlpha.computeInitialAccelerations = False
        self._solver.InitializeSolver(self._system, self._asked)

    def _per_crank(self) -> Array:
        """The rates of all coordinates over that of the crank; the drive is the last constraint."""
        held_by = constraints(self._solver, self._system)
        asked = np.zeros(len(held_by))
        asked[-1] = 1.0
        return np.asarray(np.linalg.lstsq(held_by, asked, rcond=None)[0])

    def facts(self) -> Facts:
        """The system as exudyn holds it now; its bodies have their centres at their nodes."""
        held_masses = masses(self._model)
        loads = [self._system.GetLoad(load)["loadVector"] for load in self._model.load.values()]
        gravity = loads[0] if loads else (0.0, 0.0)
        return Facts(
            version=VERSION,
            mass_kg={name: mass for name, (mass, _) in held_masses.items()},
            inertia_kg_m2={name: inertia for name, (_, inertia) in held_masses.items()},
            centre_m=dict(self._model.centre),
            gravity_m_s2=(float(gravity[0]), float(gravity[1])),
            start=self.read(),
            settings=dict(self._settings) | held(self._asked, self._solver),
            velocity_shift=0.0,
            acceleration_shift=0.0,
        )

    def step(self, steps: int) -> None:
        """Advance without logging. Raises EngineError where exudyn goes no further."""
        if stopped := self._advance(steps, log=False):
            raise EngineError(f"exudyn: {stopped}")

    def record(self, steps: int, every: int) -> Log:
        """Advance; exudyn's sensors keep all steps, of which every ``every``-th is taken."""
        at = self._done + every * np.arange(steps // every + 1, dtype=np.float64)
        began = time.perf_counter()
        with quiet(self._heard):
            self._solver.InitializeSolverOutput(self._system, self._asked)  # empties the sensors
        stopped = self._advance(steps, log=True)
        wall = time.perf_counter() - began
        kept = [self._system.GetSensorStoredData(each) for each in self._sensors]
        clock = kept[0][:, 0]
        # Of a step that was cut the last part ends at the sample.
        rows = np.searchsorted(clock, (at + 1e-6) * self._dt, side="right") - 1
        there = np.abs(clock[rows] - at * self._dt) < 1e-3 * self._dt
        levels = np.stack([each[rows, 1:] for each in kept], axis=1)
        good = there & np.isfinite(levels).all(axis=(1, 2))
        count = len(at) if good.all() else int(np.argmin(good))
        poses = self._poses(levels[:count], at[:count])
        diverged = bool(stopped) or count < len(at)
        warnings = tuple(dict.fromkeys(self._heard))
        return Log(poses, (count - 1) * every, diverged, warnings, wall, stopped)

    def read(self) -> Poses:
        """The current state."""
        state = self._system.systemData
        levels = [np.array(getattr(state, f"GetODE2{level}")()) for level in LEVELS]
        bodies = np.stack(levels).reshape(len(LEVELS), -1, WIDTH).swapaxes(0, 1)
        return self._poses(bodies.reshape(1, -1, WIDTH), np.array([float(self._done)]))

    def _advance(self, steps: int, *, log: bool) -> str:
        """Step in one go or, where steps may be cut, so that each ends in time. Why exudyn goes no
        further, in its own words; empty where it does."""
        self._asked.solution.sensors.active = log
        if self._course is not None:
            self._course.reach(self._done + steps)
        done, self._done = self._done, self._done + steps
        clock, length = self._solver.it, 1 if self._solver.it.adaptiveStep else steps
        with quiet(self._heard):
            try:
                for start in range(done, self._done, length or 1):
                    # It would count steps from its start, and times up to a rounding of its own.
                    clock.startTime = clock.currentTime = start * self._dt
                    clock.endTime = (start + length) * self._dt
                    self._asked.solution.file.writeInitialValues = start == done
                    if not self._solver.SolveSteps(self._system, self._asked):
                        return str(self._solver.GetErrorString())
            except RuntimeError as error:  # all of exudyn's are
                return plain(str(error))
        return ""

    def _poses(self, levels: Array, at: Array) -> Poses:
        """Poses of the links' own frames, of samples of the three levels of each body in turn."""
        poses = {}
        for row, (name, node) in enumerate(self._model.node.items()):
            place, rate, push = (levels[:, len(LEVELS) * row + k] for k in range(len(LEVELS)))
            reference = self._system.GetNode(node)["referenceCoordinates"]
            poses[name] = _pose(place + reference, rate, push, self._model.centre[name])
        return Poses(self._start_s + self._dt * at, poses)


def _pose(place: Array, rate: Array, push: Array, centre: Point) -> BodyPose:
    """The frame in which ``centre`` is where the node is, from coordinates and their rates."""
    theta, omega, alpha = place[:, 2], rate[:, 2], push[:, 2]
    c, s = np.cos(theta), np.sin(theta)
    arm = np.stack([c * centre[0] - s * centre[1], s * centre[0] + c * centre[1]], axis=-1)
    across = np.stack([-arm[:, 1], arm[:, 0]], axis=-1)
    return BodyPose(
        origin=place[:, :2] - arm,
        theta=theta,
        velocity=rate[:, :2] - omega[:, None] * across,
        omega=omega,
        origin_acceleration=push[:, :2] - alpha[:, None] * across + omega[:, None] ** 2 * arm,
        alpha=alpha,
    )
