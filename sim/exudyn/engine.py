"""exudyn: bodies in absolute coordinates, all joints constraints, solved for by implicit steps."""

import time
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace

import numpy as np

from models.array import Array
from models.errors import EngineError
from models.motion import State
from models.scene import Scene
from sim.engine import BodyPose, Drive, Facts, Log, Poses, Settings, measure
from sim.engine.settings import shipped_engine
from sim.exudyn import acting, crank_drive, system
from sim.exudyn import settings as own_settings
from sim.exudyn.higher_pairs import add_cam, add_gear
from sim.exudyn.solver import Multipliers, held, initialized, multipliers, per_drive, simulation

LEVELS = ("Coordinates", "Coordinates_t", "Coordinates_tt")


def node_levels(
    made: system.PlaneSystem, levels: Sequence[Array]
) -> Iterator[tuple[str, Array, Array, Array]]:
    """Yield each node with its coordinates, their rates and accelerations, (T, width) each, from
    the samples of these of each node in turn; exudyn counts coordinates from its reference."""
    for row, (name, node) in enumerate(made.node.items()):
        moved, rate, push = levels[len(LEVELS) * row : len(LEVELS) * (row + 1)]
        yield name, moved + made.system.GetNode(node)["referenceCoordinates"], rate, push


def beam_angles(
    made: system.PlaneSystem, looked: Mapping[str, float], levels: Sequence[Array]
) -> dict[str, Array]:
    """Return angles of the tangents of nodes of beams, the first within half a turn of its
    direction ``looked`` [rad] and each within half a turn of the one before: samples of every step
    are needed, or turns are lost."""
    angles = {}
    for name, place, _, _ in node_levels(made, levels) if looked else ():
        if name in looked:
            angle = np.arctan2(place[:, 3], place[:, 2])
            angles[name] = np.unwrap(np.concatenate([[looked[name]], angle]))[1:]
    return angles


def body_poses(
    made: system.PlaneSystem, levels: Sequence[Array], angles: Mapping[str, Array]
) -> dict[str, BodyPose]:
    """Return poses by body; nodes of beams have these ``angles`` (T,)."""
    return {
        name: _tangent_pose(place, rate, push, angles[name])
        if name in angles
        else measure.centred(place, rate, push, made.centre[name])
        for name, place, rate, push in node_levels(made, levels)
    }


def _tangent_pose(place: Array, rate: Array, push: Array, theta: Array) -> BodyPose:
    """Return a frame along the tangent of a beam, at those angles."""
    (x, y), (u, v), (a, b) = (each[:, 2:].T for each in (place, rate, push))
    far = x**2 + y**2
    omega = (x * v - y * u) / far
    alpha = (x * b - y * a) / far - 2.0 * omega * (x * u + y * v) / far
    return BodyPose(place[:, :2], theta, rate[:, :2], omega, push[:, :2], alpha)


LEAST_DT_S = 1e-9
"""Least step: exudyn counts an end of a run within 1e-10 s as reached."""


class ExudynSession:
    """A system with its solver. exudyn's clock begins at 0, at any time of the law. Turns of beams'
    nodes are counted from step to step in recording; over unrecorded steps, up to half a turn."""

    def __init__(
        self, scene: Scene, state: State, settings: Settings, dt_s: float, drive: Drive
    ) -> None:
        own_settings.checked(settings)
        if dt_s < LEAST_DT_S:
            raise EngineError(
                f"dt: found {dt_s:g} s; exudyn ends a step to 1e-10 s, so it takes "
                f"{LEAST_DT_S:g} s or more"
            )
        crank_drive.driven_coordinate(scene, drive)  # refuses
        settings = own_settings.of_drive(settings, drive)
        self._scene, self._settings, self._dt = scene, settings, dt_s
        self._start_s, self._done = state.time_s, 0
        self._heard: list[str] = []
        with system.quiet(self._heard):
            self._model = system.build(scene, state, prescribed=drive == "prescribed")
            self._system = self._model.system
            for gear in scene.gears.values():
                add_gear(self._model, gear)
            for cam in scene.cams.values():
                add_cam(self._model, cam)
            self._looked = dict(self._model.looked)
            self._applied = acting.Applied(self._model)
            acting.apply_loads(self._applied, state.time_s, drive, dt_s)
            acting.apply_friction(self._applied, drive)
            self._springs = acting.Springs(self._applied)
            self._crank = crank_drive.CrankDrive(self._model, settings, drive, state.time_s, dt_s)
            kept = {"storeInternal": True, "writeToFile": False}
            kinds = [getattr(system.exu.OutputVariableType, level) for level in LEVELS]
            self._sensors = [
                self._model.add("SensorNode", nodeNumber=node, outputVariableType=kind, **kept)
                for node in self._model.node.values()
                for kind in kinds
            ]
            self._system.Assemble()
            beam_n, inertia_n = system.roundings_n(scene, state)
            follow = any(load.over in ("omega", "speed") for load in scene.loads.values())
            rates = follow and drive != "prescribed"  # which are not known before a step
            self._asked = simulation(settings, dt_s, of_rates=rates, rounding_n=beam_n)
            try:
                self._solver = initialized(self._system, self._asked, settings, inertia_n)
            except ValueError as error:  # as exudyn has it: a load has no size at the start
                raise EngineError(self._applied.fault) if self._applied.fault else error from None
            course = self._crank.course
            first = None if course is None else self._set_off(course)
            self._multipliers = Multipliers(self._system, first)

    def _set_off(self, course: crank_drive.CrankCourse) -> Array:
        """Set rates that fit the crank's, and accelerations that fit its own; return their
        multipliers. exudyn leaves the part of a driver's acceleration out of its initial ones, and
        the trapezoidal rule would alternate about the true ones ever after."""
        own, rates = system.exu.ConfigurationType.Initial, self._system.systemData
        alphas = self._asked.timeIntegration.generalizedAlpha
        _, omega, alpha = (float(x) for x in self._scene.driver.law.at(np.array(self._start_s)))
        ratio = per_drive(self._solver, self._system)
        if alphas.useIndex2Constraints:
            faster = (course.speed(None, 0.0, None, 0.0) - omega) * ratio
            rates.SetODE2Coordinates_t(np.add(rates.GetODE2Coordinates_t(own), faster), own)
        push: Array = np.add(rates.GetODE2Coordinates_tt(), alpha * ratio)
        rates.SetODE2Coordinates_tt(push, own)
        first = multipliers(self._solver, self._system, push)
        alphas.computeInitialAccelerations = False
        self._solver.InitializeSolver(self._system, self._asked)
        return first

    def facts(self) -> Facts:
        """Read the system as exudyn holds it now; its bodies have their centres at their nodes."""
        model, get = self._model, self._system.GetObject
        bodies = {name: get(model.body[name]) for name in model.node if name in model.body}
        masses = {name: float(own["mass"]) for name, own in bodies.items()}
        loads = [self._system.GetLoad(load)["loadVector"] for load in model.weights]
        x, y, _ = loads[0] if loads else (0.0, 0.0, 0.0)
        beams = system.held_beams(model)
        settings = self._settings if beams else own_settings.of_rigid(self._settings)
        return Facts(
            version=system.VERSION,
            mass_kg=masses | system.node_masses(beams),
            inertia_kg_m2={name: float(own["inertia"]) for name, own in bodies.items()},
            centre_m={name: model.centre[name] for name in model.node},
            gravity_m_s2=(float(x), float(y)),
            start=self.read(),
            settings=dict(settings) | held(self._asked, self._solver, self._settings),
            velocity_shift=0.0,
            acceleration_shift=0.0,
            springs=self._springs.held(),
            beams=beams,
        )

    def step(self, steps: int) -> None:
        """Advance without logging. Raises EngineError where exudyn stops early."""
        if stopped := self._advance(steps, log=False):
            raise EngineError(f"exudyn: {stopped}")

    def record(self, steps: int, every: int) -> Log:
        """Advance and log; exudyn's sensors keep all steps, and every ``every``-th is taken."""
        at = self._done + every * np.arange(steps // every + 1, dtype=np.float64)
        began = time.perf_counter()
        with system.quiet(self._heard):
            self._solver.InitializeSolverOutput(self._system, self._asked)  # empties the sensors
        stopped = self._advance(steps, log=True)
        wall = time.perf_counter() - began
        kept = [self._system.GetSensorStoredData(each) for each in self._sensors]
        clock = kept[0][:, 0]
        # The last part of a cut step ends at the sample.
        rows = np.searchsorted(clock, (at + 1e-6) * self._dt, side="right") - 1
        there = np.abs(clock[rows] - at * self._dt) < 1e-3 * self._dt
        every_step = [each[:, 1:] for each in kept]
        levels = [each[rows] for each in every_step]
        angles = beam_angles(self._model, self._looked, every_step)
        good = np.logical_and.reduce([there, *(np.isfinite(own).all(axis=1) for own in levels)])
        count = len(at) if good.all() else int(np.argmin(good))
        angles = {name: own[rows][:count] for name, own in angles.items()}
        self._looked |= {name: float(own[-1]) for name, own in angles.items() if count}
        shown = body_poses(self._model, [own[:count] for own in levels], angles)
        poses = Poses(self._start_s + self._dt * at[:count], shown)
        lost, warnings = bool(stopped) or count < len(at), tuple(dict.fromkeys(self._heard))
        return Log(poses, (count - 1) * every, lost, warnings, wall, stopped)

    def record_forces(self, steps: int, every: int) -> Log:
        """Advance and log, as `record`, with the multipliers of each state as forces."""
        done = self._done
        with self._multipliers.kept(done):
            log = self.record(steps, every)
        at = done + every * np.arange(len(log.poses.time_s), dtype=np.float64)
        lambdas = self._multipliers.at(self._dt * at)
        torque = self._crank.torque(log.poses, lambdas, self._multipliers)
        forces = crank_drive.reactions(self._model, self._multipliers, lambdas, log.poses, torque)
        return replace(log, forces=forces)

    def read(self) -> Poses:
        """Read the current state."""
        state = self._system.systemData
        ends = np.cumsum([4 if name in self._looked else 3 for name in self._model.node])
        every = [np.array(getattr(state, f"GetODE2{level}")()) for level in LEVELS]
        levels = [np.split(one, ends)[:-1] for one in every]  # those of gears stand last
        of_nodes = [own[None] for node in zip(*levels, strict=True) for own in node]
        angles = beam_angles(self._model, self._looked, of_nodes)
        now = np.array([self._start_s + self._dt * self._done])
        return Poses(now, body_poses(self._model, of_nodes, angles))

    def _advance(self, steps: int, *, log: bool) -> str:
        """Step in one go or, where steps may be cut, so that each ends in time. Return exudyn's own
        reason for an early stop; empty without one."""
        self._asked.solution.sensors.active = log
        if self._crank.course is not None:
            self._crank.course.reach(self._done + steps)
        done, self._done = self._done, self._done + steps
        clock, length = self._solver.it, 1 if self._solver.it.adaptiveStep else steps
        with system.quiet(self._heard):
            try:
                for start in range(done, self._done, length or 1):
                    # It would count steps from its start, and times up to a rounding of its own.
                    clock.startTime = clock.currentTime = start * self._dt
                    clock.endTime = (start + length) * self._dt
                    self._asked.solution.file.writeInitialValues = start == done
                    if not self._solver.SolveSteps(self._system, self._asked):
                        return str(self._solver.GetErrorString())
            except (RuntimeError, ValueError) as error:  # all of exudyn's are
                return self._applied.fault or system.plain(str(error))
        return ""


ENGINE = shipped_engine(
    own_settings,
    system.VERSION,
    ExudynSession,
    of_states=True,
    holds=lambda settings, dt_s, drive: own_settings.of_rigid(
        own_settings.of_drive(settings, drive)
    ),
    placing=own_settings.placing,
    applies_gears=True,
    applies_cams=True,
    applies_beams=True,
)
