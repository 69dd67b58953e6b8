"""The four-bar in each engine as a user would write it, with a place for a snippet.

It knows nothing of crankcheck. The numbers are those of the lecture's first example (crank 0.1,
coupler 0.25, rocker 0.2, ground 0.3 m, rods of 1 kg/m, crank from 90 deg); the angles to be found
follow from the law of cosines.
"""

import cmath
import math
import re
from collections.abc import Callable
from typing import Any

import exudyn as exu
import exudyn.itemInterface as items  # noqa: N813 - a module
import mujoco
import numpy as np
import pymunk

from models.array import Array

CRANK, COUPLER, ROCKER, GROUND = 0.1, 0.25, 0.2, 0.3
START = math.pi / 2
TURNS = 1


def angles(crank: Array) -> tuple[Array, Array]:
    """Angles of coupler and rocker [rad] at angles of the crank; the open assembly."""
    bx, by = CRANK * np.cos(crank), CRANK * np.sin(crank)
    diagonal = np.hypot(bx - GROUND, by)
    at_d = np.arccos((diagonal**2 + ROCKER**2 - COUPLER**2) / (2 * diagonal * ROCKER))
    rocker = np.unwrap(np.arctan2(by, bx - GROUND)) - at_d
    cx, cy = GROUND + ROCKER * np.cos(rocker), ROCKER * np.sin(rocker)
    return np.unwrap(np.arctan2(cy - by, cx - bx)), rocker


COUPLER_START, ROCKER_START = (float(each[0]) for each in angles(np.array([START])))


def rates(speed: float) -> tuple[float, float]:
    """Angular velocities of coupler and rocker at the start [rad/s], from the law of sines of the
    velocities."""
    across = math.sin(ROCKER_START - COUPLER_START)
    return (
        speed * CRANK / COUPLER * math.sin(START - ROCKER_START) / across,
        speed * CRANK / ROCKER * math.sin(START - COUPLER_START) / across,
    )


def bars(speed: float) -> list[tuple[float, complex, float, complex, float]]:
    """Of crank, coupler and rocker at the start: length and mass, place of the centre, angle,
    velocity and angular velocity."""
    of_coupler, of_rocker = rates(speed)
    b, away = cmath.rect(CRANK, START), cmath.rect(ROCKER, ROCKER_START)
    of_b, of_c = 1j * speed * b, 1j * of_rocker * away
    return [
        (CRANK, b / 2, START, of_b / 2, speed),
        (COUPLER, (b + GROUND + away) / 2, COUPLER_START, (of_b + of_c) / 2, of_coupler),
        (ROCKER, GROUND + away / 2, ROCKER_START, of_c / 2, of_rocker),
    ]


def worst(found: tuple[Array, ...], exact: tuple[Array, ...]) -> float:
    return max(float(np.abs(a - b).max()) for a, b in zip(found, exact, strict=True))


def exudyn_fourbar(system: Any, speed: float) -> list[Any]:
    """The four-bar added to a system, driven; the nodes of crank, coupler and rocker."""
    ground = system.AddObject(items.ObjectGround())
    made = [
        exudyn_body(
            system,
            length,
            length**3 / 12,
            [place.real, place.imag, theta],
            [velocity.real, velocity.imag, omega],
        )
        for length, place, theta, velocity, omega in bars(speed)
    ]
    nodes, bodies = zip(*made, strict=True)
    pins = (
        (ground, 0.0, bodies[0], -CRANK / 2),
        (bodies[0], CRANK / 2, bodies[1], -COUPLER / 2),
        (bodies[1], COUPLER / 2, bodies[2], ROCKER / 2),
        (ground, GROUND, bodies[2], -ROCKER / 2),
    )
    for one, at_one, other, at_other in pins:
        exudyn_pin(system, (one, at_one), (other, at_other))
    still = system.AddNode(items.NodePointGround())
    ends = [
        system.AddMarker(items.MarkerNodeCoordinate(nodeNumber=node, coordinate=coordinate))
        for node, coordinate in ((still, 0), (nodes[0], 2))
    ]
    system.AddObject(
        items.ObjectConnectorCoordinate(markerNumbers=ends, velocityLevel=True, offset=speed)
    )
    return list(nodes)


def exudyn_body(
    system: Any, mass: float, inertia: float, pose: list[float], rates: list[float]
) -> tuple[Any, Any]:
    node = system.AddNode(items.NodeRigidBody2D(referenceCoordinates=pose, initialVelocities=rates))
    given = items.ObjectRigidBody2D(mass=mass, inertia=inertia, nodeNumber=node)
    return node, system.AddObject(given)


def exudyn_pin(system: Any, *ends: tuple[Any, float]) -> None:
    markers = [
        system.AddMarker(items.MarkerBodyRigid(bodyNumber=body, localPosition=[x, 0.0, 0.0]))
        for body, x in ends
    ]
    system.AddObject(items.ObjectJointRevolute2D(markerNumbers=markers))


def simulated(system: Any, simulation: Any, nodes: list[Any]) -> list[Array]:
    """Coordinates of the nodes at every step, after the times, of a system that is run."""
    kept = {"storeInternal": True, "writeToFile": False}
    kept["outputVariableType"] = exu.OutputVariableType.Coordinates
    sensors = [system.AddSensor(items.SensorNode(nodeNumber=node, **kept)) for node in nodes]
    system.Assemble()
    simulation.solution.file.write = False
    simulation.solution.sensors.writePeriod = 0.0
    system.SolveDynamic(simulation)
    return [np.array(system.GetSensorStoredData(sensor)) for sensor in sensors]


def exudyn_error(snippet: str, steps: int, speed: float) -> float:
    """The largest error of coupler and rocker [rad] over a turn with a snippet; infinite where
    exudyn goes no further."""
    container = exu.SystemContainer()
    system = container.AddSystem()
    nodes = exudyn_fourbar(system, speed)
    simulation = exu.SimulationSettings()
    simulation.timeIntegration.endTime = TURNS * 2.0 * math.pi / speed
    exec(measured_in_exudyn(snippet), {"simulationSettings": simulation, "exu": exu})
    assert simulation.timeIntegration.numberOfSteps == TURNS * steps
    try:
        _, coupler, rocker = simulated(system, simulation, nodes)
    except exu.SolverError:
        return math.inf
    found = COUPLER_START + coupler[:, 3], ROCKER_START + rocker[:, 3]
    return worst(found, angles(START + speed * coupler[:, 0]))


def measured_in_exudyn(snippet: str) -> str:
    """The snippet with the settings that stand in its comments in force, too."""
    return snippet.replace("#   ", "")


BODIES = """
    <body euler="0 0 {crank!r}">
      <joint name="A" axis="0 0 1" armature="{flywheel!r}"/>
      <inertial pos="0.05 0 0" mass="0.1" diaginertia="8.333333333333e-5 8.333333333333e-5 8.333333333333e-5"/>
      <body pos="0.1 0 0" euler="0 0 {coupler_in_crank!r}">
        <joint axis="0 0 1"/>
        <inertial pos="0.125 0 0" mass="0.25" diaginertia="1.302083333333e-3 1.302083333333e-3 1.302083333333e-3"/>
        <site name="C of the coupler" pos="0.25 0 0"/>
      </body>
    </body>
    <body pos="0.3 0 0" euler="0 0 {rocker!r}">
      <joint axis="0 0 1"/>
      <inertial pos="0.1 0 0" mass="0.2" diaginertia="6.666666666667e-4 6.666666666667e-4 6.666666666667e-4"/>
      <site name="C of the rocker" pos="0.2 0 0"/>
    </body>
"""  # noqa: E501
CONNECT = '<connect site1="C of the coupler" site2="C of the rocker"/>'
MJCF = f"""
<mujoco>
  <compiler angle="radian" inertiafromgeom="false"/>
  <worldbody>{BODIES}</worldbody>
  <equality>{CONNECT}</equality>
</mujoco>
"""
CLASS = 'class="crankcheck-loop"'


def measured_as_we_did(snippet: str) -> str:
    """The snippet with the settings that stand in its comments in force, too."""
    elements = re.findall(r"^ {5,}(</?(?:option|flag).*?>)(?: -->)?$", snippet, re.MULTILINE)
    return re.sub(r"^#   (?=space\.)", "", snippet, flags=re.MULTILINE) + "\n".join(elements)


def fourbar_bodies(text: str, flywheel: float) -> str:
    return text.format(
        crank=START,
        coupler_in_crank=COUPLER_START - START,
        rocker=ROCKER_START,
        flywheel=flywheel,
    )


def pasted(text: str, snippet: str) -> str:
    """MJCF text with the snippet done to it: at its end, and on the connect of the loop."""
    if CLASS in snippet:
        text = text.replace(CONNECT, CONNECT.replace("<connect", f"<connect {CLASS}"))
    return text.replace("</mujoco>", f"{snippet}</mujoco>")


def mujoco_error(snippet: str, steps: int, speed: float) -> float:
    """The largest error of coupler and rocker [rad] over a turn of the MJCF with a snippet."""
    # The snippet's rule: 1e12 times the sum of mass L^2 + inertia, L = 0.3 m.
    flywheel = 1e12 * (0.55 * 0.3**2 + (0.1**3 + 0.25**3 + 0.2**3) / 12)
    text = fourbar_bodies(MJCF, flywheel)
    model = mujoco.MjModel.from_xml_string(pasted(text, measured_as_we_did(snippet)))
    start = mujoco.MjData(model)
    of_coupler, of_rocker = rates(speed)
    start.qvel[:] = speed, of_coupler - speed, of_rocker
    start.ctrl[:] = speed
    turned = np.empty((TURNS * steps + 1, 3))
    for row in turned:
        row[:] = start.qpos
        mujoco.mj_step(model, start)
    found = turned[:, 0] + COUPLER_START + turned[:, 1], ROCKER_START + turned[:, 2]
    return worst(found, angles(START + speed * model.opt.timestep * np.arange(len(turned))))


def pymunk_fourbar(
    space: pymunk.Space, speed: float
) -> tuple[tuple[pymunk.Body, ...], tuple[pymunk.Constraint, ...]]:
    """The four-bar added to a space: crank, coupler and rocker, and their joints."""
    crank = pymunk.Body(body_type=pymunk.Body.KINEMATIC)
    crank.angle, crank.angular_velocity = START, speed
    coupler, rocker = moving = (
        pymunk.Body(COUPLER, COUPLER**3 / 12),
        pymunk.Body(ROCKER, ROCKER**3 / 12),
    )
    for body, (_, place, theta, velocity, omega) in zip(moving, bars(speed)[1:], strict=True):
        body.position, body.velocity = (place.real, place.imag), (velocity.real, velocity.imag)
        body.angle, body.angular_velocity = theta, omega
    joints = (
        pymunk.PivotJoint(crank, coupler, (CRANK, 0.0), (-COUPLER / 2, 0.0)),
        pymunk.PivotJoint(coupler, rocker, (COUPLER / 2, 0.0), (ROCKER / 2, 0.0)),
        pymunk.PivotJoint(space.static_body, rocker, (GROUND, 0.0), (-ROCKER / 2, 0.0)),
    )
    space.add(crank, *moving, *joints)
    return (crank, *moving), joints


class Clocked(pymunk.Space):
    """A space that knows how long it was stepped."""

    time_s = 0.0

    def step(self, dt: float) -> None:
        super().step(dt)
        self.time_s += dt


def pymunk_error(snippet: str, steps: int, speed: float) -> float:
    """The largest error of coupler and rocker [rad] over a turn of a space with a snippet, which
    is run so many ``steps`` times in a turn, and may step the space several times."""
    space = Clocked()
    (crank, coupler, rocker), joints = pymunk_fourbar(space, speed)
    names: dict[str, object] = {"space": space, "joints": joints}
    turned, times = [(crank.angle, coupler.angle, rocker.angle)], [0.0]
    run = compile(measured_as_we_did(snippet), "snippet", "exec")
    for _ in range(TURNS * steps):
        exec(run, names)
        turned.append((crank.angle, coupler.angle, rocker.angle))
        times.append(space.time_s)
    exact = angles(START + speed * np.array(times))
    _, *found = np.array(turned).T
    return worst(tuple(found), exact)


BARE: dict[str, Callable[[str, int, float], float]] = {
    "mujoco": mujoco_error,
    "pymunk": pymunk_error,
    "exudyn": exudyn_error,
}
"""By engine, the error [rad] with a snippet, at steps a turn and a speed of the crank [rad/s]."""
