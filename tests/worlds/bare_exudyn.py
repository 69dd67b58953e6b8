"""The four-bar of `tests.worlds.bare` in exudyn, as a user would write it."""

from __future__ import annotations

import math
from typing import Any

import exudyn as exu
import exudyn.itemInterface as items  # noqa: N813 - a module
import numpy as np

from models.array import Array
from tests.worlds.fourbar import (
    COUPLER,
    CRANK,
    GROUND,
    ROCKER,
    START,
    TURNS,
    angles,
    rates,
    worst,
)


def exudyn_fourbar(system: Any, speed: float) -> list[Any]:
    """The four-bar added to a system, driven; the nodes of crank, coupler and rocker."""
    coupler, rocker = (float(each[0]) for each in angles(np.array([START])))
    of_coupler, of_rocker = rates(START, speed)
    b = np.array([CRANK * math.cos(START), CRANK * math.sin(START)])
    c = np.array([GROUND + ROCKER * math.cos(rocker), ROCKER * math.sin(rocker)])
    d = np.array([GROUND, 0.0])
    of_b, of_c = speed * _across(b), of_rocker * _across(c - d)
    bars = (
        (CRANK, b / 2, START, of_b / 2, speed),
        (COUPLER, (b + c) / 2, coupler, (of_b + of_c) / 2, of_coupler),
        (ROCKER, (c + d) / 2, rocker, of_c / 2, of_rocker),
    )
    ground = system.AddObject(items.ObjectGround())
    bodies, nodes = [], []
    for length, place, theta, velocity, omega in bars:
        nodes.append(
            system.AddNode(
                items.NodeRigidBody2D(
                    referenceCoordinates=[*place, theta], initialVelocities=[*velocity, omega]
                )
            )
        )
        bodies.append(
            system.AddObject(
                items.ObjectRigidBody2D(mass=length, inertia=length**3 / 12, nodeNumber=nodes[-1])
            )
        )
    pins = (
        (ground, 0.0, bodies[0], -CRANK / 2),
        (bodies[0], CRANK / 2, bodies[1], -COUPLER / 2),
        (bodies[1], COUPLER / 2, bodies[2], ROCKER / 2),
        (ground, GROUND, bodies[2], -ROCKER / 2),
    )
    for one, at_one, other, at_other in pins:
        ends = [
            system.AddMarker(items.MarkerBodyRigid(bodyNumber=body, localPosition=[x, 0.0, 0.0]))
            for body, x in ((one, at_one), (other, at_other))
        ]
        system.AddObject(items.ObjectJointRevolute2D(markerNumbers=ends))
    still = system.AddNode(items.NodePointGround())
    ends = [
        system.AddMarker(items.MarkerNodeCoordinate(nodeNumber=node, coordinate=coordinate))
        for node, coordinate in ((still, 0), (nodes[0], 2))
    ]
    system.AddObject(
        items.ObjectConnectorCoordinate(markerNumbers=ends, velocityLevel=True, offset=speed)
    )
    return nodes


def _across(vector: Array) -> Array:
    return np.array([-vector[1], vector[0]])


def simulated(system: Any, simulation: Any, nodes: list[Any]) -> list[Array]:
    """Coordinates of the nodes at every step, after the times, of a system that is run."""
    sensors = [
        system.AddSensor(
            items.SensorNode(
                nodeNumber=node,
                storeInternal=True,
                writeToFile=False,
                outputVariableType=exu.OutputVariableType.Coordinates,
            )
        )
        for node in nodes
    ]
    system.Assemble()
    simulation.solution.file.write = False
    simulation.solution.sensors.writePeriod = 0.0
    system.SolveDynamic(simulation)
    return [np.array(system.GetSensorStoredData(sensor)) for sensor in sensors]


def exudyn_error(snippet: str, steps: int, speed: float) -> float:
    """The largest error of coupler and rocker [rad] over two turns with a snippet; infinite where
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
    started = (float(each[0]) for each in angles(np.array([START])))
    exact = angles(START + speed * coupler[:, 0])
    found = tuple(first + log[:, 3] for first, log in zip(started, (coupler, rocker), strict=True))
    return worst(found, exact)


def measured_in_exudyn(snippet: str) -> str:
    """The snippet with the settings that stand in its comments in force, too."""
    return snippet.replace("#   ", "")
