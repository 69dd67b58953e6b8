"""A user's own model in which a mechanism is not alone, and what a snippet does to the rest of it.

Beside the four-bar of `tests.worlds.bare`: a floor, a box that falls on it, a box that lies there,
a body that drifts, and a constraint of the user's own that gives way; in exudyn a pendulum, a mass
on a spring with a damper, and a body that flies, all in one system of equations, so that Newton's
method ends for all at once. The mechanism touches none of them. The user has his solver work until
a box that lies there does lie still.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from typing import Any

import exudyn as exu
import exudyn.itemInterface as items  # noqa: N813 - a module
import mujoco
import numpy as np
import pymunk

from models.array import Array
from tests.worlds.bare import (
    BODIES,
    CONNECT,
    exudyn_body,
    exudyn_fourbar,
    exudyn_pin,
    fourbar_bodies,
    pasted,
    pymunk_fourbar,
    rates,
    simulated,
)

SPEED = 10.0
LASTS_S = 1.0


def exudyn_disturbance(snippet: str) -> float:
    """The largest difference [m, rad] over a second to the system without the snippet, stepped as
    that says that all is: with its integrator and step."""
    simulation = _simulation()
    exec(snippet, {"simulationSettings": simulation, "exu": exu})
    stepping = simulation.timeIntegration
    integrator, radius = stepping.solverType, stepping.generalizedAlpha.spectralRadius
    try:
        same = _same_exudyn_steps(stepping.numberOfSteps, integrator, radius)
        found = _rest(simulation)
    except exu.SolverError:
        return math.inf
    return float(np.max(np.abs(found - same)))


def _simulation() -> Any:
    """A user's own settings, by which Newton's method ends near rounding."""
    simulation = exu.SimulationSettings()
    simulation.timeIntegration.endTime = LASTS_S
    simulation.timeIntegration.newton.relativeTolerance = 1e-12
    simulation.timeIntegration.newton.absoluteTolerance = 1e-13
    return simulation


@cache
def _same_exudyn_steps(steps: int, integrator: Any, radius: float) -> Array:
    """The rest of the system without a snippet, stepped so."""
    simulation = _simulation()
    simulation.timeIntegration.numberOfSteps = steps
    simulation.timeIntegration.solverType = integrator
    simulation.timeIntegration.generalizedAlpha.spectralRadius = radius
    return _rest(simulation)


def _rest(simulation: Any) -> Array:
    container = exu.SystemContainer()  # which has to live as long as its system
    system = container.AddSystem()
    exudyn_fourbar(system, SPEED)
    ground = system.AddObject(items.ObjectGround())
    swings, bounces, _ = bodies = [
        exudyn_body(system, 1.0, 0.03, [x, 0.0, 0.0], rates)
        for x, rates in ((2.0, [0.0] * 3), (4.0, [0.5, 0.0, 1.0]), (6.0, [1.0, 3.0, 2.0]))
    ]
    for _, body in bodies:
        marker = system.AddMarker(items.MarkerBodyMass(bodyNumber=body))
        weight = items.LoadMassProportional(markerNumber=marker, loadVector=[0.0, -9.81, 0.0])
        system.AddLoad(weight)
    exudyn_pin(system, (ground, 1.7), (swings[1], -0.3))
    ends = [
        system.AddMarker(items.MarkerBodyPosition(bodyNumber=body, localPosition=place))
        for body, place in ((ground, [4.0, 1.0, 0.0]), (bounces[1], [0.0, 0.0, 0.0]))
    ]
    given = {"stiffness": [20.0, 20.0, 0.0], "damping": [0.5, 0.5, 0.0]}
    system.AddObject(items.ObjectConnectorCartesianSpringDamper(markerNumbers=ends, **given))
    rows = simulated(system, simulation, [node for node, _ in bodies])
    return np.concatenate([row[:, 1:] for row in rows], axis=1)


@dataclass(frozen=True)
class Disturbance:
    """What pasting a snippet changes in the rest of a model [m, rad, or of a quaternion]: the
    largest difference over a second to the model without it, stepped as it says that all is, and
    that of what no step changes: where a box lies, and a body that drifts."""

    moving: float
    lasting: float

    @property
    def worst(self) -> float:
        return max(self.moving, self.lasting)


MJCF = f"""
<mujoco>
  <compiler angle="radian"/>
  <option timestep="0.002" tolerance="1e-12"/>
  <default class="main">
    <geom friction="0.8"/>
    <equality solref="0.03 1"/>
    <default class="mine"><joint damping="0.01"/></default>
  </default>
  <worldbody>
    <geom type="plane" size="5 5 .1"/>
    <body pos="2 0 0.3" euler="0.3 0.2 0">
      <freejoint name="falls"/>
      <geom type="box" size="0.1 0.1 0.1" mass="1"/>
    </body>
    <body pos="3 0 0.1">
      <freejoint name="lies"/>
      <geom type="box" size="0.1 0.1 0.1" mass="2"/>
    </body>
    <body pos="0 4 3" gravcomp="1">
      <freejoint name="drifts"/>
      <geom type="sphere" size="0.1" mass="1.5"/>
    </body>
    <body name="held" pos="0 -2 2">
      <joint type="ball" class="mine"/>
      <geom type="capsule" fromto="0 0 0 .3 0 0" size=".03" mass="1"/>
    </body>
    <body name="welded" pos="0.3 -2 2">
      <freejoint/><geom type="sphere" size=".05" mass="1" contype="0" conaffinity="0"/>
    </body>
    <body pos="0 0 1">{BODIES}</body>
  </worldbody>
  <equality><weld body1="held" body2="welded"/>{CONNECT}</equality>
  <actuator><velocity joint="A" kv="0.05"/></actuator>
</mujoco>
"""
OF_LOOP = 3
"""Degrees of freedom of the mechanism; MuJoCo has them last."""


def mujoco_disturbance(snippet: str) -> Disturbance:
    model = mujoco.MjModel.from_xml_string(pasted(fourbar_bodies(MJCF, 0.0), snippet))
    found, end = _mujoco_run(model)
    untouched = _untouched()
    same = _same_steps(model.opt.timestep, model.opt.integrator)
    lies, drifts = (untouched.joint(name) for name in ("lies", "drifts"))
    place, spin = drifts.qposadr[0], drifts.dofadr[0]
    drifted = untouched.qpos0[place : place + 3] + DRIFT[:3] * end.time
    lasting = [
        end.qpos[lies.qposadr[0] :][:7] - _settled()[lies.qposadr[0] :][:7],
        end.qpos[place : place + 3] - drifted,
        end.qvel[spin : spin + 6] - DRIFT,
    ]
    return Disturbance(_largest(found - same), _largest(np.concatenate(lasting)))


def _untouched() -> mujoco.MjModel:
    return mujoco.MjModel.from_xml_string(fourbar_bodies(MJCF, 0.0))


DRIFT = np.array([0.1, 0.2, 0.3, 1.0, 2.0, 3.0])
FALL = np.array([0.5, 0.2, -1.0, 0.3, 1.0, 2.0])


def _mujoco_run(model: mujoco.MjModel) -> tuple[Array, mujoco.MjData]:
    """The coordinates of the rest over a second, and the state at its end."""
    state = mujoco.MjData(model)
    for name, rate in (("falls", FALL), ("drifts", DRIFT)):
        first = model.joint(name).dofadr[0]
        state.qvel[first : first + 6] = rate
    of_coupler, of_rocker = rates(SPEED)
    state.qvel[-OF_LOOP:] = SPEED, of_coupler - SPEED, of_rocker
    state.ctrl[:] = SPEED
    rows = np.empty((round(LASTS_S / model.opt.timestep), model.nq))
    for row in rows:
        mujoco.mj_step(model, state)
        row[:] = state.qpos
    return rows[:, :-OF_LOOP], state


@cache
def _same_steps(timestep: float, integrator: int) -> Array:
    """The rest of the model without a snippet, stepped so."""
    model = _untouched()
    model.opt.timestep, model.opt.integrator = timestep, integrator
    return _mujoco_run(model)[0]


@cache
def _settled() -> Array:
    return _mujoco_run(_untouched())[1].qpos.copy()


def pymunk_disturbance(snippet: str) -> Disturbance:
    run = compile(snippet, "snippet", "exec")
    space, joints, rest = _space()
    names: dict[str, object] = {"space": space, "joints": joints}
    exec(run, names)
    found = [_places(rest)]
    dt = names["dt"]
    assert isinstance(dt, float)
    for _ in range(1, round(LASTS_S / dt)):
        exec(run, names)
        found.append(_places(rest))
    same = _same_passes(dt, space.iterations)
    space, joints, rest = _space()
    for _ in range(500):
        space.step(1.0 / 500.0)
    before, names = _places(rest), {"space": space, "joints": joints}
    for _ in range(len(found)):
        exec(run, names)
    lasting = (_places(rest) - before)[LASTING]
    lasting[-3:] -= np.array(PYMUNK_DRIFT) * dt * len(found)
    return Disturbance(_largest(np.array(found) - same), _largest(lasting))


PYMUNK_DRIFT = (1.0, 3.0, 2.0)
"""Speeds [m/s] and angular velocity."""
LASTING = slice(3, 9)
"""Of the places of the rest, those of the box that lies and of the body that drifts."""


def _space() -> tuple[pymunk.Space, tuple[pymunk.Constraint, ...], list[pymunk.Body]]:
    space = pymunk.Space()
    space.gravity = (0.0, -9.81)
    space.iterations = 50
    _, joints = pymunk_fourbar(space, SPEED)
    floor = pymunk.Segment(space.static_body, (-10.0, -1.0), (10.0, -1.0), 0.05)
    floor.friction = 0.8
    space.add(floor)
    falls, lies = _box(space, -2.0, 0.0), _box(space, 2.0, -0.85)
    falls.velocity, falls.angle, falls.angular_velocity = (0.5, 0.0), 0.3, 1.0
    drifts = _box(space, 0.0, 5.0)
    drifts.velocity, drifts.angular_velocity = PYMUNK_DRIFT[:2], PYMUNK_DRIFT[2]
    drifts.velocity_func = _weightless
    hangs, springs = _box(space, 5.0, 0.0), _box(space, 7.0, 0.0)
    gives_way = pymunk.PivotJoint(space.static_body, hangs, (5.0, 0.3), (0.0, 0.1))
    gives_way.error_bias = 0.3
    ends = (7.0, 1.0), (0.0, 0.0)
    spring = pymunk.DampedSpring(space.static_body, springs, *ends, 0.5, 20.0, 0.5)
    space.add(gives_way, spring)
    return space, joints, [falls, lies, drifts, hangs, springs]


def _box(space: pymunk.Space, x: float, y: float) -> pymunk.Body:
    side = (0.2, 0.2)
    body = pymunk.Body(1.0, pymunk.moment_for_box(1.0, side))
    body.position = x, y
    shape = pymunk.Poly.create_box(body, side)
    shape.friction = 0.8
    space.add(body, shape)
    return body


def _weightless(body: pymunk.Body, gravity: tuple[float, float], damping: float, dt: float) -> None:
    """The body's velocities after a step, without gravity."""
    pymunk.Body.update_velocity(body, (0.0, 0.0), damping, dt)


@cache
def _same_passes(dt: float, iterations: int) -> Array:
    """The rest of the space without a snippet, stepped so."""
    space, _, rest = _space()
    space.iterations = iterations
    found = []
    for _ in range(round(LASTS_S / dt)):
        space.step(dt)
        found.append(_places(rest))
    return np.array(found)


def _places(bodies: list[pymunk.Body]) -> Array:
    """Places [m] and angles [rad], three of each body."""
    return np.array([n for body in bodies for n in (*body.position, body.angle)])


DISTURBANCE: dict[str, Callable[[str], Disturbance]] = {
    "mujoco": mujoco_disturbance,
    "pymunk": pymunk_disturbance,
    "exudyn": lambda snippet: Disturbance(exudyn_disturbance(snippet), 0.0),
}
"""By engine, what a snippet changes."""


def _largest(differences: Array) -> float:
    """Infinite where a difference is no number."""
    return float(np.max(np.nan_to_num(np.abs(differences), nan=math.inf)))
